"""How bodies pass gates within a step: on which side they are, and when they are on the line."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from physicslab.systems.within_step import StepPath

_WIDTH = 1e-5
"""Half the width of a gate as a share of its length: a body has crossed it once it is out on the other side,
so that one that comes to rest on it, or trembles there, is not counted again and again."""
_SAMPLES = 8
"""Parts of a step in each of which a path crosses a gate at most once."""
_ROUNDS = 60
"""Rounds after which the search for a moment ends in any case."""
_EXACT = 1e-15
"""The part of a step within which a moment is known when it is as exact as it can be."""

type _Numbers = NDArray[np.float64]
type _Whole = NDArray[np.int64]


@dataclass(slots=True)
class Moment:
    """Positions and velocities of bodies and gates at the beginning or the end of a step.

    Attributes
    ----------
    body, body_velocity : float64 arrays (n, 2)
    start, end, start_velocity, end_velocity : float64 arrays (g, 2)
        Those of the ends of gates.
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
        self.distance = self._to_the_left(self.body, self.start)

    def rate(self) -> _Numbers:
        """Return how fast each body goes to the left of each gate (g, n) [m/s], without its turning."""
        return self._to_the_left(self.body_velocity, self.start_velocity)

    def reach(self, h: float) -> float:
        """Return how far anything can come in a step at these speeds [m]."""
        speeds = (self.body_velocity, self.start_velocity, self.end_velocity)
        return 2.0 * h * float(sum(np.abs(v).max(initial=0.0) for v in speeds))

    def _to_the_left(self, vectors: _Numbers, origins: _Numbers) -> _Numbers:
        way = self.end - self.start
        with np.errstate(divide="ignore", invalid="ignore"):
            unit = way / np.hypot(way[:, 0], way[:, 1])[:, None]
        part: _Numbers = unit[:, :1] * (vectors[:, 1] - origins[:, 1:])
        part -= unit[:, 1:] * (vectors[:, 0] - origins[:, :1])
        return part

    def sides(self, known: NDArray[np.int8]) -> NDArray[np.int8]:
        """Return on which sides of gates bodies are (gates, bodies); on a gate itself, what is ``known``."""
        with np.errstate(invalid="ignore"):
            left, right = self.distance > self.width, self.distance < -self.width
        sides: NDArray[np.int8] = np.where(left, np.int8(1), np.where(right, np.int8(-1), known))
        return sides

    def may_return(self, after: Moment, side: NDArray[np.int8], h: float) -> NDArray[np.bool_]:
        """Whether a body on a side may have gone through a gate and come back until ``after`` (g, n)."""
        close = np.abs(self.distance) < max(self.reach(h), after.reach(h))
        if not close.any():
            return close
        leaving, arriving = self.rate(), after.rate()
        turns = (side * leaving < 0.0) & (side * arriving > 0.0)
        reaches = np.abs(leaving) * h > np.abs(self.distance)
        return close & turns & reaches & (np.abs(arriving) * h > np.abs(after.distance))


@dataclass(frozen=True, slots=True)
class Roots:
    """When bodies were on the lines of gates within a step, in the order of the pairs and of time.

    Attributes
    ----------
    pair : int64 array (k,)
        Which of the pairs that were looked at.
    share : float64 array (k,)
        When, as a share of the step.
    rises : bool array (k,)
        Whether it went to the left of the line.
    within, speed : arrays (k,)
        Whether it was between the gate's ends, and how fast it was [m/s].
    beyond : float64 array (pairs,)
        How far each body came out on the side where it did not begin [m].
    """

    pair: _Whole
    share: _Numbers
    rises: NDArray[np.bool_]
    within: NDArray[np.bool_]
    speed: _Numbers
    beyond: _Numbers


class Passage:
    """The paths of some bodies past a gate each, through one step."""

    def __init__(self, before: Moment, after: Moment, gate: _Whole, body: _Whole, h: float) -> None:
        self._body = StepPath.between(
            before.body[body], after.body[body], before.body_velocity[body], after.body_velocity[body], h
        )
        self._start, self._end = (
            StepPath.between(one[gate], two[gate], first[gate], last[gate], h)
            for one, two, first, last in (
                (before.start, after.start, before.start_velocity, after.start_velocity),
                (before.end, after.end, before.end_velocity, after.end_velocity),
            )
        )
        self._first = np.sign(before.distance[gate, body])

    def roots(self) -> Roots:
        """Return when each body was on the line of its gate."""
        count, shares = len(self._first), np.linspace(0.0, 1.0, _SAMPLES + 1)
        every = np.repeat(np.arange(count), len(shares))
        across = self._offsets(every, np.tile(shares, count))[0].reshape(count, -1)
        pair, part = np.nonzero((across[:, 1:] > 0.0) != (across[:, :-1] > 0.0))
        share = self._moments(
            pair, shares[part], shares[part + 1], across[pair, part], across[pair, part + 1]
        )
        along = self._offsets(pair, share)[1]
        velocity = self._body.velocity(pair, share)
        return Roots(
            pair, share, across[pair, part] <= 0.0, (along >= 0.0) & (along <= 1.0),
            np.hypot(velocity[:, 0], velocity[:, 1]), (-self._first[:, None] * across).max(axis=1),
        )  # fmt: skip

    def _offsets(self, pair: _Whole, share: _Numbers) -> tuple[_Numbers, _Numbers]:
        """Return how far bodies are to the left of gates [m], and along them as a share, after a share."""
        start = self._start.at(pair, share)
        way, offset = self._end.at(pair, share) - start, self._body.at(pair, share) - start
        length = np.hypot(way[:, 0], way[:, 1])
        across = (way[:, 0] * offset[:, 1] - way[:, 1] * offset[:, 0]) / length
        return across, np.einsum("ij,ij->i", way, offset) / length**2

    def _moments(
        self, pair: _Whole, low: _Numbers, high: _Numbers, below: _Numbers, above: _Numbers
    ) -> _Numbers:
        """Return when bodies are on gates' lines, once each between two shares of the step.

        The rule of false position, with the weight of an end that stays halved (Dowell and Jarratt, BIT 11
        (1971) 168: "Illinois"), and now and then a halving, so that it ends.
        """
        share, stays = 0.5 * (low + high), np.zeros(len(low), np.int8)
        for n in range(_ROUNDS):
            if not len(share) or (high - low).max() <= _EXACT:
                break
            with np.errstate(divide="ignore", invalid="ignore"):
                share = (low * above - high * below) / (above - below)
            outside = ~((share >= low) & (share <= high))
            share = np.where(outside | (n % 8 == 7), 0.5 * (low + high), share)
            value = self._offsets(pair, share)[0]
            left = (value > 0.0) == (below > 0.0)
            exact = value == 0.0
            low, high = np.where(left | exact, share, low), np.where(left & ~exact, high, share)
            below = np.where(left, value, np.where(stays == -1, 0.5 * below, below))
            above = np.where(left, np.where(stays == 1, 0.5 * above, above), value)
            stays = np.where(left, np.int8(1), np.int8(-1))  # the end that stays where it was: high, or low
        return share
