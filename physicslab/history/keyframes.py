"""The key frames of a line, within a budget of memory: some all along it, and more around one place."""

from __future__ import annotations

from bisect import bisect_left, bisect_right, insort
from typing import Any

from physicslab.history.keyframe import Keyframe

__all__ = ["Keyframes"]

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
    size : int
        Bytes that all take.
    """

    def __init__(self, budget: int) -> None:
        self._budget = budget
        self._frames: dict[int, Keyframe] = {}
        self._along: list[int] = []
        self._nearby: list[int] = []
        self._uses: dict[int, int] = {}
        self.spacing, self.size = 1, 0
        self._size_nearby = 0

    def __len__(self) -> int:
        return len(self._frames)

    def __contains__(self, place: int) -> bool:
        return place in self._frames

    def __getitem__(self, place: int) -> Keyframe:
        return self._frames[place]

    def before(self, place: int) -> int:
        """Return the last place with a key frame that is not behind ``place``."""
        along, nearby = (_last(places, place) for places in (self._along, self._nearby))
        return max(along, nearby)

    def is_along(self, place: int) -> bool:
        """Whether there is one along the line at a place."""
        return _last(self._along, place) == place

    def takes(self, place: int) -> bool:
        """Whether a key frame along the line may be added at a place: it is not too near to the last one."""
        return place - _last(self._along, place) >= self.spacing

    def add_along(self, place: int, frame: Keyframe) -> None:
        """Add one along the line."""
        if place not in self._frames:
            self._keep(place, frame)
            insort(self._along, place)
        while self.size - self._size_nearby > (1.0 - _NEARBY_SHARE) * self._budget and len(self._along) > 2:
            self.spacing *= 2
            self._thin()

    def add_nearby(self, place: int, frame: Keyframe, around: int) -> None:
        """Add one near the place ``around``, and drop the farthest from there while they are too many."""
        if place in self._frames:
            return
        before = self.size
        self._keep(place, frame)
        self._size_nearby += self.size - before
        insort(self._nearby, place)
        while self._nearby and self._size_nearby > _NEARBY_SHARE * self._budget:
            first, last = self._nearby[0], self._nearby[-1]
            self._drop_nearby(first if around - first > last - around else last)

    def cut(self, place: int) -> None:
        """Drop all behind a place: the line goes on differently from there."""
        while self._nearby and self._nearby[-1] > place:
            self._drop_nearby(self._nearby[-1])
        while self._along[-1] > place:
            self._drop(self._along.pop())

    def _thin(self) -> None:
        kept = [self._along[0]]
        for place in self._along[1:]:
            if place - kept[-1] >= self.spacing:
                kept.append(place)
            else:
                self._drop(place)
        self._along = kept

    def _drop_nearby(self, place: int) -> None:
        del self._nearby[bisect_left(self._nearby, place)]
        before = self.size
        self._drop(place)
        self._size_nearby -= before - self.size

    def _keep(self, place: int, frame: Keyframe) -> None:
        self._frames[place] = frame
        self.size += _FRAME
        for part in frame.arrays():
            uses = self._uses.get(id(part), 0)
            self._uses[id(part)] = uses + 1
            if not uses:
                self.size += _bytes(part)

    def _drop(self, place: int) -> None:
        frame = self._frames.pop(place)
        self.size -= _FRAME
        for part in frame.arrays():
            uses = self._uses.pop(id(part)) - 1
            if uses:
                self._uses[id(part)] = uses
            else:
                self.size -= _bytes(part)


def _last(places: list[int], place: int) -> int:
    """Return the last of some sorted places that is not behind ``place``; -1 where there is none."""
    k = bisect_right(places, place)
    return places[k - 1] if k else -1


def _bytes(part: Any) -> int:
    return int(part.nbytes) + _OBJECT
