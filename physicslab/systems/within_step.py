"""Paths of points between the beginning and the end of a step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

type _Numbers = NDArray[np.float64]

_BEND = 0.25
"""Share of its speed by which a velocity changes where a path may have a corner."""
_EVEN = 1.0 / 6.0
"""How far from the middle of the step, as a share of it, the corner then is: where a force that hardly
changes gives the velocity, the two straight lines meet in the middle."""

_MOTION = (
    ("center_{}x", "center_{}y", "angle_{}"),
    ("before_{}x", "before_{}y", "before_w{}"),
    ("after_{}x", "after_{}y", "after_w{}"),
)
"""Where an impact has a body, and its motion before it and after: the names of fields of IMPACT."""


@dataclass(frozen=True, slots=True)
class StepPath:
    """The paths of some points through one step, from what is so at its beginning and its end.

    Each is the cubic polynomial with these places and velocities (Hermite), which is off by at most
    ``h**4 / 384`` times the fourth derivative. Where the velocity changes more than a smooth path through
    these places allows, as by an impact, it is two straight lines that meet at the moment of the impact.

    Parameters
    ----------
    first, last : float64 arrays (n, d)
        Places; the first two columns are x and y, an angle may follow.
    before, after : float64 arrays (n, d)
        Their rates of change [1/s].
    h : float64 array (n, 1)
        The length of each one's step [s].
    corner : float64 array (n,)
        The moment of the impact as a share of the step, 0 where there must have been several; NaN for smooth
        paths.
    """

    first: _Numbers
    last: _Numbers
    before: _Numbers
    after: _Numbers
    h: _Numbers
    corner: _Numbers

    @classmethod
    def between(
        cls, first: _Numbers, last: _Numbers, before: _Numbers, after: _Numbers, span: _Numbers | float
    ) -> StepPath:
        """Return paths through steps of a ``span`` each [s], of places and velocities (n, d) at both ends."""
        h = np.broadcast_to(span, len(first))[:, None]
        change = (after - before)[:, :2]
        size = np.einsum("ij,ij->i", change, change)
        speed = np.maximum(*(np.einsum("ij,ij->i", v[:, :2], v[:, :2]) for v in (before, after)))
        missed = after[:, :2] * h - (last - first)[:, :2]
        with np.errstate(divide="ignore", invalid="ignore"):
            corner = np.einsum("ij,ij->i", missed, change) / (size * h[:, 0])
        bent = (size > _BEND**2 * speed) & (np.abs(corner - 0.5) > _EVEN)
        inside = (corner > 0.0) & (corner < 1.0)
        return cls(first, last, before, after, h, np.where(bent, np.where(inside, corner, 0.0), np.nan))

    def at(self, points: NDArray[np.int64], share: _Numbers) -> _Numbers:
        """Return where points (k,) are after a share (k,) of the step each (k, d)."""
        p, q, corner = self.first[points], self.last[points], self.corner[points]
        h = self.h[points]
        u, v = h * self.before[points], h * self.after[points]
        s = share[:, None]
        smooth = (p + s * u) + s * s * ((3.0 * (q - p) - 2.0 * u - v) + s * (2.0 * (p - q) + u + v))
        bend = corner[:, None]
        angle = p + np.where(np.isnan(bend), 0.0, bend) * u
        with np.errstate(divide="ignore", invalid="ignore"):
            early, late = p + (s / bend) * (angle - p), angle + (s - bend) / (1.0 - bend) * (q - angle)
        straight = np.where(s < bend, early, late)
        path: _Numbers = np.where(np.isnan(bend), smooth, straight)
        return path

    def velocity(self, points: NDArray[np.int64], share: _Numbers) -> _Numbers:
        """Return how fast points (k,) are after a share (k,) of the step each (k, d)."""
        p, q, corner = self.first[points], self.last[points], self.corner[points]
        before, after = self.before[points], self.after[points]
        h = self.h[points]
        u, v = h * before, h * after
        s = share[:, None]
        smooth = (u + s * (2.0 * (3.0 * (q - p) - 2.0 * u - v) + 3.0 * s * (2.0 * (p - q) + u + v))) / h
        straight = np.where(s < corner[:, None], before, after)
        velocity: _Numbers = np.where(np.isnan(corner)[:, None], smooth, straight)
        return velocity


def split_at_impacts(
    impacts: NDArray[Any], entities: NDArray[np.int64], begins: _Numbers, spans: _Numbers, motion: _Numbers
) -> tuple[_Numbers, _Numbers, _Numbers]:
    """Return steps that end at impacts, so that no path within one has a corner.

    Parameters
    ----------
    impacts : array of IMPACT (n,)
        In the order of time.
    entities : int64 array (k,)
        Whose motion it is.
    begins, spans : float64 arrays (t,)
        When each step begins, and how long it is [s].
    motion : float64 array (t + 1, k, 6)
        x and y [m], the angle [rad] and their rates, at the beginning of the first and the ends of all.

    Returns
    -------
    begins, spans, motion : float64 arrays
        Likewise; between the end of a step and the beginning of the next at an impact is one of no length.
    """
    step = np.searchsorted(begins, impacts["time"], side="right") - 1
    inside = (step >= 0) & (begins[step] < impacts["time"]) & (impacts["time"] <= (begins + spans)[step])
    struck = np.isin(impacts["entity_a"], entities) | np.isin(impacts["entity_b"], entities)
    impacts = impacts[inside & struck]
    if not len(impacts):
        return begins, spans, motion
    times, place = np.unique(impacts["time"], return_inverse=True)
    step, ends = np.searchsorted(begins, times, side="right") - 1, np.arange(len(motion))
    ends += np.searchsorted(step, ends)  # instants: the ends of steps, and between them the impacts
    hits = np.arange(len(times)) + step + 1
    when, known = np.zeros(len(ends) + len(hits)), np.zeros((len(ends) + len(hits), len(entities)), np.bool_)
    when[ends], when[hits] = np.append(begins, begins[-1] + spans[-1]), times
    before = np.zeros((len(when), *motion.shape[1:]))
    before[ends], known[ends] = motion, True
    after = before.copy()
    event, body = np.nonzero(_of_both(impacts, "entity_{}")[..., 0].reshape(-1, 1) == entities)
    instant = hits[np.repeat(place, 2)[event]]
    there, early, late = (_of_both(impacts, *names).reshape(-1, 3)[event] for names in _MOTION)
    before[instant[::-1], body[::-1], 3:] = early[::-1]  # of several at one moment the first
    after[instant, body, 3:] = late
    before[instant, body, :3] = after[instant, body, :3] = there
    known[instant, body] = True
    _fill(when, before, after, known)
    twice = np.ones(len(when), np.int64)
    twice[hits] = 2
    lengths, uncut = np.diff(when), np.diff(ends) == 1
    lengths[ends[:-1][uncut]] = spans[uncut]
    last = np.cumsum(twice) - 1
    parts, whole = np.zeros(last[-1]), np.repeat(before, twice, axis=0)
    parts[last[:-1]], whole[last] = lengths, after
    return np.repeat(when, twice)[:-1], parts, whole


def _of_both(impacts: NDArray[Any], *names: str) -> NDArray[Any]:
    """Return what impacts (n,) have of both bodies by these names, an array (n, 2, names)."""
    return np.stack(
        [np.stack([impacts[name.format(body)] for name in names], axis=1) for body in "ab"], axis=1
    )


def _fill(when: _Numbers, before: _Numbers, after: _Numbers, known: NDArray[np.bool_]) -> None:
    """Put motion (t, k, 6) at instants (t,) [s] where it is not known (t, k): that of a path between."""
    number, (instant, body) = np.arange(len(when))[:, None], np.nonzero(~known)
    early = np.maximum.accumulate(np.where(known, number, 0), axis=0)[instant, body]
    late = np.minimum.accumulate(np.where(known, number, len(when))[::-1], axis=0)[::-1][instant, body]
    first, last, span = after[early, body], before[late, body], when[late] - when[early]
    path = StepPath.between(first[:, :3], last[:, :3], first[:, 3:], last[:, 3:], span)
    every, share = np.arange(len(instant)), (when[instant] - when[early]) / span
    there = np.hstack((path.at(every, share), path.velocity(every, share)))
    before[instant, body] = after[instant, body] = there
