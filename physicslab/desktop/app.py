"""Opens the window at once; what is to be shown in it, and numba with it, is imported while it is there."""

import threading
import time
from contextlib import suppress
from importlib import import_module
from typing import TYPE_CHECKING, Any

from physicslab.desktop import appearance
from physicslab.desktop.garbage import loading
from physicslab.desktop.progress import PAUSE, draw_loading
from physicslab.ecs.config import WindowConfig
from physicslab.languages.language import language
from physicslab.view.canvas.display import Display, NoScreen, wants_to_leave

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["NoScreen", "open_window"]

_PATIENCE = 0.5
"""Time [s] after which it is said that something is being loaded: later starts are there sooner."""


def open_window(scene: "str | World | None") -> int:
    """Open the sandbox on a scene and return the exit status when it is closed.

    Parameters
    ----------
    scene : str or World, optional
        A built-in scene's name, a path or a world; a small playground where none is named.

    Raises
    ------
    SceneError
        If there is no such scene or it is not allowed.
    NoScreen
        If there is no screen to open a window on.
    """
    config = WindowConfig()
    with Display.open(config, "PhysicsLab") as display:
        if not _load(display, "physicslab.desktop.session_window"):
            return 0
        from physicslab.desktop.session_window import FIRST_SCENE, run_window

        return run_window(display, config, FIRST_SCENE if scene is None else scene, welcomes=scene is None)


def _load(display: Display, module: str) -> bool:
    """Import a module in a thread while the window stays awake; return whether the user stayed.

    The first time takes seconds, as Python has not kept the bytecode of numba yet. The thread holds frames up
    for some milliseconds each, which an empty window does not show. The window is drawn where it changes.
    """
    thread = threading.Thread(target=_import, args=(module,), daemon=True)
    found: dict[str, Any] = {}
    with suppress(*appearance.UNREADABLE):  # it is said where the window can say it
        found = appearance.read_preferences(appearance.preferences_path())
    display.canvas.language = language(appearance.chosen_language(found))
    theme, start, drawn = appearance.chosen_theme(found), time.perf_counter(), None
    while drawn is None or thread.is_alive():
        seconds = time.perf_counter() - start
        remark = f"Loading, {int(seconds)} s" if seconds > _PATIENCE else ""
        if drawn != (remark, display.canvas.size):
            if drawn is None:
                thread.start()
            drawn = remark, display.canvas.size
            draw_loading(display.canvas, theme, remark)
            display.show()
        if wants_to_leave():
            return False
        thread.join(PAUSE)
    return True


def _import(module: str) -> None:
    try:
        with loading():
            import_module(module)
            import_module("physicslab.kernels.warm").load_all()
            import_module("physicslab.kernels").prepare()
    except Exception:  # it is raised once more where the window can be closed and the reason shown
        return
