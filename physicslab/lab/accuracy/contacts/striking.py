"""Impacts: on corners, of free boxes, of slow discs; and scenes that should go alike."""

import math
from collections.abc import Sequence
from functools import partial

from physicslab.components import Transform
from physicslab.diagnostics.energy import measure_momentum
from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.contacts.study import ContactCase, Pose, pose_case, state_off
from physicslab.lab.closed_forms import corner_impact, slid
from physicslab.lab.worlds import GRAVITY, Surface, empty_world, floor
from physicslab.prefabs import box, circle
from physicslab.world import World

_DROP = 0.5
_SIZES = {"cube": (1.0, 1.0), "rod": (2.0, 0.1)}
_ROLL_E, _ROLL_MU, _ROLL_R = 0.5, 0.3, 0.25
_SLOW, _GAP = 0.04, 0.01


_impact = partial(pose_case, group="impacts")


def _dropped(shape: str, tilt: float, e: float, mu: float, simulation: SimulationConfig) -> World:
    world, (width, height) = empty_world(simulation), _SIZES[shape]
    floor(world, friction=mu, restitution=e)
    y = _DROP + 0.5 * (width * math.sin(tilt) + height * math.cos(tilt))
    box(world, (0, y), width=width, height=height, angle=tilt, restitution=e, friction=mu, name="box")
    return world


def _leaves(shape: str, tilt: float, e: float, mu: float, t: float) -> dict[str, Pose]:
    width, height = _SIZES[shape]
    s, c = math.sin(tilt), math.cos(tilt)
    arm = 0.5 * (height * s - width * c), -0.5 * (width * s + height * c)
    fall = math.sqrt(2.0 * GRAVITY * _DROP)
    vx, vy, spin = corner_impact(arm, (width**2 + height**2) / 12.0, fall, e, mu)
    t -= fall / GRAVITY
    return {"box": (vx * t, -arm[1] + vy * t - 0.5 * GRAVITY * t * t, tilt + spin * t)}


def _corner(shape: str, degrees: float, e: float, mu: float, title: str) -> ContactCase:
    with_these = (shape, math.radians(degrees), e, mu)
    return _impact(
        f"corner_{shape}", title, "where it is, and its angle, after 0.4 s: 0.08 s after its impact",
        partial(_dropped, *with_these), (24,), partial(_leaves, *with_these),
    )  # fmt: skip


def _against_wall(simulation: SimulationConfig) -> World:
    """Return a disc that rolls at 1 m/s against a wall at x = 2."""
    world, r = empty_world(simulation), _ROLL_R
    surface = Surface(friction=_ROLL_MU, restitution=_ROLL_E)
    floor(world, **surface)
    box(world, (2.5, 2), width=1, height=4, static=True, **surface)
    circle(world, (1, r), radius=r, velocity=(1.0, 0), angular_velocity=-1.0 / r, name="disc", **surface)
    return world


def _hopped(t: float) -> dict[str, Pose]:
    """Return where the disc is that friction of the wall has lifted off the floor."""
    r, meets = _ROLL_R, 1.0 - _ROLL_R
    lift = min(_ROLL_MU * (1.0 + _ROLL_E), 1.0 / 3.0)  # at its limit, or until the rim has stopped
    spin = -1.0 / r + 2.0 * lift / r
    t -= meets
    return {"disc": (2.0 - r - _ROLL_E * t, r + lift * t - 0.5 * GRAVITY * t * t, -meets / r + spin * t)}


def _two_boxes(simulation: SimulationConfig) -> World:
    world, surface = empty_world(simulation, gravity=None), Surface(friction=0, restitution=1)
    box(
        world, (-1, 0), width=0.8, height=0.6, angle=0.987, velocity=(3, 0), angular_velocity=-8.75, **surface
    )
    box(world, (0.6, -0.147), width=0.5, height=0.9, angle=2.25, mass=2, angular_velocity=6.51, **surface)
    return world


def _momentum_lost(world: World, i: int) -> float:
    """Return the change of the angular momentum since the start, as a share of it."""
    start = _two_boxes(world.simulation)
    start.synchronise()
    true = measure_momentum(start).angular
    return abs(measure_momentum(world).angular - true) / abs(true)


def _slow_discs(simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    floor(world, friction=0.0, restitution=1.0)
    for name, x, speed in (("one", -1.0 - _GAP, _SLOW), ("other", 0.0, 0.0)):
        circle(world, (x, 0.5), radius=0.5, velocity=(speed, 0), restitution=1, friction=0, name=name)
    return world


def _exchanged(t: float) -> dict[str, Pose]:
    return {"one": (-1.0, 0.5, 0.0), "other": (_SLOW * t - _GAP, 0.5, 0.0)}


STRIKING = (
    _corner("cube", 20.0, 0.8, 0.5, "A cube falls on its corner at 20 degrees, e = 0.8, mu = 0.5"),
    _corner("rod", 45.0, 1.0, 0.3, "A rod falls on its end at 45 degrees, e = 1, mu = 0.3"),
    _impact(
        "corner_roll", "A disc rolls into the corner of floor and wall, e = 0.5, mu = 0.3",
        "where it is, and how far it has turned, after 0.8 s, in its hop", _against_wall, (48,), _hopped,
    ),
    ContactCase(
        name="free_boxes", title="Two spinning boxes that meet in free flight, e = 1, mu = 0",
        group="impacts", compared="angular momentum after 1 s",
        measure="change of the angular momentum, as a share of it",
        source="conservation", build=_two_boxes, times=(1.0,), error=_momentum_lost, wanted=1e-12,
    ),
    _impact(
        "slow_discs", "A disc of 4 cm/s strikes another on a smooth floor, e = 1",
        "where both are after 2 s", _slow_discs, (120,), _exchanged,
    ),
)  # fmt: skip
"""Their cases."""


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


def _apart(count: int, way: float, world: World, variant: World, i: int) -> float:
    """Return how far boxes are from those of the variant, which ``way`` mirrors where it is -1."""
    rows = {str(n): variant.component(variant.entity(str(n)), Transform) for n in range(count)}
    poses = {name: (way * row.position.x, row.position.y, way * row.angle) for name, row in rows.items()}
    return max(state_off(world, name, pose) for name, pose in poses.items())


def _variants(
    name: str, title: str, what: str, starts: Sequence[Pose], e: float, way: float, order: int
) -> ContactCase:
    return ContactCase(
        name=name, title=title, group="symmetry", compared=f"two runs after 1.5 s, the second {what}",
        measure="largest difference of x, y [m] and of the angle [rad]", source="the other run", times=(1.5,),
        build=partial(_boxes, starts, e, 1.0, 1), variant=partial(_boxes, starts, e, way, order),
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
    _variants("mirrored", "Two boxes fall on each other, e = 0.5", "mirrored", _PAIR, 0.5, -1.0, 1),
    _variants("permuted", "Five boxes fall and slide", "with bodies in another order", _HEAP, 0.2, 1.0, -1),
)  # fmt: skip
"""Their cases."""
