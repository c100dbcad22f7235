"""Runs the sandbox in a window: its scene, its session, its frames."""

from __future__ import annotations

from pathlib import Path

from physicslab.desktop.autosave import Autosave
from physicslab.desktop.compiling import Compiling, Left
from physicslab.desktop.garbage import loading
from physicslab.desktop.sandbox import Sandbox
from physicslab.desktop.sessions import Session, session_folder
from physicslab.ecs.config import WindowConfig
from physicslab.files.scene import load_scene
from physicslab.kernels import working_ns
from physicslab.view.canvas.display import Display
from physicslab.view.window.recovery import Recovery
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["run_window"]


def run_window(display: Display, config: WindowConfig, scene: str) -> int:
    """Show a scene until the window is closed; return the exit status.

    Raises
    ------
    SceneError
        If there is no such scene or it is not allowed.
    """
    world = load_scene(scene)
    display.title = _title(world)
    window = Window(display.canvas, config)
    folder = session_folder()
    abandoned = Session.abandoned(folder)
    session: Session | None = None
    autosave: Autosave | None = None
    try:
        session = Session.begin(folder)
    except OSError as error:
        words = f"The state cannot be kept for the case of a crash: {error}"
        window.notify(words, 8.0, failed=True)
    else:
        autosave = Autosave(session.path)
    window.recovery = Recovery(abandoned, None if session is None else session.path)
    try:
        with Compiling(display) as compiling:
            with loading():
                # What is waited for a kernel is no time that steps took.
                sandbox = Sandbox(
                    world, window, lambda: 1e-9 * working_ns(), autosave, compiling.scenes.follow
                )
                sandbox.frame(0.0)
            _loop(sandbox, display, compiling)
    except Left:  # the window was closed while it waited for kernels
        pass
    finally:
        window.error_study.stop()
        window.recovery.leave()
    # Only here, where the window was closed as it should be: an error leaves the state to the next start.
    if autosave is not None and session is not None:
        autosave.stop()
        session.end()
    return 0


def _loop(sandbox: Sandbox, display: Display, compiling: Compiling) -> None:
    """Show the first frame, which is drawn, and further ones until the window is to be closed."""
    window = sandbox.window
    display.show()  # the time that the first frame took, with all that it loads, is not made up for
    elapsed = 0.0
    while not window.closing:
        sandbox.frame(elapsed)
        compiling.advance(window.theme)
        window.pace.max_dt = compiling.scenes.made_up_for(window.config.max_dt)
        display.title = _title(sandbox.world)
        if window.wants_screenshot:
            window.wants_screenshot = False
            window.notify(_keep_screenshot(display))
        elapsed = display.show()


def _title(world: World) -> str:
    return f"{world.title or world.name or 'A scene'} - PhysicsLab"


def _keep_screenshot(display: Display) -> str:
    """Save a picture of the window where the program was started, and return what to say of it."""
    try:
        return f"Saved {display.save_screenshot(Path.cwd())}"
    except OSError as error:
        return f"The screenshot could not be saved: {error.strerror or error}"
