"""The places of a line that a world is taken to: from the last key frame before each, the steps since."""

import time
from collections.abc import Iterator
from contextlib import contextmanager

from physicslab.history.digest import Digester, differing
from physicslab.history.keyframes import Keyframes
from physicslab.history.line import Line, Steps
from physicslab.history.replay import Played, make_again
from physicslab.stepping.keyframe import Keyframe
from physicslab.world import World

_RARELY, _OFTEN, _SEEKING = 100.0, 16.0, 5.0
"""How many times as long as a key frame takes that takes which lies between two, at most and at least along
the line; and where steps are made again, or an edit begins."""
_SMOOTH, _LIMIT = 0.010, 0.020
"""Time [s] of what lies between two along the line, where that lies between those: nearly any place is then
reached within a frame of the screen. And how much it may be: where that is too little for the least share,
no place would be reached in time, and key frames are as rare as they may be."""
_SOON = 8
"""Number of ticks that are made sooner than a key frame is gone back to."""


class Places:
    """A world on its line of edits and runs; it is taken to any place of it.

    Parameters
    ----------
    world : World
        As it is at the beginning of the line.
    budget : int
        Bytes that key frames may take together.

    Attributes
    ----------
    world : World
        The world at the present place.
    line : Line
        Edits and runs, before the present place and after it. Whatever is added to it is noted by
        :meth:`advance`; another line is put in its place by :meth:`follow`.
    here : int
        The present place [ticks].
    digester : Digester
        Makes the digests of the world.
    difference : Played, optional
        The first place found where steps that were made again gave other bits.
    """

    def __init__(self, world: World, budget: int) -> None:
        self.world, self.line, self.here = world, Line(), 0
        self.digester = Digester()
        self.difference: Played | None = None
        self._frames = Keyframes(budget)
        self._whole = True
        self._cost = self._since = self._since_along = 0.0
        self._interval = 0.0  # what lies between two key frames along the line takes [s]
        self._last: Keyframe | None = None
        self._take()  # the first takes longer than others will
        self._cost = 0.0
        self._leave_along()

    @property
    def size(self) -> int:
        """Bytes that the key frames take."""
        return self._frames.size

    @property
    def beginning(self) -> Keyframe:
        """The world at the beginning of the line."""
        return self._frames[0]

    def advance(self, began: float) -> None:
        """Note that a tick was added at the end of the line, and leave a key frame where one is due.

        Parameters
        ----------
        began : float
            When it was begun [s], by ``time.perf_counter``.
        """
        self._count(began)
        if self._since_along >= self._interval and self._frames.takes(self.here):
            self._leave_along()

    def prepare_edit(self) -> None:
        """Leave a key frame before an edit: where it is refused, or taken back, the place is gone back to."""
        if self._since >= _SEEKING * self._cost:
            self._leave_nearby()

    def follow(self, line: Line, common: int) -> None:
        """Go on along another line, of which the first ``common`` ticks are those of this one."""
        self.line = line
        self._frames.cut(common)

    def go(self, place: int) -> None:
        """Go to a place of the line."""
        base = self._frames.before(place)
        ahead = place - self.here
        if not self._whole or ahead < 0 or (base > self.here and ahead > _SOON):
            self._restore(base)
        try:
            self._make_again(place)
        except BaseException:
            self._whole = False
            raise

    @contextmanager
    def all_or_nothing(self) -> Iterator[None]:
        """Go back to the present place where what is done in the ``with`` block fails."""
        try:
            yield
        except BaseException:
            self.break_off()
            raise

    def break_off(self) -> None:
        """Go back to the present place: what was begun there failed."""
        self._whole = False
        self.mend()

    def mend(self) -> None:
        """Make the world again that is at the present place, where something was broken off."""
        if not self._whole:
            place = self.here
            self._restore(self._frames.before(place))
            self.go(place)

    def _restore(self, base: int) -> None:
        """Go back to a key frame."""
        self._whole = False
        self._last = self._frames[base]
        self._last.restore(self.world)
        self.here, self._since, self._whole = base, 0.0, True
        # A frame nearby has no note of how far the last one along the line is.
        self._since_along = 0.0 if self._frames.is_along(base) else float("inf")

    def _make_again(self, place: int) -> None:
        """Go on to a place along the line, and leave key frames on the way: others nearby will follow."""
        for piece in self.line.between(self.here, place):
            if isinstance(piece, Steps):
                for _ in range(piece.count):
                    began = time.perf_counter()
                    self.world.step(piece.dt)
                    self._pass(began, place)
                    self._compare()
                continue
            began = time.perf_counter()
            make_again(self.world, piece)
            self._pass(began, place)

    def _count(self, began: float) -> None:
        """Go on by a tick that was begun at ``began`` [s]."""
        self.here += 1
        spent = time.perf_counter() - began
        self._since += spent
        self._since_along += spent

    def _pass(self, began: float, target: int) -> None:
        """Note that a tick was made again."""
        self._count(began)
        if self._since >= _SEEKING * self._cost:
            self._leave_nearby(target)

    def _compare(self) -> None:
        """Compare the step that was made again with what came of it once."""
        columns = differing(self.digester.digest(self.world), self.line.digest_before(self.here))
        if columns and self.difference is None:
            self.difference = Played(self.line.steps_before(self.here), self.world.time, columns)

    def _leave_along(self) -> None:
        self._frames.add_along(self.here, self._take())
        self._since_along = 0.0

    def _leave_nearby(self, target: int | None = None) -> None:
        if self.here not in self._frames:
            around = self.here if target is None else target
            self._frames.add_nearby(self.here, self._take(), around)

    def _take(self) -> Keyframe:
        """Return a key frame of now."""
        began = time.perf_counter()
        frame = Keyframe(self.world, self._last)
        took = time.perf_counter() - began
        # A part of it, and no more than twice as much: other programs may have run meanwhile.
        self._cost += 0.25 * (min(took, 2.0 * self._cost) - self._cost) if self._cost else took
        often, rarely = _OFTEN * self._cost, _RARELY * self._cost
        self._interval = rarely if often > _LIMIT else min(max(often, _SMOOTH), rarely)
        self._since, self._last = 0.0, frame
        return frame
