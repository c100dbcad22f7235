"""The wheel in a fresh environment: the base computes without a display, the extra ``window`` opens one."""

import compileall
import json
import os
import re
import shutil
import subprocess
import sys
import zipapp
import zipfile
from pathlib import Path

import pytest
from screens import ROOT, Screen, needs_screen
from screens import screen as screen

from physicslab.kernels.program import own_command

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
        self._programs = environment / ("Scripts" if os.name == "nt" else "bin")
        self.command = str(self._programs / "physicslab")

    def packages(self) -> set[str]:
        """Return the names of what is installed."""
        rows = json.loads(uv("pip", "list", "--python", self.folder / "env", "--format", "json"))
        return {row["name"] for row in rows}

    def run(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run the installed command."""
        return self._run(self.command, *arguments)

    def python(self, code: str) -> subprocess.CompletedProcess[str]:
        """Run a program with what is installed."""
        return self._run(str(self._programs / "python"), "-c", code)

    def _run(self, *command: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False)


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
    lines = {
        "--png": ["run", "drop", "--png", "drop.png"],
        "--gif": ["export", "drop", "--gif", "drop.gif"],
        "the window": [],
        "circles_10_window": ["bench", "circles_10_window"],
        "--open": ["sweep", "drop", "--vary", "ball.Mass.mass=1:2:2", "--open", "1"],
    }
    program = "from physicslab.cli import main; print([main(line) for line in {}])"
    done = installed.python(program.format([*lines.values()]))
    wanted = "needs the package pygame, which is not installed: pip install 'physicslab[window]'"
    assert done.stdout == f"{[2] * len(lines)}\n"
    assert done.stderr == "".join(f"physicslab: {user}: {wanted}\n" for user in lines)
    assert not list(installed.folder.glob("drop.[pg]*"))


@needs_screen
def test_with_the_extra_the_window_opens(wheel: Path, tmp_path: Path, screen: Screen) -> None:
    installed = Installed(tmp_path, wheel, "[window]")
    assert installed.packages() >= BASE | {"imgui-bundle", "pygame-ce"}
    assert installed.run("run", "drop", "--seconds", "1", "--png", "drop.png").returncode == 0
    program = screen.launch("drop", command=[installed.command])
    screen.leave(program)


# ---- without sources ---------------------------------------------------------------------------------------

KERNEL = "physicslab.kernels.motion.clear"
RUN = ("run", "drop", "--seconds", "1", "--json", "-")


@pytest.fixture(scope="module")
def compiled(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the package as compiled modules, and the main script of an archive."""
    folder = tmp_path_factory.mktemp("compiled")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    assert compileall.compile_dir(folder, quiet=2, legacy=True)
    for source in folder.rglob("*.py"):
        source.unlink()
    shutil.copy(ROOT / "physicslab" / "__main__.py", folder)
    return folder


@pytest.mark.parametrize("way", ["modules", "archive"])
def test_without_sources_it_gives_the_same_bits_and_keeps_kernels(
    way: str, compiled: Path, tmp_path: Path
) -> None:
    command, path = [sys.executable, "-m", "physicslab"], str(compiled)
    if way == "archive":
        command, path = [sys.executable, str(tmp_path / "physicslab.pyz")], ""
        zipapp.create_archive(compiled, command[1])
    environment = {**os.environ, "PYTHONPATH": path, "PHYSICSLAB_KERNELS": str(tmp_path / "kernels")}

    def run(*arguments: str, stdin: str = "") -> str:
        done = subprocess.run(
            [*command, *arguments], input=stdin, cwd=tmp_path, env=environment, text=True,
            capture_output=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout

    ours = subprocess.run([sys.executable, "-m", "physicslab", *RUN], capture_output=True, check=True)
    assert json.loads(run(*RUN))["entities"] == json.loads(ours.stdout)["entities"]
    assert run("kernels", "--worker", stdin=f"{KERNEL}\n") == f"{KERNEL}\n"
    (kept,) = (tmp_path / "kernels").glob("motion-*/*.nbc")
    before = kept.stat().st_mtime_ns
    assert run("kernels", "--worker", stdin=f"{KERNEL}\n") == f"{KERNEL}\n"
    assert kept.stat().st_mtime_ns == before, "it is loaded, and not compiled again"
    assert "Wie weit" in run("lesson", "projectile", "--language", "de", "--json", "-")
    assert run("export", "drop", "--seconds", "0.1", "--html", "-").startswith("<!DOCTYPE html>")


def test_a_program_without_python_starts_itself_by_its_own_name(monkeypatch: pytest.MonkeyPatch) -> None:
    assert own_command("run") == (sys.executable, "-m", "physicslab", "run")
    monkeypatch.setattr(sys, "frozen", True, raising=False)
    assert own_command("run") == (sys.executable, "run"), "-m would open its window"
    started = re.compile(r"sys\.executable")
    found = [
        path.name for path in (ROOT / "physicslab").rglob("*.py") if started.search(path.read_text("utf-8"))
    ]
    assert found == ["program.py"], "all else goes by own_command"


@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder that PyInstaller makes."""
    pytest.importorskip("PyInstaller", reason="needs the group: uv run --group bundle pytest -m slow")
    place = tmp_path_factory.mktemp("bundle")
    options = [
        "--noconfirm",
        "--log-level",
        "ERROR",
        "--distpath",
        str(place),
        "--workpath",
        str(place / "work"),
    ]
    command = [sys.executable, "-m", "PyInstaller", *options, "bundle.spec"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return place / "physicslab"


@needs_screen
def test_a_frozen_program_opens_its_window_and_works_in_processes(bundle: Path, screen: Screen) -> None:
    assert not list(bundle.rglob("physicslab/**/*.py"))
    command = str(bundle / "physicslab")
    screen.leave(screen.launch("drop", command=[command]))
    vary = ["--vary", "ball.Mass.mass=1:5:9"]
    page = [command, "export", "drop", "--seconds", "0.1", *vary, "--html", "page.html"]
    done = subprocess.run(page, cwd=screen.folder, env=screen.environment, capture_output=True, text=True)
    assert done.returncode == 0 and "9 runs" in done.stdout, done.stderr
