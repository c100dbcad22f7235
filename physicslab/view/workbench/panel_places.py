"""Places of graphs, meters and sliders: beside each other, in the room that the other panels leave."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from physicslab.view.canvas.canvas import Rect

_GRAPH = (27.0, 20.0)
"""Width and height that a graph has where there is room, in heights of the text."""
_LEAST = (12.0, 14.0)
"""Width and height below which nothing can be read in a graph: only one is then open."""
_ROOM = (13.0, 12.0)
"""Width and height below which there is no room for any panel, in heights of the text."""
_BAR = 2.2
"""Height of the bar by which the others are opened, in heights of the text."""
_GAP = 0.6
"""Room between two panels, in heights of the text."""
_NUMBERS = 1.4
"""Room for the numbers of the world's axes at the left and below, beside small panels."""
_SCALE_BAR = 3.4
"""Room for the scale bar below panels at the right."""
_LEAST_GRAPH = 18.0
"""Width that is left for graphs beside small panels; where there is less they lie above or below them."""


@dataclass(frozen=True, slots=True)
class Small:
    """A meter or a slider: its entity, the corner it is in, and its width and height [px]."""

    entity: int
    corner: str
    size: tuple[int, int]


def places(
    area: Rect, text: float, graphs: Mapping[int, str], small: Sequence[Small], active: int | None = None
) -> dict[int, Rect]:
    """Return where panels are, by entity; none lies over another unless there is too little room for any.

    Parameters
    ----------
    area : Rect
        What is left for them [px].
    text : float
        Height of the text [px].
    graphs : mapping of int to str
        The graphs, and at which side each is.
    small : sequence of Small
        Meters and sliders; they are put down first.
    active : int, optional
        The graph that is open where there is room for one alone; the last of them by default.
    """
    gap = round(_GAP * text)
    left, top, width, height = area
    inner = (left + gap, top + gap, max(width - 2 * gap, 1), max(height - 2 * gap, 1))
    least = round(_LEAST_GRAPH * text)
    ways = [_small(inner, text, gap, small, downwards=downwards) for downwards in (True, False)]
    rests = [_without(inner, list(way.values()), gap, least) for way in ways]
    found = [_graphs(rest, text, gap, graphs, active) for rest in rests]
    scales = [
        min((_scale(place[2:], text) for place in one.values() if not is_bar(place, text)), default=1.0)
        for one in found
    ]
    best = 1 if scales[1] > scales[0] else 0  # beside each other only where graphs gain by it
    return ways[best] | found[best]


def has_room(area: Rect, text: float) -> bool:
    """Whether panels can be put there at all."""
    return area[2] >= _ROOM[0] * text and area[3] >= _ROOM[1] * text


def bar_at_top(area: Rect, text: float) -> Rect:
    """Return where a bar is that stands for all panels [px]."""
    gap = round(_GAP * text)
    return area[0] + gap, area[1] + gap, max(area[2] - 2 * gap, 1), round(_BAR * text)


def _small(area: Rect, text: float, gap: int, small: Sequence[Small], *, downwards: bool) -> dict[int, Rect]:
    """Put meters and sliders into their corners, above each other or beside each other."""
    found: dict[int, Rect] = {}
    for corner in dict.fromkeys(one.corner for one in small):
        stack = [one for one in small if one.corner == corner]
        room = _beside_numbers(area, text, corner)
        if downwards:
            found |= _stacked(room, gap, stack, corner)
        else:
            below = 0 if "top" in corner else round(_SCALE_BAR * text)
            rows = (area[0], area[1], area[2], max(area[3] - below, 1))
            found |= _in_rows(rows, gap, stack, corner)
    return found


def _graphs(
    rest: Rect, text: float, gap: int, graphs: Mapping[int, str], active: int | None
) -> dict[int, Rect]:
    """Put graphs to their sides in what small panels leave."""
    if rest[3] > 2.0 * _LEAST[1] * text:
        rest = (*rest[:3], rest[3] - round(_SCALE_BAR * text))
    sides = {side: [e for e, where in graphs.items() if where == side] for side in ("left", "right")}
    if len(graphs) > 1 and _too_small(_tile(rest, text, gap, len(graphs))[1], text):
        return _folded(rest, text, gap, list(graphs), active)
    if not all(sides.values()):
        return {e: place for side in sides for e, place in _tiled(rest, text, gap, sides[side], side).items()}
    half = (rest[2] - gap) // 2
    right = (rest[0] + rest[2] - half, rest[1], half, rest[3])
    at_left = _tiled((rest[0], rest[1], half, rest[3]), text, gap, sides["left"], "left")
    return at_left | _tiled(right, text, gap, sides["right"], "right")


def _beside_numbers(area: Rect, text: float, corner: str) -> Rect:
    """Leave room for what is written at the edges of the world, where there is enough."""
    left, top, width, height = area
    if width < _LEAST_GRAPH * text:
        return area
    across = round(_NUMBERS * text) if "left" in corner else 0
    below = 0.0 if "top" in corner else _NUMBERS if "left" in corner else _SCALE_BAR
    return left + across, top, width - across, max(height - round(below * text), 1)


def _stacked(area: Rect, gap: int, stack: Sequence[Small], corner: str) -> dict[int, Rect]:
    """Put small panels above each other from a corner on, and go on beside them where the room ends."""
    left, top, width, height = area
    found: dict[int, Rect] = {}
    down = across = widest = 0
    for one in stack:
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


def _without(area: Rect, taken: Sequence[Rect], gap: int, least: int) -> Rect:
    """Return the part of an area that is left beside small panels if it is wide enough, or the largest."""
    left, top, width, height = area
    if not taken:
        return area
    right, bottom = left + width, top + height
    low_x, high_x = left, right
    low_y, high_y = top, bottom
    for x, y, w, h in taken:
        if x + 0.5 * w < left + 0.5 * width:
            low_x = max(low_x, x + w + gap)
        else:
            high_x = min(high_x, x - gap)
        if y + 0.5 * h < top + 0.5 * height:
            low_y = max(low_y, y + h + gap)
        else:
            high_y = min(high_y, y - gap)
    beside = (low_x, top, max(high_x - low_x, 1), height)
    between = (left, low_y, width, max(high_y - low_y, 1))
    return beside if beside[2] >= least else max(beside, between, key=lambda rect: rect[2] * rect[3])


def _tile(area: Rect, text: float, gap: int, count: int) -> tuple[int, tuple[float, float]]:
    """Return in how many columns graphs are largest, and their width and height [px]."""
    _, _, width, height = area
    largest = (_GRAPH[0] * text, _GRAPH[1] * text)

    def size(columns: int) -> tuple[float, float]:
        rows = max(-(-count // columns), 1)
        w = (width - (columns - 1) * gap) / columns
        h = (height - (rows - 1) * gap) / rows
        return max(min(w, largest[0]), 1.0), max(min(h, largest[1]), 1.0)

    columns = max(range(1, max(count, 1) + 1), key=lambda n: _scale(size(n), text))
    return columns, size(columns)


def _scale(size: tuple[float, float], text: float) -> float:
    """Return how large a graph is, as a share of what it has where there is room."""
    return min(size[0] / (_GRAPH[0] * text), size[1] / (_GRAPH[1] * text))


def _too_small(size: tuple[float, float], text: float) -> bool:
    return size[0] < _LEAST[0] * text or size[1] < _LEAST[1] * text


def _tiled(area: Rect, text: float, gap: int, entities: Sequence[int], side: str) -> dict[int, Rect]:
    """Put graphs below each other, and in as many columns as leaves them largest."""
    left, top, width, _ = area
    columns, (w, h) = _tile(area, text, gap, len(entities))
    rows = -(-len(entities) // columns)
    found: dict[int, Rect] = {}
    for n, entity in enumerate(entities):
        across, down = round(n // rows * (w + gap)), round(n % rows * (h + gap))
        x = left + width - across - round(w) if side == "right" else left + across
        found[entity] = (x, top + down, int(w), int(h))
    return found


def is_bar(rect: Rect, text: float) -> bool:
    """Whether this is the place of the bar by which graphs are opened."""
    return rect[3] <= round(_BAR * text)


def _folded(
    area: Rect, text: float, gap: int, entities: Sequence[int], active: int | None
) -> dict[int, Rect]:
    """Leave one graph open, and for the others a bar above it."""
    left, top, width, height = area
    shown = active if active is not None and active in entities else entities[-1]
    bar, w = round(_BAR * text), min(width, round(_GRAPH[0] * text))
    below = bar + gap // 2
    open_height = max(min(height - below, round(_GRAPH[1] * text)), 1)
    others = dict.fromkeys(entities, (left + width - w, top, w, bar))
    return others | {shown: (left + width - w, top + below, w, open_height)}
