"""Opens the window at once; what is to be shown in it, and numba with it, is imported while it is there."""

import threading
import time
from contextlib import ExitStack, suppress
from importlib import import_module
from typing import TYPE_CHECKING, Any

from physicslab.desktop import appearance
from physicslab.desktop.garbage import loading
from physicslab.desktop.progress import PAUSE, draw_loading
from physicslab.ecs.config import WindowConfig
from physicslab.languages.language import language
from physicslab.view.canvas.canvas import text_height
from physicslab.view.canvas.display import Display, NoScreen, wants_to_leave

if TYPE_CHECKING:
    from physicslab.kernels.warm import Warmup
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
    with Display.open(config, "PhysicsLab") as display, ExitStack() as at_end:
        workers = _Workers(at_end)
        if not _load(display, "physicslab.desktop.session_window", workers):
            return 0
        from physicslab.desktop.session_window import FIRST_SCENE, run_window

        shown = FIRST_SCENE if scene is None else scene
        return run_window(display, config, shown, workers.warmup, scene is None)


class _Workers:
    """Starts the processes that compile kernels while all else is still being imported.

    Parameters
    ----------
    at_end : ExitStack
        Has them stopped.

    Attributes
    ----------
    warmup : Warmup or None
        Their work; ``None`` where there is nothing to compile.
    """

    def __init__(self, at_end: ExitStack) -> None:
        self.warmup: Warmup | None = None
        self._at_end = at_end

    def start(self) -> None:
        """Start them, if the cache lacks kernels."""
        from physicslab.kernels import interpreter
        from physicslab.kernels.warm import Warmup, is_warm

        if not (interpreter.is_forced() or is_warm()):
            self.warmup = self._at_end.enter_context(Warmup())


def _load(display: Display, module: str, workers: _Workers) -> bool:
    """Import a module in a thread while the window stays awake; return whether the user stayed.

    The first time takes seconds, as Python has not kept the bytecode of numba yet. The thread holds frames up
    for some milliseconds each, which an empty window does not show. The window is drawn where it changes.
    """
    thread = threading.Thread(target=_import, args=(module, workers), daemon=True)
    found: dict[str, Any] = {}
    with suppress(*appearance.UNREADABLE):  # it is said where the window can say it
        found = appearance.read_preferences(appearance.preferences_path())
    display.canvas.language = language(appearance.chosen_language(found))
    theme, start, drawn = appearance.chosen_theme(found), time.perf_counter(), None
    scale = appearance.chosen_scale(found, display.density)
    while drawn is None or thread.is_alive():
        seconds = time.perf_counter() - start
        remark = f"Loading, {int(seconds)} s" if seconds > _PATIENCE else ""
        if drawn != (remark, display.canvas.size):
            first, drawn = drawn is None, (remark, display.canvas.size)
            size = text_height(display.canvas.size, scale)
            draw_loading(display.canvas, theme, remark, size)
            display.show()
            if first:
                thread.start()
        if wants_to_leave():
            return False
        thread.join(PAUSE)
    return True


def _import(module: str, workers: _Workers) -> None:
    try:
        with loading():
            workers.start()
            import_module(module)
            import_module("physicslab.kernels.warm").load_all()
            import_module("physicslab.kernels").prepare()
    except Exception:  # it is raised once more where the window can be closed and the reason shown
        return
