"""Rest, sliding and rolling: at the edge of sliding, in steps and gravity of any size, and far away."""

import math
from collections.abc import Callable
from functools import partial

from physicslab.components import Spring
from physicslab.diagnostics.energy import measure_energy
from physicslab.ecs.vector import Vector2
from physicslab.lab.closed_forms import rolled, slid
from physicslab.lab.stability.case import MODELS, StabilityCase, touching_space
from physicslab.lab.worlds import GRAVITY, displacements, floor, largest, open_space, place, spawn_bob
from physicslab.prefabs import box, circle, stack
from physicslab.world import World

_ANGLE = math.radians(20.0)
_LONG, _TINY, _TINY_STEPS = 10.0, 1e-9, 20_000
_GRAVITIES = (1e-6, 1e-3, 1e2, 1e3, 1e4)
_LENGTHS = (
    (1e-6, 1, 0.01, 1e-5), (1e-6, 64, 0.002, 1e-5),
    (0.1, 1, 5.0, 0.1), (0.1, 4, 5.0, 0.1), (0.1, 64, 5.0, 0.1),
)  # fmt: skip
"""Step [s], substeps, for how long [s], and how far bodies may be off then [m]."""
_MU, _SPEED, _R = 0.3, 1.0, 0.25
_ROUNDINGS = 1e4
"""So many roundings of a coordinate are put down to float64: a few for each of some hundred steps."""


def _block(share: float) -> tuple[World, int]:
    """Return a block on a slope of 20 degrees, with a share of the friction at which it would just hold."""
    along = Vector2.from_angle(_ANGLE)
    world = open_space(contacts="soft")
    friction = share * math.tan(_ANGLE)
    box(world, (0.0, 0.0), width=200.0, height=1.0, angle=_ANGLE, static=True, friction=friction)
    block = box(world, along.perpendicular * 0.75, width=1.0, height=0.5, angle=_ANGLE, friction=friction)
    return world, block


def _creep(share: float, seconds: float) -> float:
    world, block = _block(share)
    start = place(world, block)
    return largest(world, round(60.0 * seconds), lambda: (place(world, block) - start).magnitude, 10)


def _acceleration_error(share: float, seconds: float) -> float:
    """Return how far the acceleration down the slope is from the right one, as a share of it."""
    world, block = _block(share)
    (moved,) = displacements(world, [block], lambda: world.run(seconds=seconds))
    right = GRAVITY * math.sin(_ANGLE) * (1.0 - share)
    return abs(2.0 * moved.dot(-Vector2.from_angle(_ANGLE)) / seconds**2 / right - 1.0)


def _tower_in_one_step() -> float:
    world = open_space()
    floor(world)
    return max(moved.magnitude for moved in displacements(world, stack(world, 10), lambda: world.step(_LONG)))


def _fallen_through() -> float:
    """Return how deep in the floor a box is that falls on it within one step, and stays there [m]."""
    world = open_space()
    floor(world)
    fallen = box(world, (0.0, 5.0), width=1.0, height=1.0)
    world.step(_LONG)
    return abs(place(world, fallen).y - 0.5)


def _spring_energy(touches: bool) -> float:
    """Return what the energy of a spring of 10 rad/s changes by in ten steps of 10 s, as a share."""
    world, drift = open_space(gravity=None), 0.0
    # It swings sideways as well: along one line it would be closed form.
    spawn_bob(world, (0.0, -1.5), (0.5, 0.0), touches=touches, part=Spring(rest_length=1.0, stiffness=100.0))
    start = measure_energy(world).total
    for _ in range(10):
        world.step(_LONG)
        drift = max(drift, abs(measure_energy(world).total / start - 1.0))
    return drift


def _step_often(world: World) -> None:
    for _ in range(_TINY_STEPS):
        world.step()


def _fall_error() -> float:
    """Return how far a body is from where it should have fallen to in tiny steps, as a share of the fall."""
    world = open_space(dt=_TINY)
    floor(world)
    ball = circle(world, (0.0, 1.0), radius=0.1, velocity=(0.0, -1.0))
    (moved,) = displacements(world, [ball], lambda: _step_often(world))
    t = _TINY * _TINY_STEPS
    return abs(-moved.y / (t + 0.5 * GRAVITY * t * t) - 1.0)


def _drift_at_rest() -> float:
    """Return how far a stack moves in tiny steps [m]."""
    world = open_space(dt=_TINY)
    floor(world)
    return max(moved.magnitude for moved in displacements(world, stack(world, 3), lambda: _step_often(world)))


def _sunk(contacts: str, gravity: float) -> float:
    """Return how far a box of a stack of three of 1 m is from its place after 10 s [m]."""
    world = touching_space(contacts=contacts, gravity=gravity)
    floor(world)
    moved = displacements(world, stack(world, 3), lambda: world.run(seconds=10.0))
    return max(way.magnitude for way in moved)


def _astray(contacts: str, dt: float, substeps: int, seconds: float) -> float:
    """Return how far a body of a stack, a block or a disc that slide, is at most from its place [m]."""
    world = touching_space(contacts=contacts, dt=dt, substeps=substeps)
    floor(world, width=200.0, friction=_MU)
    bodies = stack(world, 3, (0.0, 0.0))
    bodies.append(box(world, (20, 0.25), friction=_MU, velocity=(_SPEED, 0)))
    bodies.append(circle(world, (40, _R), radius=_R, friction=_MU, velocity=(_SPEED, 0)))
    ways = 0.0, 0.0, 0.0, *(law(_SPEED, _MU * GRAVITY, seconds)[0] for law in (slid, rolled))
    moved = displacements(world, bodies, lambda: world.run(seconds=seconds))
    return max(math.hypot(off.x - way, off.y) for off, way in zip(moved, ways, strict=True))


def _stacked(where: float) -> list[Vector2]:
    """Return where the boxes of a tower stand after 5 s, seen from its foot, so far from the origin [m]."""
    world, foot = open_space(), Vector2(where, where)
    floor(world, foot)
    boxes = stack(world, 5, foot)
    world.run(seconds=5.0)
    return [place(world, box) - foot for box in boxes]


def _thrown(where: float) -> list[Vector2]:
    """Return how far a block slides that is pushed once, and a ball rolls, so far from the origin [m]."""
    world, foot = open_space(), Vector2(where, where)
    floor(world, foot)
    block = box(world, foot + Vector2(0.0, 0.25), velocity=(3.0, 0.0), friction=0.6)
    ball = circle(world, foot + Vector2(20.0, 0.25), radius=0.25, velocity=(3.0, 0.0), friction=0.6)
    world.run(seconds=2.0)
    return [place(world, body) - foot for body in (block, ball)]


def _far_error(ends: Callable[[float], list[Vector2]], where: float) -> float:
    return max((far - near).magnitude for far, near in zip(ends(where), ends(0.0), strict=True))


_long = partial(StabilityCase, group="long_steps")
_tiny = partial(StabilityCase, group="tiny_steps", limit=1e-9)

STEPS = (
    *(
        StabilityCase(
            name=f"slope_holds_{share:g}", group="slopes", unit="m", limit=0.001,
            title=f"block on a slope of 20 degrees, friction {share:g} times the threshold, 60 s",
            right="it holds: it creeps less than 1 mm", figure="creep", measure=partial(_creep, share, 60.0),
        )
        for share in (1.01, 1.1)
    ),
    *(
        StabilityCase(
            name=f"slope_slides_{share:g}", group="slopes", limit=0.01,
            title=f"block on a slope of 20 degrees, friction {share:g} times the threshold, 10 s",
            right="it slides with g (sin - mu cos), within 1 %", figure="error of the acceleration",
            measure=partial(_acceleration_error, share, 10.0),
        )
        for share in (0.99, 0.9)
    ),
    _long(
        name="step_10s_stack", title="tower of ten boxes, one step of 10 s", unit="m", limit=0.05,
        right="it stands as it would in steps of the scene's length", figure="farthest from its place",
        measure=_tower_in_one_step,
    ),
    _long(
        name="step_10s_fall", title="box that falls on a floor, one step of 10 s", unit="m", limit=0.01,
        right="it lies on the floor", figure="distance from there", measure=_fallen_through,
    ),
    *(
        _long(
            name=f"step_10s_spring{suffix}", title=f"spring of 10 rad/s, ten steps of 10 s{scene}",
            right="energy is kept as well as in the scene's own steps", figure="largest change of energy",
            limit=limit, measure=partial(_spring_energy, bool(suffix)),
        )
        for suffix, scene, limit in (("", "", 1e-6), ("_touching", ", in a scene with contacts", 0.01))
    ),
    _tiny(
        name="step_1ns_fall", title="falling ball, 20,000 steps of 1e-9 s", measure=_fall_error,
        right="it falls as far as it should", figure="error, of the fall",
    ),
    _tiny(
        name="step_1ns_stack", title="three boxes at rest, 20,000 steps of 1e-9 s", unit="m",
        right="they do not drift", figure="farthest from its place", measure=_drift_at_rest,
    ),
    *(
        StabilityCase(
            name=f"gravity_{gravity:g}_{contacts}", group="gravities", unit="m", limit=0.05,
            title=f"three boxes of 1 m on each other under {gravity:g} m/s^2, {model}, 10 s",
            right="they stand: none is off by a twentieth of its size", figure="farthest from its place",
            measure=partial(_sunk, contacts, gravity),
        )
        for gravity in _GRAVITIES
        for contacts, model in MODELS.items()
    ),
    *(
        StabilityCase(
            name=f"dt_{dt:g}_x{substeps}_{contacts}", group="dt", unit="m", limit=limit,
            title=f"steps of {dt:g} s in {substeps}: three boxes at rest, a block and a disc slide, {model}",
            right=f"each is where it should be, to {limit:g} m",
            figure=f"farthest from its place after {seconds:g} s",
            measure=partial(_astray, contacts, dt, substeps, seconds),
        )
        for dt, substeps, seconds, limit in _LENGTHS
        for contacts, model in MODELS.items()
        if contacts == "soft" or substeps == 1  # rigid contacts have no substeps
    ),
    *(
        StabilityCase(
            name=f"far_{name}_{kind}", title=f"{what}, {where:g} m from the origin", group="far", unit="m",
            right="contacts behave as at the origin, but for ten thousand roundings of the coordinates",
            figure="distance from where it is at the origin", limit=_ROUNDINGS * math.ulp(where),
            measure=partial(_far_error, ends, where),
        )
        for name, where in (("1e6", 1e6), ("1e9", 1e9))
        for kind, what, ends in (
            ("stack", "tower of five boxes for 5 s", _stacked),
            ("slide", "block that slides and ball that rolls for 2 s", _thrown),
        )
    ),
)  # fmt: skip
