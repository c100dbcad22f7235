"""How the fields of a component are made, read and written."""

from collections.abc import Callable, Sequence
from typing import Any

from numpy.typing import NDArray

from physicslab.ecs.fields import POINTS, REQUIRED, Field, Kind
from physicslab.ecs.text import text_of
from physicslab.ecs.vector import Vector2

type Maker = Callable[[object], list[list[Any]]]
"""Converts a value to the form that a detached component holds: a list for each column."""
ABSENT: Any = object()
"""Marks a value that was not given."""


class _Described[Read, Given]:
    """The type of a field for type checkers: what reading it yields, and what it takes."""

    def __get__(self, handle: object, owner: type | None = None) -> Read:
        """Return the value in the handle's row."""
        raise NotImplementedError  # the decorator puts a property in this place

    def __set__(self, handle: object, value: Given) -> None:
        """Store a value in the handle's row."""
        raise NotImplementedError


class Vector(_Described[Vector2, Vector2 | Sequence[float | str] | NDArray[Any] | str]):
    """The type of a vector field: reads as :class:`Vector2`, takes any pair of numbers."""


class Number(_Described[float, float | str]):
    """The type of a number: reads as ``float``, takes a text with a unit as well."""


class Entity(_Described[int | None, int | str | None]):
    """The type of a field that refers to an entity: reads as its number, takes its id as well.

    It is an id until a world spawns the component, which then must have an entity of that id.
    """


class Derived(_Described[float, float | str | None]):
    """The type of a number that the world computes where it is ``None``: reads as ``float``, takes both.

    It reads as 0 while it is not given and no world has computed it.
    """


class Points(_Described[tuple[Vector2, ...], Sequence[Vector2 | Sequence[float]] | NDArray[Any]]):
    """The type of a list of points: reads as a tuple of :class:`Vector2`, takes any pairs of numbers."""


def maker(spec: Field) -> Maker:
    """Return the conversion of a value to the form of a detached component: a list for each column."""
    check, low, high, default = spec.check, spec.lowest, spec.highest, spec.default

    def converted(value: object) -> object:
        if value is not ABSENT:
            return value
        if default is REQUIRED:
            raise TypeError(f"{spec.owner} needs {spec.name}: {spec.allowed}")
        return default

    def number(value: object) -> list[list[Any]]:
        if type(value) is float and low <= value <= high:
            return [[value]]
        return [[check(converted(value))]]

    def vector(value: object) -> list[list[Any]]:
        return [list(check(converted(value)))]

    def derived(value: object) -> list[list[Any]]:
        value = converted(value)
        return [[0.0], [False]] if value is None else [[check(value)], [True]]

    def entity(value: object) -> list[list[Any]]:
        return [[value]] if isinstance(value, str) else other(value)

    def other(value: object) -> list[list[Any]]:
        return [[check(converted(value))]]

    makers: dict[Kind, Maker] = {"number": number, "vector": vector, "entity": entity}
    return derived if spec.derived else makers.get(spec.kind, other)


def accessor(spec: Field, column: int, *, validated: bool) -> property:
    """Make the property that reads and writes one field of a handle's row."""
    check, low, high = spec.check, spec.lowest, spec.highest
    reads: dict[Kind, Callable[[Any], Any]] = {
        "number": lambda self: self._views[column][self._row],
        "whole": lambda self: self._views[column][self._row],
        "flag": lambda self: self._views[column][self._row],
        "entity": lambda self: self._views[column][self._row] or None,
        "choice": lambda self: spec.choices[self._views[column][self._row] - 1],
        "text": lambda self: text_of(self._views[column][self._row]),
        "points": lambda self: POINTS.value_of(self._views[column][self._row]),
    }

    def read_vector(self: Any) -> Vector2:
        view, i = self._views[column], 2 * self._row
        return Vector2(view[i], view[i + 1])

    def write(self: Any, value: object) -> None:
        self._views[column][self._row] = check(value)

    def write_number(self: Any, value: object) -> None:
        in_range = type(value) is float and low <= value <= high
        self._views[column][self._row] = value if in_range else check(value)

    def write_vector(self: Any, value: object) -> None:
        view, i = self._views[column], 2 * self._row
        view[i], view[i + 1] = check(value)

    def write_derived(self: Any, value: object) -> None:
        if value is not None:
            self._views[column][self._row] = check(value)
        self._views[column + 1][self._row] = value is not None

    writes: dict[Kind, Callable[[Any, object], None]] = {"number": write_number, "vector": write_vector}
    write_field = write_derived if spec.derived else writes.get(spec.kind, write)

    def write_validated(self: Any, value: object) -> None:
        type(self)(**{**self.given(), spec.name: value})  # raises where the values are inconsistent
        write_field(self, value)

    def refuse(self: Any, value: object) -> None:
        raise AttributeError(f"{spec.owner}.{spec.name} is fixed when the component is made; add a new one")

    unit = "" if spec.unit == "1" else f" [{spec.unit}]"
    return property(
        reads.get(spec.kind, read_vector),
        refuse if spec.fixed else write_validated if validated else write_field,
        doc=f"{spec.meaning}{unit}",
    )
