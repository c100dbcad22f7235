"""Components as rows of numpy columns.

A component object is a handle on one row of its component's table. Reading ``transform.position`` and running a
vectorised system over ``world.table(Transform)["position"]`` touch the same memory, so there is one truth and
nothing to copy. A component that no world has adopted yet owns a row of its own.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any, ClassVar, Literal, TypeVar, dataclass_transform, get_type_hints

import numpy as np
from numpy.typing import NDArray

from physicslab.vector import Vector2

__all__ = ["COMPONENTS", "Batch", "Component", "Derived", "Field", "InvalidValue", "Table", "Vector", "component", "field"]

Kind = Literal["number", "vector", "flag", "entity", "choice"]
T = TypeVar("T")

COMPONENTS: dict[str, type[Component]] = {}
"""Every component class made by :func:`component`, by name, in the order of definition."""


class InvalidValue(ValueError):
    """A component was given a value that it cannot hold.

    Attributes
    ----------
    component, field : str
        Where the value was going.
    value : object
        What was given.
    allowed : str
        What may be given, in words.
    """

    def __init__(self, component: str, field: str, value: object, allowed: str) -> None:
        self.component, self.field, self.value, self.allowed = component, field, value, allowed
        super().__init__(f"{component}.{field} = {value!r}: must be {allowed}")


class Vector:
    """The type of a vector field: reads as :class:`Vector2`, takes any pair of numbers."""

    def __get__(self, handle: object, owner: type | None = None) -> Vector2:
        """Return the vector stored in the handle's row."""
        raise NotImplementedError  # the decorator puts a property in this place

    def __set__(self, handle: object, value: Vector2 | Sequence[float]) -> None:
        """Store a pair of numbers in the handle's row."""
        raise NotImplementedError


class Derived:
    """The type of a number that the world works out where none is given: reads as ``float``, takes ``None`` too."""

    def __get__(self, handle: object, owner: type | None = None) -> float:
        """Return the number in the handle's row; 0 while it is not given and no world has worked it out."""
        raise NotImplementedError  # the decorator puts a property in this place

    def __set__(self, handle: object, value: float | None) -> None:
        """Give the number by hand, or hand it back to the world with ``None``."""
        raise NotImplementedError


@dataclass(frozen=True, slots=True)
class Field:
    """What is known of one field of a component: its type, unit, range and meaning.

    The inspector, the scene file and every check are made from this record.
    """

    name: str
    kind: Kind
    default: Any
    unit: str
    meaning: str
    minimum: float
    maximum: float
    above: float
    choices: tuple[str, ...]
    derived: str
    fixed: bool
    owner: str = ""

    @property
    def allowed(self) -> str:
        """What the field may hold, in words."""
        unit = f" {self.unit}" if self.unit not in ("", "1") else ""
        match self.kind:
            case "choice":
                return "one of " + ", ".join(f'"{choice}"' for choice in self.choices)
            case "flag":
                return "true or false"
            case "entity":
                return "an entity or null"
            case "vector":
                return f"two finite numbers [x, y]{unit}"
        words = "a finite number"
        if self.above > -math.inf:
            words += f" > {self.above:g}"
        if self.minimum > -math.inf and self.maximum < math.inf:
            words += f" from {self.minimum:g} to {self.maximum:g}"
        elif self.minimum > -math.inf:
            words += f" >= {self.minimum:g}"
        return words + unit

    def check(self, value: object) -> Any:
        """Return ``value`` as the column stores it, or raise :class:`InvalidValue`.

        Vectors come back as a pair of floats, choices as their code (1, 2, ...), no entity as 0.
        """
        match self.kind:
            case "number":
                if isinstance(value, Real) and not isinstance(value, bool):
                    number = _as_float(value)
                    if math.isfinite(number) and self.minimum <= number <= self.maximum and number > self.above:
                        return number
            case "vector":
                if isinstance(value, Vector2):
                    if math.isfinite(value.x) and math.isfinite(value.y):
                        return (value.x, value.y)
                elif isinstance(value, Sequence | np.ndarray) and not isinstance(value, str) and len(value) == 2:
                    pair = tuple(
                        _as_float(part) if isinstance(part, Real) and not isinstance(part, bool) else math.nan
                        for part in value
                    )
                    if math.isfinite(pair[0]) and math.isfinite(pair[1]):
                        return pair
            case "flag":
                if isinstance(value, bool | np.bool_):
                    return bool(value)
            case "entity":
                if value is None:
                    return 0
                if isinstance(value, Integral) and not isinstance(value, bool) and 0 < value < 2**63:
                    return int(value)
            case "choice":
                if isinstance(value, str) and value in self.choices:
                    return self.choices.index(value) + 1
        raise InvalidValue(self.owner, self.name, value, self.allowed)


def _as_float(value: Real) -> float:
    """Return a number as a float; one too large for a float is infinite, which every check refuses."""
    try:
        return float(value)
    except OverflowError:
        return math.inf


_REQUIRED: Any = object()


def field(
    default: Any = _REQUIRED,
    *,
    unit: str = "1",
    meaning: str = "",
    minimum: float = -math.inf,
    maximum: float = math.inf,
    above: float = -math.inf,
    choices: tuple[str, ...] = (),
    derived: str = "",
    fixed: bool = False,
) -> Any:
    """Describe one field of a component.

    Parameters
    ----------
    default : object, optional
        The value where none is given; without it the field is required.
    unit, meaning : str
        SI unit ("1" for a pure number) and one line on what the number is.
    minimum, maximum, above : float
        Inclusive bounds, and an exclusive lower one.
    choices : tuple of str
        The words that a choice field takes.
    derived : str
        Where the value comes from when it is ``None`` ("from the Shape"): the world then keeps it up to date.
    fixed : bool
        Whether the field is settled when the component is made.
    """
    return Field("", "number", default, unit, meaning, minimum, maximum, above, choices, derived, fixed)


class Component:
    """A handle on one row of a table. Made by :func:`component`, never directly."""

    __slots__ = ("_row", "_views")
    FIELDS: ClassVar[tuple[Field, ...]] = ()
    _views: list[Any]
    _row: int

    def __init__(self, *args: object, **kwargs: object) -> None:
        cls = type(self)
        if len(args) > len(cls.FIELDS):
            raise TypeError(f"{cls.__name__} takes at most {len(cls.FIELDS)} values, got {len(args)}")
        given = dict(zip((f.name for f in cls.FIELDS), args, strict=False))
        for name, value in kwargs.items():
            if name in given:
                raise TypeError(f"{cls.__name__}.{name} was given twice")
            given[name] = value
        self._row = 0
        self._views = []
        for spec in cls.FIELDS:
            value = given.pop(spec.name, spec.default)
            if value is _REQUIRED:
                raise TypeError(f"{cls.__name__} needs {spec.name}: {spec.allowed}")
            if spec.derived:
                self._views += ([0.0 if value is None else spec.check(value)], [value is not None])
            else:
                stored = spec.check(value)
                self._views.append(list(stored) if spec.kind == "vector" else [stored])
        if given:
            names = ", ".join(f.name for f in cls.FIELDS)
            raise TypeError(f"{cls.__name__} has no field {next(iter(given))!r}; it has {names}")
        self.validate()

    def validate(self) -> None:
        """Check what no single field can know; raise :class:`InvalidValue`. Overridden where there is such a rule."""

    def values(self) -> dict[str, Any]:
        """Return every field's present value by name."""
        return {spec.name: getattr(self, spec.name) for spec in self.FIELDS}

    def is_given(self, name: str) -> bool:
        """Whether a derived field was given by hand (``True`` for every other field)."""
        column = 0
        for spec in self.FIELDS:
            if spec.name == name:
                return bool(self._views[column + 1][self._row]) if spec.derived else True
            column += 2 if spec.derived else 1
        raise KeyError(name)

    def __repr__(self) -> str:
        values = ", ".join(f"{name}={value!r}" for name, value in self.values().items())
        return f"{type(self).__name__}({values})"

    def __reduce__(self) -> tuple[Any, ...]:
        given = tuple(
            getattr(self, spec.name) if self.is_given(spec.name) else None for spec in type(self).FIELDS
        )
        return type(self), given


@dataclass_transform(field_specifiers=(field,))
def component(cls: type[T]) -> type[T]:
    """Turn an annotated class into a component whose fields live in columns.

    Annotate each field with its type and describe it with :func:`field`:

    ======================  =========================================  ===============================
    annotation              holds                                      column
    ======================  =========================================  ===============================
    ``float``               a finite number, within its range          float64 (n,)
    ``Vector``              two finite numbers, read as ``Vector2``    float64 (n, 2)
    ``Derived``             a number the world can work out            float64 (n,) and a bool (n,)
    ``bool``                a flag                                     bool (n,)
    ``int | None``          an entity, or none                         int64 (n,), 0 for none
    ``str`` with choices    one word of a fixed list                   int64 (n,), 1 + index in the list
    ======================  =========================================  ===============================

    A row whose entity lacks the component is all zeros. Reading gives plain Python values; writing checks the value
    and raises :class:`InvalidValue` with the component, the field, the value and what is allowed.

    Examples
    --------
    >>> @component
    ... class Charge:
    ...     charge: float = field(0.0, unit="C", meaning="electric charge")
    >>> charge = Charge(2)
    >>> charge.charge
    2.0
    >>> charge.charge = float("nan")
    Traceback (most recent call last):
    ...
    physicslab.columns.InvalidValue: Charge.charge = nan: must be a finite number C
    >>> _ = COMPONENTS.pop("Charge")
    """
    hints = get_type_hints(cls)
    specs: list[Field] = []
    namespace: dict[str, Any] = {
        name: value
        for name, value in vars(cls).items()
        if name not in ("__dict__", "__weakref__", "__annotations__") and not isinstance(value, Field)
    }
    column = 0
    for name, hint in hints.items():
        described = vars(cls).get(name)
        if hint is ClassVar or not isinstance(described, Field):
            continue
        spec = Field(
            name, _kind_of(hint, described), described.default, described.unit, described.meaning,
            described.minimum, described.maximum, described.above, described.choices, described.derived,
            described.fixed, cls.__name__,
        )  # fmt: skip
        specs.append(spec)
        namespace[name] = _property(spec, column)
        column += 2 if spec.derived else 1
    namespace["__slots__"] = ()
    namespace["FIELDS"] = tuple(specs)
    made: Any = type(cls.__name__, (Component,), namespace)
    made.__doc__ = cls.__doc__
    COMPONENTS[cls.__name__] = made
    return made  # type: ignore[no-any-return]


def _kind_of(hint: Any, described: Field) -> Kind:
    if hint is Vector:
        return "vector"
    if hint is bool:
        return "flag"
    if described.choices:
        return "choice"
    if hint is float or hint is Derived:
        return "number"
    if hint == int | None:
        return "entity"
    raise TypeError(f"no column holds a field annotated {hint!r}; use float, Vector, bool, int | None or choices")


def _property(spec: Field, column: int) -> property:
    """Make the property that reads and writes one field of a handle's row."""
    check = spec.check
    reads: dict[Kind, Any] = {
        "number": lambda self: self._views[column][self._row],
        "flag": lambda self: self._views[column][self._row],
        "entity": lambda self: self._views[column][self._row] or None,
        "choice": lambda self: spec.choices[self._views[column][self._row] - 1],
        "vector": lambda self: Vector2(
            self._views[column][2 * self._row], self._views[column][2 * self._row + 1]
        ),
    }

    def write(self: Component, value: object) -> None:
        self._views[column][self._row] = check(value)

    def write_vector(self: Component, value: object) -> None:
        view, i = self._views[column], 2 * self._row
        view[i], view[i + 1] = check(value)

    def write_derived(self: Component, value: object) -> None:
        if value is not None:
            self._views[column][self._row] = check(value)
        self._views[column + 1][self._row] = value is not None

    def refuse(self: Component, value: object) -> None:
        raise AttributeError(f"{spec.owner}.{spec.name} is settled when the component is made; add a new one instead")

    writer = write_vector if spec.kind == "vector" else write_derived if spec.derived else write
    unit = "" if spec.unit == "1" else f" [{spec.unit}]"
    return property(reads[spec.kind], refuse if spec.fixed else writer, doc=f"{spec.meaning}{unit}")


_DTYPES: Mapping[Kind, type] = {
    "number": np.float64,
    "vector": np.float64,
    "flag": np.bool_,
    "entity": np.int64,
    "choice": np.int64,
}


class Table:
    """The columns of one component in one world, one row an entity.

    All tables of a world number their rows alike, so that a kernel indexes every column with the same number. Row 0
    is the world itself, fixed at the origin. A row whose entity lacks the component holds zeros, which every kernel
    reads as "nothing here": no mass, no speed, no shape.

    ``table["position"]`` is the column of a field, in use rows only; a derived field has a second column
    ``"<field>_given"``. The arrays are views that stay valid until the next structural change.
    """

    def __init__(self, component: type[Any], capacity: int) -> None:
        self.component: type[Component] = component
        self.handles: dict[int, Component] = {}
        self.present: NDArray[np.bool_] = np.zeros(0, np.bool_)
        self._names: list[str] = []
        self._storage: list[NDArray[Any]] = []
        self._views: list[Any] = []
        self._columns: dict[str, NDArray[Any]] = {}
        for spec in self.component.FIELDS:
            self._names.append(spec.name)
            shape = (0, 2) if spec.kind == "vector" else (0,)
            self._storage.append(np.zeros(shape, _DTYPES[spec.kind]))
            if spec.derived:
                self._names.append(f"{spec.name}_given")
                self._storage.append(np.zeros(0, np.bool_))
        self._present = self.present
        self.resize(0, capacity)

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self._columns[name]

    def resize(self, rows: int, capacity: int) -> None:
        """Use the first ``rows`` rows, with room for ``capacity``."""
        if capacity > len(self._present):
            self._present = _grown(self._present, capacity)
            self._storage = [_grown(column, capacity) for column in self._storage]
            # Handles share this list, so replacing its items moves every one of them to the new memory.
            self._views[:] = [memoryview(column.reshape(-1)) for column in self._storage]
        self.present = self._present[:rows]
        self._columns = {
            name: column[:rows] for name, column in zip(self._names, self._storage, strict=True)
        }

    def adopt(self, entity: int, handle: Component, row: int) -> None:
        """Move a detached component's values into ``row``; from here on the handle is a view of it."""
        if type(handle._views[0]) is memoryview:
            raise ValueError(
                f"entity {entity}: this {type(handle).__name__} object already belongs to an entity; "
                f"make one for each"
            )
        for view, own in zip(self._views, handle._views, strict=True):
            if len(own) == 2:
                view[2 * row], view[2 * row + 1] = own
            else:
                view[row] = own[0]
        handle._views, handle._row = self._views, row
        self._present[row] = True
        self.handles[entity] = handle

    def release(self, entity: int) -> None:
        """Detach the entity's handle, which keeps its last values, and blank its row."""
        handle = self.handles.pop(entity)
        row = handle._row
        handle._views = [
            [view[2 * row], view[2 * row + 1]] if column.ndim == 2 else [view[row]]
            for view, column in zip(self._views, self._storage, strict=True)
        ]
        handle._row = 0
        self._present[row] = False
        for column in self._storage:
            column[row] = 0

    def compact(self, kept: NDArray[np.int64], row_of: Mapping[int, int]) -> None:
        """Move rows ``kept`` to the front, in order; ``row_of`` gives each entity its new row."""
        for column in (self._present, *self._storage):
            column[: len(kept)] = column[kept]
            column[len(kept) :] = 0
        for entity, handle in self.handles.items():
            handle._row = row_of[entity]


def _grown(column: NDArray[Any], capacity: int) -> NDArray[Any]:
    larger = np.zeros((capacity, *column.shape[1:]), column.dtype)
    larger[: len(column)] = column
    return larger


@dataclass(frozen=True, slots=True)
class Batch:
    """The rows of all entities that have certain components, in the order of their entity ids.

    Attributes
    ----------
    rows : int64 array (k,)
        Row numbers, good for every table of the world.
    entities : int64 array (k,)
        The entity in each of those rows.
    """

    rows: NDArray[np.int64]
    entities: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.rows)

    @classmethod
    def of(cls, tables: Iterable[Table], entities: NDArray[np.int64]) -> Batch:
        """Select the rows that are present in every one of ``tables``."""
        selected = entities > 0
        for table in tables:
            selected = selected & table.present
        rows = np.flatnonzero(selected).astype(np.int64)
        return cls(rows, entities[rows])
