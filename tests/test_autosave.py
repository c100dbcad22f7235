"""The window keeps its state, and offers it after a crash: sessions, autosave and the bar."""

import gc
import os
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path
from typing import Literal

import pygame
import pytest
from desk import FRAME, Desk, bits, click, empty_world
from platformdirs.api import PlatformDirsABC
from platformdirs.macos import MacOS
from platformdirs.unix import Unix

from physicslab.components import Transform
from physicslab.desktop import sessions
from physicslab.desktop.app import open_window
from physicslab.desktop.autosave import Autosave
from physicslab.desktop.sandbox import Sandbox
from physicslab.desktop.sessions import Session, session_folder
from physicslab.files.scene import load_scene, save_scene
from physicslab.prefabs import circle
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.window.recent import Recovery
from physicslab.view.window.window import Window
from physicslab.world import World


class Clock:
    """A clock that is set forward by hand."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


def saved(autosave: Autosave, world: World, clock: Clock, seconds: float = 10.0) -> bool:
    """Let time and frames go by; return whether the file was written meanwhile."""
    before = autosave.path.stat().st_mtime_ns if autosave.path.exists() else 0
    clock.now += seconds
    for _ in range(300):
        autosave.advance(world)
        if autosave._thread is not None:
            autosave._thread.join()  # the disk may take any time
    return autosave.path.exists() and autosave.path.stat().st_mtime_ns != before


def test_the_state_is_saved_bit_for_bit_while_the_world_goes_on(tmp_path: Path) -> None:
    clock, world = Clock(), load_scene("slope")
    world.run(steps=30)
    autosave = Autosave(tmp_path / "s.json", share=0.0, clock=clock)
    clock.now = 11.0
    autosave.advance(world)
    state = bits(world)
    save_scene(world, tmp_path / "whole.json")
    while autosave._thread is None:
        autosave.advance(world)
        world.step()
    autosave.stop(60.0)
    assert bits(world) != state
    assert autosave.path.read_bytes() == (tmp_path / "whole.json").read_bytes()
    assert bits(load_scene(autosave.path)) == state and gc.isenabled()


def test_only_what_changed_is_saved_and_not_too_often(tmp_path: Path) -> None:
    clock, world = Clock(), load_scene("stack")
    autosave = Autosave(tmp_path / "s.json", clock=clock)
    world.synchronise()
    autosave.finish(world)
    assert not saved(autosave, world, clock, 30.0), "nothing was done to it"
    world.step()
    assert saved(autosave, world, clock)
    assert not saved(autosave, world, clock), "nothing was done since"
    circle(world, (0, 9))
    world.synchronise()
    assert not saved(autosave, world, clock, 1.0), "too soon"
    assert saved(autosave, world, clock)


@pytest.mark.parametrize("way", ["full", "gone", "nan"])
def test_a_failed_save_is_reported_once_and_the_sandbox_goes_on(
    way: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock, world = Clock(), load_scene("stack")
    folder = tmp_path / "state"
    folder.mkdir()
    autosave = Autosave(folder / "s.json", clock=clock)
    window = Window(PygameCanvas(pygame.display.set_mode((1280, 720))))
    sandbox = Sandbox(world, window, clock=lambda: 0.0, autosave=autosave)

    def no_room(*arguments: object) -> None:
        raise OSError(28, "No space left on device")

    if way == "full":
        monkeypatch.setattr("physicslab.desktop.autosave.replace_file", no_room)
    elif way == "gone":
        folder.rmdir()
    else:
        entity = world.batch(Transform).entities[0]
        world.table(Transform)["position"][world.entity_index.row_of[int(entity)]] = float("nan")
        world.steps += 1  # numbers written into a column by hand are not noticed
        window.pace.paused = True
    reported: list[str] = []
    for _ in range(200):
        clock.now += 0.25
        sandbox.frame(FRAME)
        if autosave._thread is not None:
            autosave._thread.join()
        if window.notice.startswith("The state cannot be kept"):
            reported.append(window.notice)
            window.notify("")
    assert len(reported) == 1 and window.notice_failed is False
    assert gc.isenabled() and (way == "nan" or sandbox.world.time > 1.0)


def test_a_lock_distinguishes_a_crash_from_an_open_window(tmp_path: Path) -> None:
    code = (
        "import sys, time, pathlib; from physicslab.desktop.sessions import Session;"
        "s = Session.begin(pathlib.Path(sys.argv[1])); s.path.write_text('{}'); print(s.path, flush=True);"
        "time.sleep(60)"
    )
    command = [sys.executable, "-c", code, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout is not None
        path = Path(other.stdout.readline().strip())
        (tmp_path / f".{path.name}.{'0' * 16}.physicslab-tmp").write_text("{")
        assert Session.abandoned(tmp_path) == []
        own = Session.begin(tmp_path)
        assert own.path != path
        other.send_signal(signal.SIGKILL if hasattr(signal, "SIGKILL") else signal.SIGTERM)
        other.wait()
    (found,) = Session.abandoned(tmp_path)
    assert found.path == path and path.read_text() == "{}"
    assert not list(tmp_path.glob("*.physicslab-tmp")), "what was being written is cleared away"
    assert Session.abandoned(tmp_path) == [], "and is this process's now"
    found.release()
    (found,) = Session.abandoned(tmp_path)
    found.end()
    own.end()
    assert not list(tmp_path.iterdir())


def test_sessions_without_a_state_leave_nothing(tmp_path: Path) -> None:
    Session.begin(tmp_path).release()
    assert Session.abandoned(tmp_path) == [] and not list(tmp_path.iterdir())
    assert Session.abandoned(tmp_path / "missing") == []


@pytest.mark.skipif(os.name == "nt", reason="Windows has its own folder")
def test_where_sessions_are_kept(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(sessions, "user_state_path", partial(_state_path, Unix))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert session_folder() == tmp_path / "physicslab" / "sessions"
    monkeypatch.setenv("XDG_STATE_HOME", "relative")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert session_folder() == tmp_path / ".local" / "state" / "physicslab" / "sessions"
    monkeypatch.setattr(sessions, "user_state_path", partial(_state_path, MacOS))
    assert session_folder() == tmp_path / "Library" / "Application Support" / "physicslab" / "sessions"


def _state_path(system: type[PlatformDirsABC], name: str, *, appauthor: Literal[False]) -> Path:
    """Return what ``user_state_path`` does on another system."""
    return system(name, appauthor).user_state_path


def crashed(folder: Path, scene: str) -> World:
    """Leave a session behind as a crash does, and return the world in it."""
    world = load_scene(scene)
    world.run(steps=5)
    session = Session.begin(folder)
    save_scene(world, session.path)
    session.release()
    return world


def test_restoring_opens_the_last_state(tmp_path: Path) -> None:
    lost = crashed(tmp_path, "stack")
    own = Session.begin(tmp_path)
    desk = Desk(empty_world())
    desk.window.scenes.recovery = Recovery(Session.abandoned(tmp_path), own.path)
    desk.frames(10)
    assert desk.world.name != "stack", "nothing is applied without being asked"
    desk.key("space")
    desk.frames()
    assert [desk.window.pace.paused] == [True], "keys stay with the scene"
    click(desk, "Restore it")
    assert desk.world.name == "stack" and bits(desk.world) == bits(lost) and desk.window.pace.paused
    assert not desk.window.scenes.recovery.offered and "Discard" not in desk.ui.places
    assert own.path.exists(), "it would be offered again after another crash"
    own.end()
    assert not list(tmp_path.iterdir())


def test_discarding_offers_the_one_before(tmp_path: Path) -> None:
    for scene in ("stack", "drop"):
        crashed(tmp_path, scene)
        time.sleep(0.02)
    desk = Desk(empty_world())
    world = desk.world
    desk.window.scenes.recovery = Recovery(Session.abandoned(tmp_path))
    desk.frames(10)
    click(desk, "Discard")
    assert {"Restore it", "Discard"} <= set(desk.ui.places)
    assert len(list(tmp_path.glob("*.json"))) == 1
    click(desk, "Discard")
    assert "Discard" not in desk.ui.places and not list(tmp_path.iterdir()) and desk.world is world


def test_a_state_that_cannot_be_read_is_reported_and_kept(tmp_path: Path) -> None:
    crashed(tmp_path, "stack")
    (path,) = tmp_path.glob("*.json")
    path.write_text("{ half")
    desk = Desk(empty_world())
    world = desk.world
    desk.window.scenes.recovery = Recovery(Session.abandoned(tmp_path))
    desk.frames(10)
    click(desk, "Restore it")
    assert "Not restored" in desk.window.notice and desk.world is world and path.exists()
    desk.window.scenes.recovery.leave()


def test_a_window_that_closes_leaves_nothing(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("physicslab.kernels.warm.is_warm", lambda: True)
    monkeypatch.setattr("physicslab.desktop.session_window.session_folder", lambda: tmp_path / "state")
    pygame.init()
    pygame.event.clear()
    frames = 0
    usual = Sandbox.frame

    def frame(sandbox: Sandbox, elapsed: float) -> None:
        nonlocal frames
        frames += 1
        assert len(list((tmp_path / "state").glob("*.lock"))) == 1
        if frames == 3:
            sandbox.window.closing = True
        usual(sandbox, elapsed)

    monkeypatch.setattr(Sandbox, "frame", frame)
    assert open_window("drop") == 0
    assert frames == 3 and not list((tmp_path / "state").iterdir())


def test_a_folder_that_cannot_be_made_is_reported(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "state").write_text("a file, no folder")
    monkeypatch.setattr("physicslab.kernels.warm.is_warm", lambda: True)
    monkeypatch.setattr("physicslab.desktop.session_window.session_folder", lambda: tmp_path / "state")
    said: list[str] = []
    usual = Sandbox.frame

    def frame(sandbox: Sandbox, elapsed: float) -> None:
        usual(sandbox, elapsed)
        said.append(sandbox.window.notice)
        sandbox.window.closing = True

    monkeypatch.setattr(Sandbox, "frame", frame)
    assert open_window("drop") == 0
    assert said[0].startswith("The state cannot be kept for the case of a crash: ")
