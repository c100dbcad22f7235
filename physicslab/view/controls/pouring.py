"""Discs that are poured while the button is held."""

import contextlib
import heapq
import math
from collections.abc import Sequence

from physicslab.ecs.quantity_text import InvalidText, evaluate
from physicslab.ecs.vector import Vector2
from physicslab.state.solid import solid_rows
from physicslab.view.window.copying import MOST
from physicslab.view.window.placing import outlines_of
from physicslab.view.window.window import Window
from physicslab.world import World

_RATE = 150.0
"""Discs that are poured a second."""
_APART, _ROW = 2.05, math.sqrt(0.75)
"""The distance of discs that are poured, in radii, and of their rows, in such distances."""


def _typed_count(window: Window) -> int | None:
    """Return how many are wanted, if a number was typed."""
    with contextlib.suppress(InvalidText):
        return min(max(round(evaluate(window.sketch.typed)), 1), MOST) if window.sketch.typed else None
    return None


def pour(world: World, window: Window, elapsed: float) -> None:
    """Let more be poured in an elapsed time [s]; where a number was typed, so many at once."""
    more = max(round(_RATE * elapsed), 1) if elapsed else 0
    wanted = _typed_count(window) or min(max(len(window.sketch.stroke) + more, 1), MOST)
    window.sketch.stroke = _poured(world, window, wanted)


def _poured(world: World, window: Window, wanted: int) -> list[Vector2]:
    """Return so many places of discs [m]: those so far, and more around the cursor.

    They lie on a hexagonal lattice, the nearest to the cursor first, where nothing is yet and within the
    walls. There are fewer where what surrounds the cursor is full.
    """
    sketch, radius, cursor = window.sketch, window.recipe.grain, window.place
    found = list(sketch.stroke[:wanted])
    origin, step = sketch.grips[0].anchor, _APART * radius
    taken = {_cell(place, origin, step) for place in found}
    solid, bounds = outlines_of(world, solid_rows(world)), world.physics.bounds
    begin = _cell(cursor, origin, step)
    front, seen = [(0.0, begin)], {begin}
    while front and len(found) < wanted:
        _, cell = heapq.heappop(front)
        place = _at_cell(cell, origin, step)
        if cell not in taken:
            if len(solid.place) and float(solid.gaps(place.x, place.y).min()) < radius:
                continue
            if bounds is not None and _to_walls(place, bounds) < radius:
                continue
            found.append(place)
        row, column = cell
        for other in (
            (row, -1),
            (row, 1),
            *((row + up, row % 2 - left) for up in (-1, 1) for left in (0, 1)),
        ):
            beside = other[0], column + other[1]
            if beside not in seen:
                seen.add(beside)
                heapq.heappush(front, ((_at_cell(beside, origin, step) - cursor).magnitude, beside))
    return found


def _to_walls(place: Vector2, bounds: Sequence[float]) -> float:
    left, bottom, right, top = bounds
    return min(place.x - left, right - place.x, place.y - bottom, top - place.y)


def _at_cell(cell: tuple[int, int], origin: Vector2, step: float) -> Vector2:
    row, column = cell
    return origin + Vector2((column + 0.5 * (row % 2)) * step, row * step * _ROW)


def _cell(place: Vector2, origin: Vector2, step: float) -> tuple[int, int]:
    """Return the row and the column of the lattice that a place has."""
    row = round((place.y - origin.y) / (step * _ROW))
    return row, round((place.x - origin.x) / step - 0.5 * (row % 2))
