"""Cubes that stand; blocks that slide, on an incline, to a stop and on a spring; a disc round a planet."""

import math
from functools import partial

from physicslab.components import Mass, Material, Shape, Spring, Transform
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.accuracy.contacts.case import Pose, pose_case
from physicslab.lab.closed_forms import slid, stopped_by_friction
from physicslab.lab.worlds import GRAVITY, PLANETS, empty_world, floor
from physicslab.prefabs import box, circle
from physicslab.world import World

_SLOPE = math.pi / 6.0
_SIZE, _SPEED, _MU = 0.5, 3.0, 0.3
_STIFFNESS, _PULLED = 20.0, 1.0
_RADIUS, _PULL = 5.5, 1000.0


def _stack(count: int, simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    floor(world)
    for i in range(count):
        box(world, (0, i + 0.5), width=1, height=1, friction=0.6, name=f"cube {i}")
    return world


def _places(count: int, t: float) -> dict[str, Pose]:
    return {f"cube {i}": (0.0, i + 0.5, 0.0) for i in range(count)}


def _on_slope(friction: float, simulation: SimulationConfig) -> World:
    """Return a block of 50 cm on a slope that falls to the right, whose upper face the origin is on."""
    world, normal = empty_world(simulation), Vector2(math.sin(_SLOPE), math.cos(_SLOPE))
    box(world, normal * -0.5, width=40, height=1, angle=-_SLOPE, static=True, friction=friction)
    start = normal * (0.5 * _SIZE)
    box(world, start, width=_SIZE, height=_SIZE, angle=-_SLOPE, friction=friction, name="block")
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


def _stopped(t: float) -> dict[str, Pose]:
    return {"block": (slid(_SPEED, _MU * GRAVITY, t)[0], 0.5 * _SIZE, 0.0)}


def _on_spring(simulation: SimulationConfig) -> World:
    """Return a block of 1 kg on a rough floor, whose spring is slack where its centre is at x = 0."""
    world = empty_world(simulation)
    floor(world, friction=_MU)
    block = box(world, (_PULLED, 0.5 * _SIZE), width=_SIZE, height=_SIZE, friction=_MU, name="block")
    world.spawn(Spring(block, anchor_b=(-3, 0.5 * _SIZE), rest_length=3.0, stiffness=_STIFFNESS))
    return world


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


_sliding = partial(pose_case, group="sliding")

SLIDING = (
    *(
        pose_case(
            f"rest_{count}", title, "where every cube is after 2 s", partial(_stack, count), (120,),
            partial(_places, count), group="resting", source="they stay where they were put",
        )
        for count, title in ((1, "A cube of 1 m on a floor"), (10, "Ten cubes of 1 m on each other"))
    ),
    _sliding(
        "slide_incline", "A block slides down 30 degrees, mu = 0.4", "where it is after 1 s",
        partial(_on_slope, 0.4), (60,), partial(_down_slope, 0.4),
    ),
    _sliding(
        "slide_held", "A block that friction holds on 30 degrees, mu = 0.6", "where it is after 1 s",
        partial(_on_slope, 0.6), (60,), partial(_down_slope, 0.6),
    ),
    _sliding(
        "slide_stop", "A block of 3 m/s slides to a stop, mu = 0.3", "where it is after 0.3 and 2 s", _thrown,
        (18, 120), _stopped,
    ),
    _sliding(
        "slide_spring", "A block on a spring of 20 N/m, with Coulomb friction, mu = 0.3",
        "where it is after 0.5 and 1.5 s, and at rest", _on_spring, (30, 90, 150), _swung,
    ),
    _sliding(
        "slide_planet", "A disc slides round a planet at half the orbital speed, without friction",
        "where it is after 4 s, two thirds of a round", _round_planet, (240,), _gone_round, wanted=1e-8,
    ),
)  # fmt: skip
"""Their cases."""
