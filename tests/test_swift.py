"""What is thrown at a thin wall passes it in no substep, whatever its shape and however it turns."""

import math
import random

import pytest

from physicslab import World
from physicslab.components import Transform
from physicslab.components.vertices import regular
from physicslab.diagnostics.energy import measure_energy
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.lab.worlds import Surface
from physicslab.prefabs import box, capsule, circle, polygon

_LEFT = -4.0
"""Where the second of two walls is [m]; the first is at 0, and bodies start between them."""


def _thrown(draw: random.Random) -> tuple[World, int, float, int]:
    """Return a world with a body thrown at a blade, the body, how fast it is [m/s], and how many blades."""
    thick, speed, slant = draw.choice((0.001, 0.002, 0.05)), 10 ** draw.uniform(1.0, 3.7), draw.uniform(-1, 1)
    surface = Surface(
        restitution=draw.choice((0.0, draw.random(), 1.0)), friction=draw.choice((0.0, 0.3, 1.0))
    )  # fmt: skip
    world = World(physics=PhysicsConfig(gravity_mode="none"), simulation=SimulationConfig(contacts="soft"))
    blade = [(-0.5 * thick, 0.0), (0.0, -1e3), (0.5 * thick, 0.0), (0.0, 1e3)]
    walls = draw.randint(1, 2)
    for x in (0.0, _LEFT)[:walls]:
        if draw.random() < 0.5:
            box(world, (x, 0.0), width=thick, height=2e3, static=True, **surface)
        else:
            polygon(world, (x, 0.0), blade, static=True, **surface)
    at, velocity = (-2.0, 0.0), (speed * math.cos(slant), speed * math.sin(slant))
    turn, spin = draw.uniform(0.0, 6.3), draw.choice((0.0, draw.uniform(-1.0, 1.0) * speed / 0.05))
    kind = draw.choice(("circle", "box", "capsule", "polygon"))
    if kind == "circle":
        body = circle(world, at, radius=0.05, velocity=velocity, angular_velocity=spin, **surface)
    elif kind == "box":
        height = draw.choice((0.1, 0.04))
        body = box(
            world,
            at,
            width=0.1,
            height=height,
            angle=turn,
            velocity=velocity,
            angular_velocity=spin,
            **surface,
        )
    elif kind == "capsule":
        radius = draw.choice((0.02, 0.005))
        body = capsule(
            world, at, length=0.1, radius=radius, angle=turn, velocity=velocity, angular_velocity=spin,
            **surface,
        )  # fmt: skip
    else:
        corners = regular(draw.randint(3, 8), 0.05)
        body = polygon(world, at, corners, angle=turn, velocity=velocity, angular_velocity=spin, **surface)
    return world, body, speed, walls


@pytest.mark.parametrize("throws", [20, pytest.param(1_000, marks=pytest.mark.slow)])
def test_nothing_that_is_thrown_passes_a_blade_or_gains_energy(throws: int) -> None:
    for seed in range(throws):
        world, body, speed, walls = _thrown(random.Random(seed))
        energy = measure_energy(world).total
        for step in range(4 + int(150.0 / speed)):
            world.step()
            x = world.component(body, Transform).position.x
            assert x < 0.0 and (walls < 2 or x > _LEFT), (seed, step, x)
            assert measure_energy(world).total <= energy * (1.0 + 1e-9), (seed, step)


def test_a_square_that_is_spun_up_by_its_corner_stays_before_the_wall() -> None:
    """It lands on a corner, without restitution, and would swing its centre through within the substep."""
    world = World(physics=PhysicsConfig(gravity_mode="none"), simulation=SimulationConfig(contacts="soft"))
    box(world, (0.0, 0.0), width=0.001, height=100.0, static=True, restitution=0.0, friction=1.0)
    flier = box(
        world, (-2.0, 0.0), width=0.1, height=0.04, angle=1.44, velocity=(55.0, -54.5), restitution=0.0,
        friction=1.0,
    )  # fmt: skip
    for _ in range(6):
        world.step()
        assert world.component(flier, Transform).position.x < 0.0
    assert world.collisions > 0


def test_what_is_hit_by_a_fast_one_passes_nothing_in_the_same_substep() -> None:
    """It is listed as near the wall only once it has been hit, and then is past it within the substep."""
    config = SimulationConfig(contacts="soft", collisions="step", integrator="leapfrog")
    draw = random.Random(1)
    for _ in range(60):
        world = World(physics=PhysicsConfig(gravity_mode="none"), simulation=config)
        speed, to_wall, e = draw.uniform(50.0, 300.0), draw.uniform(0.1, 0.9), draw.choice((0.5, 1.0))
        surface = Surface(restitution=e, friction=0.0)
        circle(
            world, (-draw.uniform(0.26, 8.0), 0.0), mass=100.0, radius=0.2, velocity=(speed, 0.0), **surface
        )
        hit = circle(world, (0.0, 0.0), mass=1.0, radius=0.05, **surface)
        box(world, (to_wall, 0.0), width=0.02, height=4.0, static=True, **surface)
        energy = measure_energy(world).total
        for _ in range(20):
            world.step()
            assert world.component(hit, Transform).position.x < to_wall
        assert measure_energy(world).total <= energy * (1.0 + 1e-12)
