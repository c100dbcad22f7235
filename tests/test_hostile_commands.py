"""The program as a process of its own: any command line is run, or refused in one line."""

from __future__ import annotations

import os
import random
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from deadline import deadline
from forked import ForkedProgram

from physicslab.files.plain import FILE_LIMIT
from physicslab.files.scene import SceneError, load_scene

MAIN = Path(__file__).parents[1] / "main.py"
WARNINGS = {"SDL_VIDEODRIVER": "dummy", "PYTHONWARNINGS": "error"}

WORDS = (
    "0", "1", "-1", "1e308", "5e-324", "nan", "9" * 400, "", " ", "--", "a\nb", "\udcff", "x" * 5000,
    "/dev/zero", "/", "drop", "leapfrog", "--bogus", "--json=", "--png=/", "--csv=/none/x",
    "bob.Mass.mass=1e308", "ball.Velocity.linear=[1e308, 1e308]", "=.=.=",
)  # fmt: skip
OPTIONS = (
    "--seconds",
    "--steps",
    "--dt",
    "--substeps",
    "--integrator",
    "--json",
    "--csv",
    "--png",
    "--set",
    "--every",
)
HOSTILE = (
    ["accuracy", "nothing"], ["accuracy", "a\nb"], ["accuracy", "--json"], ["accuracy", "--json", "/"],
    ["accuracy", "--json", "/none/x"], ["accuracy", "--plot", "/dev/null"],
    ["accuracy", "--plot", "/dev/null/x"], ["accuracy", "/dev/zero"], ["accuracy", "x" * 5000],
    ["accuracy", "drop", "--json", "/proc/x"], ["accuracy", "drop", "--json", "x" * 5000],
    ["stability", "nothing"], ["stability", ""], ["stability", "x" * 5000], ["stability", "a\nb"],
    ["stability", "--json", "/"], ["stability", "--json", "/none/x"], ["stability", "--json", "/proc/x"],
    ["scenes", "--json", "/"], ["scenes", "more"], ["bench", "nothing"], ["run"], ["run", "--json"],
    ["export", "drop"], ["export", "drop", "--html", "/proc/x"], ["export", "drop", "--html", "x" * 5000],
    ["export", "/dev/zero", "--html", "x.html"], ["export", "drop", "--html", "x.html", "--seconds", "1e14"],
    ["export", "drop", "--html", "x.html", "--set", "a\nb"],
    ["nothing"], ["--bogus"], ["drop", "drop"], ["/"], ["/dev/zero"], [""],
)  # fmt: skip


@pytest.fixture
def program(tmp_path: Path) -> Iterator[ForkedProgram]:
    """Return the program, imported once for all command lines of a test."""
    if not hasattr(os, "fork"):
        pytest.skip("processes are not forked here")
    with ForkedProgram(tmp_path, WARNINGS) as forked:
        yield forked


def spoken(line: list[str], directory: Path, program: ForkedProgram | None = None) -> tuple[int, str]:
    """Run a command line in a directory; return its status and what it says on stderr.

    ``python main.py`` in a fresh process where no program is given.
    """
    with deadline(line):
        if program is not None:
            status, _, said = program.run(line)
        else:
            done = subprocess.run(
                [sys.executable, str(MAIN), *line],
                capture_output=True, check=False, cwd=directory, env={**os.environ, **WARNINGS},
            )  # fmt: skip
            status, said = done.returncode, done.stderr
    return status, said.decode("utf-8", "replace")


def random_lines(count: int) -> list[list[str]]:
    """Return command lines that are drawn alike each time; those that are allowed run for two steps."""
    chance = random.Random(23)
    lines = []
    for _ in range(count):
        line = ["run", chance.choice(("drop", "pendulum", "two_planets", *WORDS))]
        for option in chance.sample(OPTIONS, 2):
            line += [option, chance.choice(WORDS)]
        long = "--seconds" in line or "--steps" in line
        lines.append(line if long else [*line, "--steps", "2"])
    return [line for line in lines if not ("--seconds" in line and "--dt" in line)]


def check(line: list[str], directory: Path, program: ForkedProgram | None = None) -> int:
    """Check how a command line ends, and return its status."""
    status, said = spoken(line, directory, program)
    assert status in (0, 1, 2), (line, status, said)
    assert "Traceback" not in said and "Warning" not in said, (line, said)
    if status:
        assert len(said.splitlines()) == 1 and said.startswith("physicslab: "), (line, said)
        assert said.strip().isprintable() and len(said) < 12_000, (line, said)
    else:
        assert said == "", (line, said)
    return status


def test_hostile_options_are_refused_in_one_line(program: ForkedProgram, tmp_path: Path) -> None:
    assert {check(line, tmp_path, program) for line in HOSTILE} == {2}


def test_hostile_options_are_refused_in_one_line_by_a_fresh_process(tmp_path: Path) -> None:
    assert {check(line, tmp_path) for line in HOSTILE[::6]} == {2}


def test_random_command_lines_are_done_or_refused_in_one_line(program: ForkedProgram, tmp_path: Path) -> None:
    statuses = [check(line, tmp_path, program) for line in random_lines(12)]
    assert set(statuses) >= {0, 2}, "some of them are allowed"


def test_a_file_that_grows_while_it_is_read_is_read_no_further_than_the_limit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "scene.json"
    path.write_bytes(b"{")
    fstat = os.fstat

    def grow(file: int) -> os.stat_result:
        seen = fstat(file)
        os.truncate(path, 2 * FILE_LIMIT)  # after it was looked at, before it is read
        return seen

    monkeypatch.setattr("physicslab.files.scene.os.fstat", grow)
    with pytest.raises(SceneError, match="is too large: a scene file must have at most"):
        load_scene(path)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="nothing is forbidden to root")
def test_a_file_without_permission_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_bytes(b"{}")
    path.chmod(0)
    status, said = spoken(["run", str(path)], tmp_path)
    assert (status, said) == (2, f"physicslab: {path}: cannot be read: Permission denied\n")
