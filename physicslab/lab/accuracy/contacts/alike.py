"""Scenes that should go alike: over seams as over one floor, mirrored, and in another order."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from physicslab.components import Transform
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.contacts.case import ContactCase, Pose, in_frames, single, state_off
from physicslab.lab.worlds import GRAVITY, empty_world, floor
from physicslab.prefabs import box, circle
from physicslab.world import World

__all__ = ["ALIKE"]

_SPEED, _MU, _THICK = 5.0, 0.3, 0.1
_HEAP = (
    (0.0, 0.55, 0.02), (0.15, 1.7, -0.05), (-0.2, 2.85, 0.1), (1.35, 0.55, 0.0), (1.5, 1.75, 0.07),
)  # fmt: skip
"""Where the boxes of the heap begin: x, y [m] and angle [rad]."""
_PAIR = ((0.1, 0.57, 0.02), (-0.1, 1.62, 0.04))


def _tiles(friction: float, simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    for i in range(-2, 12):
        box(world, (i + 0.5, -0.5), width=1, height=1, static=True, friction=friction)
    return world


def _plank(friction: float, simulation: SimulationConfig) -> World:
    world = _tiles(friction, simulation)
    box(
        world, (0, 0.5 * _THICK), width=1, height=_THICK, friction=friction, velocity=(_SPEED, 0), name="body"
    )
    return world


def _disc(simulation: SimulationConfig) -> World:
    world = _tiles(0.0, simulation)
    circle(world, (0, 0.25), radius=0.25, friction=0, velocity=(_SPEED, 0), name="body")
    return world


def _slid(friction: float, height: float, t: float) -> dict[str, Pose]:
    slowing = friction * GRAVITY
    t = min(t, _SPEED / slowing) if slowing else t
    return {"body": (_SPEED * t - 0.5 * slowing * t * t, height, 0.0)}


def _boxes(starts: Sequence[Pose], e: float, way: float, order: int, simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    floor(world, restitution=e)
    for i, (x, y, angle) in list(enumerate(starts))[::order]:
        box(
            world,
            (way * x, y),
            width=1,
            height=1,
            angle=way * angle,
            restitution=e,
            friction=0.6,
            name=str(i),
        )
    return world


def _both(
    one: Callable[[SimulationConfig], World], other: Callable[[SimulationConfig], World],
    simulation: SimulationConfig,
) -> tuple[World, ...]:  # fmt: skip
    return one(simulation), other(simulation)


def _apart(count: int, way: float, worlds: Sequence[World], i: int) -> float:
    """Return how far boxes are from those of the twin, which ``way`` mirrors where it is -1."""
    one, twin = worlds
    poses = {}
    for n in range(count):
        pose = twin.component(twin.entity(str(n)), Transform)
        poses[str(n)] = way * pose.position.x, pose.position.y, way * pose.angle
    return max(state_off(one, name, pose) for name, pose in poses.items())


def _twins(
    name: str, title: str, what: str, starts: Sequence[Pose], e: float, way: float, order: int
) -> ContactCase:
    build = partial(_boxes, starts, e)
    return ContactCase(
        name=name, title=title, group="symmetry", compared=f"two runs after 1.5 s, the second {what}",
        measure="largest difference of x, y [m] and of the angle [rad]", source="the other run",
        build=partial(_both, partial(build, 1.0, 1), partial(build, way, order)), times=in_frames(90),
        error=partial(_apart, len(starts), way),
    )  # fmt: skip


ALIKE = (
    single(
        "seam_plank", "A plank slides over a floor of 1 m tiles, mu = 0.3", "where it is after 0.5 and 2 s",
        partial(_plank, _MU), (30, 120), partial(_slid, _MU, 0.5 * _THICK), group="seams",
        source="closed form, of one floor",
    ),
    single(
        "seam_box", "A thin box slides over a floor of 1 m tiles, without friction", "where it is after 1 s",
        partial(_plank, 0.0), (60,), partial(_slid, 0.0, 0.5 * _THICK), group="seams",
        source="closed form, of one floor",
    ),
    single(
        "seam_disc", "A disc slides over a floor of 1 m tiles, without friction", "where it is after 1 s",
        _disc, (60,), partial(_slid, 0.0, 0.25), group="seams", source="closed form, of one floor",
    ),
    _twins("mirrored", "Two boxes fall on each other, e = 0.5", "mirrored", _PAIR, 0.5, -1.0, 1),
    _twins("permuted", "Five boxes fall and slide", "with bodies in another order", _HEAP, 0.2, 1.0, -1),
)  # fmt: skip
"""Their cases."""
