"""Has kernels compiled by other processes, and loads them between frames: no frame waits for either."""

from __future__ import annotations

import math
import time
from collections.abc import Hashable, Sequence
from typing import TYPE_CHECKING, Any

from physicslab.desktop.progress import PAUSE, draw_corner, draw_progress, draw_waiting
from physicslab.kernels import KERNELS, ask_before_compiling, interpreter, load
from physicslab.kernels.python_fallback import natives
from physicslab.kernels.solver import soft
from physicslab.kernels.tiers import natives_within
from physicslab.kernels.warm import Progress, Warmup, name_of
from physicslab.stepping.small import is_small
from physicslab.theme import DARK, Theme
from physicslab.view.canvas.display import Display, wants_to_leave

if TYPE_CHECKING:
    from physicslab.world import World


INTERPRETING_LIMIT = 0.5
"""Work that takes longer than this [s] to interpret, a call or several frames in turn, waits: until then
slow frames, as on a machine that is busy, are better than half a minute without any."""
_STEPS = 0.05
"""So long [s] a frame may make steps while kernels are interpreted; the last may end later."""
_STEPS_AND_LOADING = 0.02
"""And so long [s] where it loads a kernel besides, which takes up to 30 ms."""
_IN_TURN = 4
"""So many frames in turn: a single one is late for other reasons."""


class SmallScenes:
    """Finds which kernels run as Python until they are compiled: those of a scene that is small.

    It takes 0.2 to 30 ms a step, and so it moves at once. A scene that turns out to be slow, as one whose
    method chooses its steps may be with few bodies too, is waited for from then on, until another scene is
    shown.

    Attributes
    ----------
    kernels : list
        Those that are interpreted, until they are loaded.
    """

    def __init__(self) -> None:
        self.kernels: list[Any] = []
        self._world: World | None = None
        self._slow = False
        self._late = 0

    def follow(self, world: World) -> None:
        """Note which world is shown from now on."""
        self._world, self._slow, self._late = world, False, 0

    @property
    def small(self) -> bool:
        """Whether what is shown is small, and has not turned out to be slow."""
        return self._world is not None and not self._slow and is_small(self._world)

    def interpret(self, missing: Sequence[Any]) -> Sequence[Any]:
        """Return which of the missing kernels are to be interpreted: all, or none."""
        if not self.small:
            return ()
        self.kernels = list(dict.fromkeys((*self.kernels, *missing)))
        return missing

    def give_up(self) -> list[Any]:
        """Let nothing more be interpreted of this scene; return what was, and is to be waited for."""
        self._slow = True
        return self.pending()

    def pending(self) -> list[Any]:
        """Return the kernels that are interpreted and not loaded yet."""
        self.kernels = [jitted for jitted in self.kernels if not jitted.compiled]
        return self.kernels

    def notice(self, left: float) -> bool:
        """Return whether frames are too long, after one that was done ``left`` seconds before it was due.

        They are not while a kernel is awaited that runs within others: it comes first, and soon.
        """
        pending = self.pending()
        awaits = any(jitted in natives.values() for jitted in pending)
        late = pending and left < -INTERPRETING_LIMIT and not awaits
        self._late = self._late + 1 if late else 0
        return self._late >= _IN_TURN

    def made_up_for(self, longest: float, loads: bool = False) -> float:
        """Return the time [s] that a frame makes up for at most, ``longest`` where nothing is interpreted.

        It is less where the frame also loads a kernel.
        """
        return min(longest, _STEPS_AND_LOADING if loads else _STEPS) if self.pending() else longest


def _seconds_saved(jitted: Any) -> float:
    """Return how long [s] a kernel was interpreted; what runs within others is the most that they do."""
    return math.inf if jitted in natives.values() else interpreter.spent_on(jitted)


_ROOM = 0.008
"""Time [s] that must be left of a frame to load a kernel in it; most take 2 to 4 ms, few more than 8."""
_LOAD_EVERY = 30
"""One frame in so many loads a kernel, whatever is left of it: a busy scene would never load any."""


class Left(Exception):
    """The user closed the window while it waited for kernels."""


class Compiling:
    """Loads what other processes compile, in a ``with`` block of the window, which stays awake.

    On the first launch they compile all, first those that the scene is about to call. A small scene is
    interpreted until these are there; in a large one they are waited for. The rest comes while it runs. A
    wait follows once more where something new in it needs a kernel that is not there yet.

    Parameters
    ----------
    display : Display
        Where it is shown how far it is.
    warmup : Warmup, optional
        The processes that compile; none where all are in the cache, or all are to be interpreted.
    theme : Theme
        The colours of that.
    size : int
        Height of its letters until the first frame [px].

    Attributes
    ----------
    scenes : SmallScenes
        The object that finds whether the scene that is shown may be interpreted.
    """

    def __init__(self, display: Display, warmup: Warmup | None, theme: Theme = DARK, size: int = 14) -> None:
        self.scenes = SmallScenes()
        self._display = display
        self._warmup = warmup
        self._progress = Progress(0, 1)
        self._coming: Any = None
        self._frames = 0
        self._theme, self._size = theme, size
        self._drawn: Hashable = None

    def __enter__(self) -> Compiling:
        if self._warmup is not None:
            interpreter.prepare()
            interpreter.limit(lambda _: INTERPRETING_LIMIT, self._catch_up)
            ask_before_compiling(self._ask)
        elif not interpreter.is_forced():
            load(soft.advance)  # 26 ms, for which no frame has room
        return self

    def __exit__(self, *raised: Any) -> None:
        ask_before_compiling(None)
        interpreter.unlimited()

    @property
    def finished(self) -> bool:
        """Whether nothing is being compiled any more."""
        return self._warmup is None or self._warmup.finished

    def _ask(self, missing: Sequence[Any]) -> Sequence[Any]:
        """Return which of these kernels are interpreted for now, once the others are compiled."""
        now = self.scenes.interpret(missing)
        if now:
            self.scenes.interpret([native for jitted in now for native in natives_within(jitted)])
            assert self._warmup is not None
            awaited = dict.fromkeys((*now, *self.scenes.pending()))
            self._warmup.hurry({name_of(jitted): _seconds_saved(jitted) for jitted in awaited})
        else:
            self._wait(missing)
        return now

    def _catch_up(self, slow: Any) -> None:
        """Wait for what was interpreted until now, as a call of one kernel takes too long."""
        waited = self.scenes.give_up()
        self._wait(waited)
        for jitted in (*waited, slow):
            load(jitted)

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
        warmup.hurry(dict.fromkeys(names, math.inf))
        start, waits = time.perf_counter(), False
        self._progress, self._drawn = warmup.poll(), None
        while not (warmup.finished or warmup.has(names)):
            waits = True
            if wants_to_leave():
                raise Left
            self._show_waiting(int(time.perf_counter() - start))
            self._load_one(missing)  # all at once would be a long frame when the last is there
            self._progress = warmup.poll(PAUSE)
        if waits:
            self._display.show()  # the next frame begins now: what was waited is no time that passed in it

    def _show_waiting(self, seconds: int) -> None:
        """Show that it waits: in an empty window before the first frame, over the world after that.

        It is drawn where it changes, and once a second in case that something lay over the window: to draw it
        60 times a second took as much of the processor as the compilers.
        """
        canvas, progress = self._display.canvas, self._progress
        wanted = progress.done, seconds, canvas.size
        if wanted == self._drawn:
            return
        self._drawn = wanted
        share, done, total = progress.share, progress.done, progress.total
        if self._frames:
            draw_waiting(canvas, self._theme, share, f"{done} of {total} parts, {seconds} s", self._size)
        else:
            draw_progress(canvas, self._theme, share, f"{done} of {total} parts", self._size)
        self._display.show()

    def advance(self, theme: Theme, corner: tuple[int, int] | None = None, size: int = 12) -> None:
        """Show how far it is, and load a kernel if this frame has time left for it.

        It is written within the upper right ``corner`` [px] of the world, of the window where that is not
        given, in letters of a ``size`` [px].
        """
        self._frames += 1
        self._theme, self._size = theme, size
        pending = self.scenes.pending()
        if self._warmup is not None and not self._warmup.finished:
            self._progress = self._warmup.poll()
            canvas = self._display.canvas
            draw_corner(canvas, theme, self._progress.share, corner or (canvas.size[0], 0), size)
        if interpreter.is_forced():
            return
        if self.scenes.notice(self._display.left):
            self._catch_up(pending[0])
        elif pending:  # a frame that interprets them takes longer than one that loads one
            self._load_announced(pending)
        elif self._display.left > _ROOM or self._frames % _LOAD_EVERY == 0:
            self._load_one(KERNELS)

    @property
    def seconds_left(self) -> float | None:
        """How long [s] it takes about until what moves the scene is compiled; ``None`` where it is."""
        pending = self.scenes.pending()
        if self._warmup is None or not pending:
            return None
        return self._warmup.seconds_left([name_of(jitted) for jitted in pending])

    def time_for_steps(self, longest: float) -> float:
        """Return how long [s] the steps of the coming frame may take, at most ``longest``.

        In a frame in which a kernel will be loaded the steps take less.
        """
        return self.scenes.made_up_for(longest, self._coming is not None)

    def _load_announced(self, pending: Sequence[Any]) -> None:
        """Load the kernel that this frame has left time for, and choose one for the next."""
        if self._coming is not None:
            load(self._coming)
        ready = (jitted for jitted in pending if not jitted.compiled and self._is_kept(jitted))
        self._coming = next(ready, None)

    def _load_one(self, kernels: Sequence[Any]) -> None:
        """Load the first of some kernels that is in the cache and not loaded yet, if there is one."""
        for jitted in kernels:
            if not jitted.compiled and self._is_kept(jitted):
                load(jitted)
                return

    def _is_kept(self, jitted: Any) -> bool:
        return self._warmup is None or self._warmup.has((name_of(jitted),))
