"""Components as rows of numpy columns.

A component object is a handle on one row of its component's table. Reading ``transform.position`` and running
a vectorised system over ``world.table(Transform)["position"]`` touch the same memory, so there is one truth
and nothing to copy. A component that no world has adopted yet owns a row of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, cast, dataclass_transform, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.fields import REQUIRED, Field, InvalidValue, Kind, field
from physicslab.ecs.vector import Vector2

__all__ = [
    "COMPONENTS", "Batch", "Component", "Derived", "Field", "InvalidValue", "Table", "Vector",
    "component", "field",
]  # fmt: skip

COMPONENTS: dict[str, type[Component]] = {}
"""Every component class made by :func:`component`, by name, in the order of definition."""


type _Maker = Callable[[object], list[list[Any]]]
_ABSENT: Any = object()
"""What stands for a value that was not given."""


class Vector:
    """The type of a vector field: reads as :class:`Vector2`, takes any pair of numbers."""

    def __get__(self, handle: object, owner: type | None = None) -> Vector2:
        """Return the vector stored in the handle's row."""
        raise NotImplementedError  # the decorator puts a property in this place

    def __set__(self, handle: object, value: Vector2 | Sequence[float] | NDArray[Any]) -> None:
        """Store a pair of numbers in the handle's row."""
        raise NotImplementedError


class Derived:
    """The type of a number that the world works out where it is ``None``: reads as ``float``, takes both."""

    def __get__(self, handle: object, owner: type | None = None) -> float:
        """Return the number in the handle's row; 0 while it is not given and no world has worked it out."""
        raise NotImplementedError  # the decorator puts a property in this place

    def __set__(self, handle: object, value: float | None) -> None:
        """Give the number by hand, or hand it back to the world with ``None``."""
        raise NotImplementedError


class Component:
    """A handle on one row of a table. Made by :func:`component`, never directly.

    A detached component has row 0 of lists of its own; an adopted one has a row of its world's table, never
    row 0.
    """

    __slots__ = ("_row", "_views")
    FIELDS: ClassVar[tuple[Field, ...]] = ()
    _makers: ClassVar[tuple[tuple[str, _Maker], ...]] = ()
    _views: list[Any]
    _row: int

    def __init_subclass__(cls) -> None:
        if cls.__bases__ != (Component,):
            raise TypeError(f"{cls.__name__}: a component has no subclasses; esper goes by the exact type")

    def __init__(self, *args: object, **kwargs: object) -> None:
        # Loading a scene of 100,000 entities makes 500,000 components: nothing here is done twice.
        cls = type(self)
        given = self._named(args, kwargs) if args else kwargs
        self._row = 0
        self._views = views = []
        left = len(given)
        for name, make in cls._makers:
            if name in given:
                views += make(given[name])
                left -= 1
            else:
                views += make(_ABSENT)
        if left:
            unknown = next(name for name in given if all(name != f.name for f in cls.FIELDS))
            names = ", ".join(f.name for f in cls.FIELDS)
            raise TypeError(f"{cls.__name__} has no field {unknown!r}; it has {names or 'none'}")
        self.validate()

    @classmethod
    def _named(cls, args: tuple[object, ...], kwargs: dict[str, object]) -> dict[str, object]:
        """Return all values by name, those that were given by place among them."""
        if len(args) > len(cls.FIELDS):
            raise TypeError(f"{cls.__name__} takes at most {len(cls.FIELDS)} values, got {len(args)}")
        given = {spec.name: value for spec, value in zip(cls.FIELDS, args, strict=False)}
        for name in given:
            if name in kwargs:
                raise TypeError(f"{cls.__name__}.{name} was given twice")
        return given | kwargs

    def validate(self) -> None:
        """Raise :class:`InvalidValue` where fields do not go together. Override where there is such a rule.

        It is called on a new component, so it may read every field; a write is tried on a new one first.
        """

    def values(self) -> dict[str, Any]:
        """Return every field's present value by name."""
        return {spec.name: getattr(self, spec.name) for spec in self.FIELDS}

    def given(self) -> dict[str, Any]:
        """Return what makes the same component again: its values, ``None`` for those the world works out."""
        return {name: value if self.is_given(name) else None for name, value in self.values().items()}

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
        return type(self), tuple(self.given().values())


@dataclass_transform(field_specifiers=(field,))
def component[T](cls: type[T]) -> type[T]:
    """Turn an annotated class into a component whose fields live in columns.

    Derive it from :class:`Component`, so that type checkers know its methods, and from nothing else. Annotate
    each field with its type and describe it with :func:`field`:

    ======================  =========================================  ===============================
    annotation              holds                                      column
    ======================  =========================================  ===============================
    ``float``               a finite number, within its range          float64 (n,)
    ``int``                 a whole number, within its range           int64 (n,)
    ``Vector``              two finite numbers, read as ``Vector2``    float64 (n, 2)
    ``Derived``             a number the world can work out            float64 (n,) and a bool (n,)
    ``bool``                a flag                                     bool (n,)
    ``int | None``          an entity, or none                         int64 (n,), 0 for none
    ``str`` with choices    one word of a fixed list                   int64 (n,), 1 + index in the list
    ======================  =========================================  ===============================

    A row whose entity lacks the component is all zeros. Reading gives plain Python values; writing checks the
    value and raises :class:`InvalidValue` with the component, the field, the value and what is allowed.

    Examples
    --------
    >>> @component
    ... class Charge(Component):
    ...     charge: float = field(default=0.0, unit="C", meaning="electric charge")
    >>> charge = Charge(2)
    >>> charge.charge
    2.0
    >>> charge.charge = float("nan")
    Traceback (most recent call last):
    ...
    physicslab.ecs.fields.InvalidValue: Charge.charge = nan: must be a finite number C
    >>> _ = COMPONENTS.pop("Charge")
    """
    known = COMPONENTS.get(cls.__name__)
    if known is not None and (known.__module__, known.__qualname__) != (cls.__module__, cls.__qualname__):
        raise TypeError(f"there is a component {cls.__name__} already, in {known.__module__}")
    if cls.__bases__ not in ((Component,), (object,)):
        raise TypeError(f"{cls.__name__}: a component has no base class but Component")
    namespace: dict[str, Any] = {
        name: value
        for name, value in vars(cls).items()
        if name not in ("__dict__", "__weakref__", "__annotations__")
    }
    specs = _described(cls)
    column = 0
    for spec in specs:
        namespace[spec.name] = _property(spec, column, validated="validate" in namespace)
        column += 2 if spec.derived else 1
    namespace |= {"__slots__": (), "FIELDS": specs, "__qualname__": cls.__qualname__}
    namespace["_makers"] = tuple((spec.name, _maker(spec)) for spec in specs)
    made: Any = type(cls.__name__, (Component,), namespace)
    COMPONENTS[cls.__name__] = made
    return cast(type[T], made)


def _described(cls: type) -> tuple[Field, ...]:
    """Return the fields of a class as it was written, with what the annotations add to their descriptions."""
    known = get_type_hints(cls)
    hints = {name: known[name] for name in cls.__annotations__ if get_origin(known[name]) is not ClassVar}
    specs: list[Field] = []
    for name, hint in hints.items():
        described = vars(cls).get(name)
        if not isinstance(described, Field):
            raise TypeError(f"{cls.__name__}.{name}: describe it with field(...)")
        spec = replace(described, name=name, kind=_kind_of(hint, described), owner=cls.__name__)
        if spec.default is not REQUIRED and not (spec.default is None and spec.derived):
            spec.check(spec.default)
        specs.append(spec)
    for name, value in vars(cls).items():
        if isinstance(value, Field) and name not in hints:
            raise TypeError(f"{cls.__name__}.{name}: annotate it with its type")
    return tuple(specs)


def _kind_of(hint: Any, described: Field) -> Kind:
    kinds: dict[Any, Kind] = {
        float: "number", Derived: "number", int: "whole", Vector: "vector", bool: "flag",
        int | None: "entity",
    }  # fmt: skip
    if described.choices:
        return "choice"
    if hint not in kinds:
        allowed = "float, int, bool, Vector, Derived, int | None, or str with choices"
        raise TypeError(f"no column holds {hint!r}; use {allowed}")
    return kinds[hint]


def _maker(spec: Field) -> _Maker:
    """Make what turns a value of a field into what a detached component holds of it: a list a column."""
    check, low, high, default = spec.check, spec.lowest, spec.highest, spec.default

    def settled(value: object) -> object:
        if value is not _ABSENT:
            return value
        if default is REQUIRED:
            raise TypeError(f"{spec.owner} needs {spec.name}: {spec.allowed}")
        return default

    def number(value: object) -> list[list[Any]]:
        if type(value) is float and low <= value <= high:
            return [[value]]
        return [[check(settled(value))]]

    def vector(value: object) -> list[list[Any]]:
        return [list(check(settled(value)))]

    def derived(value: object) -> list[list[Any]]:
        value = settled(value)
        return [[0.0], [False]] if value is None else [[check(value)], [True]]

    def other(value: object) -> list[list[Any]]:
        return [[check(settled(value))]]

    makers: dict[Kind, _Maker] = {"number": number, "vector": vector}
    return derived if spec.derived else makers.get(spec.kind, other)


def _property(spec: Field, column: int, *, validated: bool) -> property:
    """Make the property that reads and writes one field of a handle's row."""
    check, low, high = spec.check, spec.lowest, spec.highest
    reads: dict[Kind, Callable[[Any], Any]] = {
        "number": lambda self: self._views[column][self._row],
        "whole": lambda self: self._views[column][self._row],
        "flag": lambda self: self._views[column][self._row],
        "entity": lambda self: self._views[column][self._row] or None,
        "choice": lambda self: spec.choices[self._views[column][self._row] - 1],
    }

    def read_vector(self: Component) -> Vector2:
        view, i = self._views[column], 2 * self._row
        return Vector2(view[i], view[i + 1])

    def write(self: Component, value: object) -> None:
        self._views[column][self._row] = check(value)

    def write_number(self: Component, value: object) -> None:
        in_range = type(value) is float and low <= value <= high
        self._views[column][self._row] = value if in_range else check(value)

    def write_vector(self: Component, value: object) -> None:
        view, i = self._views[column], 2 * self._row
        view[i], view[i + 1] = check(value)

    def write_derived(self: Component, value: object) -> None:
        if value is not None:
            self._views[column][self._row] = check(value)
        self._views[column + 1][self._row] = value is not None

    writes: dict[Kind, Callable[[Any, object], None]] = {"number": write_number, "vector": write_vector}
    write_field = write_derived if spec.derived else writes.get(spec.kind, write)

    def write_validated(self: Component, value: object) -> None:
        type(self)(**{**self.given(), spec.name: value})  # raises where the values do not go together
        write_field(self, value)

    def refuse(self: Component, value: object) -> None:
        raise AttributeError(f"{spec.owner}.{spec.name} is settled when the component is made; add a new one")

    unit = "" if spec.unit == "1" else f" [{spec.unit}]"
    return property(
        reads.get(spec.kind, read_vector),
        refuse if spec.fixed else write_validated if validated else write_field,
        doc=f"{spec.meaning}{unit}",
    )


_DTYPES: Mapping[Kind, type] = {
    "number": np.float64,
    "whole": np.int64,
    "vector": np.float64,
    "flag": np.bool_,
    "entity": np.int64,
    "choice": np.int64,
}


class Table:
    """The columns of one component in one world, one row an entity.

    All tables of a world number their rows alike, so that a kernel indexes every column with the same number.
    Row 0 is the world itself, fixed at the origin. A row whose entity lacks the component holds zeros, which
    every kernel reads as "nothing here": no mass, no speed, no shape.

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

    @property
    def columns(self) -> list[NDArray[Any]]:
        """Every column, in the order in which components hold them."""
        return list(self._columns.values())

    def resize(self, rows: int, capacity: int) -> None:
        """Use the first ``rows`` rows, with room for ``capacity``."""
        if capacity > len(self._present):
            self._present = _grown(self._present, capacity)
            self._storage = [_grown(column, capacity) for column in self._storage]
            # Handles share this list, so replacing its items moves every one of them to the new memory.
            self._views[:] = [memoryview(column.reshape(-1)) for column in self._storage]
        self.present = self._present[:rows]
        self._columns = {name: column[:rows] for name, column in zip(self._names, self._storage, strict=True)}

    def adopt(self, entity: int, handle: Component, row: int) -> None:
        """Move a detached component's values into ``row``; from here on the handle is a view of it."""
        if handle._row:
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
