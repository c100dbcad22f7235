"""Whether a scene is so small that its kernels are interpreted while other processes compile them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from physicslab.stepping.small import is_small

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["INTERPRETING_LIMIT", "SmallScenes"]

INTERPRETING_LIMIT = 0.5
"""What takes longer than this [s] to interpret, a call or several frames in turn, is waited for: until then
slow frames, as on a machine that is busy, are better than half a minute without any."""
_STEPS = 0.05
"""So long [s] a frame may make steps while kernels are interpreted; the last may end later."""
_STEPS_AND_LOADING = 0.02
"""And so long [s] where it loads a kernel besides, which takes up to 30 ms."""
_IN_TURN = 4
"""So many frames in turn: a single one is late for other reasons."""


class SmallScenes:
    """Finds which kernels run as Python until they are compiled: those of a scene that is small.

    It takes 0.2 to 30 ms a step, and no one need wait. What turns out to be slow, as a method that chooses
    its steps may be with few bodies too, is waited for from then on, until another scene is shown.

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
        """Return whether frames are too long, after one that was done ``left`` seconds before it was due."""
        self._late = self._late + 1 if self.pending() and left < -INTERPRETING_LIMIT else 0
        return self._late >= _IN_TURN

    def made_up_for(self, longest: float, loads: bool = False) -> float:
        """Return the time [s] that a frame makes up for at most, ``longest`` where nothing is interpreted.

        It is less where the frame also loads a kernel.
        """
        return min(longest, _STEPS_AND_LOADING if loads else _STEPS) if self.pending() else longest
