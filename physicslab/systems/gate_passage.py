"""How bodies pass gates within a step: on which side they are, and when they are on the line."""

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
class Moments:
    """Positions and velocities of bodies and gates at the beginning of a step and at the ends of some.

    Attributes
    ----------
    body, body_velocity : float64 arrays (t, n, 2)
    start, end, start_velocity, end_velocity : float64 arrays (t, g, 2)
        Those of the ends of gates.
    distance, width : float64 arrays (t, g, n), (t, g, 1)
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
        self.width = _WIDTH * np.hypot(way[..., 0], way[..., 1])[..., None]
        self.distance = self._to_the_left(self.body, self.start)

    def _reach(self, longest: float) -> float:
        """Return how far anything can come in so many seconds at these speeds [m]."""
        speeds = (self.body_velocity, self.start_velocity, self.end_velocity)
        return 2.0 * longest * float(sum(np.abs(v).max(initial=0.0) for v in speeds))

    def _to_the_left(self, vectors: _Numbers, origins: _Numbers) -> _Numbers:
        way = self.end - self.start
        with np.errstate(divide="ignore", invalid="ignore"):
            unit = way / np.hypot(way[..., 0], way[..., 1])[..., None]
        part: _Numbers = unit[..., :1] * (vectors[..., None, :, 1] - origins[..., 1:])
        part -= unit[..., 1:] * (vectors[..., None, :, 0] - origins[..., :1])
        return part

    def is_close(self, spans: _Numbers) -> NDArray[np.bool_]:
        """Whether bodies come so close to the line of a gate that they may cross it within a step (n,).

        ``spans`` is how long each step is [s], an array (t - 1,).
        """
        own, gates = self.body_velocity, (self.start_velocity, self.end_velocity)
        speed = np.abs(own).sum(axis=2).max(axis=0) + sum(np.abs(v).max(initial=0.0) for v in gates)
        reach = 2.0 * float(spans.max()) * speed + self.width.max(initial=0.0)
        close: NDArray[np.bool_] = (np.abs(self.distance) <= reach).any(axis=(0, 1))
        return close

    def sides(self, known: NDArray[np.int8]) -> NDArray[np.int8]:
        """Return on which sides of gates bodies are (t, g, n); on a gate itself, where they were before.

        At first that is what is ``known`` (g, n).
        """
        with np.errstate(invalid="ignore"):
            sides = (self.distance > self.width).astype(np.int8) - (self.distance < -self.width)
        sides[0] = np.where(sides[0] == 0, known, sides[0])
        last = np.where(sides != 0, np.arange(len(sides))[:, None, None], 0)
        return np.take_along_axis(sides, np.maximum.accumulate(last, axis=0), axis=0)

    def may_return(self, side: NDArray[np.int8], spans: _Numbers) -> NDArray[np.bool_]:
        """Whether bodies may have gone through gates and come back within each step (t - 1, g, n).

        ``side`` is that on which they begin it, ``spans`` how long it is [s], an array (t - 1,).
        """
        distance = np.abs(self.distance)
        close: NDArray[np.bool_] = distance[:-1] < self._reach(float(spans.max()))
        if not close.any():
            return close
        rate, h = self._to_the_left(self.body_velocity, self.start_velocity), spans[:, None, None]
        leaving, arriving = rate[:-1], rate[1:]
        turns = (side * leaving < 0.0) & (side * arriving > 0.0)
        reaches = np.abs(leaving) * h > distance[:-1]
        return close & turns & reaches & (np.abs(arriving) * h > distance[1:])


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

    def __init__(self, moments: Moments, step: int, gate: _Whole, body: _Whole, h: float) -> None:
        both = slice(step, step + 2)
        parts = (
            (moments.body[both, body], moments.body_velocity[both, body]),
            (moments.start[both, gate], moments.start_velocity[both, gate]),
            (moments.end[both, gate], moments.end_velocity[both, gate]),
        )
        self._body, self._start, self._end = (
            StepPath.between(place[0], place[1], velocity[0], velocity[1], h) for place, velocity in parts
        )
        self._first = np.sign(moments.distance[step, gate, body])

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
