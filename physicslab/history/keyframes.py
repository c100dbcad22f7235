"""The key frames of a line, within a budget of memory: some all along it, and more around one place."""

from bisect import bisect_left, bisect_right, insort
from typing import Any

from physicslab.stepping.keyframe import Keyframe

_OBJECT = 120
"""Bytes that an array takes besides its contents."""
_FRAME = 3_000
"""Bytes that a key frame takes besides its arrays."""
_NEARBY_SHARE = 0.25
"""Share of the budget for the key frames around one place."""


class Keyframes:
    """Key frames by place, in two sets.

    Those *along* the line keep a distance; where they take more memory than they may, it doubles, and those
    nearer to each other go. Those *nearby* are left where someone scrubs or edits; the farthest from there go
    first. The one at place 0 stays.

    Parameters
    ----------
    budget : int
        Bytes that all may take together.

    Attributes
    ----------
    spacing : int
        The least distance of two along the line [ticks].
    """

    def __init__(self, budget: int) -> None:
        self._budget = budget
        self._along, self._nearby = _Frames(), _Frames()
        self.spacing = 1

    def __contains__(self, place: int) -> bool:
        return place in self._along.by_place or place in self._nearby.by_place

    def __getitem__(self, place: int) -> Keyframe:
        return self._along.by_place.get(place) or self._nearby.by_place[place]

    @property
    def size(self) -> int:
        """Bytes that all take; what the two sets share is counted in both."""
        return self._along.size + self._nearby.size

    def before(self, place: int) -> int:
        """Return the last place with a key frame that is not behind ``place``."""
        return max(self._along.last(place), self._nearby.last(place))

    def is_along(self, place: int) -> bool:
        """Whether there is one along the line at a place."""
        return place in self._along.by_place

    def takes(self, place: int) -> bool:
        """Whether a key frame along the line may be added at a place: it is not too near to the last one."""
        return place - self._along.last(place) >= self.spacing

    def add_along(self, place: int, frame: Keyframe) -> None:
        """Add one along the line."""
        if place not in self._along.by_place:
            self._along.add(place, frame)
        while self._along.size > (1.0 - _NEARBY_SHARE) * self._budget and len(self._along.places) > 2:
            self.spacing *= 2
            self._thin()

    def add_nearby(self, place: int, frame: Keyframe, around: int) -> None:
        """Add one near the place ``around``, and drop the farthest from there while they are too many."""
        if place in self:
            return
        nearby = self._nearby
        nearby.add(place, frame)
        while nearby.places and nearby.size > _NEARBY_SHARE * self._budget:
            first, last = nearby.places[0], nearby.places[-1]
            nearby.drop(first if around - first > last - around else last)

    def cut(self, place: int) -> None:
        """Drop all behind a place: the line goes on differently from there."""
        for frames in (self._along, self._nearby):
            while frames.places and frames.places[-1] > place:
                frames.drop(frames.places[-1])

    def _thin(self) -> None:
        last = self._along.places[0]
        for place in self._along.places[1:]:
            if place - last >= self.spacing:
                last = place
            else:
                self._along.drop(place)


class _Frames:
    """Some key frames, and what they take: an array that several share is counted once.

    Attributes
    ----------
    by_place : dict of int to Keyframe
        All of them.
    places : list of int
        Where they are, in order.
    size : int
        Bytes that they take.
    """

    def __init__(self) -> None:
        self.by_place: dict[int, Keyframe] = {}
        self.places: list[int] = []
        self.size = 0
        self._uses: dict[int, int] = {}

    def last(self, place: int) -> int:
        """Return the last place of one that is not behind ``place``; -1 where there is none."""
        k = bisect_right(self.places, place)
        return self.places[k - 1] if k else -1

    def add(self, place: int, frame: Keyframe) -> None:
        """Keep one at a place where there is none."""
        self.by_place[place] = frame
        insort(self.places, place)
        self.size += _FRAME
        for part in frame.arrays():
            uses = self._uses.get(id(part), 0)
            self._uses[id(part)] = uses + 1
            if not uses:
                self.size += _bytes(part)

    def drop(self, place: int) -> None:
        """Let go of the one at a place."""
        frame = self.by_place.pop(place)
        del self.places[bisect_left(self.places, place)]
        self.size -= _FRAME
        for part in frame.arrays():
            uses = self._uses.pop(id(part)) - 1
            if uses:
                self._uses[id(part)] = uses
            else:
                self.size -= _bytes(part)


def _bytes(part: Any) -> int:
    return int(part.nbytes) + _OBJECT
