"""Numbers beside points of the picture: none over another, none that jumps about."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.view.canvas.camera import Drawing
from physicslab.view.canvas.canvas import Rect, TextStyle

type Key = tuple[int, ...]

_OFF = 14.0
"""The least distance between a place and its label [px]."""
type Slot = tuple[int, int, int]


def _cost(slot: Slot) -> float:
    """Return how far a slot is; one row up or down comes first, where it hides no arrow along the surface."""
    _, column, row = slot
    return 3.0 * column + abs(abs(row) - 0.9) + 0.05 * (row > 0)


_SLOTS: list[Slot] = sorted(
    ((side, column, row) for column in range(2) for row in range(-3, 4) for side in (1, -1)), key=_cost
)
"""Positions of a label: right (1) or left (-1) of its place, and widths aside, heights down."""
_BETTER = 2.0
"""By how much a free slot must be nearer for a label to move there."""
_POINT = 7
"""Half the side of what labels leave free around each place [px]."""
_PAD = 5
_CLEAR = 3
"""Room between labels [px]."""


@dataclass(frozen=True, slots=True)
class Label:
    """Lines of words that belong to a place of the picture.

    Attributes
    ----------
    key : tuple of ints
        The same from frame to frame.
    at : tuple of two floats
        The place [px].
    lines : sequence of str
        Its words.
    """

    key: Key
    at: tuple[float, float]
    lines: Sequence[str]


class Labels:
    """Finds room for labels, and keeps each where it was for as long as there is room."""

    def __init__(self) -> None:
        self._slot: dict[Key, int] = {}

    def clear(self) -> None:
        """Forget where labels were."""
        self._slot.clear()

    def known(self, key: Key) -> bool:
        """Whether a label was shown in the last frame."""
        return key in self._slot

    def draw(
        self, labels: Sequence[Label], covered: Sequence[Rect], on: Drawing, *, always: bool = False
    ) -> dict[Key, Rect]:
        """Draw labels, those of the last frame and the first ones first; return where they are [px].

        A label that finds no room is left out; or, ``always``, lies over something.
        """
        points = [
            (round(x) - _POINT, round(y) - _POINT, 2 * _POINT, 2 * _POINT)
            for x, y in (label.at for label in labels)
        ]
        taken, slots = [*covered, *points], {}
        turn = {key: n for n, key in enumerate(self._slot)}
        style = TextStyle(on.size, on.theme.text)
        line_height = on.canvas.text_size("Ag", style)[1] - 2
        placed: list[tuple[Label, Rect]] = []
        for label in sorted(labels, key=lambda label: turn.get(label.key, len(turn))):
            width = max(on.canvas.text_size(line, style)[0] for line in label.lines) + 2 * _PAD
            extent = width, line_height * len(label.lines) + 2 * _PAD
            found = self._find(label, extent, taken, on.canvas.size)
            if found is None and always:
                found = self._find(label, extent, (), on.canvas.size)
            if found is None:
                continue
            slots[label.key], rect = found
            taken.append(rect)
            placed.append((label, rect))
        self._slot = slots
        _draw_leaders(placed, on)
        for label, rect in placed:
            _draw(label, rect, style, line_height, on)
        return {label.key: rect for label, rect in placed}

    def _find(
        self, label: Label, extent: tuple[int, int], taken: Sequence[Rect], screen: tuple[int, int]
    ) -> tuple[int, Rect] | None:
        """Return the nearest slot that is free; the one of the last frame if it is about as near."""
        rects = _beside(label.at, extent)
        low, high = rects, rects + extent
        free = ((low >= 0) & (high <= screen)).all(axis=1)
        other = np.array(taken, np.int64).reshape(-1, 4)
        apart = (low[:, None] >= other[:, :2] + other[:, 2:] + _CLEAR) | (
            other[:, :2] >= high[:, None] + _CLEAR
        )
        free &= apart.any(axis=2).all(axis=1)
        if not free.any():
            return None
        slot, before = int(free.argmax()), self._slot.get(label.key)
        if before is not None and free[before] and _cost(_SLOTS[before]) < _cost(_SLOTS[slot]) + _BETTER:
            slot = before
        left, top = rects[slot].tolist()
        return slot, (left, top, *extent)


def _beside(at: tuple[float, float], extent: tuple[int, int]) -> NDArray[np.int64]:
    """Return the left top corners (n, 2) of a rectangle in each of the slots around ``at`` [px]."""
    side, column, row = np.array(_SLOTS).T
    x = at[0] + side * (_OFF + (column + 0.5) * (extent[0] + _CLEAR)) - 0.5 * extent[0]
    y = at[1] + row * (extent[1] + _CLEAR) - 0.5 * extent[1]
    return np.rint(np.stack((x, y), axis=1)).astype(np.int64)


def _draw(label: Label, rect: Rect, style: TextStyle, line_height: int, on: Drawing) -> None:
    left, top, _, _ = rect
    on.canvas.panel(rect, on.theme.panel, on.theme.outline, on.theme.panel_opacity)
    for n, line in enumerate(label.lines):
        on.canvas.text(line, (left + _PAD, top + _PAD + n * line_height - 1), style)


def _draw_leaders(placed: Sequence[tuple[Label, Rect]], on: Drawing) -> None:
    """Draw the thin lines from places to their labels."""
    if placed:
        start = np.array([label.at for label, _ in placed])
        corner, extent = np.split(np.array([rect for _, rect in placed], np.float64), 2, axis=1)
        on.canvas.lines(start, np.clip(start, corner, corner + extent), on.theme.faint, 1.0, 0.8)
