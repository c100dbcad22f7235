"""Scenes that should go alike: over seams as over one floor, mirrored, and in another order."""

from collections.abc import Sequence
from functools import partial

from physicslab.components import Transform
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.contacts.case import ContactCase, Pose, pose_case, state_off
from physicslab.lab.closed_forms import slid
from physicslab.lab.worlds import GRAVITY, Surface, empty_world, floor
from physicslab.prefabs import box, circle
from physicslab.world import World

_SPEED, _MU, _THICK = 5.0, 0.3, 0.1
_HEAP = (
    (0.0, 0.55, 0.02), (0.15, 1.7, -0.05), (-0.2, 2.85, 0.1), (1.35, 0.55, 0.0), (1.5, 1.75, 0.07),
)  # fmt: skip
"""The initial poses of the boxes of the heap: x, y [m] and angle [rad]."""
_PAIR = ((0.1, 0.57, 0.02), (-0.1, 1.62, 0.04))


def _tiles(friction: float, simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    for i in range(-2, 12):
        box(world, (i + 0.5, -0.5), width=1, height=1, static=True, friction=friction)
    return world


def _plank(friction: float, simulation: SimulationConfig) -> World:
    world, start, speed = _tiles(friction, simulation), (0, 0.5 * _THICK), (_SPEED, 0)
    box(world, start, width=1, height=_THICK, friction=friction, velocity=speed, name="body")
    return world


def _disc(simulation: SimulationConfig) -> World:
    world = _tiles(0.0, simulation)
    circle(world, (0, 0.25), radius=0.25, friction=0, velocity=(_SPEED, 0), name="body")
    return world


def _gone(friction: float, height: float, t: float) -> dict[str, Pose]:
    return {"body": (slid(_SPEED, friction * GRAVITY, t)[0], height, 0.0)}


def _boxes(starts: Sequence[Pose], e: float, way: float, order: int, simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    surface = Surface(friction=0.6, restitution=e)
    floor(world, **surface)
    for i, (x, y, angle) in list(enumerate(starts))[::order]:
        box(world, (way * x, y), width=1, height=1, angle=way * angle, name=str(i), **surface)
    return world


def _apart(count: int, way: float, world: World, twin: World, i: int) -> float:
    """Return how far boxes are from those of the twin, which ``way`` mirrors where it is -1."""
    rows = {str(n): twin.component(twin.entity(str(n)), Transform) for n in range(count)}
    poses = {name: (way * row.position.x, row.position.y, way * row.angle) for name, row in rows.items()}
    return max(state_off(world, name, pose) for name, pose in poses.items())


def _twins(
    name: str, title: str, what: str, starts: Sequence[Pose], e: float, way: float, order: int
) -> ContactCase:
    return ContactCase(
        name=name, title=title, group="symmetry", compared=f"two runs after 1.5 s, the second {what}",
        measure="largest difference of x, y [m] and of the angle [rad]", source="the other run", times=(1.5,),
        build=partial(_boxes, starts, e, 1.0, 1), twin=partial(_boxes, starts, e, way, order),
        error=partial(_apart, len(starts), way),
    )  # fmt: skip


_seam = partial(pose_case, group="seams", source="closed form, of one floor")

ALIKE = (
    _seam(
        "seam_plank", "A plank slides over a floor of 1 m tiles, mu = 0.3", "where it is after 0.5 and 2 s",
        partial(_plank, _MU), (30, 120), partial(_gone, _MU, 0.5 * _THICK),
    ),
    _seam(
        "seam_box", "A thin box slides over a floor of 1 m tiles, without friction", "where it is after 1 s",
        partial(_plank, 0.0), (60,), partial(_gone, 0.0, 0.5 * _THICK),
    ),
    _seam(
        "seam_disc", "A disc slides over a floor of 1 m tiles, without friction", "where it is after 1 s",
        _disc, (60,), partial(_gone, 0.0, 0.25),
    ),
    _twins("mirrored", "Two boxes fall on each other, e = 0.5", "mirrored", _PAIR, 0.5, -1.0, 1),
    _twins("permuted", "Five boxes fall and slide", "with bodies in another order", _HEAP, 0.2, 1.0, -1),
)  # fmt: skip
"""Their cases."""
