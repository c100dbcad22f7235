"""Steps that are far too long, and far too short."""

from __future__ import annotations

from functools import partial

from physicslab.components import Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy
from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import GRAVITY, floor, open_space, place, spawn_point
from physicslab.prefabs import box, circle, stack
from physicslab.world import World

__all__ = ["STEPS"]

_LONG = 10.0
_TINY = 1e-9
_TINY_STEPS = 20_000


def _tower() -> tuple[World, list[int]]:
    world = open_space()
    floor(world)
    return world, stack(world, 10)


def _moved_in_one_step() -> float:
    world, boxes = _tower()
    before = [place(world, box) for box in boxes]
    world.step(_LONG)
    return max((place(world, box) - start).magnitude for box, start in zip(boxes, before, strict=True))


def _fallen_through() -> float:
    """Return how deep in the floor a box is that falls on it within one step, and stays there [m]."""
    world = open_space()
    floor(world)
    fallen = box(world, (0.0, 5.0), width=1.0, height=1.0)
    world.step(_LONG)
    return abs(place(world, fallen).y - 0.5)


def _spring_energy(touches: bool) -> float:
    """Return what the energy of a spring of 10 rad/s changes by in ten steps of 10 s, as a share."""
    world = open_space(gravity=None)
    if touches:
        floor(world, Vector2(0.0, -20.0))
        bob = circle(world, (0.0, -1.5), radius=0.1)
    else:
        bob = spawn_point(world, (0.0, -1.5))
    world.component(bob, Velocity).linear = Vector2(0.5, 0.0)  # along one line it would be closed form
    world.add(bob, Spring(rest_length=1.0, stiffness=100.0))
    start = measure_energy(world).total
    drift = 0.0
    for _ in range(10):
        world.step(_LONG)
        drift = max(drift, abs(measure_energy(world).total / start - 1.0))
    return drift


def _fall_error() -> float:
    """Return how far a body is from where it should have fallen to in tiny steps, as a share of the fall."""
    world = open_space(dt=_TINY)
    floor(world)
    ball = circle(world, (0.0, 1.0), radius=0.1, velocity=(0.0, -1.0))
    for _ in range(_TINY_STEPS):
        world.step()
    t = _TINY * _TINY_STEPS
    right = t + 0.5 * GRAVITY * t * t
    return abs((1.0 - place(world, ball).y) / right - 1.0)


def _drift_at_rest() -> float:
    """Return how far a stack moves in tiny steps, of what it would in free fall [m]."""
    world = open_space(dt=_TINY)
    floor(world)
    boxes = [world.component(entity, Transform) for entity in stack(world, 3)]
    before = [box.position for box in boxes]
    for _ in range(_TINY_STEPS):
        world.step()
    return max((box.position - start).magnitude for box, start in zip(boxes, before, strict=True))


STEPS = [
    StabilityCase(
        name="step_10s_stack", title="tower of ten boxes, one step of 10 s", group="long_steps",
        right="it stands as it would in steps of the scene's length", figure="farthest from its place",
        unit="m", limit=0.05, measure=_moved_in_one_step,
    ),
    StabilityCase(
        name="step_10s_fall", title="box that falls on a floor, one step of 10 s", group="long_steps",
        right="it lies on the floor", figure="distance from there", unit="m", limit=0.01,
        measure=_fallen_through,
    ),
    *(
        StabilityCase(
            name=f"step_10s_spring{'_touching' if touches else ''}", group="long_steps",
            title=f"spring of 10 rad/s, ten steps of 10 s{', in a scene with contacts' if touches else ''}",
            right="energy is kept as well as in the scene's own steps", figure="largest change of energy",
            limit=0.01 if touches else 1e-6, measure=partial(_spring_energy, touches),
        )
        for touches in (False, True)
    ),
    StabilityCase(
        name="step_1ns_fall", title="falling ball, 20,000 steps of 1e-9 s", group="tiny_steps",
        right="it falls as far as it should", figure="error, of the fall", limit=1e-9, measure=_fall_error,
    ),
    StabilityCase(
        name="step_1ns_stack", title="three boxes at rest, 20,000 steps of 1e-9 s", group="tiny_steps",
        right="they do not drift", figure="farthest from its place", unit="m", limit=1e-9,
        measure=_drift_at_rest,
    ),
]  # fmt: skip
