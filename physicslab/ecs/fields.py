"""The description of one value: its type, unit, range and meaning, by which it is checked."""

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from numbers import Integral, Real
from typing import Any, Concatenate, Literal

import numpy as np

from physicslab.ecs.interned import Interned
from physicslab.ecs.quantity_text import InvalidText
from physicslab.ecs.text import code_of, has_width, is_line
from physicslab.ecs.value_text import evaluate_as, is_written
from physicslab.ecs.vector import Vector2

Kind = Literal["number", "whole", "vector", "flag", "entity", "choice", "text", "points", "box"]

_SHOWN_LIMIT = 100
"""Characters of a value that a message shows."""
_LISTED = 30
"""Choices that a message lists."""
COORDINATE_LIMIT = 1e300
"""The largest coordinate [m]: the difference of two is finite, and the product of one with a usual number."""
LENGTH_LIMIT = 1e150
"""The largest extent, arm or length of a spring [m]: the squares of two can be added."""
_TINY = 1e-200
"""A least number below this is said to be any above 0; a message to one that is still smaller names it."""
_FINITE_LIMIT = float(np.finfo(np.float64).max)
TEXT_LIMIT = 200
"""Characters of a text whose field gives no ``limit`` of its own."""
POINTS: Interned[tuple[Vector2, ...]] = Interned(())
"""The lists of points in columns."""
REQUIRED: Any = object()
"""The default of a field that has none."""
MEASURED: frozenset[Kind] = frozenset({"number", "vector", "points"})
"""Kinds of fields that may be given as texts with units, as ``"2 kg"``, but in files. Counts have none."""


class InvalidValue(ValueError):
    """A component or a configuration was given a value that it cannot hold.

    Attributes
    ----------
    component, field : str
        Where the value was going.
    value : object
        The value given.
    allowed : str
        The allowed values, in words.
    """

    def __init__(self, component: str, field: str, value: object, allowed: str) -> None:
        self.component, self.field, self.value, self.allowed = component, field, value, allowed
        try:
            shown = repr(value)
        except (ValueError, RecursionError):  # an integer of thousands of digits, or recursive lists
            shown = f"<{type(value).__name__}>"
        if len(shown) > _SHOWN_LIMIT:
            shown = f"{shown[: _SHOWN_LIMIT - 3]}..."
        super().__init__(f"{component}.{field} = {shown}: must be {allowed}")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.component, self.field, self.value, self.allowed)


@dataclass(frozen=True, slots=True)
class Field:
    """The description of one field: its type, unit, range and meaning.

    The inspector, the scene file and every check are made from this record.

    Attributes
    ----------
    name, kind : str
        Its name, and the sort of value that it holds.
    default : object
        The value where none is given.
    unit, meaning : str
        SI unit ("1" for a pure number) and one line on what the number is.
    minimum, maximum, above : float
        Inclusive bounds, and an exclusive lower one.
    limit : float
        How large a number, or each part of a vector, the engine can hold; how many characters a text may
        have, ``TEXT_LIMIT`` where it is infinite.
    choices : tuple of str
        The words that a choice field takes, and those that a flag takes beside true and false.
    derived : str
        Where the value comes from when it is ``None`` ("from the Shape").
    fixed : bool
        Whether the field cannot change once the component is made.
    owner : str
        The component or section that has the field.
    lines : int
        How many lines a text may have.
    lowest, highest : float
        The smallest and the largest finite number in its range.
    """

    name: str
    kind: Kind
    default: Any = REQUIRED
    unit: str = "1"
    meaning: str = ""
    minimum: float = -math.inf
    maximum: float = math.inf
    above: float = -math.inf
    choices: tuple[str, ...] = ()
    derived: str = ""
    fixed: bool = False
    owner: str = ""
    limit: float = math.inf
    lines: int = 1
    lowest: float = dataclasses.field(init=False, repr=False, compare=False)
    highest: float = dataclasses.field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        lowest = max(self.minimum, math.nextafter(self.above, math.inf), -_FINITE_LIMIT)
        object.__setattr__(self, "lowest", lowest)
        object.__setattr__(self, "highest", min(self.maximum, self.limit, _FINITE_LIMIT))

    @property
    def allowed(self) -> str:
        """The allowed values, in words."""
        unit = f" {self.unit}" if self.unit not in ("", "1") else ""
        match self.kind:
            case "choice":
                more = len(self.choices) - _LISTED
                words = ", ".join(f'"{choice}"' for choice in self.choices[:_LISTED])
                return f"one of {words}" + (f", or of {more} more" if more > 0 else "")
            case "flag":
                return "".join(f'"{choice}", ' for choice in self.choices) + "true or false"
            case "entity":
                return "an entity or null"
            case "text":
                where = "on one line" if self.lines == 1 else f"of at most {self.lines} lines"
                return f"a text {where}, at most {self.longest} characters, that can be seen, or empty"
            case "vector":
                each = f", at most {self.limit:g} each" if self.limit < math.inf else ""
                return f"two finite numbers [x, y]{unit}{each}"
            case "points":
                return f"a list of points [x, y]{unit} of finite numbers, at most {self.limit:g} each"
            case "box":
                return (
                    f"null or four finite numbers [xmin, ymin, xmax, ymax]{unit} with xmin < xmax and "
                    f"ymin < ymax, at most {self.limit:g} each"
                )
        words = "a whole number" if self.kind == "whole" else "a finite number"
        if self.above > -math.inf:
            words += f" > {self.above:g}"
        if self.minimum > -math.inf and self.maximum < math.inf:
            words = f"{words} from {self.minimum:g} to {self.maximum:g}"
        elif 0.0 < self.minimum < _TINY:
            words += " > 0"
        elif self.minimum > -math.inf:
            words += f" >= {self.minimum:g}"
        elif self.maximum < math.inf:
            words += f" <= {self.maximum:g}"
        upper = f", at most {self.limit:g}" if self.limit < math.inf else ""
        return words + unit + upper + (" or null" if self.derived else "")

    @property
    def longest(self) -> int:
        """How many characters a text may have."""
        return int(self.limit) if self.limit < math.inf else TEXT_LIMIT

    def check(self, value: object) -> Any:
        """Return ``value`` as a column stores it, or raise :class:`InvalidValue`.

        Vectors come back as a pair of floats, choices as their code (1, 2, ...), no entity as 0,
        texts and lists of points as their codes (:mod:`physicslab.ecs.interned`). Numbers may be texts with
        units, as ``"30 deg"``.
        """
        convert, why, written = _CONVERSIONS[self.kind], "", value
        stored = convert(self, value)
        if stored is None and self.kind in MEASURED and is_written(value):
            try:
                value = evaluate_as(self.kind, written, self.unit)
                stored = convert(self, value)
            except InvalidText as error:
                why = f": {error}"
        if stored is None:
            allowed = self.allowed + why
            if self.minimum < _TINY and isinstance(value, int | float) and 0.0 < value < self.minimum:
                allowed = ", ".join((allowed, f"at least {self.minimum:g}"))
            if self.kind == "entity" and isinstance(value, str):
                allowed = f"{allowed}: world.entity({value!r}) is that of an id"
            raise InvalidValue(self.owner, self.name, written, allowed)
        return stored


def _unnamed[**P](make: Callable[Concatenate[str, Kind, P], Field]) -> Callable[P, Any]:
    return partial(make, "", "number")


field = _unnamed(Field)
"""Describe one field of a component, by the values of :class:`Field` from ``default`` on.

Name, kind and owner are filled in by :func:`physicslab.ecs.component.component`. A field without ``default``
is required. A ``derived`` field that is given as ``None`` is kept up to date by the world.
"""


def _finite(value: object) -> float | None:
    """Return any finite real number as a float."""
    if type(value) is float:
        return value if math.isfinite(value) else None
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, bool) or not isinstance(value, Real):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None


def _number(field: Field, value: object) -> float | None:
    number = _finite(value)
    return number if number is not None and field.lowest <= number <= field.highest else None


def _whole(field: Field, value: object) -> int | None:
    if type(value) is not int and (isinstance(value, bool) or not isinstance(value, Integral)):
        return None
    number = int(value)
    return number if abs(number) < 2**63 and field.lowest <= number <= field.highest else None


def _vector(field: Field, value: object) -> tuple[float, float] | None:
    limit = field.highest  # which no number that is not finite is within
    if isinstance(value, Vector2):
        return (value.x, value.y) if abs(value.x) <= limit and abs(value.y) <= limit else None
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, tuple | list) or (
        isinstance(value, Sequence) and not isinstance(value, str | bytes | bytearray)
    ):
        if len(value) != 2:
            return None
        x, y = _finite(value[0]), _finite(value[1])
        return (x, y) if x is not None and y is not None and abs(x) <= limit and abs(y) <= limit else None
    return None


def _flag(field: Field, value: object) -> bool | str | None:
    if isinstance(value, str):
        return value if value in field.choices else None
    return bool(value) if isinstance(value, bool | np.bool_) else None


def _entity(field: Field, value: object) -> int | None:
    if value is None:
        return 0
    if isinstance(value, bool) or not isinstance(value, Integral):
        return None
    entity = int(value)
    return entity if 0 < entity < 2**63 else None


def _choice(field: Field, value: object) -> int | None:
    return field.choices.index(value) + 1 if isinstance(value, str) and value in field.choices else None


def _text(field: Field, value: object) -> int | None:
    if not isinstance(value, str) or len(value) > field.longest or value.count("\n") >= field.lines:
        return None
    if not all(map(is_line, value.split("\n"))) or (value and not has_width(value)):
        return None
    return code_of(value)


def _points(field: Field, value: object) -> int | None:
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if not isinstance(value, tuple | list):
        return None
    found = [_vector(field, point) for point in value]
    known = [Vector2(point[0] + 0.0, point[1] + 0.0) for point in found if point is not None]  # no -0.0
    return POINTS.code_of(tuple(known)) if len(known) == len(found) else None


def _box(field: Field, value: object) -> tuple[float, float, float, float] | None:
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if not isinstance(value, tuple | list) or len(value) != 4:
        return None
    low, high = _vector(field, value[:2]), _vector(field, value[2:])
    return (*low, *high) if low and high and low[0] < high[0] and low[1] < high[1] else None


_CONVERSIONS: Mapping[Kind, Callable[[Field, object], Any]] = {
    "number": _number,
    "whole": _whole,
    "vector": _vector,
    "flag": _flag,
    "entity": _entity,
    "choice": _choice,
    "text": _text,
    "points": _points,
    "box": _box,
}
"""How each kind of field turns a value into what its column stores; ``None`` for one that it cannot hold."""
