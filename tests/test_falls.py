"""Nothing falls through anything, however far it falls in a step: closed forms, and random scenes."""

from __future__ import annotations

import math
import random
from typing import Any

import numpy as np
import pytest

from physicslab import World
from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box, circle
from physicslab.systems.standard import standard_systems

MODELS: dict[str, dict[str, Any]] = {
    "auto": {},
    "rigid": {"contacts": "rigid"},
    "exact": {"collisions": "exact"},
    "soft": {"contacts": "soft", "collisions": "step", "sleeping": False},
    "exact and soft": {"collisions": "exact", "contacts": "soft"},
}


def dropped(
    model: str, size: float, g: float, dt: float, drop: float, *, kind: str = "box", speed: float = 0.0,
    e: float = 0.0, thickness: float = 1.0,
) -> tuple[World, int]:  # fmt: skip
    """Return a world in which a body is ``drop`` sizes above a floor of some sizes ``thickness``."""
    world = World(
        *standard_systems(),
        physics=PhysicsConfig(gravity=Vector2(0.0, -g)),
        simulation=SimulationConfig(dt=dt, **MODELS[model]),
    )
    height, width = thickness * size, 60.0 * size + 40.0 * speed * dt
    box(world, (0, -0.5 * height), width=width, height=height, static=True, restitution=e, friction=0.5)
    place, motion = (0.1 * size, (0.5 + drop) * size), (speed, 0.0)
    if kind == "box":
        body = box(world, place, width=size, height=size, velocity=motion, restitution=e, friction=0.5)
        world.component(body, Mass).fixed_rotation = model.startswith("exact")
    else:
        body = circle(world, place, radius=0.5 * size, velocity=motion, restitution=e, friction=0.5)
    return world, body


def height_of(world: World, body: int) -> float:
    return world.component(body, Transform).position.y


@pytest.mark.parametrize("model", ["auto", "rigid", "exact"])
@pytest.mark.parametrize(
    ("kind", "size", "g", "dt"),
    [
        ("box", 1.0, 1000.0, 0.1), ("box", 0.1, 9.81, 1.0), ("box", 1e-4, 9.81, 1 / 60),
        ("circle", 1e-5, 9.81, 1 / 60), ("box", 1e-6, 9.81, 1 / 60), ("box", 1e6, 9.81, 10.0),
    ],
)  # fmt: skip
def test_it_falls_as_galilei_says_and_rests_on_the_floor(
    model: str, kind: str, size: float, g: float, dt: float
) -> None:
    world, body = dropped(model, size, g, dt, 2.5, kind=kind)
    lands = math.sqrt(2.0 * 2.5 * size / g)
    world.run(seconds=0.7 * lands)
    assert height_of(world, body) == pytest.approx((3.0 - 0.49 * 2.5) * size, rel=1e-12)
    world, body = dropped(model, size, g, dt, 2.5, kind=kind)
    for _ in range(3):
        world.run(seconds=max(dt, 1.1 * lands))
        assert height_of(world, body) == pytest.approx(0.5 * size, rel=1e-9)
    assert world.component(body, Velocity).linear.magnitude < 1e-9 * math.sqrt(g * size)


@pytest.mark.parametrize("model", MODELS)
def test_nothing_passes_through_a_floor(model: str) -> None:
    draw = random.Random(f"falls: {model}")
    for _ in range(25):
        size, g = 10 ** draw.uniform(-6, 3), 10 ** draw.uniform(-1, 5)
        dt = 10 ** draw.uniform(-4, 0)
        if "soft" in model:  # each part of a step is a call: up to so many are cheap
            dt = min(dt, math.sqrt(1e4 * size / g))
        drop = draw.choice((0.0, 10 ** draw.uniform(-3, 3)))
        speed = draw.choice((0.0, 0.0, 10 ** draw.uniform(-2, 2) * math.sqrt(g * size)))
        kind, thickness = draw.choice(("box", "circle")), 10 ** draw.uniform(-1, 1)
        e = draw.choice((0.0, 0.0, 0.5, 0.9, 1.0))
        world, body = dropped(model, size, g, dt, drop, kind=kind, speed=speed, e=e, thickness=thickness)
        for step in range(4):
            world.step(dt)
            found = height_of(world, body) / size
            assert found > 0.35, (step, size, g, dt, drop, speed, kind, thickness, e, found)


@pytest.mark.parametrize(
    ("model", "size", "g", "dt", "drop", "speed"),
    [("soft", 9.3e-4, 74.2, 0.389, 666.0, 0.944), ("exact and soft", 4.57e-4, 1136.0, 0.0413, 68.6, 0.0)],
)
def test_soft_contacts_stop_what_falls_thousands_of_sizes_in_a_step(
    model: str, size: float, g: float, dt: float, drop: float, speed: float
) -> None:
    world, body = dropped(model, size, g, dt, drop, speed=speed)
    for _ in range(4):
        world.step(dt)
        assert height_of(world, body) > 0.4 * size


def test_what_a_spring_draws_does_not_pass_through_a_plate() -> None:
    """At rest, and drawn by 10 km/s^2: 140 times its size in a step."""
    world = World(
        *standard_systems(),
        physics=PhysicsConfig(gravity=Vector2(0.0, 0.0)),
        simulation=SimulationConfig(dt=1 / 60),
    )
    box(world, (0, -0.005), width=1.0, height=0.01, static=True)
    ball = circle(world, (0.0, 0.05), radius=0.005, mass=1.0, restitution=0.0)
    world.spawn(Spring(ball, None, anchor_b=(0.0, -1000.0), rest_length=0.0, stiffness=10.0))
    for _ in range(5):
        world.step(1 / 60)
        assert height_of(world, ball) > 0.004


def test_what_rests_in_bounds_stays_in_them() -> None:
    for size in (1e-5, 0.1):
        world = World(
            *standard_systems(),
            physics=PhysicsConfig(bounds=(-1.0, 0.0, 1.0, 3.0)),
            simulation=SimulationConfig(dt=1.0, contacts="rigid"),
        )
        cubes = [box(world, (3 * n * size, 2 * size), width=size, height=size) for n in range(3)]
        world.run(seconds=3.0)
        heights = np.array([height_of(world, cube) for cube in cubes])
        assert heights == pytest.approx(np.full(3, 0.5 * size), rel=1e-9)
