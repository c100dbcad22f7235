"""Rounding remainders of positions and velocities, carried on from step to step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

type _Numbers = NDArray[np.float64]
type _Keys = NDArray[np.int64]


@dataclass(slots=True, eq=False)
class Remainders:
    """The remainders that a compensated method left, with the values that they belong to.

    A remainder is less than the last digit of its value. It holds as long as its value is the one that the
    method left: what was edited since has none. Nothing here is changed in place.

    Attributes
    ----------
    keys : int64 array (n,)
        The coordinates (:func:`coordinate_keys`).
    q, v : float64 arrays (n,)
        The coordinates [m, rad] and their rates as the method left them.
    q_low, v_low : float64 arrays (n,)
        Their remainders.
    """

    keys: _Keys
    q: _Numbers
    v: _Numbers
    q_low: _Numbers
    v_low: _Numbers

    def of(self, keys: _Keys, q: _Numbers, v: _Numbers) -> tuple[_Numbers, _Numbers]:
        """Return copies of the remainders (n,) of coordinates and rates that are now ``q`` and ``v`` (n,)."""
        if keys is self.keys:
            return _held(q, self.q, self.q_low), _held(v, self.v, self.v_low)
        q_low, v_low = np.zeros_like(q), np.zeros_like(v)
        if not len(self.keys):
            return q_low, v_low
        _, here, kept = np.intersect1d(keys, self.keys, assume_unique=True, return_indices=True)
        q_low[here] = _held(q[here], self.q[kept], self.q_low[kept])
        v_low[here] = _held(v[here], self.v[kept], self.v_low[kept])
        return q_low, v_low

    @classmethod
    def joined(cls, kept: Sequence[Remainders]) -> Remainders:
        """Return all remainders of several parts of a world; a coordinate of more than one has the first."""
        if len(kept) == 1:
            return kept[0]
        names = ("keys", "q", "v", "q_low", "v_low")
        columns = [np.concatenate([getattr(one, name) for one in kept]) for name in names]
        _, first = np.unique(columns[0], return_index=True)
        return cls(*(column[first] for column in columns))

    @classmethod
    def of_bodies(cls, bodies: Mapping[int, tuple[Sequence[float], Sequence[float]]]) -> Remainders:
        """Return the remainders of entities.

        Parameters
        ----------
        bodies : dict of int to two sequences of six floats
            x, y, angle and their rates of each entity, and the six remainders.
        """
        keys = (3 * np.array(list(bodies), np.int64)[:, None] + np.arange(3)).ravel()
        values = np.array(list(bodies.values()), np.float64).reshape(len(bodies), 2, 2, 3) + 0.0  # no -0.0
        q, v, q_low, v_low = (values[:, i, j].ravel() for i in (0, 1) for j in (0, 1))
        return cls(keys, q, v, q_low, v_low)


def coordinate_keys(moving: _Keys, turning: _Keys) -> _Keys:
    """Return numbers for x and y in turn of entities ``moving`` (n,), then for angles of ``turning`` (m,)."""
    places = np.repeat(3 * moving, 2)
    places[1::2] += 1
    return np.concatenate((places, 3 * turning + 2))


def _held(values: _Numbers, kept: _Numbers, low: _Numbers) -> _Numbers:
    """Return the remainders of what is unchanged, and zero for the rest."""
    if values.tobytes() == kept.tobytes():  # the quickest way to find that nothing was edited
        return low.copy()
    return np.where(values == kept, low, 0.0)


_NONE = np.zeros(0)
NO_REMAINDERS = Remainders(np.zeros(0, np.int64), _NONE, _NONE, _NONE, _NONE)
"""Where nothing is compensated."""
