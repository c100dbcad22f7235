"""Runs as samples, and the figures that expressions read from them.

Samples are taken after each step. Between them a quantity is the polynomial through six samples around it
that lie on one curve, so that a moment is not bound to steps: the error is of the sixth power of a step. An
impact ends a curve: through it no polynomial leads, and within its step there is a straight line.
"""

from __future__ import annotations

import ast
import bisect
import itertools
import math
import re
from collections.abc import Callable, Iterable, Sequence
from keyword import iskeyword

from physicslab.components.quantities import QUANTITIES, carrier_of, why_not_of
from physicslab.diagnostics.quantities import Reading
from physicslab.ecs.conditions import Comparison, comparison, difference
from physicslab.ecs.quantity_text import (
    Expression,
    InvalidText,
    Quantity,
    Scope,
    Undefined,
    dotted,
    in_words,
)
from physicslab.ecs.text import suggestion
from physicslab.world import World

AROUND, _FEW = 6, 4
"""Samples that an interpolation goes through, and where no six of them lie on one curve."""
_ROUGH, _BENDS = 0.5, 2.0
"""The largest fourth difference of six samples on one curve, as a share of the second and third ones: across
an impact it is 1 to 3, of an oscillation 0.5 at nine samples a period. Of four samples, the largest ratio of
the second differences."""
_ROUNDED = 1e-12
"""Share of the largest value below which differences are rounding."""
_LISTED = 20
"""Names of entities that a refusal lists."""
_HALVINGS = 60
"""How often an interval is halved in which a moment is."""
_SECOND = Quantity(1.0, (0, 0, 1, 0), True)
COLLISIONS = "world.collisions"
"""The number of impacts since the run began."""
_NAMES = {quantity.column.replace(" ", "_"): name for name, quantity in QUANTITIES.items()}
"""Quantities as expressions call them: ``vx``, ``kinetic``, ``energy``."""


def quoted(text: str, ids: Iterable[str]) -> str:
    """Return an expression or a condition with quotes around ids of entities that are no plain words.

    >>> quoted("box 2.y < 2 box 10.y", ["box", "box 2", "box 10"])
    '"box 2".y < 2 "box 10".y'
    """
    odd = sorted((one for one in ids if not _is_word(one)), key=len, reverse=True)
    either = "|".join(map(re.escape, odd))
    return re.sub(rf'(?<![\w."])({either})(?=\.[^\W\d])', r'"\1"', text) if odd else text


def _is_word(name: str) -> bool:
    return name.isidentifier() and not iskeyword(name)


def quantity_of(name: str, ids: Iterable[str]) -> tuple[str | None, str]:
    """Return the entity and the quantity that ``ball.x`` stands for; ``None`` for the world.

    Raises
    ------
    InvalidText
        If there is none such; with the names that there are.
    """
    known = [*ids, "world"]
    entity = max((one for one in known if name.startswith(f"{one}.")), key=len, default="")
    if not entity:
        words = ", ".join(one if _is_word(one) else f'"{one}"' for one in known[:_LISTED])
        more = (", ..." if len(known) > _LISTED else "") + suggestion(name.rpartition(".")[0] or name, known)
        raise InvalidText(f"'{name}' is no quantity: must begin with one of {words}{more}")
    column = name[len(entity) + 1 :]
    body = None if entity == "world" else 1
    if name != COLLISIONS and (column not in _NAMES or why_not_of(_NAMES[column], body) is not None):
        raise InvalidText(f"'{name}' is no quantity: {entity} has {', '.join(columns(body))}")
    return (None if body is None else entity), _NAMES.get(column, column)


def columns(body: int | None) -> dict[str, str]:
    """Return the quantities of a body, or of the world for ``None``, by what expressions call them."""
    return {
        short: long
        for short, long in _NAMES.items()
        if why_not_of(long, body) is None and ":" not in long and carrier_of(long) == "Transform"
    }


def unit_of(name: str) -> str:
    """Return the SI unit of ``ball.x``."""
    return "1" if name == COLLISIONS else QUANTITIES[_NAMES[name.rpartition(".")[2]]].unit


class Record:
    """Samples of a run: times [s], and the values of quantities [SI], each as many.

    Parameters
    ----------
    world : World
        The world that is recorded; it may go on between samples.
    names : iterable of str
        Quantities of it, as ``ball.x``.

    Attributes
    ----------
    end : float
        When the run ends [s]; samples after that serve to interpolate before it.
    """

    def __init__(self, world: World, names: Iterable[str]) -> None:
        ids = {world.label(entity): entity for entity in world.entities()}
        self._world = world
        self.end = world.time
        self.times: list[float] = []
        self.columns: dict[str, list[float]] = {name: [] for name in names}
        self._sources = []
        for name in self.columns:
            entity, quantity = quantity_of(name, ids)
            self._sources.append((quantity, None if entity is None else ids[entity]))
        self.dimensions = {name: Expression(unit_of(name)).value().dimension for name in self.columns}

    @property
    def samples(self) -> range:
        """Those until the end."""
        return range(bisect.bisect_right(self.times, self.end))

    def clear(self) -> None:
        """Forget all samples, for another run of the same world."""
        self.times.clear()
        for column in self.columns.values():
            column.clear()

    def take(self, times: list[float], columns: Iterable[list[float]]) -> None:
        """Take samples from elsewhere: times [s], and as many values of each column [SI]."""
        self.end, self.times = times[-1], times
        self.columns = dict(zip(self.columns, columns, strict=True))

    def add(self) -> None:
        """Take a sample of the world as it is now."""
        self.end = self._world.time
        self.times.append(self.end)
        if not self._sources:
            return
        reading = Reading(self._world)
        for column, (quantity, body) in zip(self.columns.values(), self._sources, strict=True):
            value = self._world.collisions if quantity == "collisions" else reading.value(quantity, body)
            column.append(float(value))


class Figures:
    """The figures of a run: the scope in which expressions are evaluated, as those of lessons are.

    A quantity by its name is that at the end of the run. Functions of expressions look at all of it:
    ``start``, ``greatest``, ``least``, ``mean``, ``slope``, ``at(time, E)``, ``when(a < b[, n])``,
    ``peak(n, E)``, ``period(E)`` and ``count(a < b)``.

    Parameters
    ----------
    record : Record
        The samples.
    parameters : Scope, optional
        Values that have names.
    now : float or int, optional
        At which time [s], or at which sample, quantities are read; at the end where absent.
    """

    def __init__(
        self, record: Record, parameters: Scope | None = None, now: float | int | None = None
    ) -> None:
        self.record, self.parameters = record, parameters
        self.now = record.end if now is None else now

    def named(self, name: str) -> Quantity | None:
        """Return the value of a parameter, of a quantity, or the ``time``."""
        column = self.record.times if name == "time" else self.record.columns.get(name)
        if column is None:
            return None if self.parameters is None else self.parameters.named(name)
        dimension = _SECOND.dimension if name == "time" else self.record.dimensions[name]
        value = column[self.now] if isinstance(self.now, int) else self.between(column, self.now)
        return Quantity(value, dimension, name != COLLISIONS)

    def called(self, name: str, arguments: list[ast.expr], whole: Expression) -> Quantity | None:
        """Return the value of a function of the run; ``None`` where there is none of that name."""
        function = _FUNCTIONS.get(name)
        if function is None:
            return None
        least, most, read = function
        if not least <= len(arguments) <= most:
            raise InvalidText(f"{name} takes {least}{'' if least == most else f' or {most}'} parts")
        return read(self, *(Expression(whole.text, argument) for argument in arguments))

    def at(self, now: float | int) -> Figures:
        """Return the figures of the same run at another time [s], or sample."""
        return Figures(self.record, self.parameters, now)

    def series(self, expression: Expression) -> list[float]:
        """Return an expression's value at each sample [SI]."""
        name = dotted(expression.node)
        if name in self.record.columns and not (self.parameters and self.parameters.named(name)):
            return self.record.columns[name][: len(self.record.samples)]
        return [expression.value(self.at(sample)).value for sample in self.record.samples]

    def moment(self, margin: Callable[[Figures], float], number: int = 1) -> float:
        """Return when a margin becomes positive for the ``number``-th time [s]; NaN if it never does."""
        signs = [margin(self.at(sample)) > 0.0 for sample in range(len(self.record.times))]
        for sample in range(1, len(signs)):
            if signs[sample] and not signs[sample - 1]:
                number -= 1
                if not number:
                    return self._root(margin, sample)
        return math.nan

    def _root(self, margin: Callable[[Figures], float], sample: int) -> float:
        before, after = self.record.times[sample - 1 : sample + 1]
        for _ in range(_HALVINGS):
            middle = 0.5 * (before + after)
            before, after = (before, middle) if margin(self.at(middle)) > 0.0 else (middle, after)
        return 0.5 * (before + after)

    def between(self, column: Sequence[float], time: float) -> float:
        """Return the value of samples at a time [s], by Lagrange's polynomial through those around it."""
        times = self.record.times[: len(column)]
        place = bisect.bisect_left(times, time)
        if place < len(times) and times[place] == time:
            return column[place]
        if not (times and times[0] <= time <= times[-1]):
            raise Undefined(f"the run has no time {time:.6g} s")
        return self._through(self._curve(column, place), column, time)

    def _through(self, nodes: Sequence[int], column: Sequence[float], time: float) -> float:
        """Return the value at a time [s] of Lagrange's polynomial through some samples."""
        times, total = self.record.times, 0.0
        for i in nodes:
            weight = 1.0
            for j in nodes:
                if j != i:
                    weight *= (time - times[j]) / (times[i] - times[j])
            total += weight * column[i]
        return total

    def _curve(self, column: Sequence[float], place: int) -> range:
        """Return the samples on one curve with that at a place and the one before, the nearest if possible.

        They are these two where an impact is between them.
        """
        for count in (AROUND, _FEW):
            middle = place - count // 2
            for first in sorted(range(place - count + 1, place), key=lambda first: abs(first - middle)):
                nodes = range(first, first + count)
                if first >= 0 and nodes.stop <= len(column) and self._is_one_curve(column, nodes):
                    return nodes
        return range(len(column)) if len(column) < _FEW else range(place - 1, place + 1)

    def _is_one_curve(self, column: Sequence[float], nodes: range) -> bool:
        """Whether neighbouring samples lie on one smooth curve, as far as their differences tell."""
        times, values = self.record.times[nodes.start : nodes.stop], column[nodes.start : nodes.stop]
        step, orders = (times[-1] - times[0]) / (len(nodes) - 1), []
        for k in range(1, 5):  # divided differences, as equal steps would have them
            pairs = range(len(values) - 1)
            values = [k * step * (values[i + 1] - values[i]) / (times[i + k] - times[i]) for i in pairs]
            orders.append(values)
        rounding = _ROUNDED * max(map(abs, column[nodes.start : nodes.stop]))
        if len(nodes) == _FEW:
            least, most = sorted(orders[1], key=abs)
            return abs(most) <= rounding or 0.0 < least * most >= most * most / _BENDS
        bends = max(abs(value) for order in orders[1:3] for value in order)
        return max(map(abs, orders[3])) <= max(_ROUGH * bends, rounding)

    def extreme(self, series: Sequence[float], sample: int, sign: float) -> float:
        """Return the extreme value of samples near one of them, ``sign`` 1 for the greatest, -1 the least.

        It is that of the curves before and after the sample; at an impact, or at an end, often the sample.
        """
        best = sign * series[sample]
        for place in range(max(sample, 1), min(sample + 2, len(series))):
            nodes = self._curve(series, place)
            low, high = self.record.times[place - 1 : place + 1]
            for _ in range(_HALVINGS):
                third = (high - low) / 3.0
                left, right = (self._through(nodes, series, time) for time in (low + third, high - third))
                low, high = (low + third, high) if sign * left < sign * right else (low, high - third)
            best = max(best, sign * self._through(nodes, series, 0.5 * (low + high)))
        return sign * best


def _like(of: Figures, expression: Expression, value: float) -> Quantity:
    usual = expression.value(of.at(0))
    return Quantity(value, usual.dimension, usual.has_unit)


def _start(of: Figures, expression: Expression) -> Quantity:
    return expression.value(of.at(0))


def _greatest(of: Figures, expression: Expression, sign: float = 1.0) -> Quantity:
    series = of.series(expression)
    sample = max(range(len(series)), key=lambda i: sign * series[i])
    return _like(of, expression, of.extreme(series, sample, sign))


def _least(of: Figures, expression: Expression) -> Quantity:
    return _greatest(of, expression, -1.0)


def _mean(of: Figures, expression: Expression) -> Quantity:
    times, series = of.record.times, of.series(expression)
    span = times[len(series) - 1] - times[0]
    areas = (0.5 * (series[i] + series[i + 1]) * (times[i + 1] - times[i]) for i in range(len(series) - 1))
    return _like(of, expression, sum(areas) / span)


def _slope(of: Figures, expression: Expression) -> Quantity:
    """Return the slope of the line of least squares through all samples."""
    series = of.series(expression)
    times = of.record.times[: len(series)]
    middle, mean = sum(times) / len(times), sum(series) / len(series)
    above = sum((t - middle) * (value - mean) for t, value in zip(times, series, strict=True))
    usual = _like(of, expression, above / sum((t - middle) ** 2 for t in times))
    length, mass, time, charge = usual.dimension
    return Quantity(usual.value, (length, mass, time - 1, charge), True)


def _at(of: Figures, time: Expression, expression: Expression) -> Quantity:
    when = time.value(of)
    if when.has_unit and when.dimension != _SECOND.dimension:
        raise InvalidText(f"'{time.text}': the time is in {in_words(when.dimension)}; must be in s")
    return expression.value(of.at(when.value))


def _when(of: Figures, condition: Expression, number: Expression | None = None) -> Quantity:
    compared, n = comparison(condition), 1 if number is None else round(number.value(of).value)
    time = of.moment(lambda figures: difference(compared, figures), n)
    if math.isnan(time):
        raise Undefined(f"'{condition.text}': that does not happen {n} times within the run")
    return Quantity(time, _SECOND.dimension, True)


def _count(of: Figures, condition: Expression) -> Quantity:
    compared: Comparison = comparison(condition)
    signs = [difference(compared, of.at(i)) > 0.0 for i in of.record.samples]
    return Quantity(float(sum(now and not before for before, now in itertools.pairwise(signs))))


def _peak(of: Figures, number: Expression, expression: Expression) -> Quantity:
    series, n = of.series(expression), round(number.value(of).value)
    peaks = [i for i in range(1, len(series) - 1) if series[i - 1] < series[i] >= series[i + 1]]
    if not 1 <= n <= len(peaks):
        raise Undefined(f"'{expression.text}': the run has {len(peaks)} peaks, not {n}")
    return _like(of, expression, of.extreme(series, peaks[n - 1], 1.0))


def _period(of: Figures, expression: Expression) -> Quantity:
    """Return the mean time from one crossing of zero upwards to the next."""
    series = of.series(expression)
    ups = [i for i in range(1, len(series)) if series[i - 1] <= 0.0 < series[i]]
    if len(ups) < 2:
        raise Undefined(
            f"'{expression.text}': it crosses zero upwards fewer than twice within the run; of a motion "
            "about another place the mean is to be taken away: period(ball.x - mean(ball.x))"
        )
    first, last = (of._root(lambda figures: expression.value(figures).value, i) for i in (ups[0], ups[-1]))
    return Quantity((last - first) / (len(ups) - 1), _SECOND.dimension, True)


_FUNCTIONS: dict[str, tuple[int, int, Callable[..., Quantity]]] = {
    "start": (1, 1, _start), "greatest": (1, 1, _greatest), "least": (1, 1, _least),
    "mean": (1, 1, _mean), "slope": (1, 1, _slope), "at": (2, 2, _at), "when": (1, 2, _when),
    "count": (1, 1, _count), "peak": (2, 2, _peak), "period": (1, 1, _period),
}  # fmt: skip
"""The functions of a run, with how many expressions they take."""
FUNCTIONS = frozenset(_FUNCTIONS)
