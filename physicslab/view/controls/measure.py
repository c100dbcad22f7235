"""Sizes of what is drawn: as words beside the cursor, and as numbers that are typed in place of a drag."""

import math
import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from physicslab.ecs.quantity_text import InvalidText, evaluate
from physicslab.ecs.vector import Vector2

_TURN = math.pi / 12.0
"""The step of directions while Shift is held [rad]."""
_BETWEEN = re.compile(r"\s*(?:,\s+|;|\bx\b|×)\s*")
"""What stands between two numbers."""


class Measure(NamedTuple):
    """How the second point of what is drawn follows from numbers; a way leads to it from the first [m].

    Attributes
    ----------
    units : tuple of str
        The units of the numbers.
    numbers : callable
        Returns the numbers of a way.
    way : callable
        Returns the way for such numbers; the last argument is the way to the cursor.
    words : callable
        Returns the numbers in words.
    rounded : callable
        Returns the way to draw in place of one, while Shift is held.
    """

    units: tuple[str, ...]
    numbers: Callable[[Vector2], Sequence[float]]
    way: Callable[[Sequence[float], Vector2], Vector2]
    words: Callable[..., str]
    rounded: Callable[[Vector2], Vector2]

    def written(self, text: str, way: Vector2) -> Vector2:
        """Return the way by typed numbers; those that are not typed are the cursor's.

        Raises
        ------
        InvalidText
            If they are no such numbers.
        """
        parts = [part for part in _BETWEEN.split(text.strip())]
        if len(parts) > len(self.units):
            raise InvalidText(f"at most {len(self.units)} numbers")
        numbers = list(self.numbers(way))
        for n, part in enumerate(parts):
            if part:
                numbers[n] = evaluate(part, self.units[n])
        if numbers[0] <= 0.0 or not all(map(math.isfinite, numbers)):
            raise InvalidText("a length is above 0")
        return self.way(numbers, way)

    def said(self, way: Vector2) -> str:
        """Return the numbers of a way in words."""
        return self.words(*self.numbers(way))


def _metres(length: float) -> str:
    return f"{length:.3g} m" if length < 0.1 or length >= 100.0 else f"{length:.2f} m"


def _turned(way: Vector2) -> Vector2:
    return Vector2.from_angle(round(way.angle / _TURN) * _TURN, way.magnitude)


def _square(way: Vector2) -> Vector2:
    side = max(abs(way.x), abs(way.y))
    return Vector2(math.copysign(side, way.x), math.copysign(side, way.y))


def _sides(numbers: Sequence[float], way: Vector2) -> Vector2:
    return Vector2(math.copysign(numbers[0], way.x), math.copysign(numbers[1], way.y))


def _polar(down: float) -> Measure:
    """Return a length and an angle from a direction [rad], counter-clockwise."""
    return Measure(
        ("m", "deg"),
        lambda way: (way.magnitude, math.degrees(math.remainder(way.angle - down, 2.0 * math.pi))),
        lambda numbers, way: Vector2.from_angle(down + math.radians(numbers[1]), numbers[0]),
        lambda length, angle: f"{_metres(length)}, {angle:.1f}°",
        _turned,
    )


LENGTH = _polar(0.0)
"""A length, and an angle from the right."""
HANGING = _polar(-0.5 * math.pi)
"""A length, and an angle from straight down."""
RADIUS = Measure(
    ("m",),
    lambda way: (way.magnitude,),
    lambda numbers, way: (way.normalized if way else Vector2(1.0, 0.0)) * numbers[0],
    lambda radius: f"radius {_metres(radius)}",
    lambda way: way,
)
CORNERS = Measure(
    ("m", "m"),
    lambda way: (abs(way.x), abs(way.y)),
    _sides,
    lambda width, height: f"{_metres(width)} × {_metres(height)}",
    _square,
)
"""From corner to corner."""
