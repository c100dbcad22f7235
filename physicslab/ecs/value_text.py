"""Values of fields as people write them: numbers, pairs and lists of points, with units."""

import re
from collections.abc import Iterable
from typing import Any

from physicslab.ecs.quantity_text import InvalidText, evaluate, shown_in
from physicslab.ecs.vector import Vector2

_ROW = re.compile(r"\s*\[(?P<parts>[^][]*)\](?P<unit>[^][]*)")
_ROWS = {"vector": (2, "pair"), "box": (4, "row of four numbers")}
"""Kinds of fields that are rows of numbers: how many, and what that is called."""
_POINTS = re.compile(r"\s*\[(?P<points>\s*(?:\[[^][]*\]\s*,?\s*)*)\](?P<unit>[^][]*)")


def _evaluate_row(text: str, unit: str, count: int, noun: str) -> tuple[float, ...]:
    """Return so many numbers in an SI unit; a unit behind the brackets is that of all."""
    if (row := _ROW.fullmatch(text)) is None or row["parts"].count(",") != count - 1:
        raise InvalidText(f"'{shown_in(text)}' is no {noun}")
    own = row["unit"].strip()
    return tuple(evaluate(f"({one.strip()}) {own}" if own else one, unit) for one in row["parts"].split(","))


def evaluate_points(text: str, unit: str = "1") -> list[tuple[float, float]]:
    """Return a list of pairs of numbers in an SI unit; a unit behind the brackets is that of all.

    >>> evaluate_points("[[0, 0], [3, 0], [0, 1/2]] cm", "m")
    [(0.0, 0.0), (0.03, 0.0), (0.0, 0.005)]
    """
    points = _POINTS.fullmatch(text)
    if points is None:
        raise InvalidText(f"'{shown_in(text)}' is no list of points [[x, y], ...]")
    own = points["unit"]
    found = re.findall(r"\[[^][]*\]", points["points"])
    return [(x, y) for x, y in (_evaluate_row(one + own, unit, *_ROWS["vector"]) for one in found)]


def is_written(value: object) -> bool:
    """Whether a value is a text, or a list or tuple with one in it."""
    parts = value if isinstance(value, list | tuple) else (value,)
    return any(isinstance(part, str) for part in parts)


def evaluate_as(kind: str, value: Any, unit: str = "1") -> Any:
    """Return what is written as a kind of field takes it, in an SI unit.

    Parameters
    ----------
    kind : str
        ``"number"``, ``"whole"``, ``"vector"``, ``"points"`` or ``"box"``, four numbers.
    value : str, number or sequence
        What :func:`evaluate` and :func:`evaluate_points` take, or a row in brackets; a list of texts and
        numbers too.
    unit : str
        Unit of a number that has none of its own.

    Raises
    ------
    InvalidText
        If it cannot be read, or has another dimension.

    Examples
    --------
    >>> evaluate_as("vector", ("20 cm", 1), "m"), evaluate_as("whole", "2*8")
    ((0.2, 1), 16)
    >>> evaluate_as("vector", "[1 + 1, 3] cm", "m"), evaluate_as("vector", "[20 mm, 0.5]", "m")
    ((0.02, 0.03), (0.02, 0.5))
    """
    if kind == "points":
        return evaluate_points(value, unit) if isinstance(value, str) else value
    if kind in _ROWS:
        if isinstance(value, str):
            return _evaluate_row(value, unit, *_ROWS[kind])
        return tuple(evaluate(part, unit) if isinstance(part, str) else part for part in value)
    number = evaluate(value, unit) if isinstance(value, str) else value
    return int(number) if kind == "whole" and isinstance(number, float) and number.is_integer() else number


def points_text(points: Iterable[Vector2]) -> str:
    """Return points as :func:`evaluate_points` takes them, to all figures.

    >>> points_text([Vector2(0.5, -1.0), Vector2(0.1, 2.0)])
    '[[0.5, -1], [0.1, 2]]'
    """
    return repr([[int(x) if x == round(x) and abs(x) < 1e15 else x for x in point] for point in points])
