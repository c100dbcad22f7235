"""Measures, kept of each run: expressions of its figures, or functions of the world at its end.

Expressions are those of lessons (:mod:`physicslab.diagnostics.figures`). These names are known besides, as
``run --json`` has them: ``ball.position.y``, ``ball.linear.x``, ``ball.angular``, ``account.friction``,
``numerical`` and ``collisions``. ``end.ball.x`` is ``ball.x``, that at the end; ``max`` and ``min`` of one
expression are the greatest and least of the run; the first and last impact of the run have ``time``, ``x``,
``y``, ``speed`` and ``energy_lost``.
"""

from __future__ import annotations

import ast
import math
import pickle
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity
from physicslab.components.quantities import ENERGY_CAUSES
from physicslab.diagnostics.figures import FUNCTIONS, Figures
from physicslab.diagnostics.impact_table import first_and_last, read_impacts
from physicslab.diagnostics.samples import COLLISIONS, Record, quantity_of, quoted
from physicslab.ecs.quantity_text import (
    Expression,
    InvalidText,
    Quantity,
    Undefined,
    dotted,
    in_words,
    is_known,
)
from physicslab.ensembles.rollout import MOTION
from physicslab.files.checks import SceneError, shown
from physicslab.files.places import entity_names
from physicslab.state.run import Run
from physicslab.world import World

type Measure = str | Callable[[World], float]
"""An expression, or an importable function of the world at the end of the run."""

_PARTS = {"position.x": "x", "position.y": "y", "linear.x": "vx", "linear.y": "vy", "angular": "omega"}
"""Quantities by what ``run --json`` calls them."""
_SHORT = {
    **{f"account.{cause}": f"world.account_{cause}" for cause in ENERGY_CAUSES},
    "account.numerical": "world.error_of_energy",
    "numerical": "world.error_of_energy",
    "collisions": COLLISIONS,
}
_EXTREMES = {"max": "greatest", "min": "least"}
_IMPACTS = {
    "time": (0, 0, 1, 0), "x": (1, 0, 0, 0), "y": (1, 0, 0, 0), "speed": (1, 0, -1, 0),
    "energy_lost": (2, 1, -2, 0),
}  # fmt: skip
"""Quantities of an impact, with the powers of their units."""
_WHICH = ("first_impact", "last_impact")
_TRIAL = 8
"""Samples of the run that never was by which an expression is tried."""


def parsed(text: str, ids: Iterable[str]) -> Expression:
    """Return an expression in the names that figures have, all of which are known.

    Raises
    ------
    InvalidText
        If it is no expression, or names what is not there.
    """
    known = [*ids]
    whole = Expression(quoted(text, known))
    expression = Expression(text, _Canonical(known).visit(whole.node))
    for name in _quantities((expression,)):
        quantity_of(name, known)
    _refuse_undefined(expression)
    return expression


def _refuse_undefined(expression: Expression) -> None:
    """Refuse parts that no run gives a value, as ``sqrt(-1)`` and ``ball.x/0``."""
    for node in ast.walk(expression.node):
        match node:
            case ast.BinOp(op=ast.Div() as division, right=divisor):
                node = ast.BinOp(ast.Constant(1), division, divisor)
            case ast.BinOp() | ast.Call() | ast.Constant(value=int() | float()):
                pass
            case _:
                continue
        part = Expression(expression.text, node)
        if not any(part.names()):
            part.value()


class _Canonical(ast.NodeTransformer):
    """Puts the names that figures have in the place of others."""

    def __init__(self, ids: Sequence[str]) -> None:
        self._ids = ids

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return self._named(node)

    def visit_Attribute(self, node: ast.Attribute) -> ast.expr:
        return self._named(node)

    def visit_Call(self, node: ast.Call) -> ast.expr:
        name = dotted(node.func)
        if len(node.args) == 1 and name in _EXTREMES:
            name = _EXTREMES[name]
        if name and name not in FUNCTIONS and not is_known(name):
            words = ", ".join(sorted({*FUNCTIONS, *_EXTREMES}))
            raise InvalidText(f"'{name}' is no function: of a run there are {words}")
        return ast.Call(ast.Name(name), [self.visit(argument) for argument in node.args], node.keywords)

    def _named(self, node: ast.Name | ast.Attribute) -> ast.expr:
        whole = dotted(node)
        name = whole.removeprefix("end.")
        name = _SHORT.get(name, name)
        own = self._owner(name)
        if not own and (own := self._owner(whole)):  # a body that is called end
            name = whole
        which, _, column = name.partition(".")
        if which in _WHICH and own == which:
            raise InvalidText(f"'{name}': an entity is called {which} as well; give it another id")
        if which in _WHICH and not own and column not in _IMPACTS:
            raise InvalidText(f"'{name}': an impact has {', '.join(_IMPACTS)}")
        if own:
            column = name.removeprefix(f"{own}.")
            name = f"{own}.{_PARTS.get(column, column)}"
        return ast.Name(name)

    def _owner(self, name: str) -> str:
        """Return the longest id that a name begins with; empty if none."""
        return max((one for one in self._ids if name.startswith(f"{one}.")), key=len, default="")


def _is_of_impact(name: str) -> bool:
    """Whether a name is that of a quantity of the first or the last impact, as ``first_impact.x``."""
    which, _, column = name.partition(".")
    return which in _WHICH and column in _IMPACTS


def _impact_columns(ends: NDArray[Any]) -> dict[str, list[float]]:
    """Return the quantities of the first and the last impact (n, 2) of runs, by their names."""
    found: dict[str, list[float]] = {}
    for which, records in zip(_WHICH, ends.T, strict=True):
        derived = read_impacts(records)
        columns = (records["time"], records["x"], records["y"], -derived.vn_before, derived.energy_lost)
        found |= {f"{which}.{name}": each.tolist() for name, each in zip(_IMPACTS, columns, strict=True)}
    return found


class _Impacts:
    """The first and the last impact of a run, as names of expressions."""

    def __init__(self, found: Mapping[str, float]) -> None:
        self._found = found

    def named(self, name: str) -> Quantity | None:
        if not _is_of_impact(name):
            return None
        return Quantity(self._found.get(name, math.nan), _IMPACTS[name.partition(".")[2]], True)

    def called(self, name: str, arguments: list[ast.expr], whole: Expression) -> Quantity | None:
        return None


class Measures:
    """The measures of one world's runs.

    Parameters
    ----------
    world : World
        Whose runs.
    given : mapping of str to str or callable
        The measures by what their columns are called.

    Attributes
    ----------
    needs_path : bool
        Whether one of them looks at the whole run, which is sampled then after each step.
    of_impacts : bool
        Whether one is of the first or the last impact.

    Raises
    ------
    SceneError
        If one cannot be computed.
    """

    def __init__(self, world: World, given: Mapping[str, Measure]) -> None:
        self._world, self._functions = world, {}
        self._expressions: dict[str, Expression] = {}
        ids = list(entity_names(world))
        for name, measure in given.items():
            if callable(measure):
                self._functions[name] = _importable(name, measure)
                continue
            try:
                self._expressions[name] = parsed(measure, ids)
            except InvalidText as error:
                raise SceneError(f"measure {shown(measure)}: {error}") from error
        self._names = list(given)
        path = {name for name, expression in self._expressions.items() if _looks_back(expression)}
        self.needs_path = bool(path)
        self._path = _quantities(self._expressions[name] for name in path)
        self._end = _quantities(self._expressions[name] for name in self._expressions.keys() - path)
        self._on_path = path
        self._since, named = 0, (name for one in self._expressions.values() for name in one.names())
        self.of_impacts = any(map(_is_of_impact, named))
        world.contacts.read |= self.of_impacts or self.needs_path
        self.units = {name: self._tried(name) for name in self._names}
        self._record, self._ends = Record(world, self._path), Record(world, self._end)

    def begin(self) -> None:
        """Note the beginning of a run."""
        self._since = self._world.contacts.logged
        self._record.clear()
        self.sample()

    def sample(self) -> None:
        """Sample the run, where a measure looks at all of it."""
        if self.needs_path:
            self._record.add()

    @property
    def path_is_motion(self) -> bool:
        """Whether some measure looks at the whole run, and at nothing but the motion of bodies there."""
        return self.needs_path and self._motion(self._record) is not None

    @property
    def read_at_end(self) -> list[tuple[int, str]] | None:
        """Entities and what is read of their motion at the end, where no measure needs more than impacts."""
        return None if self._functions or self.needs_path else self._motion(self._ends)

    def _motion(self, record: Record) -> list[tuple[int, str]] | None:
        """Return the entities that move, and what of their motion, that are all of a record's columns."""
        ids = {self._world.label(entity): entity for entity in self._world.entities()}
        found: list[tuple[int, str]] = []
        for name in record.columns:
            body, _, quantity = name.rpartition(".")
            if name == COLLISIONS and record is self._ends:
                found.append((0, quantity))
                continue
            if quantity not in MOTION or body not in ids:
                return None
            if not all(self._world.has(ids[body], kind) for kind in (Transform, Velocity)):
                return None
            found.append((ids[body], quantity))
        return found

    def take(self, run: Run) -> None:
        """Take the samples of a run that was recorded."""
        if self.needs_path:
            self._record.take(
                run.times.tolist(), [run.columns[name].tolist() for name in self._record.columns]
            )

    def values_at(
        self, time: float, ends: NDArray[np.float64], impacts: NDArray[Any]
    ) -> Iterator[tuple[list[float], str]]:
        """Yield the measures of runs that ended at a time [s], and why one is NaN.

        Parameters
        ----------
        time : float
            The time of the world.
        ends : float64 array (n, quantities)
            Readings at the end, in the order of ``read_at_end``.
        impacts : array of IMPACT (n, 2)
            The first and the last of each run.
        """
        columns = _impact_columns(impacts) if self.of_impacts else {}
        for number, read in enumerate(ends.tolist()):
            self._ends.take([time], [[value] for value in read])
            yield self._evaluated(_Impacts({name: column[number] for name, column in columns.items()}))

    def values(self) -> tuple[list[float], str]:
        """Return the measures of the run that has ended [SI], and why one of them is NaN."""
        self._ends.clear()
        self._ends.add()
        found = _impact_columns(first_and_last(self._world, self._since)[None]) if self.of_impacts else {}
        return self._evaluated(_Impacts({name: value for name, (value,) in found.items()}))

    def _evaluated(self, impacts: _Impacts) -> tuple[list[float], str]:
        path, end = Figures(self._record, impacts), Figures(self._ends, impacts)
        found, why = [], ""
        for name in self._names:
            if name in self._functions:
                found.append(float(self._functions[name](self._world)))
                continue
            scope = path if name in self._on_path else end
            try:
                found.append(self._expressions[name].value(scope).value)
            except Undefined as error:
                found.append(math.nan)
                why = why or f"measure {name}: {error}"
        return found, why

    def _tried(self, name: str) -> str:
        """Return the unit of a measure, tried on samples that are all alike: no run is made for it."""
        if name in self._functions:
            return ""
        expression = self._expressions[name]
        record = Record(self._world, _quantities((expression,)))
        record.times = [self._world.time + number for number in range(_TRIAL)]
        record.columns = {column: [1.0] * _TRIAL for column in record.columns}
        record.end = record.times[-1]
        try:
            quantity = expression.value(Figures(record, _Impacts({})))
        except Undefined:
            return ""
        except InvalidText as error:
            raise SceneError(f"measure {shown(expression.text)}: {error}") from error
        return in_words(quantity.dimension) if quantity.has_unit else ""


def _importable(name: str, function: Callable[[World], float]) -> Callable[[World], float]:
    """Return a function that other processes can import."""
    try:
        pickle.dumps(function)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        words = "must be an expression, or a function of a module: another process imports it by its name"
        raise SceneError(f"measure {shown(name)}: {words}") from error
    return function


def _looks_back(expression: Expression) -> bool:
    calls = (node for node in ast.walk(expression.node) if isinstance(node, ast.Call))
    return any(dotted(call.func) in FUNCTIONS for call in calls)


def _quantities(expressions: Iterable[Expression]) -> list[str]:
    names = dict.fromkeys(name for one in expressions for name in one.names())
    return [name for name in names if name not in ("time", *FUNCTIONS) and not _is_of_impact(name)]
