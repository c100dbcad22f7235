"""Has kernels compiled by other processes, and loads them between frames: no frame waits for either."""

from __future__ import annotations

import time
from collections.abc import Sequence
from types import TracebackType
from typing import Any

from physicslab.kernels import KERNELS, ask_before_compiling, load
from physicslab.kernels.solver import fused_contact
from physicslab.kernels.warm import Progress, Warmup, is_warm, name_of
from physicslab.view.canvas.display import Display, wants_to_leave
from physicslab.view.canvas.theme import DARK, Theme
from physicslab.view.panels.progress import draw_corner, draw_progress, draw_waiting

__all__ = ["Compiling", "Left"]

_ROOM = 0.008
"""Time [s] that must be left of a frame to load a kernel in it; most take 2 to 4 ms, few more than 8."""
_AT_LEAST = 30
"""One frame in so many loads a kernel, whatever is left of it: a busy scene would never load any."""


class Left(Exception):
    """The user closed the window while it waited for kernels."""


class Compiling:
    """Sees to it that kernels are there before they are called, in a ``with`` block of the window.

    On the first launch other processes compile them all, first those that are asked for. What the scene needs
    at once is waited for, with the window awake. The rest comes while it runs; only who does something new
    before then waits once more.

    Parameters
    ----------
    display : Display
        Where it is shown how far it is.
    """

    def __init__(self, display: Display) -> None:
        self._display = display
        self._warmup = None if is_warm() else Warmup()
        self._progress = Progress(0, 1)
        self._frames = 0
        self._theme: Theme = DARK

    def __enter__(self) -> Compiling:
        if self._warmup is not None:
            self._warmup.__enter__()
            ask_before_compiling(self._wait)
        else:
            load(fused_contact.advance)  # 26 ms, for which no frame has room
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        ask_before_compiling(None)
        if self._warmup is not None:
            self._warmup.__exit__(kind, error, trace)

    @property
    def finished(self) -> bool:
        """Whether nothing is being compiled any more."""
        return self._warmup is None or self._warmup.finished

    def _wait(self, missing: Sequence[Any]) -> None:
        """Keep the window awake until other processes have compiled these kernels, or cannot.

        Raises
        ------
        Left
            If the user closes the window meanwhile.
        """
        warmup = self._warmup
        assert warmup is not None
        names = [name_of(jitted) for jitted in missing]
        warmup.hurry(names)
        start = time.perf_counter()
        self._progress = warmup.poll()
        while not (warmup.finished or warmup.has(names)):
            if wants_to_leave():
                raise Left
            self._show_waiting(time.perf_counter() - start)
            self._load_one(missing)  # all at once would be a long frame when the last is there
            self._display.show()
            self._progress = warmup.poll()

    def _show_waiting(self, seconds: float) -> None:
        """Show that it waits: in an empty window before the first frame, over the world after that."""
        canvas, progress = self._display.canvas, self._progress
        share, so_far = progress.done / progress.total, f"{progress.done} of {progress.total} parts"
        if self._frames:
            draw_waiting(canvas, self._theme, share, f"{so_far}, {int(seconds)} s")
        else:
            draw_progress(canvas, self._theme, share, so_far)

    def advance(self, theme: Theme) -> None:
        """Show in a corner how far it is, and load a kernel if this frame has time left for it."""
        self._frames += 1
        self._theme = theme
        if self._warmup is not None and not self._warmup.finished:
            self._progress = self._warmup.poll()
            share = self._progress.done / self._progress.total
            draw_corner(self._display.canvas, theme, share)
        if self._display.left > _ROOM or self._frames % _AT_LEAST == 0:
            self._load_one(KERNELS)

    def _load_one(self, kernels: Sequence[Any]) -> None:
        """Load the first of some kernels that is in the cache and not loaded yet, if there is one."""
        for jitted in kernels:
            if not jitted.compiled and self._is_kept(jitted):
                load(jitted)
                return

    def _is_kept(self, jitted: Any) -> bool:
        return self._warmup is None or self._warmup.has((name_of(jitted),))
