"""Worlds far from the origin, where float64 is coarse."""

from __future__ import annotations

import math
from functools import partial

from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import floor, open_space, place
from physicslab.prefabs import box, circle, stack

__all__ = ["FAR"]

_ROUNDINGS = 1e4
"""So many roundings of a coordinate are put down to float64: a few for each of some hundred steps."""


def _stacked(where: float) -> list[Vector2]:
    """Return where the boxes of a tower stand after 5 s, seen from its foot, so far from the origin [m]."""
    world, foot = open_space(), Vector2(where, where)
    floor(world, foot)
    boxes = stack(world, 5, foot)
    world.run(seconds=5.0)
    return [place(world, box) - foot for box in boxes]


def _slid(where: float) -> list[Vector2]:
    """Return how far a block slides that is pushed once, and a ball rolls, so far from the origin [m]."""
    world, foot = open_space(), Vector2(where, where)
    floor(world, foot)
    block = box(world, foot + Vector2(0.0, 0.25), velocity=(3.0, 0.0), friction=0.6)
    ball = circle(world, foot + Vector2(20.0, 0.25), radius=0.25, velocity=(3.0, 0.0), friction=0.6)
    world.run(seconds=2.0)
    return [place(world, body) - foot for body in (block, ball)]


def _stack_error(where: float) -> float:
    return max((far - near).magnitude for far, near in zip(_stacked(where), _stacked(0.0), strict=True))


def _slide_error(where: float) -> float:
    return max((far - near).magnitude for far, near in zip(_slid(where), _slid(0.0), strict=True))


FAR = [
    StabilityCase(
        name=f"far_{name}_{kind}", title=f"{what}, {where:g} m from the origin", group="far",
        right="contacts behave as at the origin, but for ten thousand roundings of the coordinates",
        figure="distance from where it is at the origin", unit="m", limit=_ROUNDINGS * math.ulp(where),
        measure=partial(measure, where),
    )
    for name, where in (("1e6", 1e6), ("1e9", 1e9))
    for kind, what, measure in (
        ("stack", "tower of five boxes for 5 s", _stack_error),
        ("slide", "block that slides and ball that rolls for 2 s", _slide_error),
    )
]  # fmt: skip
