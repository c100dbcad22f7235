"""States of windows that ended badly: none lost, whoever starts at the same time and however one ends."""

import os
import signal
import stat
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pygame
import pytest
from at_once import run_at_once
from desk import Desk, bits

from physicslab.desktop import session_window, sessions
from physicslab.desktop.app import open_window
from physicslab.desktop.autosave import Autosave
from physicslab.desktop.sandbox import Sandbox
from physicslab.desktop.session_window import Termination
from physicslab.desktop.sessions import Session, session_folder
from physicslab.files.scene import load_scene
from physicslab.view.canvas.display import Display
from physicslab.world import World

ROOT = Path(__file__).parent.parent

AT_ONCE = """
import sys
from pathlib import Path
from physicslab.desktop.sessions import Session
folder, times = Path(sys.argv[1]), int(sys.argv[2])
input("ready\\n")
for _ in range(times):
    found = Session.abandoned(folder)
    session = Session.begin(folder)
    session.path.write_text("{}")
    print("kept", session.path.name)
    for other in found:
        print("offered", other.path.name)
        other.end()
    session.release()  # as the system does for a process that is killed
"""
PROCESSES, TIMES = 4, 25


def test_of_windows_that_start_at_once_each_state_is_offered_once(
    tmp_path: Path, processes: int = PROCESSES, times: int = TIMES
) -> None:
    folder = tmp_path / "sessions"
    lines = [line.split() for line in run_at_once(AT_ONCE, str(folder), str(times), count=processes)]
    kept = sorted(name for what, name in lines if what == "kept")
    offered = [name for what, name in lines if what == "offered"]
    for session in Session.abandoned(folder):
        offered.append(session.path.name)
        session.end()
    assert len(kept) == processes * times and sorted(offered) == kept
    assert not list(folder.iterdir())


def test_a_lock_is_not_taken_between_its_making_and_its_locking(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The moment of the race: another window looks for crashes when a lock file is there and free."""
    from physicslab.desktop import sessions

    locked, other = sessions._locked, None

    def interrupted(path: Path) -> object:
        nonlocal other
        if other is None:
            path.touch()
            code = (
                "import sys, pathlib, time; from physicslab.desktop.sessions import Session\n"
                "remove = Session._remove\n"
                "Session._remove = lambda self: (time.sleep(3), remove(self))\n"  # while it has the lock
                "print(len(Session.abandoned(pathlib.Path(sys.argv[1]))))"
            )
            command = [sys.executable, "-c", code, str(tmp_path)]
            other = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
            time.sleep(1.5)
        return locked(path)

    monkeypatch.setattr(sessions, "_locked", interrupted)
    session = Session.begin(tmp_path)
    assert other is not None and other.communicate()[0] == "0\n"
    assert session.path.with_suffix(".lock").exists(), "without it the state would never be offered"
    session.end()


def test_a_state_without_a_lock_is_offered_too(tmp_path: Path) -> None:
    (tmp_path / "orphan.json").write_text("{}")
    (found,) = Session.abandoned(tmp_path)
    assert found.path.name == "orphan.json"
    found.end()
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="Windows has no such permissions")
def test_states_are_kept_where_no_other_user_writes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "a" / "sessions"
    Session.begin(folder).end()
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    folder.chmod(0o777)
    (folder / "planted.json").write_text("{}")
    assert len(Session.abandoned(folder)) == 1 and stat.S_IMODE(folder.stat().st_mode) == 0o700
    (tmp_path / "link").symlink_to(folder)
    other = tmp_path / "other"
    other.mkdir()
    for refused in (tmp_path / "link", other):
        if refused == other:
            monkeypatch.setattr(os, "getuid", lambda: 4711)
        with pytest.raises(PermissionError, match="is not a directory of this user"):
            Session.begin(refused)
        assert Session.abandoned(refused) == []


@pytest.mark.skipif(os.name == "nt", reason="Windows ends programs without a signal")
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT"])
def test_a_signal_keeps_the_state_as_it_is(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    number, frame, frames = signal.Signals[name], Sandbox.frame, 0
    worlds: list[World] = []

    def until(sandbox: Sandbox, elapsed: float) -> None:
        nonlocal frames
        frames += 1
        frame(sandbox, elapsed)
        worlds[:] = [sandbox.world]
        if frames == 20:
            os.kill(os.getpid(), number)
        assert frames < 40, "the window closes"

    monkeypatch.setattr(Sandbox, "frame", until)
    before = signal.getsignal(number)
    assert open_window("stack") == 128 + number
    assert signal.getsignal(number) is before
    (session,) = Session.abandoned(session_folder())
    kept = load_scene(session.path)
    assert kept.name == "stack" and kept.time > 0.1 and bits(kept) == bits(worlds[0])
    session.end()


@pytest.mark.skipif(os.name == "nt", reason="Windows ends programs without a signal")
def test_a_signal_before_anything_was_done_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    monkeypatch.setattr(Sandbox, "frame", lambda *_: os.kill(os.getpid(), signal.SIGTERM))
    monkeypatch.setattr(session_window, "_loop", lambda *_: None)
    assert open_window("stack") == 143
    assert Session.abandoned(session_folder()) == []
    assert not list(session_folder().iterdir())


def test_of_several_signals_the_first_counts() -> None:
    closed: list[None] = []
    with Termination(lambda: closed.append(None)) as termination:
        assert termination.status == 0
        for number in (signal.SIGTERM, signal.SIGINT):
            termination._note(number, None)
    assert termination.status == 128 + signal.SIGTERM and len(closed) == 2


def test_a_second_ctrl_c_interrupts_what_is_waited_for() -> None:
    with Termination(lambda: None) as termination:
        termination._note(signal.SIGINT, None)
        with pytest.raises(KeyboardInterrupt):
            termination._note(signal.SIGINT, None)
    assert termination.status == 128 + signal.SIGINT


def test_saving_at_once_drops_what_is_half_written(tmp_path: Path) -> None:
    now = [0.0]
    world = load_scene("stack")
    autosave = Autosave(tmp_path / "s.json", share=0.0, clock=lambda: now[0])
    world.step()
    now[0] = 11.0
    autosave.advance(world)
    autosave.advance(world)
    world.run(steps=10)
    autosave.save(world)
    assert bits(load_scene(autosave.path)) == bits(world) and autosave.failure == ""
    autosave.path.unlink()
    tmp_path.chmod(0o700)
    autosave.path.mkdir()
    world.step()
    autosave.save(world)
    assert "is a directory" in autosave.failure


def test_without_a_home_the_window_works_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    def homeless(*_: object, **__: object) -> Path:
        raise RuntimeError("Could not determine home directory.")

    for name in ("XDG_STATE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(sessions, "user_state_path", homeless)
    said: list[str] = []
    frame = Sandbox.frame

    def closing(sandbox: Sandbox, elapsed: float) -> None:
        frame(sandbox, elapsed)
        said.append(sandbox.window.notice)
        sandbox.window.closing = len(said) > 3

    monkeypatch.setattr(Sandbox, "frame", closing)
    assert open_window("drop") == 0
    line = "The state cannot be kept for the case of a crash: there is no home directory to keep it in"
    assert said[0] == line


@pytest.mark.parametrize("way", ["full", "taken"])
def test_a_screenshot_is_whole_or_reported_as_failed(
    way: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    if way == "full":
        monkeypatch.setattr("physicslab.files.replace.os.fsync", full)
    pygame.display.init()
    display = Display(SimpleNamespace(surface=pygame.Surface((40, 30))), 60)  # type: ignore[arg-type]
    told: list[tuple[str, bool]] = []
    window = SimpleNamespace(notify=lambda words, *_, failed=False: told.append((words, failed)))
    for _ in range(2):
        session_window._keep_screenshot(display, window)  # type: ignore[arg-type]
    if way == "full":
        assert told == 2 * [("The screenshot could not be saved: No space left on device", True)]
        assert not list(tmp_path.iterdir())
    else:
        assert [failed for _, failed in told] == [False, False]
        for path in tmp_path.iterdir():
            assert pygame.image.load(path).get_size() == (40, 30)
        assert len(list(tmp_path.iterdir())) == 2


def test_a_title_of_any_length_fits_over_the_window() -> None:
    world = load_scene("drop")
    world.title = "x\n" * 5_000
    desk = Desk(world)
    title = session_window._title(world, desk.window)
    assert len(title) < 250 and title.isprintable() and title.endswith("... - PhysicsLab")
