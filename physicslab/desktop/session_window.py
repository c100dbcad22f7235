"""Runs the sandbox in a window: its scene, its session, its frames, and signals that end it."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import FrameType
from typing import Any

from physicslab.desktop.appearance import preferences_path
from physicslab.desktop.autosave import Autosave
from physicslab.desktop.compiling import Compiling, Left
from physicslab.desktop.garbage import loading
from physicslab.desktop.preferences import load_preferences, save_preferences
from physicslab.desktop.sandbox import Sandbox
from physicslab.desktop.screen_reader import ScreenReader
from physicslab.desktop.sessions import Session, session_folder
from physicslab.ecs.config import WindowConfig
from physicslab.ecs.text import printable, shortened
from physicslab.files.scene import load_scene
from physicslab.kernels import working_ns
from physicslab.kernels.warm import Warmup
from physicslab.scenes import SCENES
from physicslab.view.canvas.display import Display, ask_to_leave, forget_clicks
from physicslab.view.controls.lesson_actions import open_lesson
from physicslab.view.controls.saving import scene_words
from physicslab.view.window.recent import Recovery
from physicslab.view.window.scenes import stamp_of
from physicslab.view.window.window import Window
from physicslab.world import World

# ---- signals: noted, so that the window closes between two frames with its state kept ----------------------


_SIGNALS = ("SIGTERM", "SIGHUP", "SIGINT")
"""At a logout or a shutdown, by ``kill``; when the terminal is closed, which Windows lacks; by Ctrl+C."""


class Termination:
    """Notes the signals that end the program, within a ``with`` block, and has the window closed.

    A second Ctrl+C interrupts what the window waits for. SDL would make of SIGTERM what a click on the
    window's cross is: the state would be removed as if the user had left.

    Parameters
    ----------
    close : callable
        Has the window closed; called between two instructions of Python, whatever is under way.

    Attributes
    ----------
    signal : int
        The number of the one that came; 0 if none did.
    """

    def __init__(self, close: Callable[[], None]) -> None:
        self.signal = 0
        self._close = close
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Termination:
        if threading.current_thread() is threading.main_thread():  # no other may set handlers
            for name in _SIGNALS:
                number = getattr(signal, name, None)
                if number is not None:
                    self._before[number] = signal.signal(number, self._note)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, signal.SIG_DFL if handler is None else handler)

    @property
    def status(self) -> int:
        """The exit status: 0, or what a shell reports of a program that a signal ended."""
        return 128 + self.signal if self.signal else 0

    def _note(self, number: int, frame: FrameType | None) -> None:
        if number == self.signal == signal.SIGINT:
            raise KeyboardInterrupt
        self.signal = self.signal or number
        self._close()


# ---- the window --------------------------------------------------------------------------------------------


FIRST_SCENE = "sandbox"
"""The scene that is opened where none is named, and that stands behind a lesson."""
_STILL = 0.5
"""Time [s] between two frames where nothing moves and nothing is done: a laptop lives on its battery."""
_TITLE_LIMIT = 200
"""Characters of the window's title that come from the scene."""


def run_window(
    display: Display, config: WindowConfig, scene: str | World, workers: Warmup | None, welcomes: bool
) -> int:
    """Show a scene, a lesson or a world, until the window is closed; return the exit status.

    Kernels that the cache lacks come from ``workers``. Where it ``welcomes``, the cards of the first minute
    are shown, unless they were used before. Where a signal ends the program (a logout, ``kill``), the state
    is saved and offered at the next start.

    Raises
    ------
    SceneError
        If there is no such scene, or it is not allowed.
    """
    lesson = scene if isinstance(scene, str) and scene.endswith(".md") else ""
    scene = FIRST_SCENE if lesson else scene
    source = None if isinstance(scene, World) else scene if scene in SCENES else Path(scene)
    stamp = None if source is None else stamp_of(source)
    world = scene if isinstance(scene, World) else load_scene(scene)
    window = Window(display.canvas, config)
    window.text_scale = display.density
    window.scenes.source = source
    session, abandoned = _begin_session(window)
    with suppress(OSError):
        load_preferences(preferences_path(), window)
    offered = window.shows_cards = welcomes and not window.welcomed
    if source is not None:
        window.scenes.note(source, stamp)
    autosave = None if session is None else Autosave(session.path)
    window.scenes.recovery = Recovery(abandoned, None if session is None else session.path)
    sandbox: Sandbox | None = None
    try:
        with Termination(ask_to_leave) as termination:
            try:
                with Compiling(display, workers, window.theme, window.drawing.size) as compiling:
                    window.has_kernels = partial(getattr, compiling, "finished")
                    with loading():
                        # Time spent waiting for a kernel is no time that steps took.
                        sandbox = Sandbox(
                            world, window, lambda: 1e-9 * working_ns(), autosave, compiling.scenes.follow
                        )
                        if lesson:
                            open_lesson(world, window, lesson)
                        forget_clicks()
                        sandbox.frame(0.0)
                        forget_clicks()
                    _loop(sandbox, display, compiling)
            except Left:  # the window was closed while it waited for kernels
                pass
            if termination.signal and autosave is not None and sandbox is not None:
                autosave.save(window.own.history.world)
    finally:
        window.error_study.stop()
        window.sharing.stop()
        window.trust.stop()
        window.filming.end()
        window.scenes.recovery.leave()
        window.welcomed = window.welcomed or (offered and not window.shows_cards)
        with suppress(OSError):  # a window without preferences is the usual one
            save_preferences(preferences_path(), window)
    if session is not None and termination.signal:
        session.release()
    elif autosave is not None and session is not None:
        # Closed by the user: an edited world that was not saved is offered at the next start, as after an
        # error or a signal; the rest can be had again.
        if sandbox is not None and window.has_unsaved:
            autosave.save(window.own.history.world)
            session.release()
        else:
            autosave.stop()
            session.end()
    return termination.status


def _begin_session(window: Window) -> tuple[Session | None, list[Session]]:
    """Begin a session and find those that were left; where that fails the window shows it, and works."""
    abandoned: list[Session] = []
    try:
        folder = session_folder()
        abandoned = Session.abandoned(folder)
        return Session.begin(folder), abandoned
    except OSError as error:
        words = f"The state cannot be kept for the case of a crash: {error}"
        window.notify(words, 8.0, failed=True)
        return None, abandoned


def _loop(sandbox: Sandbox, display: Display, compiling: Compiling) -> None:
    """Show the first frame, which is drawn, and further ones until the window is to be closed."""
    window = sandbox.window
    display.show()  # the time that the first frame took, with all that it loads, is not made up for
    elapsed, reader = 0.0, ScreenReader()
    while not window.closing:
        drawn = sandbox.frame(elapsed)
        reader.follow(sandbox.world, window, sandbox.interface.ui)
        left, top, width, _ = window.framing.room()
        compiling.advance(window.theme, (left + width, top), window.drawing.size - 1)
        window.preparing = compiling.seconds_left
        window.pace.max_dt = compiling.time_for_steps(window.config.max_dt)
        display.title = _title(sandbox.world, window)
        if window.wants_screenshot:
            window.wants_screenshot = False
            _keep_screenshot(display, window)
        elapsed = display.show() if drawn or not compiling.finished else display.wait()
        if compiling.finished and sandbox.is_still():
            display.rest(_STILL)


def _title(world: World, window: Window) -> str:
    """Return the words of the title bar; a world made by a program may have a title of any length."""
    return f"{shortened(printable(scene_words(world, window)), _TITLE_LIMIT)} - PhysicsLab"


def _keep_screenshot(display: Display, window: Window) -> None:
    """Save a picture of the window where the program was started, and say what came of it."""
    try:
        window.notify(f"Saved {printable(str(display.save_screenshot(Path.cwd())))}")
    except OSError as error:
        words = f"The screenshot could not be saved: {error.strerror or error}"
        window.notify(words, 6.0, failed=True)
