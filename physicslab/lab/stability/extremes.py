"""Weak and strong gravity, short and long steps: what rests, slides and rolls all the same."""

from __future__ import annotations

import math
from functools import partial

from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.stability.contact_models import MODELS, touching_space
from physicslab.lab.worlds import GRAVITY, floor, place
from physicslab.prefabs import box, circle, stack
from physicslab.world import World

__all__ = ["EXTREMES"]

_STEPS = (
    (1e-6, 1, 0.01, 1e-5), (1e-6, 64, 0.002, 1e-5),
    (0.1, 1, 5.0, 0.1), (0.1, 4, 5.0, 0.1), (0.1, 64, 5.0, 0.1),
)  # fmt: skip
"""Step [s], substeps, for how long [s], and how far bodies may be off then [m]."""
_MU, _SPEED, _R = 0.3, 1.0, 0.25


def _sunk(contacts: str, gravity: float) -> float:
    """Return how far a box of a stack of three of 1 m is from its place after 10 s [m]."""
    world = touching_space(contacts, gravity=gravity)
    floor(world)
    bodies = stack(world, 3)
    starts = [place(world, body) for body in bodies]
    world.run(seconds=10.0)
    return max((place(world, body) - start).magnitude for body, start in zip(bodies, starts, strict=True))


def _everyday(contacts: str, dt: float, substeps: int) -> tuple[World, list[int]]:
    """Return a stack of three, a block and a disc that slide, far from each other."""
    world = touching_space(contacts, dt=dt, substeps=substeps)
    floor(world, width=200.0, friction=_MU)
    bodies = stack(world, 3, (0.0, 0.0))
    bodies.append(box(world, (20, 0.25), width=0.5, height=0.5, friction=_MU, velocity=(_SPEED, 0)))
    bodies.append(circle(world, (40, _R), radius=_R, friction=_MU, velocity=(_SPEED, 0)))
    return world, bodies


def _astray(contacts: str, dt: float, substeps: int, seconds: float) -> float:
    """Return how far such a body is at most from where it should be [m]."""
    world, bodies = _everyday(contacts, dt, substeps)
    starts = [place(world, body) for body in bodies]
    world.run(seconds=seconds)
    slowing = _MU * GRAVITY
    t = min(seconds, _SPEED / slowing)
    slid = _SPEED * t - 0.5 * slowing * t * t
    t = min(seconds, _SPEED / (3.0 * slowing))
    rolled = _SPEED * t - 0.5 * slowing * t * t + (_SPEED - slowing * t) * (seconds - t)
    ways = (0.0, 0.0, 0.0, slid, rolled)
    return max(
        math.hypot(place(world, body).x - start.x - way, place(world, body).y - start.y)
        for body, start, way in zip(bodies, starts, ways, strict=True)
    )


EXTREMES = [
    *(
        StabilityCase(
            name=f"gravity_{gravity:g}_{contacts}",
            title=f"three boxes of 1 m on each other under {gravity:g} m/s^2, {model}, 10 s",
            group="gravities", right="they stand: none is off by a twentieth of its size",
            figure="farthest from its place", unit="m", limit=0.05, measure=partial(_sunk, contacts, gravity),
        )
        for gravity in (1e-6, 1e-3, 1e2, 1e3, 1e4)
        for contacts, model in MODELS.items()
    ),
    *(
        StabilityCase(
            name=f"dt_{dt:g}_x{substeps}_{contacts}",
            title=f"steps of {dt:g} s in {substeps}: three boxes at rest, a block and a disc slide, {model}",
            group="dt", right=f"each is where it should be, to {limit:g} m",
            figure=f"farthest from its place after {seconds:g} s", unit="m", limit=limit,
            measure=partial(_astray, contacts, dt, substeps, seconds),
        )
        for dt, substeps, seconds, limit in _STEPS
        for contacts, model in MODELS.items()
        if contacts == "soft" or substeps == 1  # rigid contacts have no substeps
    ),
]  # fmt: skip
"""Their cases."""
