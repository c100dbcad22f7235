"""Arrows: each kind has its own colour, head and shaft, so that no two differ by colour alone."""

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from physicslab.theme import Colour, Theme
from physicslab.view.canvas.camera import Drawing
from physicslab.view.canvas.canvas import Canvas, Numbers, Points
from physicslab.view.picture.pen import divided

MIN_LENGTH = 3.0
"""Arrows shorter than this are left out [px]."""
_MAX_LENGTH = 0.3
"""Arrows are cut at this share of the smaller side of the picture."""
_HEAD = 10.0
"""Length of a head [px]; at most half of the arrow."""
_MAX_DASHES = 600
_DASH, _GAP = 5.0, 4.0
"""The strokes of a broken shaft, and the spaces between them [px]."""
_PART_WIDTH = 1.3
"""Width of the parts of arrows along x and y [px]."""
_BOLD_LIMIT = 256
"""More arrows than this of one kind are drawn finer, so that something is seen between them."""

type Strokes = tuple[tuple[tuple[float, float], tuple[float, float]], ...]


class Head(Enum):
    """The strokes of a head of length 1 that points along x, its tip at the origin."""

    CLOSED = (
        ((0.0, 0.0), (-1.0, 0.42)), ((0.0, 0.0), (-1.0, -0.42)), ((-1.0, 0.42), (-1.0, -0.42)),
    )  # fmt: skip
    DOUBLE = (
        ((0.0, 0.0), (-0.7, 0.42)), ((0.0, 0.0), (-0.7, -0.42)),
        ((-0.6, 0.0), (-1.3, 0.42)), ((-0.6, 0.0), (-1.3, -0.42)),
    )  # fmt: skip
    BAR = (((0.0, 0.45), (0.0, -0.45)),)
    DIAMOND = (
        ((0.0, 0.0), (-0.6, 0.4)), ((0.0, 0.0), (-0.6, -0.4)),
        ((-0.6, 0.4), (-1.2, 0.0)), ((-0.6, -0.4), (-1.2, 0.0)),
    )  # fmt: skip
    OPEN = (((0.0, 0.0), (-0.9, 0.45)), ((0.0, 0.0), (-0.9, -0.45)))
    FORKED = (
        ((0.0, 0.0), (-1.0, 0.42)), ((0.0, 0.0), (-1.0, -0.42)), ((-1.0, 0.42), (-0.6, 0.0)),
        ((-1.0, -0.42), (-0.6, 0.0)),
    )  # fmt: skip


_CUT: Strokes = (((-0.3, -0.55), (0.1, 0.55)), ((0.1, -0.55), (0.5, 0.55)))
"""The mark across the middle of an arrow that is longer than it is drawn."""


@dataclass(frozen=True, slots=True)
class ArrowKind:
    """The meaning of an arrow, and its look.

    Attributes
    ----------
    name : str
        Its name in the legend.
    paint : str
        The field of the theme that holds its colour.
    head : Head
        The shape of its tip.
    width : float
        Width of its strokes [px].
    dashed : bool
        Whether its shaft is broken.
    """

    name: str
    paint: str
    head: Head
    width: float = 2.0
    dashed: bool = False

    def colour(self, theme: Theme) -> Colour:
        """Return its colour."""
        colour: Colour = getattr(theme, self.paint)
        return colour


VELOCITY = ArrowKind("Velocity", "velocity", Head.CLOSED)
MOMENTUM = ArrowKind("Momentum", "planet", Head.FORKED)
FORCE = ArrowKind("Net force", "force", Head.DOUBLE)
BODY_FORCE = ArrowKind("Forces on the selection", "force", Head.DOUBLE, 2.6)
CONTACT_NORMAL = ArrowKind("Contact normal", "contact_normal", Head.BAR, width=1.4)
NORMAL_IMPULSE = ArrowKind("Normal impulse", "normal_impulse", Head.DIAMOND)
FRICTION_IMPULSE = ArrowKind("Friction impulse", "friction_impulse", Head.OPEN, dashed=True)


IMPACT_WIDTH, REST_WIDTH = 3.0, 1.6
"""How thick arrows are drawn [px]: an impact's, and those of resting contact."""


def max_length(canvas: Canvas) -> float:
    """Return the length at which arrows are cut [px]."""
    return _MAX_LENGTH * min(canvas.size)


def draw_arrows(
    start: Points, span: Points, kind: ArrowKind, on: Drawing, opacity: float | Numbers = 1.0
) -> None:
    """Draw arrows of one kind from ``start`` (n, 2) on, each ``span`` (n, 2) long [px].

    Shafts are one call of :meth:`Canvas.lines`, heads a second one; arrows that are cut have two strokes
    across the middle. Arrows shorter than ``MIN_LENGTH``, not finite, or out of the picture are left out.
    Each arrow may have an opacity of its own (n,).
    """
    limit = max_length(on.canvas)
    with np.errstate(invalid="ignore", over="ignore"):
        length = np.hypot(span[:, 0], span[:, 1])
        seen = (length >= MIN_LENGTH) & np.isfinite(length)
        for place, side in zip(start.T, on.canvas.size, strict=True):
            seen &= (place > -limit) & (place < side + limit)
    if not seen.any():
        return
    start, span, length = start[seen], span[seen], length[seen]
    share = np.full(len(length), opacity) if isinstance(opacity, float) else opacity[seen]
    unit = span / length[:, None]
    cut = length > limit
    length = np.minimum(length, limit)
    end = start + length[:, None] * unit
    colour, width = kind.colour(on.theme), kind.width
    head = _HEAD + width
    if len(length) > _BOLD_LIMIT:
        width, head, share = max(0.5 * width, 1.0), 0.6 * _HEAD, 0.6 * share
    if kind.dashed:
        froms, tos, whose = dashes(start, end)
        on.canvas.lines(froms, tos, colour, width, share[whose])
    else:
        on.canvas.lines(start, end, colour, width, share)
    size = np.minimum(head, 0.5 * length)
    froms, tos = _placed(kind.head.value, end, unit, size)
    shares = np.tile(share, len(kind.head.value))
    if cut.any():
        middle = 0.5 * (start[cut] + end[cut])
        marks = _placed(_CUT, middle, unit[cut], np.full(int(cut.sum()), _HEAD))
        froms, tos = np.concatenate((froms, marks[0])), np.concatenate((tos, marks[1]))
        shares = np.concatenate((shares, np.tile(share[cut], len(_CUT))))
    on.canvas.lines(froms, tos, colour, width, shares)


def draw_parts(start: Points, span: Points, kind: ArrowKind, on: Drawing) -> None:
    """Draw the parts of arrows (n, 2) [px] along x and y, each from where the arrow begins."""
    for axis in (0, 1):
        part = np.zeros_like(span)
        part[:, axis] = span[:, axis]
        fine = replace(kind, width=_PART_WIDTH, dashed=True)
        draw_arrows(start, part, fine, on, 0.85)


def _placed(strokes: Strokes, tip: Points, unit: Points, size: NDArray[np.float64]) -> tuple[Points, Points]:
    """Return the starts and ends of strokes, placed at every tip: the first of each, then the second."""
    along = unit * size[:, None]
    across = np.stack((-along[:, 1], along[:, 0]), axis=1)
    axes = np.concatenate((along.reshape(1, -1), across.reshape(1, -1)))
    corners = np.array(strokes)  # (stroke, start or end, along and across)
    froms, tos = ((corners[:, side] @ axes).reshape(len(strokes), -1, 2) + tip for side in (0, 1))
    return froms.reshape(-1, 2), tos.reshape(-1, 2)


def dashes(start: Points, end: Points) -> tuple[Points, Points, NDArray[np.int64]]:
    """Return the strokes of broken lines between ends (n, 2) [px], and of which line each is.

    The last stroke of each line ends where that does.
    """
    span = end - start
    length = np.hypot(span[:, 0], span[:, 1])
    count = np.maximum(np.ceil(length / (_DASH + _GAP)), 1.0).astype(np.int64)
    line, place = divided(count)
    unit = span / np.maximum(length, 1e-9)[:, None]
    high = length[line] - place * (_DASH + _GAP)
    low = np.maximum(high - _DASH, 0.0)
    start, unit = start[line], unit[line]
    return start + low[:, None] * unit, start + high[:, None] * unit, line


def even_dashes(start: NDArray[np.float64], end: NDArray[np.float64], dash: float) -> tuple[Points, Points]:
    """Return the strokes of a broken line between ends (2,); dashes and gaps are about ``dash`` long [px]."""
    count = min(max(round(0.5 * float(np.hypot(*(end - start))) / dash), 1), _MAX_DASHES)
    share = np.arange(2 * count, dtype=np.float64)[:, None] / max(2 * count - 1, 1)
    corners = start + share * (end - start)
    return corners[0::2], corners[1::2]
