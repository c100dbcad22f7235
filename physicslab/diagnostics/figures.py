"""The figures that expressions read from the samples of a run.

Samples are taken after each step. Between them a quantity is the polynomial through six samples around it
that lie on one curve, so that a moment is not bound to steps: the error is of the sixth power of a step. An
impact ends a curve: what it moves has two values at its moment, those of the curves before and after. Where
few samples are between two impacts, a curve goes through these and the values that the log of impacts has.
"""

from __future__ import annotations

import ast
import bisect
import itertools
import math
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from physicslab.diagnostics.samples import COLLISIONS, Record
from physicslab.ecs.conditions import Comparison, comparison, difference
from physicslab.ecs.quantity_text import Expression, InvalidText, Quantity, Scope, Undefined, dotted, in_words

AROUND, _FEW = 6, 4
"""Samples that an interpolation goes through, and where no six of them lie on one curve."""
_ROUGH, _BENDS = 0.5, 2.0
"""The largest fourth difference of six samples on one curve, as a share of the second and third ones: across
an impact it is 1 to 3, of an oscillation 0.5 at nine samples a period. Of four samples, the largest ratio of
the second differences."""
_ROUNDED = 1e-12
"""Share of the largest value below which differences are rounding."""
_NEAR = 1e-3
"""Share of a step by which a sample must be away from an impact to be a point of a curve beside it."""
_HALVINGS = 60
"""How often an interval is halved in which a moment is."""
_SAME = 1e-9
"""Share by which values on both sides of an impact differ at most that are treated as the same."""
_SECOND = Quantity(1.0, (0, 0, 1, 0), True)


class Limit(NamedTuple):
    """The moment of an impact [s], just before or just after it."""

    time: float
    after: bool


type Instant = int | float | Limit
"""A sample by its number, a time [s], or one side of an impact."""


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
    now : Instant, optional
        When quantities are read; at the end where absent.
    """

    def __init__(self, record: Record, parameters: Scope | None = None, now: Instant | None = None) -> None:
        self.record, self.parameters = record, parameters
        self.now = record.end if now is None else now

    def named(self, name: str) -> Quantity | None:
        """Return the value of a parameter, of a quantity, or the ``time``."""
        if name == "time":
            return Quantity(self.time_of(self.now), _SECOND.dimension, True)
        if name not in self.record.columns:
            return None if self.parameters is None else self.parameters.named(name)
        value = self.record.columns[name][self.now] if isinstance(self.now, int) else self._between(name)
        return Quantity(value, self.record.dimensions[name], name != COLLISIONS)

    def time_of(self, instant: Instant) -> float:
        """Return the time of an instant [s]."""
        if isinstance(instant, int):
            return self.record.times[instant]
        return instant.time if isinstance(instant, Limit) else instant

    def called(self, name: str, arguments: list[ast.expr], whole: Expression) -> Quantity | None:
        """Return the value of a function of the run; ``None`` where there is none of that name."""
        function = _FUNCTIONS.get(name)
        if function is None:
            return None
        least, most, read = function
        if not least <= len(arguments) <= most:
            raise InvalidText(f"{name} takes {least}{'' if least == most else f' or {most}'} parts")
        return read(self, *(Expression(whole.text, argument) for argument in arguments))

    def at(self, now: Instant) -> Figures:
        """Return the figures of the same run at another instant."""
        return Figures(self.record, self.parameters, now)

    def series(self, expression: Expression) -> list[float]:
        """Return an expression's value at each sample [SI]."""
        name = dotted(expression.node)
        if name in self.record.columns and not (self.parameters and self.parameters.named(name)):
            return self.record.columns[name][: len(self.record.samples)]
        return [expression.value(self.at(sample)).value for sample in self.record.samples]

    def instants(self, names: Iterable[str], end: float) -> list[Instant]:
        """Return what is looked at of a run until an ``end`` [s]: samples, and impacts on what has names."""
        record = self.record
        samples = bisect.bisect_right(record.times, end)
        cuts = {time for name in names for time in record.breaks.get(name, ()) if time <= end}
        sides = ((time, after, Limit(time, bool(after))) for time in cuts for after in (0, 1))
        merged: list[tuple[float, int, Instant]] = [
            *((record.times[sample], 2, sample) for sample in range(samples)), *sides
        ]  # fmt: skip
        if cuts:
            merged.sort(key=lambda one: one[:2])
        if record.times[samples - 1] < end:
            merged.append((end, 2, end))
        return [instant for _, _, instant in merged]

    def course(self, expression: Expression) -> tuple[list[Instant], list[float]]:
        """Return the instants until the end of the run, and an expression's value at each [SI].

        There is one of an impact through which the value stays.
        """
        instants: list[Instant] = []
        values: list[float] = []
        for instant in self.instants(expression.names(), self.record.end):
            value = expression.value(self.at(instant)).value
            is_same = bool(instants) and self.time_of(instants[-1]) == self.time_of(instant)
            if not (is_same and math.isclose(values[-1], value, rel_tol=_SAME)):
                instants.append(instant)
                values.append(value)
        return instants, values

    def moment(self, margin: Callable[[Figures], float], names: Iterable[str], number: int = 1) -> float:
        """Return when a margin of ``names`` becomes positive for the ``number``-th time [s]; NaN if never."""
        instants = self.instants(names, self.record.times[-1])
        signs = [margin(self.at(instant)) > 0.0 for instant in instants]
        for place in range(1, len(signs)):
            if signs[place] and not signs[place - 1]:
                number -= 1
                if not number:
                    return self.root(margin, *instants[place - 1 : place + 1])
        return math.nan

    def root(self, margin: Callable[[Figures], float], early: Instant, late: Instant) -> float:
        """Return when a margin becomes positive between two instants [s]."""
        before, after = self.time_of(early), self.time_of(late)
        for _ in range(_HALVINGS if before < after else 0):
            middle = 0.5 * (before + after)
            before, after = (before, middle) if margin(self.at(middle)) > 0.0 else (middle, after)
        return 0.5 * (before + after)

    def _between(self, name: str) -> float:
        """Return a quantity now, by Lagrange's polynomial through the samples around on one curve."""
        times, column, now = self.record.times, self.record.columns[name], self.now
        time, after = self.time_of(now), not isinstance(now, Limit) or now.after
        place = bisect.bisect_left(times, time)
        if after and place < len(times) and times[place] == time:
            return column[place]
        if not (times and times[0] <= time <= times[-1]):
            raise Undefined(f"the run has no time {time:.6g} s")
        return _polynomial(self._points(name, time, place, after=after), time)

    def _points(self, name: str, time: float, place: int, *, after: bool) -> list[tuple[float, float]]:
        """Return times and values on a curve around a time [s], between the impacts before and behind it."""
        times, column = self.record.times, self.record.columns[name]
        breaks, sides = self.record.breaks.get(name, []), self.record.sides.get(name, {})
        k = (bisect.bisect_right if after else bisect.bisect_left)(breaks, time)
        first = bisect.bisect_left(times, breaks[k - 1]) if k else 0
        stop = bisect.bisect_left(times, breaks[k]) if k < len(breaks) else len(times)
        nodes: Sequence[int] = range(first, stop)
        if not breaks or len(nodes) >= _FEW:
            nodes = self._curve(column, place, range(first, stop))
            return [(times[i], column[i]) for i in nodes]
        ends = [
            (breaks[i], sides[breaks[i]][i < k])
            for i in (k - 1, k)
            if 0 <= i < len(breaks) and breaks[i] in sides
        ]
        near = _NEAR * (times[1] - times[0])
        between = [(times[i], column[i]) for i in nodes if all(abs(times[i] - t) > near for t, _ in ends)]
        if len(ends) + len(between) > 1:
            return ends + between
        place = max(bisect.bisect_left(times, time), 1)
        return [(times[i], column[i]) for i in (nodes if len(nodes) > 1 else range(place - 1, place + 1))]

    def _curve(self, column: Sequence[float], place: int, piece: range) -> range:
        """Return the samples of a piece on one curve with that at a place and the one before, or the nearest.

        They are the two nearest where there is no such curve.
        """
        left, right = max(place - 1, piece.start), min(place, piece.stop - 1)
        for count in (AROUND, _FEW):
            starts = range(max(right - count + 1, piece.start), min(left, piece.stop - count) + 1)
            middle = place - count // 2
            for first in sorted(starts, key=lambda first: abs(first - middle)):
                nodes = range(first, first + count)
                if self._is_one_curve(column, nodes):
                    return nodes
        if len(piece) < _FEW:
            return piece
        first = min(max(place - 1, piece.start), piece.stop - 2)
        return range(first, first + 2)

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

    def extreme(self, expression: Expression, near: Sequence[Instant], sign: float) -> float:
        """Return the greatest value on the curves between instants, the least for a ``sign`` of -1."""

        def value(instant: Instant) -> float:
            return sign * expression.value(self.at(instant)).value

        best = max(map(value, near))
        for early, late in itertools.pairwise(near):
            low, high = self.time_of(early), self.time_of(late)
            for _ in range(_HALVINGS if low < high else 0):
                third = (high - low) / 3.0
                left, right = low + third, high - third
                low, high = (left, high) if value(left) < value(right) else (low, right)
            best = max(best, value(0.5 * (low + high)) if low < high else best)
        return sign * best


def _polynomial(points: Sequence[tuple[float, float]], time: float) -> float:
    """Return the value at a time [s] of Lagrange's polynomial through points: times and values."""
    total = 0.0
    for i, (t, value) in enumerate(points):
        weight = 1.0
        for j, (other, _) in enumerate(points):
            if j != i:
                weight *= (time - other) / (t - other)
        total += weight * value
    return total


def _like(of: Figures, expression: Expression, value: float) -> Quantity:
    usual = expression.value(of.at(0))
    return Quantity(value, usual.dimension, usual.has_unit)


def _start(of: Figures, expression: Expression) -> Quantity:
    return expression.value(of.at(0))


def _greatest(of: Figures, expression: Expression, sign: float = 1.0) -> Quantity:
    instants, values = of.course(expression)
    place = max(range(len(values)), key=lambda i: sign * values[i])
    return _like(of, expression, of.extreme(expression, instants[max(place - 1, 0) : place + 2], sign))


def _least(of: Figures, expression: Expression) -> Quantity:
    return _greatest(of, expression, -1.0)


def _mean(of: Figures, expression: Expression) -> Quantity:
    """Return the mean over time, by Simpson's rule on the curves between samples."""
    instants, values = of.course(expression)
    times, area = [of.time_of(instant) for instant in instants], 0.0
    for i, (early, late) in enumerate(itertools.pairwise(times)):
        if early < late:
            middle = expression.value(of.at(0.5 * (early + late))).value
            area += (late - early) / 6.0 * (values[i] + 4.0 * middle + values[i + 1])
    return _like(of, expression, area / (times[-1] - times[0]))


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
    time = of.moment(lambda figures: difference(compared, figures), condition.names(), n)
    if math.isnan(time):
        raise Undefined(f"'{condition.text}': that does not happen {n} times within the run")
    return Quantity(time, _SECOND.dimension, True)


def _count(of: Figures, condition: Expression) -> Quantity:
    compared: Comparison = comparison(condition)
    instants = of.instants(condition.names(), of.record.end)
    signs = [difference(compared, of.at(instant)) > 0.0 for instant in instants]
    return Quantity(float(sum(now and not before for before, now in itertools.pairwise(signs))))


def _peak(of: Figures, number: Expression, expression: Expression) -> Quantity:
    (instants, values), n = of.course(expression), round(number.value(of).value)
    peaks = [i for i in range(1, len(values) - 1) if values[i - 1] < values[i] >= values[i + 1]]
    if not 1 <= n <= len(peaks):
        raise Undefined(f"'{expression.text}': the run has {len(peaks)} peaks, not {n}")
    peak = peaks[n - 1]
    return _like(of, expression, of.extreme(expression, instants[peak - 1 : peak + 2], 1.0))


def _period(of: Figures, expression: Expression) -> Quantity:
    """Return the mean time from one crossing of zero upwards to the next."""
    instants, values = of.course(expression)
    ups = [i for i in range(1, len(values)) if values[i - 1] <= 0.0 < values[i]]
    if len(ups) < 2:
        raise Undefined(
            f"'{expression.text}': it crosses zero upwards fewer than twice within the run; of a motion "
            "about another place the mean is to be taken away: period(ball.x - mean(ball.x))"
        )
    first, last = (
        of.root(lambda figures: expression.value(figures).value, *instants[up - 1 : up + 1])
        for up in (ups[0], ups[-1])
    )
    return Quantity((last - first) / (len(ups) - 1), _SECOND.dimension, True)


_FUNCTIONS: dict[str, tuple[int, int, Callable[..., Quantity]]] = {
    "start": (1, 1, _start), "greatest": (1, 1, _greatest), "least": (1, 1, _least),
    "mean": (1, 1, _mean), "slope": (1, 1, _slope), "at": (2, 2, _at), "when": (1, 2, _when),
    "count": (1, 1, _count), "peak": (2, 2, _peak), "period": (1, 1, _period),
}  # fmt: skip
"""The functions of a run, with how many expressions they take."""
FUNCTIONS = frozenset(_FUNCTIONS)
