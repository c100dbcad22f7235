"""Along the edges of the picture: the scale bar, coordinates, and where bodies out of sight are."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.state.shapes import lengths_of
from physicslab.view.canvas.camera import Camera, Drawing
from physicslab.view.canvas.canvas import Canvas, Rect, TextStyle, overlap
from physicslab.view.canvas.quantities import coordinate, round_quantity
from physicslab.view.picture.backdrop import grid_spacing
from physicslab.world import World


def draw_scale_bar(on: Drawing, right: int, bottom: int) -> Rect:
    """Draw a bar as long as a square of the grid is wide, in a corner at the right, and return where [px].

    Parameters
    ----------
    right : int
        Where the corner is [px from the left].
    bottom : int
        Where it ends [px from the top].
    """
    length = grid_spacing(on.camera.scale)
    bar = length * on.camera.scale
    style = TextStyle(on.size, on.theme.text)
    words = round_quantity(length, "m")
    width = on.canvas.text_size(words, style)[0]
    pad, tick = round(0.7 * on.size), 4.0
    panel_width = round(max(bar, width)) + 2 * pad
    panel_height = on.canvas.text_size(words, style)[1] + on.size + round(0.7 * on.size) // 2
    left, top = right - round(0.8 * on.size) - panel_width, bottom - panel_height
    rect = (left, top, panel_width, panel_height)
    on.canvas.panel(rect, on.theme.panel, on.theme.outline, on.theme.panel_opacity)
    middle = left + panel_width // 2
    on.canvas.text(words, (middle, top + pad // 3), style, "centre")
    y = float(bottom - pad)
    start, end = middle - 0.5 * bar, middle + 0.5 * bar
    on.canvas.lines(
        np.array([(start, y), (start, y - tick), (end, y - tick)]),
        np.array([(end, y), (start, y + tick), (end, y + tick)]),
        on.theme.text, 2.0,
    )  # fmt: skip
    return rect


_EVERY = 2
"""One in so many lines of the grid has its number."""
_MAX_LINES = 400
"""In a picture with more lines than that, which would be a speck, none has."""


def _number_style(on: Drawing) -> TextStyle:
    return TextStyle(max(on.size - 3, 9), on.theme.coordinate)


def axis_numbers_height(on: Drawing) -> int:
    """Return how high the coordinates at the lower edge of a room are [px]."""
    return on.canvas.text_size("0", _number_style(on))[1] + 2


def draw_axis_numbers(on: Drawing, room: Rect, right: int, taken: Sequence[Rect]) -> list[Rect]:
    """Write the coordinates [m] of lines of the grid at the lower and the left edge of a room [px].

    Those at the lower edge end before ``right`` [px], where the scale bar begins; none is partly under what
    is ``taken``. Return where each is [px].
    """
    left, top, width, height = room
    step = _EVERY * grid_spacing(on.camera.scale)
    low, high = on.camera.to_world((left, top + height)), on.camera.to_world((left + width, top))
    style = _number_style(on)
    text_height = on.canvas.text_size("0", style)[1]
    written: list[Rect] = []

    def write(words: str, x: int, y: int) -> None:
        extent = on.canvas.text_size(words, style)
        if not any(overlap(one, (x, y, *extent)) for one in taken):
            on.canvas.text(words, (x, y), style)
            written.append((x, y, *extent))

    for x in _multiples(low.x, high.x, step):
        place = round(on.camera.to_screen(Vector2(x, on.camera.centre.y))[0])
        words = coordinate(x, step)
        if left + on.size < place and place + on.canvas.text_size(words, style)[0] + on.size // 2 < right:
            write(words, place + 3, top + height - text_height - 2)
    for y in _multiples(low.y, high.y, step):
        place = round(on.camera.to_screen(Vector2(on.camera.centre.x, y))[1])
        if top + 2 * text_height < place < top + height - 2 * text_height:
            write(coordinate(y, step), left + 4, place - text_height - 1)
    return written


def _multiples(low: float, high: float, step: float) -> list[float]:
    first, last = math.ceil(low / step), math.floor(high / step)
    return [] if last - first > _MAX_LINES else (step * np.arange(first, last + 1)).tolist()


# ---- bodies out of sight: none that was thrown away is lost silently ---------------------------------------


_SIDES: tuple[tuple[int, int], ...] = ((-1, 0), (1, 0), (0, -1), (0, 1))
"""Left, right, up and down on the screen."""
_STEP = 4
"""How far an arrow makes way at a time [px]."""
_GAP = 3
"""How far it stays from what is in its way [px]."""


def draw_edge_arrows(world: World, on: Drawing, room: Rect, taken: Sequence[Rect]) -> None:
    """Draw an arrow at each edge of a room beyond which there are moving bodies, with their number.

    Parameters
    ----------
    room : Rect
        Where the world can be seen: no panel lies over it [px].
    taken : sequence of Rect
        Rectangles that the arrows keep clear of [px].
    """
    places = _out_of_sight(world, on.camera, room)
    half = 0.5 * np.array(room[2:])
    middle = np.array(room[:2]) + half
    # The side is that on which the way from the middle of the room to the body leaves it.
    offset = (places - middle) / half
    level = np.abs(offset[:, 0]) >= np.abs(offset[:, 1])
    obstacles = list(taken)
    for side in _SIDES:
        here = (level == (side[0] != 0)) & (offset @ np.array(side, np.float64) > 0.0)
        count = int(here.sum())
        if count:
            aim = middle + _mean_way(places[here] - middle)
            style = TextStyle(on.size, on.theme.accent, bold=True)
            rect = _free_place(_at_edge(aim, room, f"{count}", style, on.canvas), side, obstacles, room)
            if rect is not None:
                obstacles.append(rect)
                _draw_arrow(rect, aim, f"{count}", style, on)


def _out_of_sight(world: World, camera: Camera, room: Rect) -> NDArray[np.float64]:
    """Return where on the plane of the screen moving bodies are (n, 2) [px] that no part of a room shows."""
    rows = world.batch(Transform, Velocity).rows
    place = camera.project(world.table(Transform)["position"][rows])
    across, down = place[:, 0], place[:, 1]
    low, high = np.array(room[:2]), np.array(room[:2]) + room[2:]
    # Most bodies are in sight as a rule, by their middle alone: only the others are looked at closely.
    beyond = np.flatnonzero((across < low[0]) | (across > high[0]) | (down < low[1]) | (down > high[1]))
    place, margin = place[beyond], _reach(world, camera, rows[beyond])
    out = ((place < low - margin) | (place > high + margin)).any(axis=1)
    found: NDArray[np.float64] = place[out & np.isfinite(place).all(axis=1)]
    return found


def count_under(world: World, camera: Camera, rect: Rect) -> int:
    """Return how many moving bodies a rectangle [px] lies over, by the discs around them."""
    rows = world.batch(Transform, Velocity).rows
    place = camera.project(world.table(Transform)["position"][rows])
    low, high = np.array(rect[:2]), np.array(rect[:2]) + rect[2:]
    margin = _reach(world, camera, rows)
    return int(((place > low - margin) & (place < high + margin)).all(axis=1).sum())


def _reach(world: World, camera: Camera, rows: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return how far bodies reach from their middles (n, 1) [px]."""
    half, radius = lengths_of(world.table(Shape), rows)
    reach: NDArray[np.float64] = radius + np.hypot(half[:, 0], half[:, 1])
    return (reach * camera.scale)[:, None]


def _mean_way(offsets: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the mean of the directions (n, 2), a long way off: one that is far off counts no more."""
    way: NDArray[np.float64] = (offsets / np.hypot(offsets[:, 0], offsets[:, 1])[:, None]).mean(axis=0)
    return way * 1e5


def _at_edge(aim: NDArray[np.float64], room: Rect, words: str, style: TextStyle, canvas: Canvas) -> Rect:
    """Return the rectangle of an arrow at the edge, where the way from the middle to ``aim`` crosses it."""
    text_width, text_height = canvas.text_size(words, style)
    size = style.size
    width, height, margin = text_width + 3 * size, text_height + size // 2, size // 2
    corner, half = np.array(room[:2]), 0.5 * np.array(room[2:])
    way = aim - corner - half
    crossing = half + way * float(np.min(half / np.maximum(np.abs(way), 1e-9)))
    left = min(max(round(crossing[0]) - width // 2, margin), room[2] - width - margin)
    top = min(max(round(crossing[1]) - height // 2, margin), room[3] - height - margin)
    return room[0] + left, room[1] + top, width, height


def _free_place(rect: Rect, side: tuple[int, int], obstacles: Sequence[Rect], room: Rect) -> Rect | None:
    """Move a rectangle away from the edge until nothing is in its way; ``None`` if there is no room."""
    left, top, width, height = rect
    right, bottom = room[0] + room[2], room[1] + room[3]
    while left >= room[0] and top >= room[1] and left + width <= right and top + height <= bottom:
        around = left - _GAP, top - _GAP, width + 2 * _GAP, height + 2 * _GAP
        if not any(overlap(around, obstacle) for obstacle in obstacles):
            return left, top, width, height
        left, top = left - _STEP * side[0], top - _STEP * side[1]
    return None


def _draw_arrow(rect: Rect, aim: NDArray[np.float64], words: str, style: TextStyle, on: Drawing) -> None:
    size = style.size
    left, top, width, height = rect
    on.canvas.panel(rect, on.theme.panel, on.theme.accent, 0.95)
    text_width, text_height = on.canvas.text_size(words, style)
    on.canvas.text(words, (left + width - size - text_width, top + (height - text_height) // 2), style)
    centre = np.array([left + 1.1 * size, top + 0.5 * height])
    angle = math.atan2(aim[1] - centre[1], aim[0] - centre[0])
    reach = 0.5 * size
    tip, tail = (centre + sign * reach * np.array([math.cos(angle), math.sin(angle)]) for sign in (1, -1))
    barbs = [
        tip - 0.8 * reach * np.array([math.cos(angle + turn), math.sin(angle + turn)]) for turn in (0.6, -0.6)
    ]
    on.canvas.lines(np.array([tail, tip, tip]), np.array([tip, *barbs]), on.theme.accent, 2.0)
