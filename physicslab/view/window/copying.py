"""Copies of bodies in a row, in a grid or around a circle: how many, and how far from each other."""

import math
from dataclasses import dataclass
from itertools import product
from typing import ClassVar

from physicslab.ecs.fields import LENGTH_LIMIT, Field
from physicslab.ecs.vector import Vector2

ROW, GRID, CIRCLE = WAYS = ("in a row", "in a grid", "around a circle")
MOST = 2_000
"""How many bodies are made at once at most."""


@dataclass(frozen=True, slots=True)
class Copying:
    """Which copies are to be made.

    Attributes
    ----------
    way : str
        One of ``WAYS``.
    count, rows : int
        How many there are beside each other, or around the circle, and above each other; with the original.
    distance, upward : float
        From one to the next, beside and above each other [m].
    direction : float
        Direction of a row, from the right [deg].
    radius : float
        Radius of the circle, of which the original is at the right [m].
    """

    way: str = ROW
    count: int = 5
    rows: int = 3
    distance: float = 1.0
    upward: float = 1.0
    direction: float = 0.0
    radius: float = 2.0

    OF: ClassVar[dict[str, tuple[str, ...]]] = {
        ROW: ("count", "distance", "direction"),
        GRID: ("count", "rows", "distance", "upward"),
        CIRCLE: ("count", "radius"),
    }
    FIELDS: ClassVar[dict[str, Field]] = {
        spec.name: spec
        for spec in (
            Field("count", "whole", minimum=1, maximum=MOST, meaning="how many, with the one there is"),
            Field("rows", "whole", minimum=1, maximum=MOST, meaning="how many above each other"),
            Field("distance", "number", unit="m", limit=LENGTH_LIMIT, meaning="from one to the next"),
            Field("upward", "number", unit="m", limit=LENGTH_LIMIT, meaning="from one row to the next"),
            Field("direction", "number", unit="deg", meaning="counter-clockwise from the right"),
            Field("radius", "number", unit="m", above=0.0, limit=LENGTH_LIMIT, meaning="of the circle"),
        )
    }

    @property
    def offsets(self) -> list[Vector2]:
        """Where the copies are, from the original [m]."""
        if self.way == ROW:
            step = Vector2.from_angle(math.radians(self.direction), self.distance)
            return [step * n for n in range(1, self.count)]
        if self.way == GRID:
            cells = list(product(range(min(self.rows, MOST // self.count)), range(self.count)))[1:]
            return [Vector2(column * self.distance, row * self.upward) for row, column in cells]
        turn = 2.0 * math.pi / self.count
        return [
            Vector2.from_angle(n * turn, self.radius) - Vector2(self.radius, 0.0)
            for n in range(1, self.count)
        ]
