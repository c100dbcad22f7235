"""The program as a process of its own: whatever stands on its command line, it says one line or does it."""

from __future__ import annotations

import os
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from physicslab.files.scene import LARGEST_FILE, SceneError, load_scene

MAIN = Path(__file__).parents[1] / "main.py"
SECONDS = 60
"""After so long a command hangs."""

WORDS = (
    "0", "1", "-1", "1e308", "5e-324", "nan", "9" * 400, "", " ", "--", "a\nb", "\udcff", "x" * 5000,
    "/dev/zero", "/", "drop", "leapfrog", "--bogus", "--json=", "--png=/", "--csv=/none/x",
)  # fmt: skip
OPTIONS = ("--seconds", "--steps", "--dt", "--substeps", "--integrator", "--json", "--csv", "--png")
HOSTILE = (
    ["accuracy", "nothing"], ["accuracy", "a\nb"], ["accuracy", "--json"], ["accuracy", "--json", "/"],
    ["accuracy", "--json", "/none/x"], ["accuracy", "--plot", "/dev/null"],
    ["accuracy", "--plot", "/dev/null/x"], ["accuracy", "/dev/zero"], ["accuracy", "x" * 5000],
    ["accuracy", "drop", "--json", "/proc/x"], ["accuracy", "drop", "--json", "x" * 5000],
    ["stability", "nothing"], ["stability", ""], ["stability", "x" * 5000], ["stability", "a\nb"],
    ["stability", "--json", "/"], ["stability", "--json", "/none/x"], ["stability", "--json", "/proc/x"],
    ["scenes", "--json", "/"], ["scenes", "more"], ["bench", "nothing"], ["run"], ["run", "--json"],
    ["nothing"], ["--bogus"], ["drop", "drop"], ["/"], ["/dev/zero"], [""],
)  # fmt: skip


def spoken(line: list[str], directory: Path, *program: str) -> tuple[int, str]:
    """Run a command line in a directory; return its status and what it says on stderr."""
    environment = {**os.environ, "SDL_VIDEODRIVER": "dummy", "PYTHONWARNINGS": "error"}
    done = subprocess.run(
        [sys.executable, *(program or ("-m", "physicslab.cli")), *line],
        capture_output=True, timeout=SECONDS, check=False, cwd=directory, env=environment,
    )  # fmt: skip
    return done.returncode, done.stderr.decode("utf-8", "replace")


def random_lines(count: int) -> list[list[str]]:
    """Return command lines that are drawn alike each time; those that are allowed run for two steps."""
    chance = random.Random(2)
    lines = []
    for _ in range(count):
        line = ["run", chance.choice(("drop", "pendulum", "two_planets", *WORDS))]
        for option in chance.sample(OPTIONS, 2):
            line += [option, chance.choice(WORDS)]
        long = "--seconds" in line or "--steps" in line
        lines.append(line if long else [*line, "--steps", "2"])
    return [line for line in lines if not ("--seconds" in line and "--dt" in line)]


def check(line: list[str], directory: Path, *program: str) -> int:
    """Check how a command line ends, and return its status."""
    status, said = spoken(line, directory, *program)
    assert status in (0, 1, 2), (line, status, said)
    assert "Traceback" not in said and "Warning" not in said, (line, said)
    if status:
        assert len(said.splitlines()) == 1 and said.startswith("physicslab: "), (line, said)
        assert said.strip().isprintable() and len(said) < 12_000, (line, said)
    else:
        assert said == "", (line, said)
    return status


@pytest.mark.parametrize("program", [(), (str(MAIN),)], ids=["module", "main.py"])
def test_hostile_options_are_refused_in_one_line(program: tuple[str, ...], tmp_path: Path) -> None:
    lines = HOSTILE if not program else HOSTILE[::6]
    with ThreadPoolExecutor(2) as pool:
        statuses = list(pool.map(lambda line: check(line, tmp_path, *program), lines))
    assert set(statuses) == {2}


def test_random_command_lines_are_done_or_refused_in_one_line(tmp_path: Path) -> None:
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda line: check(line, tmp_path), random_lines(12)))


def test_a_file_that_grows_while_it_is_read_is_read_no_further_than_the_limit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "scene.json"
    path.write_bytes(b"{")
    fstat = os.fstat

    def grow(file: int) -> os.stat_result:
        seen = fstat(file)
        os.truncate(path, 2 * LARGEST_FILE)  # after it was looked at, before it is read
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
