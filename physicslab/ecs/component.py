"""Components as rows of numpy columns.

A component object is a handle on one row of its component's table. Reading ``transform.position`` and running
a vectorised system over ``world.table(Transform)["position"]`` touch the same memory, so there is one copy of
each value. A component that no world has adopted yet owns a row of its own.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from inspect import Parameter, Signature
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar, cast, dataclass_transform, get_origin, get_type_hints

from physicslab.ecs.accessors import ABSENT, Derived, Entity, Maker, Number, Points, Vector, accessor, maker
from physicslab.ecs.fields import REQUIRED, Field, InvalidValue, Kind, field
from physicslab.ecs.text import no_such

__all__ = [
    "COMPONENTS", "Component", "Derived", "Entity", "Field", "InvalidValue", "Number", "Points", "Vector",
    "component", "field", "local_components",
]  # fmt: skip

COMPONENTS: dict[str, type[Component]] = {}
"""The components of files: every class made by :func:`component`, by name, in the order of definition."""
_local = False
"""Whether a component may have the name of another: within a block of :func:`local_components`."""
_BUILT_IN = "physicslab.components."
_empty = Parameter.empty
_set = object.__setattr__


class Component:
    """A handle on one row of a table. Made by :func:`component`, never directly.

    A detached component has row 0 of lists of its own; an adopted one has a row of its world's table, never
    row 0.
    """

    __slots__ = ("_row", "_views")
    physical: ClassVar[bool] = True
    """Whether the motion may depend on it: adding or removing one then is an edit of the motion."""
    FIELDS: ClassVar[tuple[Field, ...]] = ()
    _makers: ClassVar[tuple[tuple[str, Maker], ...]] = ()
    _views: list[Any]
    _row: int

    def __init_subclass__(cls) -> None:
        if cls.__bases__ != (Component,):
            raise TypeError(f"{cls.__name__}: a component has no subclasses; esper looks up the exact type")

    def __init__(self, *args: object, **kwargs: object) -> None:
        # Loading a scene of 100,000 entities makes 500,000 components: nothing here is done twice.
        cls = type(self)
        given = self._named(args, kwargs) if args else kwargs
        _set_row(self, 0)
        _set_views(self, views := [])
        left = len(given)
        for name, make in cls._makers:
            if name in given:
                views += make(given[name])
                left -= 1
            else:
                views += make(ABSENT)
        if left:
            unknown = next(name for name in given if all(name != f.name for f in cls.FIELDS))
            raise TypeError(cls._no_such(unknown))
        self.validate()

    if not TYPE_CHECKING:  # type checkers know the fields

        def __setattr__(self, name: str, value: object) -> None:
            try:
                _set(self, name, value)
            except AttributeError as error:
                if hasattr(type(self), name):
                    raise
                raise AttributeError(self._no_such(name), name=None) from error

        def __getattr__(self, name: str) -> object:
            if name[:1] == "_" or hasattr(type(self), name):
                return super().__getattribute__(name)
            raise AttributeError(self._no_such(name), name=None)

    @classmethod
    def _no_such(cls, name: str) -> str:
        return no_such(cls.__name__, "field", name, (spec.name for spec in cls.FIELDS))

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
        """Raise :class:`InvalidValue` where fields are inconsistent. Override where there is such a rule.

        It is called on a new component, so it may read every field; a write is tried on a new one first.
        """

    def references(self) -> dict[str, str]:
        """Return, by the names of fields that hold an entity, which component that one must have.

        Override it where a scene file is to be refused that refers to another. An instrument, a component
        that is not ``physical``, is left out of a file where what it refers to is gone.
        """
        return {}

    def values(self) -> dict[str, Any]:
        """Return every field's present value by name."""
        return {spec.name: getattr(self, spec.name) for spec in self.FIELDS}

    def given(self) -> dict[str, Any]:
        """Return the arguments to make the same component: values, ``None`` for those the world computes."""
        return {name: value if self.is_given(name) else None for name, value in self.values().items()}

    def is_given(self, name: str) -> bool:
        """Whether a derived field was given explicitly (``True`` for every other field)."""
        spec, column = self._placed(name)
        return bool(self._views[column + 1][self._row]) if spec.derived else True

    def name_entity(self, name: str, entity: int) -> None:
        """Put the number of an entity in place of its id, in a component that no world has yet."""
        self._views[self._placed(name)[1]][self._row] = entity

    @classmethod
    def _placed(cls, name: str) -> tuple[Field, int]:
        """Return a field and its column."""
        column = 0
        for spec in cls.FIELDS:
            if spec.name == name:
                return spec, column
            column += 2 if spec.derived else 1
        raise KeyError(name)

    def __repr__(self) -> str:
        values = ", ".join(f"{name}={value!r}" for name, value in self.values().items())
        return f"{type(self).__name__}({values})"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), tuple(self.given().values())


_set_row, _set_views = (vars(Component)[name].__set__ for name in Component.__slots__)


@dataclass_transform(field_specifiers=(field,))
def component[T](cls: type[T]) -> type[T]:
    """Turn an annotated class into a component whose fields live in columns.

    Derive it from :class:`Component`, so that type checkers find its methods, and from nothing else. Annotate
    each field with its type and describe it with :func:`field`:

    ======================  =========================================  ===============================
    annotation              holds                                      column
    ======================  =========================================  ===============================
    ``float``, ``Number``   a finite number, within its range          float64 (n,)
    ``int``                 a whole number, within its range           int64 (n,)
    ``Vector``              two finite numbers, read as ``Vector2``    float64 (n, 2)
    ``Derived``             a number the world can compute             float64 (n,) and a bool (n,)
    ``bool``                a flag                                     bool (n,)
    ``int | None``          an entity, or none; so does ``Entity``     int64 (n,), 0 for none
    ``str`` with choices    one word of a fixed list                   int64 (n,), 1 + index in the list
    ``str``                 a text, empty or to be seen                int64 (n,), a code, 0 for empty
    ``Points``              a list of points, read as ``Vector2``      int64 (n,), a code, 0 for empty
    ======================  =========================================  ===============================

    ``Number`` and ``Entity`` tell type checkers that texts are taken: a number with its unit, ``"2 kg"``, and
    the id of an entity. A row whose entity lacks the component is all zeros. Reading gives plain Python
    values; writing checks the value and raises :class:`InvalidValue` with the component, the field, the value
    and what is allowed.
    Scene files identify a component by the name of its class, so no two classes have the same; a class that
    is defined again, as by a notebook's cell, replaces itself. Examples and tests use
    :func:`local_components`.

    Raises
    ------
    TypeError
        If a field is not described, no column holds its type, or another class has the name.

    Examples
    --------
    >>> with local_components():
    ...     @component
    ...     class Charge(Component):
    ...         charge: float = field(default=0.0, unit="C", meaning="electric charge")
    >>> charge = Charge(2)
    >>> charge.charge
    2.0
    >>> charge.charge = float("nan")
    Traceback (most recent call last):
    ...
    physicslab.ecs.fields.InvalidValue: Charge.charge = nan: must be a finite number C
    """
    if cls.__bases__ not in ((Component,), (object,)):
        raise TypeError(f"{cls.__name__}: a component has no base class but Component")
    known = COMPONENTS.get(cls.__name__)
    if known is not None and not _local and _origin(known) != _origin(cls):
        raise TypeError(
            f"component {_origin(cls)}: {_origin(known)} has this name already, and scene files use it; "
            "choose another"
        )
    namespace: dict[str, Any] = {
        name: value
        for name, value in vars(cls).items()
        if name not in ("__dict__", "__weakref__", "__annotations__")
    }
    specs = _described(cls)
    column = 0
    for spec in specs:
        namespace[spec.name] = accessor(spec, column, validated="validate" in namespace)
        column += 2 if spec.derived else 1
    namespace |= {"__slots__": (), "FIELDS": specs, "__qualname__": cls.__qualname__}
    namespace["_makers"] = tuple((spec.name, maker(spec)) for spec in specs)
    namespace["__signature__"], namespace["__doc__"] = _signature(specs), _documented(cls, specs)
    made: Any = type(cls.__name__, (Component,), namespace)
    COMPONENTS[cls.__name__] = made
    return cast(type[T], made)


@contextmanager
def local_components() -> Iterator[None]:
    """Let components be defined for the length of a ``with`` block, under any name.

    For examples and tests: such a class may have the name of a component that exists, or that will exist one
    day. After the block the components of files are those of before. The classes go on working in worlds.

    Examples
    --------
    >>> before = dict(COMPONENTS)
    >>> with local_components():
    ...     @component
    ...     class Mass(Component):
    ...         value: float = field(default=1.0, unit="kg")
    ...     COMPONENTS["Mass"] is Mass
    True
    >>> COMPONENTS == before
    True
    """
    global _local
    before, outer = dict(COMPONENTS), _local
    _local = True
    try:
        yield
    finally:
        # Components of the package itself that were imported in the block stay.
        stay = {n: kind for n, kind in COMPONENTS.items() if kind.__module__.startswith(_BUILT_IN)}
        COMPONENTS.clear()
        COMPONENTS.update(stay | before)
        _local = outer


def _origin(cls: type) -> str:
    return f"{cls.__module__}.{cls.__qualname__}"


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


def _signature(specs: tuple[Field, ...]) -> Signature:
    """Return what ``help`` and notebooks show of the arguments."""
    kind = Parameter.POSITIONAL_OR_KEYWORD
    known = [Parameter(s.name, kind, default=_empty if s.default is REQUIRED else s.default) for s in specs]
    required_last = any(a.default is not _empty and b.default is _empty for a, b in pairwise(known))
    return Signature([one.replace(kind=Parameter.KEYWORD_ONLY) for one in known] if required_last else known)


def _documented(cls: type, specs: tuple[Field, ...]) -> str:
    """Return the description of a component, with its fields: their meaning and what they may hold."""
    lines = [f"{s.name} : {s.meaning or s.name}; {s.allowed}" for s in specs]
    words = inspect.cleandoc(cls.__doc__ or cls.__name__)
    return "\n".join([words, "", "Parameters", "----------", *lines]) if lines else words


def _kind_of(hint: Any, described: Field) -> Kind:
    kinds: dict[Any, Kind] = {
        float: "number", Number: "number", Derived: "number", int: "whole", Vector: "vector", bool: "flag",
        int | None: "entity", Entity: "entity", str: "text", Points: "points",
    }  # fmt: skip
    if described.choices:
        return "choice"
    if hint not in kinds:
        allowed = "float, Number, int, bool, Vector, Points, Derived, int | None, Entity, or str"
        raise TypeError(f"no column holds {hint!r}; use {allowed}")
    return kinds[hint]
