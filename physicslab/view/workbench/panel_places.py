"""Places of meters and sliders: beside each other in corners of the room that the other panels leave."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations

from physicslab.view.canvas.canvas import Rect, free_rects, overlap

_ROOM = (13.0, 12.0)
"""Width and height below which there is no room for any panel, in heights of the text."""
_BAR = 2.2
"""Height of the bar by which the others are opened, in heights of the text."""
_GAP = 0.6
"""Room between two panels, in heights of the text."""
_NUMBERS = 1.4
"""Room for the numbers of the world's axes at the left and below, beside small panels."""
_SCALE_BAR, _BAR_WIDTH = 3.4, 5.0
"""Room for the scale bar below panels at the right, and its width, in heights of the text."""
_CROWDED = 0.3
"""Share of the room from which on small panels hide too much of the world."""
_LEAST_GRAPH = 18.0
"""Width that is left for graphs beside small panels; where there is less they lie above or below them."""


@dataclass(frozen=True, slots=True)
class Small:
    """A meter or a slider: its entity, the corner it is in, and its width and height [px]."""

    entity: int
    corner: str
    size: tuple[int, int]


def places(area: Rect, text: float, small: Sequence[Small]) -> dict[int, Rect]:
    """Return where meters and sliders are, by entity: below each other, or beside, where that takes less.

    Parameters
    ----------
    area : Rect
        The room left for them [px].
    text : float
        Height of the text [px].
    small : sequence of Small
        Meters and sliders, in the order in which they are put down.
    """
    gap = round(_GAP * text)
    left, top, width, height = area
    inner = (left + gap, top + gap, max(width - 2 * gap, 1), max(height - 2 * gap, 1))
    ways = [_small(inner, text, gap, small, downwards=downwards) for downwards in (True, False)]
    return max(ways, key=lambda way: (-covered(way.values()), _largest(inner, list(way.values()))))


def covered(taken: Iterable[Rect]) -> int:
    """Return how much of small panels others cover, as those from two corners do in little room [px^2]."""
    pairs = combinations(taken, 2)
    return sum(
        max(min(x + w, u + m) - max(x, u), 0) * max(min(y + h, v + n) - max(y, v), 0)
        for (x, y, w, h), (u, v, m, n) in pairs
    )


def has_room(area: Rect, text: float) -> bool:
    """Whether panels can be put there at all."""
    return area[2] >= _ROOM[0] * text and area[3] >= _ROOM[1] * text


def is_crowded(area: Rect, small: Sequence[Small]) -> bool:
    """Whether meters and sliders would take too much of the room."""
    return sum(one.size[0] * one.size[1] for one in small) > _CROWDED * area[2] * area[3]


def bar_at_top(area: Rect, text: float) -> Rect:
    """Return where a bar is that stands for all panels [px]."""
    gap = round(_GAP * text)
    return area[0] + gap, area[1] + gap, max(area[2] - 2 * gap, 1), round(_BAR * text)


def _small(area: Rect, text: float, gap: int, small: Sequence[Small], *, downwards: bool) -> dict[int, Rect]:
    """Put meters and sliders into their corners, above each other or beside each other."""
    found: dict[int, Rect] = {}
    bar = round(_BAR_WIDTH * text), round(_SCALE_BAR * text)
    taken: list[Rect] = [(area[0] + area[2] - bar[0], area[1] + area[3] - bar[1], *bar)]
    for corner in dict.fromkeys(one.corner for one in small):
        stack = [one for one in small if one.corner == corner]
        if downwards:
            placed = _stacked(_beside_numbers(area, text, corner), gap, stack, corner)
            if covered([*taken, *placed.values()]):  # over the numbers all of a stack is in one line
                placed = _stacked(area, gap, stack, corner)
        else:
            below = 0 if "top" in corner else round(_SCALE_BAR * text)
            rows = (area[0], area[1], area[2], max(area[3] - below, 1))
            placed = _in_rows(rows, gap, stack, corner)
        for entity, rect in placed.items():
            found[entity] = _nearest_free(rect, taken, area, gap)
            taken.append(found[entity])
    return found


def _nearest_free(rect: Rect, taken: Sequence[Rect], area: Rect, gap: int) -> Rect:
    """Return the place nearest to that of a panel where it lies over none; its own if there is none."""
    x, y, width, height = rect
    left, top, across, down = area
    columns = [x, left, left + across - width]
    columns += [at for u, _, w, _ in taken for at in (u + w + gap, u - gap - width)]
    rows = [
        y,
        top,
        top + down - height,
        *(at for _, v, _, h in taken for at in (v + h + gap, v - gap - height)),
    ]
    free = [
        (abs(u - x) + abs(v - y), (u, v, width, height))
        for u in columns if left <= u <= left + across - width
        for v in rows if top <= v <= top + down - height
        if not any(overlap((u, v, width, height), one) for one in taken)
    ]  # fmt: skip
    return min(free, default=(0, rect))[1]


def _beside_numbers(area: Rect, text: float, corner: str) -> Rect:
    """Leave room for what is written at the edges of the world, where there is enough."""
    left, top, width, height = area
    if width < _LEAST_GRAPH * text:
        return area
    across = round(_NUMBERS * text) if "left" in corner else 0
    below = 0.0 if "top" in corner else _NUMBERS if "left" in corner else _SCALE_BAR
    return left + across, top, width - across, max(height - round(below * text), 1)


def _stacked(area: Rect, gap: int, stack: Sequence[Small], corner: str) -> dict[int, Rect]:
    """Put small panels above each other from a corner on, and go on beside them where the room ends.

    The first is uppermost, at the bottom, too.
    """
    left, top, width, height = area
    found: dict[int, Rect] = {}
    down = across = widest = 0
    for one in stack if "top" in corner else reversed(stack):
        w, h = min(one.size[0], width), min(one.size[1], height)
        if down and down + h > height:
            down, across, widest = 0, across + widest + gap, 0
        x = left + across if "left" in corner else left + width - across - w
        y = top + down if "top" in corner else top + height - down - h
        found[one.entity] = (max(min(x, left + width - w), left), y, w, h)
        down, widest = down + h + gap, max(widest, w)
    return found


def _in_rows(area: Rect, gap: int, stack: Sequence[Small], corner: str) -> dict[int, Rect]:
    """Put small panels beside each other from a corner on: stacks with across and down exchanged."""
    left, top, width, height = area
    turned = [Small(one.entity, corner, one.size[::-1]) for one in stack]
    flipped = f"{'top' if 'left' in corner else 'bottom'} {'left' if 'top' in corner else 'right'}"
    found = _stacked((top, left, height, width), gap, turned, flipped)
    return {entity: (y, x, h, w) for entity, (x, y, w, h) in found.items()}


def _largest(area: Rect, taken: Sequence[Rect]) -> int:
    """Return the area of the largest part that small panels leave [px^2]."""
    return max((width * height for _, _, width, height in free_rects(area, taken)), default=0)
