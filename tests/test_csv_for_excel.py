"""Tables for spreadsheets of languages with decimal commas: the numbers of the usual ones, to the bit."""

import csv
from pathlib import Path

import pytest

from physicslab.cli import main


@pytest.mark.parametrize("kind", ["csv", "ledger"])
def test_the_numbers_are_those_of_the_usual_table(kind: str, tmp_path: Path) -> None:
    usual, excel = tmp_path / "usual.csv", tmp_path / "excel.csv"
    run = ["run", "drop", "--seconds", "1.2"]
    assert (
        main([*run, f"--{kind}", str(usual)])
        == main([*run, f"--{kind}", str(excel), "--csv-for", "excel"])
        == 0
    )
    content = excel.read_bytes()
    assert content.startswith(b"\xef\xbb\xbf") and b"\r" not in content
    rows = [*csv.reader(content.decode("utf-8-sig").splitlines(), delimiter=";")]
    wanted = [*csv.reader(usual.read_text("utf-8").splitlines())]
    assert rows[0] == wanted[0] and len(rows) == len(wanted) > 1
    assert any("," in cell for cell in rows[1]) and not any("." in cell for cell in rows[1])
    assert [[cell.replace(",", ".") for cell in row] for row in rows[1:]] == wanted[1:]
