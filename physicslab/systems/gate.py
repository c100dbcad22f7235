"""When bodies cross light gates."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Gate, Transform, Velocity
from physicslab.state.attached import carried, carriers, let_go_of_removed
from physicslab.state.samples import ends_of_steps, motion_of_rows
from physicslab.state.state import State
from physicslab.systems.gate_passage import Moments, Passage, Roots
from physicslab.systems.system import Stage, System, at
from physicslab.systems.within_step import split_at_impacts

LIMIT = 500
"""Crossings that are kept; the oldest go first."""


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
    sampled = True

    def __init__(self) -> None:
        self.crossings: tuple[Crossing, ...] = ()
        self.count = 0
        self._gates = self._bodies = np.zeros(0, np.int64)
        self._gate_rows = self._body_rows = np.zeros(0, np.int64)
        self._side = np.zeros((0, 0), np.int8)  # 0: not known yet, as for one that was put on the gate
        self._pending: dict[tuple[int, int], Crossing | None] = {}
        self._before: _Numbers | None = None
        self._logged = 0
        self._kept: tuple[NDArray[Any], ...] = ()
        self._rows = np.zeros((0, 5))
        self._rows_of: tuple[Crossing, ...] = self.crossings

    def attach(self, state: State) -> None:
        """Follow the gates and the bodies there are; points that went with removed bodies stay where put."""
        let_go_of_removed(state)
        gates = state.batch(Gate)
        if not len(gates) and not len(self._gates):
            return
        bodies = state.batch(Transform, Velocity)
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

    def restore(self, kept: tuple[NDArray[Any], ...]) -> None:
        """Go on with an earlier record of the same gates and bodies, in the shapes of :meth:`keep`."""
        count, rows, pending, self._gates, self._bodies, self._side = kept
        self.count = int(count[0])
        self.crossings = tuple(_crossing(row) for row in rows)
        self._pending = {(int(r[0]), int(r[1])): _crossing(r[3:]) if r[2] else None for r in pending}
        self._before = None

    @at(Stage.PREPARE)
    def begin(self, state: State, h: float) -> None:
        """Note where everything is at the beginning of the step, and that impacts are to be logged."""
        state.contacts.read, self._logged = True, state.contacts.logged
        self._before = motion_of_rows(state, self._followed(state))
        if self.crossings and self.crossings[-1].time > state.time + h:  # the clock was set back
            self.crossings = tuple(one for one in self.crossings if one.time <= state.time)

    @at(Stage.FINISH)
    def record(self, state: State, h: float) -> None:
        """Note what was crossed within the step, or within each of the steps that were one call."""
        if self._before is None:
            return
        followed = self._followed(state)
        ends = ends_of_steps(state.samples, state, followed, state.time, state.time + h, h)
        motion = np.concatenate((self._before[None], ends.motion))
        moments, impacts = self._moments(state, motion), state.contacts.impacts_since(self._logged)
        begins, spans = np.append(state.time, ends.times[:-1]), ends.spans
        if len(impacts):
            close = np.append(moments.is_close(spans), np.ones(2 * len(self._gates), np.bool_))
            starts, entities = begins, state.entity_index.entities[followed]
            begins, spans, path = split_at_impacts(
                impacts, entities[close], starts, spans, motion[:, close]
            )  # fmt: skip
            # Bodies far from all gates cross none: they are as at the beginning of the step.
            motion = motion[np.append(np.searchsorted(starts, begins, side="right") - 1, -1)]
            motion[:, close] = path
            moments = self._moments(state, motion)
        distance, width, side = moments.distance, moments.width, moments.sides(self._side)
        through = (side[1:] != side[:-1]) & (side[:-1] != 0)
        on_line = (np.abs(distance[1:]) <= width[1:]) & ((distance[1:] > 0.0) != (distance[:-1] > 0.0))
        crossed = through | on_line | moments.may_return(side[:-1], spans)
        seen = 0
        for step in np.flatnonzero(crossed.any(axis=(1, 2))).tolist():
            self._drop_pending(moments, seen, step + 1)
            gate, body = np.nonzero(crossed[step])
            span, seen = float(spans[step]), step + 1
            roots = Passage(moments, step, gate, body, span).roots()
            deep = roots.beyond > width[step + 1, gate, 0]
            found = (through[step, gate, body], deep, float(begins[step]), span)
            self._note(self._located(roots, gate, body, *found))
        self._drop_pending(moments, seen, len(side))
        self._side = side[-1]

    def _followed(self, state: State) -> _Whole:
        """Return the rows of the bodies, and of what carries the ends of gates (n + 2 g,)."""
        ends = (carriers(state, Gate, name, self._gate_rows) for name in Gate.POINTS)
        return np.concatenate((self._body_rows, *ends))

    def _moments(self, state: State, motion: _Numbers) -> Moments:
        """Return the moments of a motion (t, n + 2 g, 6) of the rows that are followed."""
        table, (n, g) = state.table(Gate), (len(self._body_rows), len(self._gate_rows))
        start = carried(motion[:, n : n + g], table["start"][self._gate_rows])
        end = carried(motion[:, n + g :], table["end"][self._gate_rows])
        return Moments(motion[:, :n, :2], motion[:, :n, 3:5], *start, *end)

    def _located(
        self, roots: Roots, gate: _Whole, body: _Whole, through: NDArray[np.bool_], deep: NDArray[np.bool_],
        time: float, h: float,
    ) -> list[Crossing]:  # fmt: skip
        """Return the crossings of these pairs of gates and bodies, as far as they are certain by now."""
        keys: list[tuple[int, int]] = list(
            zip(self._gates[gate].tolist(), self._bodies[body].tolist(), strict=True)
        )
        seen: list[list[Crossing | None]] = [[] for _ in keys]
        columns = (roots.pair, time + roots.share * h, roots.rises, roots.within, roots.speed)
        for pair, moment, rises, within, speed in zip(*(part.tolist() for part in columns), strict=True):
            crossing = Crossing(moment, keys[pair][0], keys[pair][1], 1 if rises else -1, speed)
            seen[pair].append(crossing if within else None)
        found: list[Crossing | None] = []
        for k, key in enumerate(keys):
            if through[k]:
                before = self._pending.pop(key, None)
                found.append(seen[k][-1] if seen[k] else before)
            elif len(seen[k]) == 2:
                found += seen[k] if deep[k] else []
            elif seen[k]:
                self._pending[key] = seen[k][-1]
        return [one for one in found if one is not None]

    def _note(self, found: list[Crossing]) -> None:
        found.sort(key=lambda one: (one.time, one.gate, one.body))
        self.count += len(found)
        self.crossings = (*self.crossings, *found)[-LIMIT:]

    def _drop_pending(self, moments: Moments, first: int, behind: int) -> None:
        """Forget what went through the line of a gate and is then out on the side that it came from.

        The moments are those from number ``first`` on, before number ``behind``.
        """
        for gate, body in list(self._pending):
            g, n = np.searchsorted(self._gates, gate), np.searchsorted(self._bodies, body)
            there = n < len(self._bodies) and self._bodies[n] == body
            distance, width = moments.distance[first:behind, g], moments.width[first:behind, g, 0]
            if not there or bool((np.abs(distance[:, n]) > width).any()):
                del self._pending[gate, body]


def _numbers(crossing: Crossing | None) -> tuple[float, ...]:
    if crossing is None:
        return (0.0,) * 5
    return crossing.time, crossing.gate, crossing.body, crossing.direction, crossing.speed


def _crossing(row: _Numbers) -> Crossing:
    time, gate, body, direction, speed = row.tolist()
    return Crossing(time, int(gate), int(body), int(direction), speed)
