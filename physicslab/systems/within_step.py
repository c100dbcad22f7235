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
    """Return steps that end where something is struck, so that no path within one has a corner.

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
    every, known = np.arange(len(entities)), set[int]()
    struck = np.isin(impacts["entity_a"], entities) | np.isin(impacts["entity_b"], entities)
    for impact in impacts[struck]:
        time, step = float(impact["time"]), int(np.searchsorted(begins, impact["time"], side="right")) - 1
        if step < 0 or time > begins[step] + spans[step]:
            continue
        early = time - begins[step]
        if early > 0.0:
            known.clear()
            (first, last), span = motion[step : step + 2], spans[step]
            path = StepPath.between(first[:, :3], last[:, :3], first[:, 3:], last[:, 3:], span)
            share = np.full(len(every), early / span)
            there = np.hstack((path.at(every, share), path.velocity(every, share)))
            motion = np.insert(motion, step + 1, (there, there), axis=0)
            spans = np.concatenate((spans[:step], (early, 0.0, span - early), spans[step + 1 :]))
            begins = np.insert(begins, step + 1, (time, time))
            step += 2
        elif not step or spans[step - 1] > 0.0:
            continue  # it ended the step before
        for body in "ab":
            entity = int(impact[f"entity_{body}"])
            own = entities == entity
            place = [impact[name] for name in (f"center_{body}x", f"center_{body}y", f"angle_{body}")]
            before, after = (
                [impact[f"{moment}_{part}"] for part in (f"{body}x", f"{body}y", f"w{body}")]
                for moment in ("before", "after")
            )
            motion[step - 1 : step + 1, own, :3], motion[step, own, 3:] = place, after
            if entity not in known:  # else it was struck twice at this moment
                motion[step - 1, own, 3:] = before
                known.add(entity)
    return begins, spans, motion
