"""When bodies cross light gates."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Gate, Transform, Velocity
from physicslab.state.attached import let_go_of_removed, points_of
from physicslab.state.state import State
from physicslab.systems.system import Stage, System, at
from physicslab.systems.within_step import StepPath

__all__ = ["LIMIT", "Crossing", "GateSystem"]

LIMIT = 500
"""Crossings that are kept; the oldest go first."""
_WIDTH = 1e-5
"""Half the width of a gate as a share of its length: a body has crossed it once it is out on the other side,
so that one that comes to rest on it, or trembles there, is not counted again and again."""
_SAMPLES = 8
"""Parts of a step in each of which a path crosses a gate at most once."""
_HALVINGS = 52
"""After so many a moment within a step is as exact as its number can be."""

type _Numbers = NDArray[np.float64]
type _Whole = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Crossing:
    """A body's centre went through a gate.

    Attributes
    ----------
    time : float
        When [s].
    gate, body : int
        The entities.
    direction : int
        1 where it came out at the left of the line from the gate's start to its end, else -1.
    speed : float
        How fast the body was then [m/s].
    """

    time: float
    gate: int
    body: int
    direction: int
    speed: float


@dataclass(slots=True)
class _Moment:
    """Where bodies and gates are at the beginning or the end of a step, and how fast they are.

    Attributes
    ----------
    body, body_velocity : float64 arrays (n, 2)
    start, end, start_velocity, end_velocity : float64 arrays (g, 2)
        Of the ends of gates.
    distance, width : float64 arrays (g, n), (g, 1)
        How far each body is to the left of each gate's line [m], NaN of one without length; and from which
        distance on it is out of the gate [m].
    """

    body: _Numbers
    body_velocity: _Numbers
    start: _Numbers
    start_velocity: _Numbers
    end: _Numbers
    end_velocity: _Numbers
    distance: _Numbers = field(init=False)
    width: _Numbers = field(init=False)

    def __post_init__(self) -> None:
        way = self.end - self.start
        self.width = _WIDTH * np.hypot(way[:, 0], way[:, 1])[:, None]
        self.distance = self._to_the_left(self.body[None] - self.start[:, None])

    @property
    def rate(self) -> _Numbers:
        """How fast each body goes to the left of each gate (g, n) [m/s], but for the gate's turning."""
        return self._to_the_left(self.body_velocity[None] - self.start_velocity[:, None])

    def _to_the_left(self, vectors: _Numbers) -> _Numbers:
        way = self.end - self.start
        with np.errstate(divide="ignore", invalid="ignore"):
            unit = way / np.hypot(way[:, 0], way[:, 1])[:, None]
        part: _Numbers = unit[:, 0, None] * vectors[..., 1] - unit[:, 1, None] * vectors[..., 0]
        return part


class _Passage:
    """The paths of bodies and gates through a step."""

    def __init__(self, before: _Moment, after: _Moment, h: float) -> None:
        self.body = StepPath.between(before.body, after.body, before.body_velocity, after.body_velocity, h)
        self.start, self.end = (
            StepPath.between(*places, *velocities, h)
            for places, velocities in (
                ((before.start, after.start), (before.start_velocity, after.start_velocity)),
                ((before.end, after.end), (before.end_velocity, after.end_velocity)),
            )
        )

    def offsets(self, gate: _Whole, body: _Whole, share: _Numbers) -> tuple[_Numbers, _Numbers]:
        """Return how far bodies are to the left of gates [m], and along them as a share, after a share."""
        start = self.start.at(gate, share)
        way, offset = self.end.at(gate, share) - start, self.body.at(body, share) - start
        length = np.hypot(way[:, 0], way[:, 1])
        across = (way[:, 0] * offset[:, 1] - way[:, 1] * offset[:, 0]) / length
        return across, np.einsum("ij,ij->i", way, offset) / length**2

    def moments(self, gate: _Whole, body: _Whole, low: _Numbers, high: _Numbers) -> _Numbers:
        """Return after which shares of the step bodies are on gates' lines, once between two shares each."""
        left = self.offsets(gate, body, low)[0] > 0.0
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            before = (self.offsets(gate, body, middle)[0] > 0.0) == left
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        return 0.5 * (low + high)


class GateSystem(System):
    """Records which body's centre crosses which :class:`Gate`, and when: the moment is found within the step.

    A body that was on one side of a gate and is now out on the other has crossed it, at the moment at which
    its path last went through the line (:class:`physicslab.systems.within_step.StepPath`). One that is moved
    by an edit crosses nothing. The record goes with the gate.

    Attributes
    ----------
    crossings : tuple of Crossing
        The last ones, in the order in which they were noted.
    count : int
        How many there have been, those that are not kept any more among them.
    """

    needs = (Gate,)

    def __init__(self) -> None:
        self.crossings: tuple[Crossing, ...] = ()
        self.count = 0
        self._gates = self._bodies = np.zeros(0, np.int64)
        self._gate_rows = self._body_rows = np.zeros(0, np.int64)
        self._side = np.zeros((0, 0), np.int8)  # 0: not known yet, as for one that was put on the gate
        self._pending: dict[tuple[int, int], Crossing | None] = {}
        self._before: _Moment | None = None
        self._kept: tuple[NDArray[Any], ...] = ()
        self._rows = np.zeros((0, 5))
        self._rows_of: tuple[Crossing, ...] = self.crossings

    def attach(self, state: State) -> None:
        """Follow the gates and the bodies there are; points that went with removed bodies stay where put."""
        let_go_of_removed(state)
        gates, bodies = state.batch(Gate), state.batch(Transform, Velocity)
        side = np.zeros((len(gates), len(bodies)), np.int8)
        g, n = np.isin(gates.entities, self._gates), np.isin(bodies.entities, self._bodies)
        side[np.ix_(g, n)] = self._side[
            np.ix_(
                np.searchsorted(self._gates, gates.entities[g]),
                np.searchsorted(self._bodies, bodies.entities[n]),
            )
        ]
        self._side = side
        self._gates, self._gate_rows = gates.entities, gates.rows
        self._bodies, self._body_rows = bodies.entities, bodies.rows
        self._before = None
        there = set(gates.entities.tolist())
        self.crossings = tuple(crossing for crossing in self.crossings if crossing.gate in there)
        self._pending = {pair: one for pair, one in self._pending.items() if pair[0] in there}

    def keep(self) -> tuple[NDArray[Any], ...]:
        """Return the record, and on which side of each gate each body is."""
        pending = [(*pair, one is not None, *_numbers(one)) for pair, one in sorted(self._pending.items())]
        if self._rows_of is not self.crossings:
            self._rows = np.array([_numbers(one) for one in self.crossings]).reshape(-1, 5)
            self._rows_of = self.crossings
        fresh: tuple[NDArray[Any], ...] = (
            np.array([self.count]), self._rows, np.array(pending, np.float64).reshape(-1, 8),
            self._gates, self._bodies, self._side,
        )  # fmt: skip
        same = len(self._kept) == len(fresh)
        self._kept = tuple(
            old if same and np.array_equal(old, new) else new.copy()
            for old, new in zip(self._kept if same else fresh, fresh, strict=True)
        )
        return self._kept

    def bring_back(self, kept: tuple[NDArray[Any], ...]) -> None:
        """Go on with an earlier record of the same gates and bodies."""
        count, rows, pending, self._gates, self._bodies, self._side = kept
        self.count = int(count[0])
        self.crossings = tuple(_crossing(row) for row in rows)
        self._pending = {(int(r[0]), int(r[1])): _crossing(r[3:]) if r[2] else None for r in pending}
        self._before = None

    @at(Stage.PREPARE)
    def begin(self, state: State, h: float) -> None:
        """Note where everything is at the beginning of the step, and on which side of the gates."""
        before = self._before = self._moment(state)
        self._side = _sides(before, self._side)
        if self._pending:
            self._drop_pending(before)
        if self.crossings and self.crossings[-1].time > state.time + h:  # the clock was set back
            self.crossings = tuple(one for one in self.crossings if one.time <= state.time)

    @at(Stage.FINISH)
    def record(self, state: State, h: float) -> None:
        """Note what was crossed within the step."""
        if self._before is None:
            return
        before, after = self._before, self._moment(state)
        side = _sides(after, self._side)
        through = (side != self._side) & (self._side != 0)
        on_line = (np.abs(after.distance) <= after.width) & (
            (before.distance > 0.0) != (after.distance > 0.0)
        )
        returns = self._may_return(before, after, h) & ~through
        gate, body = np.nonzero(through | on_line | returns)
        if len(gate):
            passage = _Passage(before, after, h)
            self._note(self._located(passage, gate, body, through[gate, body], after, state.time, h))
        self._side = side
        if self._pending:
            self._drop_pending(after)

    def _moment(self, state: State) -> _Moment:
        transform, velocity = state.table(Transform), state.table(Velocity)
        rows = self._body_rows
        start, end = (points_of(state, Gate, name, self._gate_rows) for name in Gate.POINTS)
        return _Moment(transform["position"][rows], velocity["linear"][rows], *start, *end)

    def _may_return(self, before: _Moment, after: _Moment, h: float) -> NDArray[np.bool_]:
        """Whether a body may have gone through a gate and come back within the step (g, n)."""
        leaving, arriving = before.rate, after.rate
        turns = (self._side * leaving < 0.0) & (self._side * arriving > 0.0)
        reaches = (np.abs(leaving) * h > np.abs(before.distance)) & (
            np.abs(arriving) * h > np.abs(after.distance)
        )
        return turns & reaches

    def _located(
        self,
        passage: _Passage,
        gate: _Whole,
        body: _Whole,
        through: NDArray[np.bool_],
        after: _Moment,
        time: float,
        h: float,
    ) -> list[Crossing]:
        """Return the crossings of these pairs of gates and bodies, as far as they are certain by now."""
        shares = np.linspace(0.0, 1.0, _SAMPLES + 1)
        across = np.stack([passage.offsets(gate, body, np.full(len(gate), s))[0] for s in shares], axis=1)
        pair, part = np.nonzero((across[:, 1:] > 0.0) != (across[:, :-1] > 0.0))
        moment = passage.moments(gate[pair], body[pair], shares[part], shares[part + 1])
        along = passage.offsets(gate[pair], body[pair], moment)[1]
        velocity = passage.body.velocity(body[pair], moment)
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
        beyond = (-self._side[gate, body][:, None] * across).max(axis=1) > after.width[gate, 0]
        found: list[Crossing] = []
        for k in range(len(gate)):
            key = int(self._gates[gate[k]]), int(self._bodies[body[k]])
            seen: list[Crossing | None] = [
                Crossing(
                    time + float(moment[m]) * h, *key, 1 if across[k, part[m]] <= 0.0 else -1, float(speed[m])
                )
                if 0.0 <= along[m] <= 1.0
                else None
                for m in np.flatnonzero(pair == k).tolist()
            ]
            if through[k]:
                last = seen[-1] if seen else self._pending.pop(key, None)
                found += [last] if last is not None else []
                self._pending.pop(key, None)
            elif len(seen) == 2:
                if not beyond[k]:
                    continue
                found += [one for one in seen if one is not None]
            elif seen:
                self._pending[key] = seen[-1]
        return found

    def _note(self, found: list[Crossing]) -> None:
        found.sort(key=lambda one: (one.time, one.gate, one.body))
        self.count += len(found)
        self.crossings = (*self.crossings, *found)[-LIMIT:]

    def _drop_pending(self, moment: _Moment) -> None:
        """Forget what went through the line of a gate and is out on the side that it came from."""
        for gate, body in list(self._pending):
            g, n = np.searchsorted(self._gates, gate), np.searchsorted(self._bodies, body)
            there = n < len(self._bodies) and self._bodies[n] == body
            if not there or abs(moment.distance[g, n]) > moment.width[g, 0]:
                del self._pending[gate, body]


def _sides(moment: _Moment, known: NDArray[np.int8]) -> NDArray[np.int8]:
    """Return on which side of each gate each body is; on the gate itself, where it was before."""
    distance, width = moment.distance, moment.width
    with np.errstate(invalid="ignore"):
        left, right = distance > width, distance < -width
    sides: NDArray[np.int8] = np.where(left, np.int8(1), np.where(right, np.int8(-1), known))
    return sides


def _numbers(crossing: Crossing | None) -> tuple[float, ...]:
    if crossing is None:
        return (0.0,) * 5
    return crossing.time, crossing.gate, crossing.body, crossing.direction, crossing.speed


def _crossing(row: _Numbers) -> Crossing:
    time, gate, body, direction, speed = row.tolist()
    return Crossing(time, int(gate), int(body), int(direction), speed)
