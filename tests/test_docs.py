"""What the README and the documents say is so: worked examples work, files that are named are there."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from physicslab.integrators import INTEGRATORS
from physicslab.view.controls.controls import CONTROLS

ROOT = Path(__file__).parent.parent
README = ROOT / "README.md"
CONTRIBUTING = ROOT / "docs" / "contributing.md"
BLOCK = re.compile(r"^```(python|diff)\n# (\S+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
EXAMPLES = [match.groups() for match in BLOCK.finditer(CONTRIBUTING.read_text(encoding="utf-8"))]
NEW = {path for kind, path, _ in EXAMPLES if kind == "python"}
CHANGES = [(name, text) for kind, name, text in EXAMPLES if kind == "diff" and name not in NEW]
FOR_ALL = {
    "tests/test_integrate.py": "yoshida4", "tests/test_accounts_of_flows.py": "yoshida4",
    "tests/test_mutated_flows.py": "yoshida4", "tests/test_scenes.py": "balloons",
    "tests/test_workbench.py": "every_control", "tests/test_input.py": "table_of_controls",
    "tests/test_docs.py": "has_every_key or every_method_is_in", "README.md": "README",
}  # fmt: skip
"""Tests that hold for every method, scene and control, and the words by which those of the examples go."""
MOUSE = {"left", "middle", "right", "wheel"}


def kept(text: str) -> str:
    """Return the part of a line that is written out, where ``...`` stands for its beginning or end."""
    if text.lstrip().startswith("..."):
        return text.lstrip().removeprefix("...").lstrip()
    return text.removesuffix("...")


def changed(source: str, diff: str, name: str = "") -> str:
    """Return the source of a file with one change made, whose old lines must be there once."""
    lines = [(line[:1], kept(line[1:])) for line in diff.splitlines()]
    before = "\n".join(text for sign, text in lines if sign in " -")
    after = "\n".join(text for sign, text in lines if sign in " +")
    times = source.count(before)
    assert times == 1, f"{before!r} must be there once in {name}, and is {times} times. The change:\n{diff}"
    return source.replace(before, after)


def run_tests(place: Path, chosen: str, *files: str) -> None:
    """Run some tests of a copy of the program, in a process of its own."""
    ours = {"PYTHONPATH": str(place), "PYTHONDONTWRITEBYTECODE": "1"}
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST_")} | ours
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--doctest-glob=README.md"]
    command += ["-k", f"({chosen}) and not document_names", *files]
    done = subprocess.run(
        command, cwd=place, env=environment, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture
def copy(tmp_path: Path) -> Iterator[Path]:
    """Return a copy of the program and its tests, to be changed."""
    for name in ("physicslab", "tests", "docs"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__", "*.png"))
    for name in ("conftest.py", "README.md"):
        shutil.copy(ROOT / name, tmp_path)
    (tmp_path / "pytest.ini").write_text("[pytest]\nfilterwarnings = error\nmarkers = slow\n")
    yield tmp_path
    shutil.rmtree(tmp_path)


def test_the_worked_examples_of_contributing_work(copy: Path) -> None:
    added: list[str] = []
    for kind, name, text in EXAMPLES:
        path = copy / name
        if kind == "python":
            assert not path.exists(), f"{name} exists by now: choose another name in docs/contributing.md"
            path.write_text(text, encoding="utf-8")
            added += [name] * name.startswith("tests/")
            continue
        if name in NEW and "-    @at" in text:  # an example is about to be replaced: see that it works first
            assert added
            run_tests(copy, "test_", *added)
        path.write_text(changed(path.read_text(encoding="utf-8"), text, name), encoding="utf-8")
    assert len(added) == 9
    chosen = " or ".join((*(Path(name).stem for name in added), *FOR_ALL.values()))
    run_tests(copy, chosen, *added, *FOR_ALL)


@pytest.mark.parametrize(("name", "text"), CHANGES, ids=[name for name, _ in CHANGES])
def test_an_example_still_applies_where_the_same_was_done_before(name: str, text: str) -> None:
    once = changed((ROOT / name).read_text(encoding="utf-8"), text, name)
    assert len(changed(once, text, name)) > len(once), "lines are added, none replaced"


def test_a_change_is_refused_whose_old_lines_are_not_there_once() -> None:
    assert changed("a = [1]\nb = 2\n", " b = 2\n+c = 3\n") == "a = [1]\nb = 2\nc = 3\n"
    assert changed("a = [1]\n", "-a = [...\n+a = [0, ...\n") == "a = [0, 1]\n"
    for source in ("", "b = 2\nb = 2\n"):
        with pytest.raises(AssertionError, match=r"must be there once in a\.py(?s:.)*\+c = 3"):
            changed(source, " b = 2\n+c = 3\n", "a.py")


@pytest.mark.parametrize("path", [README, *sorted((ROOT / "docs").rglob("*.md"))], ids=lambda path: path.name)
def test_files_that_a_document_names_are_there(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    named = set(re.findall(r"`((?:physicslab|tests|benchmarks|docs)/[\w/.]*)`", text)) - NEW
    assert [name for name in sorted(named) if not (ROOT / name).exists()] == []
    linked = set(re.findall(r"\]\((?!https?:|#)([^)#\s]+)", text))
    assert [name for name in sorted(linked) if not (path.parent / name).exists()] == []


def keys_in(text: str) -> set[str]:
    """Return what is pressed according to the table of keys, in small letters: a cell names one or more."""
    table = text.partition("## Keys")[2].partition("\n## ")[0]
    cells = re.findall(r"^\| (.+?) \| ", table, re.MULTILINE)[1:]
    keys = {key.lower() for cell in cells for key in re.split(r", | and ", cell)}
    return {first if (first := key.split()[0]) in MOUSE else key for key in keys}


def test_the_readme_is_short_and_has_every_key() -> None:
    text = README.read_text(encoding="utf-8")
    assert 150 <= len(text.splitlines()) <= 200
    shown, names = keys_in(text), [{c.label.lower(), c.key or c.label.lower(), *c.also} for c in CONTROLS]
    assert [min(known - {""}) for known in names if shown.isdisjoint(known)] == [], "keys without a row"
    assert sorted(shown.difference(*names)) == [], "rows of keys that there are not"


def test_every_method_is_in_the_table_of_accuracy() -> None:
    text = (ROOT / "docs" / "accuracy.md").read_text(encoding="utf-8")
    rows = dict(re.findall(r"^\| `(\w+)` \| [^|]+ \| (\w+) \|", text, re.MULTILINE))
    orders = {name: str(method.order).removesuffix(".0") for name, method in INTEGRATORS.items()}
    assert rows == {name: order.replace("inf", "exact") for name, order in orders.items()}


def test_a_key_is_in_the_table_only_where_a_cell_names_it() -> None:
    table = "## Keys\n\n| input | action |\n|---|---|\n"
    assert keys_in(f"{table}| wheel, middle drag | zoom |\n") == {"wheel", "middle"}
    rows = f"{table}| P | what W does |\n| G, O | laws |\n| [ and ] | speed |\n\n## More\n\n| X | other |\n"
    assert keys_in(rows) == {"p", "g", "o", "[", "]"}


def test_the_page_of_components_has_every_field() -> None:
    spec = importlib.util.spec_from_file_location("components_page", ROOT / "docs" / "components.py")
    assert spec is not None and spec.loader is not None
    writer = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(writer)
    words = "uv run python docs/components.py writes it again"
    assert writer.page() == writer.PAGE.read_text(encoding="utf-8"), words
    assert "| `restitution` | `0.0` | a finite number from 0 to 1 |" in writer.page()
