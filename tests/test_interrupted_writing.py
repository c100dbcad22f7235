"""Saving never destroys: a kill in the middle, or a full disk, leaves the old file whole."""

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pygame
import pytest
from desk import Desk
from forked import ForkedProgram

from physicslab.cli import main
from physicslab.desktop.autosave import Autosave
from physicslab.files import replace
from physicslab.files.replace import create_file, remove_leftovers, replace_file
from physicslab.files.scene import load_scene, save_scene

pytestmark = pytest.mark.skipif(os.name == "nt", reason="signals and limits of POSIX")

CTRL = pygame.KMOD_LCTRL

WRITER = """
import os, signal, sys, threading

from pathlib import Path
from physicslab.files.scene import load_scene, save_scene
from physicslab.desktop.autosave import Autosave
from physicslab.cli import main
way, path, moment = sys.argv[1], Path(sys.argv[2]), sys.argv[3]

def die(*arguments, **named):
    os.kill(os.getpid(), signal.SIGKILL)

class Half:
    def __init__(self, file): self.file = file
    def __enter__(self): return self
    def __exit__(self, *why): self.file.close()
    def write(self, content):
        self.file.write(content[: len(content) // 2]); self.file.flush(); die()

if moment == "write":
    import builtins
    import physicslab.files.replace as module
    module.open = lambda name, mode: Half(builtins.open(name, mode))
else:
    setattr(os, moment, die)
world = load_scene("stack")
if way == "save_scene":
    save_scene(world, path)
elif way == "json":
    main(["run", "drop", "--steps", "3", "--json", str(path)])
else:
    autosave = Autosave(path, period=0.0, share=60.0)
    while True:
        autosave.advance(world)
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ForkedProgram]:
    with ForkedProgram(tmp_path_factory.mktemp("program"), {}) as forked:
        yield forked


@pytest.mark.parametrize(
    ("way", "moment"),
    [
        ("save_scene", "write"), ("save_scene", "fsync"), ("save_scene", "replace"),
        ("json", "write"), ("autosave", "write"), ("autosave", "replace"),
    ],
)  # fmt: skip
def test_a_kill_in_the_middle_leaves_the_old_file_whole(
    way: str, moment: str, tmp_path: Path, program: ForkedProgram
) -> None:
    path = tmp_path / "kept.json"
    save_scene(load_scene("drop"), path)
    old = path.read_bytes()
    status, _, said = program.run([way, str(path), moment], WRITER)
    assert status == -9, said.decode()
    assert path.read_bytes() == old
    (left,) = set(tmp_path.iterdir()) - {path}
    assert left.name.startswith(".kept.json.") and left.name.endswith(".physicslab-tmp")
    replace_file(path, b"new")
    assert left.exists(), "another process might still write it"
    os.utime(left, (0, 0))
    replace_file(path, b"newer")
    assert list(tmp_path.iterdir()) == [path] and path.read_bytes() == b"newer"


def test_a_writer_killed_at_any_time_leaves_one_whole_file(tmp_path: Path) -> None:
    path = tmp_path / "kept.bin"
    code = (
        "import sys; from physicslab.files.replace import replace_file\n"
        "n = 0\n"
        "while True:\n"
        "    n = (n + 1) % 250; replace_file(sys.argv[1], bytes([n]) * 3_000_000)\n"
        "    n == 1 and print('on', flush=True)"
    )
    for wait in (0.0, 0.003, 0.01, 0.02, 0.05):
        command = [sys.executable, "-c", code, str(path)]
        with subprocess.Popen(command, stdout=subprocess.PIPE) as writer:
            assert writer.stdout is not None
            writer.stdout.readline()
            time.sleep(wait)
            writer.kill()
        content = path.read_bytes()
        assert len(content) == 3_000_000 and len(set(content)) == 1
    remove_leftovers(path)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("write", [replace_file, create_file])
def test_what_a_kill_left_is_removed_by_the_next_write_in_the_folder(
    write: Callable[[Path, bytes], None], tmp_path: Path
) -> None:
    old, fresh = (tmp_path / f".film.gif.{digit * 16}.physicslab-tmp" for digit in "ab")
    others = (
        tmp_path / "film.gif",
        tmp_path / ".film.gif.x.physicslab-tmp",
        tmp_path / f"{'a' * 16}.physicslab-tmp",
    )
    for path in (old, fresh, *others):
        path.touch()
        os.utime(path, (0, 0))
    os.utime(fresh)
    write(tmp_path / "new.json", b"x")
    assert set(tmp_path.iterdir()) == {fresh, *others, tmp_path / "new.json"}


@pytest.mark.parametrize("way", ["save_scene", "json", "autosave", "ctrl+s"])
def test_a_full_disk_leaves_the_old_file_whole(
    way: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "kept.json"
    save_scene(load_scene("drop"), path)
    old = path.read_bytes()

    def no_room(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("physicslab.files.replace.os.fsync", no_room)
    world = load_scene("stack")
    if way == "save_scene":
        with pytest.raises(OSError, match="No space left"):
            save_scene(world, path)
    elif way == "json":
        assert main(["run", "drop", "--steps", "3", "--json", str(path)]) == 1
        assert "No space left on device" in capsys.readouterr().err
    elif way == "autosave":
        autosave = Autosave(path, period=0.0, share=60.0)
        while not autosave.failure:
            autosave.advance(world)
        assert "No space left" in autosave.failure
    else:
        desk = Desk(world)
        for _ in range(2):  # the second time under the name that is offered
            desk.key("s", CTRL)
            desk.frames(8)
        assert desk.window.scenes.naming is not None
        refused = desk.window.scenes.naming.refused
        assert "could not be saved" in refused and "No space left" in refused
    assert list(tmp_path.iterdir()) == [path] and path.read_bytes() == old


@pytest.mark.parametrize("way", ["save_scene", "json"])
def test_a_limit_on_the_size_of_files_leaves_the_old_file_whole(
    way: str, tmp_path: Path, program: ForkedProgram
) -> None:
    """The system itself refuses to write on, in the middle of the file."""
    path = tmp_path / "kept.json"
    save_scene(load_scene("drop"), path)
    old = path.read_bytes()
    code = (
        "import resource, signal, sys\n"
        "from physicslab.cli import main\n"
        "from physicslab.files.scene import load_scene, save_scene\n"
        "world = load_scene('stack')\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300))\n"
        "if sys.argv[1] == 'json':\n"
        "    sys.exit(main(['run', 'drop', '--steps', '3', '--json', sys.argv[2]]))\n"
        "try: save_scene(world, sys.argv[2])\n"
        "except OSError as error: print(error, file=sys.stderr); sys.exit(1)\n"
    )
    status, _, said = program.run([way, str(path)], code)
    assert status == 1 and b"File too large" in said
    assert list(tmp_path.iterdir()) == [path] and path.read_bytes() == old


def test_a_file_that_is_held_for_a_moment_is_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As Windows refuses to replace one that a virus scanner reads."""
    target, attempts, own = tmp_path / "scene.json", [1], os.replace

    def held(fresh: Path, onto: Path) -> None:
        attempts[0] -= 1
        if attempts[0] >= 0:
            raise PermissionError(13, "Access is denied", str(onto))
        own(fresh, onto)

    monkeypatch.setattr(replace, "_PAUSE", 0.0)
    monkeypatch.setattr(os, "replace", held)
    with pytest.raises(PermissionError, match="denied"):
        replace.replace_file(target, b"elsewhere")  # where it is not for being held
    monkeypatch.setattr(replace, "_CAN_BE_HELD", True)
    attempts[0] = 2
    replace.replace_file(target, b"new")
    assert target.read_bytes() == b"new" and attempts == [-1]
    monkeypatch.setattr(replace, "_PATIENCE", 0.0)
    attempts[0] = 10**9
    with pytest.raises(PermissionError, match="another program holds it open"):
        replace.replace_file(target, b"newer")
    assert target.read_bytes() == b"new" and os.listdir(tmp_path) == ["scene.json"]
