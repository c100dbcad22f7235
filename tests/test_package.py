"""The wheel in a fresh environment: the base computes without a display, the extra ``window`` opens one."""

import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from screens import ROOT, Screen, needs_screen
from screens import screen as screen

UV = os.environ.get("UV") or shutil.which("uv")
pytestmark = [pytest.mark.slow, pytest.mark.skipif(UV is None, reason="uv is not installed")]

BASE = {"esper", "filelock", "llvmlite", "numba", "numpy", "physicslab", "platformdirs"}


def uv(*arguments: object) -> str:
    """Run uv, and return what it printed."""
    assert UV is not None
    command = [UV, *map(str, arguments)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


class Installed:
    """An environment with the wheel in it, whose commands are run where no source is."""

    def __init__(self, folder: Path, wheel: Path, extra: str) -> None:
        self.folder, environment = folder, folder / "env"
        uv("venv", "--quiet", "--python", sys.executable, environment)
        uv("pip", "install", "--quiet", "--python", environment, f"physicslab{extra} @ {wheel.as_uri()}")
        self.command = str(environment / ("Scripts" if os.name == "nt" else "bin") / "physicslab")

    def packages(self) -> set[str]:
        """Return the names of what is installed."""
        rows = json.loads(uv("pip", "list", "--python", self.folder / "env", "--format", "json"))
        return {row["name"] for row in rows}

    def run(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run the installed command."""
        return subprocess.run(
            [self.command, *arguments], cwd=self.folder, capture_output=True, text=True, check=False
        )


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    uv("build", "--quiet", "--wheel", "--out-dir", folder)
    (built,) = folder.glob("*.whl")
    return built


def test_the_wheel_is_typed_and_has_its_data(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    ours = [path.relative_to(ROOT).as_posix() for path in (ROOT / "physicslab").rglob("*") if path.is_file()]
    assert {"physicslab/py.typed", "physicslab/languages/de.po"} <= set(names)
    assert {name for name in ours if "__pycache__" not in name} <= set(names)
    assert not [name for name in names if not name.startswith(("physicslab/", "physicslab-"))]


def test_the_base_runs_and_exports_without_the_window(wheel: Path, tmp_path: Path) -> None:
    installed = Installed(tmp_path, wheel, "")
    assert installed.packages() == BASE
    done = installed.run("run", "drop", "--seconds", "1", "--json", "-")
    assert done.returncode == 0 and json.loads(done.stdout)["steps"] == 60, done.stderr
    done = installed.run("export", "drop", "--seconds", "0.5", "--html", "drop.html")
    assert done.returncode == 0 and (installed.folder / "drop.html").stat().st_size > 10_000, done.stderr
    assert "two_planets" in installed.run("scenes").stdout
    for user, *arguments in (
        ("--png", "run", "drop", "--png", "drop.png"),
        ("--gif", "export", "drop", "--gif", "drop.gif"),
        ("the window",),
        ("circles_10_window", "bench", "circles_10_window"),
    ):
        done = installed.run(*arguments)
        wanted = "needs the package pygame, which is not installed: pip install 'physicslab[window]'"
        assert (done.returncode, done.stdout, done.stderr) == (2, "", f"physicslab: {user}: {wanted}\n")
    assert not list(installed.folder.glob("drop.[pg]*"))


@needs_screen
def test_with_the_extra_the_window_opens(wheel: Path, tmp_path: Path, screen: Screen) -> None:
    installed = Installed(tmp_path, wheel, "[window]")
    assert installed.packages() >= BASE | {"imgui-bundle", "pygame-ce"}
    assert installed.run("run", "drop", "--seconds", "1", "--png", "drop.png").returncode == 0
    program = screen.launch("drop", command=[installed.command])
    screen.leave(program)
