"""Where documents go: old ones stay until new ones are there, and none goes where another does."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from physicslab import World, cli
from physicslab.components import Name, Velocity
from physicslab.files.scene import load_scene, save_scene
from physicslab.prefabs import circle
from physicslab.systems.standard import standard_systems

ROOT = Path(__file__).parent.parent
LATIN = os.fsdecode(b"caf\xe9.json")
"""A file name that is not UTF-8."""


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Run a command that is refused, and return the one line that it says."""
    assert cli.main(arguments) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 1
    return said.err


def test_a_full_disk_leaves_the_old_table(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    table = tmp_path / "old.csv"
    table.write_text("old")
    monkeypatch.setattr("physicslab.commands.run.TrajectoryWriter.write", full)
    assert cli.main(["run", "drop", "--steps", "3", "--csv", str(table)]) == 1
    assert "No space left on device" in capsys.readouterr().err
    assert table.read_text() == "old" and os.listdir(tmp_path) == ["old.csv"]


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such signal")
def test_a_killed_run_leaves_the_old_table(tmp_path: Path) -> None:
    table = tmp_path / "old.csv"
    table.write_text("old")
    command = [sys.executable, "main.py", "run", "gas", "--seconds", "1000", "--csv", str(table)]
    with subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE, text=True) as program:
        deadline = time.monotonic() + 60.0
        while not any(path.stat().st_size > 10_000 for path in tmp_path.glob(".*-tmp")):
            assert program.poll() is None and time.monotonic() < deadline
            time.sleep(0.05)
        program.send_signal(signal.SIGKILL)
    assert table.read_text() == "old"


@pytest.mark.parametrize("option", ["--csv", "--json", "--png"])
def test_a_second_name_of_the_scene_is_the_scene(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene, other = tmp_path / "scene.json", tmp_path / "other"
    save_scene(load_scene("drop"), scene)
    os.link(scene, other)
    before = scene.read_bytes()
    assert refused(capsys, "run", str(scene), option, str(other)).endswith("is the scene itself\n")
    assert scene.read_bytes() == before


def test_two_names_of_one_file_are_not_both_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one, two = tmp_path / "one", tmp_path / "two"
    one.write_text("")
    os.link(one, two)
    line = refused(capsys, "run", "drop", "--json", str(one), "--csv", str(two))
    assert "--json and --csv cannot both go to" in line


@pytest.mark.skipif(not Path("/dev/stdout").exists(), reason="needs /dev/stdout")
def test_stdout_has_two_names() -> None:
    command = [
        sys.executable,
        "main.py",
        "run",
        "drop",
        "--steps",
        "1",
        "--json",
        "-",
        "--csv",
        "/dev/stdout",
    ]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert "--json and --csv cannot both go to -" in done.stderr


@pytest.mark.parametrize("command", [["run", "drop"], ["scenes"], ["accuracy"], ["stability"], ["bench"]])
def test_an_empty_path_is_refused_before_anything_runs(
    command: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert refused(capsys, *command, "--json", "") == (
        'physicslab: --json "": must be a path, or - for stdout\n'
    )


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="file names are Unicode there")
def test_a_file_name_that_is_not_utf_8_loses_no_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    save_scene(load_scene("two_planets"), LATIN)
    text = Path(LATIN).read_text().replace('"name": "two_planets"', '"name": ""')
    text = text.replace('"title": "', '"title": "\u202e\u2066\u200e')
    Path(LATIN).write_text(text)
    assert cli.main(["run", LATIN, "--steps", "2", "--json", "out.json"]) == 0
    assert json.loads(Path("out.json").read_bytes())["scene"] == "caf\\udce9"
    capsys.readouterr()
    assert cli.main(["run", LATIN, "--steps", "2"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("caf\\udce9: \\u202e\\u2066\\u200e") and err == ""
    assert out.replace("\n", "").isprintable(), "nothing turns the terminal's text round"


@pytest.mark.skipif(os.name == "nt", reason="Windows allows no such file names")
def test_no_file_name_moves_the_cursor(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    name = "a\x1b[2J\nb.json"
    Path(name).write_text('{"format": "physicslab-scene/1", "entities": []}')
    assert cli.main(["run", name, "--steps", "1"]) == 0
    assert capsys.readouterr().out.startswith("a\\x1b[2J\\nb\n")
    assert cli.main(["bench", name]) == 0
    out, err = capsys.readouterr()
    assert "\x1b" not in out + err and "a\\x1b[2J\\nb" in out + err


def test_a_spreadsheet_computes_no_id(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What begins with = + - or @ is a formula to a spreadsheet, in quotes too."""
    monkeypatch.chdir(tmp_path)
    world = World(*standard_systems())
    ids = ("=HYPERLINK(1)", "+1", "-1", "@SUM(1)", "ball")
    for n, name in enumerate(ids):
        world.add(circle(world, (n * 0.5, 0.4)), Name(name))
        world.component(world.entity(name), Velocity).linear = (-float(n), 0.0)
    save_scene(world, "formula.json")
    assert cli.main(["run", "formula.json", "--seconds", "1", "--csv", "a.csv", "--ledger", "b.csv"]) == 0
    with open("a.csv", newline="") as table, open("b.csv", newline="") as impacts:
        names = {row["entity"] for row in csv.DictReader(table)}
        struck = {row[side] for row in csv.DictReader(impacts) for side in "AB"}
    assert names == {"'=HYPERLINK(1)", "'+1", "'-1", "'@SUM(1)", "ball"}
    assert struck and struck <= names
