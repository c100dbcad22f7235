"""Blocks that slide, on an incline, to a stop and on a spring; a disc that slides round a planet."""

from __future__ import annotations

import math
from functools import partial

from physicslab.components import Mass, Material, Shape, Spring, Transform
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.contacts.case import Pose, single
from physicslab.lab.worlds import GRAVITY, PLANETS, empty_world, floor
from physicslab.prefabs import box, circle
from physicslab.world import World

__all__ = ["SLIDING", "stopped_by_friction"]

_SLOPE = math.pi / 6.0
_SIZE, _SPEED, _MU = 0.5, 3.0, 0.3
_STIFFNESS, _PULLED = 20.0, 1.0
_RADIUS, _PULL = 5.5, 1000.0


def _on_slope(friction: float, simulation: SimulationConfig) -> World:
    """Return a block of 50 cm on a slope that falls to the right, whose upper face the origin is on."""
    world = empty_world(simulation)
    normal = math.sin(_SLOPE), math.cos(_SLOPE)
    box(
        world, (-0.5 * normal[0], -0.5 * normal[1]), width=40, height=1, angle=-_SLOPE, static=True,
        friction=friction,
    )  # fmt: skip
    half = 0.5 * _SIZE
    box(
        world, (half * normal[0], half * normal[1]), width=_SIZE, height=_SIZE, angle=-_SLOPE,
        friction=friction, name="block",
    )  # fmt: skip
    return world


def _down_slope(friction: float, t: float) -> dict[str, Pose]:
    rate = max(0.0, GRAVITY * (math.sin(_SLOPE) - friction * math.cos(_SLOPE)))
    way, half = 0.5 * rate * t * t, 0.5 * _SIZE
    x = way * math.cos(_SLOPE) + half * math.sin(_SLOPE)
    return {"block": (x, half * math.cos(_SLOPE) - way * math.sin(_SLOPE), -_SLOPE)}


def _thrown(simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    floor(world, friction=_MU)
    box(world, (0, 0.5 * _SIZE), width=_SIZE, height=_SIZE, friction=_MU, velocity=(_SPEED, 0), name="block")
    return world


def _slid(t: float) -> dict[str, Pose]:
    slowing = _MU * GRAVITY
    t = min(t, _SPEED / slowing)
    return {"block": (_SPEED * t - 0.5 * slowing * t * t, 0.5 * _SIZE, 0.0)}


def _on_spring(simulation: SimulationConfig) -> World:
    """Return a block of 1 kg on a rough floor, whose spring is slack where its centre is at x = 0."""
    world = empty_world(simulation)
    floor(world, friction=_MU)
    block = box(
        world, (_PULLED, 0.5 * _SIZE), width=_SIZE, height=_SIZE, friction=_MU, mass=1.0, name="block"
    )
    world.spawn(Spring(block, anchor_b=(-3, 0.5 * _SIZE), rest_length=3.0, stiffness=_STIFFNESS))
    return world


def stopped_by_friction(start: float, rate: float, held: float, t: float) -> float:
    """Return where a body on a spring is that Coulomb friction slows, let go at ``start`` [m].

    Each half of a swing is one about a point that friction has moved by ``held`` [m], the way from the middle
    at which it holds the body; where a half ends within that, the body stays.

    >>> stopped_by_friction(1.0, 1.0, 0.25, 100.0)
    0.0
    >>> stopped_by_friction(1.0, 1.0, 0.375, 100.0)
    -0.25
    """
    half = math.pi / rate
    while abs(start) > held:
        middle = math.copysign(held, start)
        if t < half:
            return middle + (start - middle) * math.cos(rate * t)
        start, t = 2.0 * middle - start, t - half
    return start


def _swung(t: float) -> dict[str, Pose]:
    x = stopped_by_friction(_PULLED, math.sqrt(_STIFFNESS), _MU * GRAVITY / _STIFFNESS, t)
    return {"block": (x, 0.5 * _SIZE, 0.0)}


def _round_planet(simulation: SimulationConfig) -> World:
    world = empty_world(simulation, PLANETS)
    world.spawn(Transform(), Mass(_PULL), Shape.circle(5.0), Material(0.0, 0.0))
    speed = 0.5 * math.sqrt(_PULL / _RADIUS)
    circle(world, (0, _RADIUS), radius=0.5, mass=1e-3, friction=0, velocity=(-speed, 0), name="disc")
    return world


def _gone_round(t: float) -> dict[str, Pose]:
    turned = 0.5 * math.sqrt(_PULL / _RADIUS) / _RADIUS * t
    return {"disc": (-_RADIUS * math.sin(turned), _RADIUS * math.cos(turned), 0.0)}


SLIDING = (
    single(
        "slide_incline", "A block slides down 30 degrees, mu = 0.4", "where it is after 1 s",
        partial(_on_slope, 0.4), (60,), partial(_down_slope, 0.4), group="sliding",
    ),
    single(
        "slide_held", "A block that friction holds on 30 degrees, mu = 0.6", "where it is after 1 s",
        partial(_on_slope, 0.6), (60,), partial(_down_slope, 0.6), group="sliding",
    ),
    single(
        "slide_stop", "A block of 3 m/s slides to a stop, mu = 0.3", "where it is after 0.3 and 2 s", _thrown,
        (18, 120), _slid, group="sliding",
    ),
    single(
        "slide_spring", "A block on a spring of 20 N/m, with Coulomb friction, mu = 0.3",
        "where it is after 0.5 and 1.5 s, and at rest", _on_spring, (30, 90, 150), _swung, group="sliding",
    ),
    single(
        "slide_planet", "A disc slides round a planet at half the orbital speed, without friction",
        "where it is after 4 s, two thirds of a round", _round_planet, (240,), _gone_round, group="sliding",
        wanted=1e-8,
    ),
)  # fmt: skip
"""Their cases."""
