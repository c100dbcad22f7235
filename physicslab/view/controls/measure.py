"""Sizes of what is drawn: as words beside the cursor, and as numbers that are typed in place of a drag."""

import contextlib
import math
import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from physicslab.ecs.quantity_text import InvalidText, evaluate
from physicslab.ecs.vector import Vector2
from physicslab.view.window.copying import MOST

_TURN = math.pi / 12.0
"""The step of directions while Shift is held [rad]."""
_BETWEEN = re.compile(r"\s*(?:,\s+|;|\bx\b|×)\s*")
"""Separators of two numbers."""


_OF_BODY = ("kg", "m/s")
"""The units of what can be typed of a body beside its size."""


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
    beside : tuple of str
        The units of what can be typed beside these numbers.
    """

    units: tuple[str, ...]
    numbers: Callable[[Vector2], Sequence[float]]
    way: Callable[[Sequence[float], Vector2], Vector2]
    words: Callable[..., str]
    rounded: Callable[[Vector2], Vector2]
    beside: tuple[str, ...] = _OF_BODY

    def written(self, text: str, way: Vector2) -> Vector2:
        """Return the way by typed numbers; those that are not typed are the cursor's.

        Raises
        ------
        InvalidText
            If they are no such numbers.
        """
        parts = self.sizes(text)
        if len(parts) > len(self.units):
            raise InvalidText(f"it takes {len(self.units)} number{'s' * (len(self.units) > 1)} at most")
        numbers = list(self.numbers(way))
        place = 0
        for part in parts:
            if part:
                place, numbers[place] = self._placed(part, place)
            place += 1
        if numbers[0] <= 0.0 or not all(map(math.isfinite, numbers)):
            raise InvalidText("a length is above 0")
        if "1" in self.units and math.prod(numbers) > MOST:
            raise InvalidText(f"at most {MOST:,} in all")
        return self.way(numbers, way)

    def sizes(self, text: str) -> list[str]:
        """Return the texts between separators but for what is no size, and empty ones at the end."""
        parts = [part for part in _BETWEEN.split(text) if _of_body(part, self.units, self.beside) is None]
        while parts and not parts[-1].strip():
            del parts[-1]
        return parts

    def _placed(self, part: str, first: int) -> tuple[int, float]:
        """Return which number a text is, and its value: by its unit, the angle may be typed alone.

        Raises
        ------
        InvalidText
            If it is none from the ``first`` on: what it is not as that one.
        """
        for place in range(first, len(self.units)):
            with contextlib.suppress(InvalidText):
                return place, evaluate(part, self.units[place])
        if first == len(self.units):
            raise InvalidText("numbers stand in this order: " + ", ".join(self.units))
        return first, evaluate(part, self.units[first])

    def refusal(self, text: str, way: Vector2) -> str:
        """Return why no way is written with typed numbers; empty where one is, or nothing is typed."""
        try:
            if text:
                self.written(text, way)
        except InvalidText as error:
            return str(error)
        return ""

    def given(self, text: str) -> dict[str, float]:
        """Return the mass [kg], speed [m/s] and angle [deg] among typed numbers: no sizes, by their units."""
        found = (_of_body(part, self.units, self.beside) for part in _BETWEEN.split(text.strip()))
        return dict(one for one in found if one is not None)

    def said(self, way: Vector2) -> str:
        """Return the numbers of a way in words."""
        return self.words(*self.numbers(way))


def motion_of(text: str) -> dict[str, float]:
    """Return the speed [m/s], the direction [deg] and the mass [kg] that are typed of a body, in this order.

    >>> motion_of("2; 30"), motion_of("500 g, 36 km/h")
    ({'m/s': 2.0, 'deg': 30.0}, {'kg': 0.5, 'm/s': 10.0})

    Raises
    ------
    InvalidText
        If a part is neither a speed, a direction nor a mass, or there are two of a kind.
    """
    found: dict[str, float] = {}
    for part in _BETWEEN.split(text.strip()):
        for unit in ("m/s", "deg", "kg"):
            with contextlib.suppress(InvalidText):
                if unit not in found:
                    found[unit] = evaluate(part, unit)
                    break
        else:
            raise InvalidText("a speed, a direction, a mass: 2 m/s, 30 deg, 3 kg")
    return found


def _of_body(text: str, units: Sequence[str], beside: Sequence[str]) -> tuple[str, float] | None:
    """Return the property that a number is of by its unit; ``None`` for a size, or one half written."""
    for unit in (*units, *beside):
        with contextlib.suppress(InvalidText):
            value = evaluate(text, unit)
            return None if unit in units else (unit, value)
    return None


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
    (*_OF_BODY, "deg"),
)
"""From corner to corner; an angle turns what is between them."""

BRICK, DOMINO_SPACING = (0.4, 0.2), 0.25
"""Width and height of a brick, and the distance of dominoes [m]."""


def _bricks(way: Vector2) -> Sequence[float]:
    return tuple(max(round(abs(part) / size), 1) for part, size in zip(way, BRICK, strict=True))


WALL = Measure(
    ("1", "1"),
    _bricks,
    lambda numbers, way: _sides([round(n) * size for n, size in zip(numbers, BRICK, strict=True)], way),
    lambda columns, rows: f"{columns:.0f} × {rows:.0f} bricks",
    lambda way: way,
)
"""So many bricks beside and above each other."""
DOMINOES = Measure(
    ("1",),
    lambda way: (round(way.magnitude / DOMINO_SPACING) + 1,),
    lambda numbers, way: (
        (way.normalized if way else Vector2(1.0, 0.0)) * (max(round(numbers[0]) - 1, 0) * DOMINO_SPACING)
    ),
    lambda count: f"{count:.0f} dominoes",
    _turned,
)
"""So many in a row."""
