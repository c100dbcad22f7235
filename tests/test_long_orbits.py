"""Long runs of bodies that attract each other, in which the digits that rounding takes would grow."""

from __future__ import annotations

import math

import pytest

from physicslab.components import Mass, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.accuracy.catalogue import PROBLEMS
from physicslab.systems.standard import standard_systems
from physicslab.world import World


def go(world: World, seconds: float, *, stepped: bool) -> None:
    """Run at once, or as a window does, step by step."""
    if stepped:
        for _ in world.stepping(seconds=seconds):
            pass
    else:
        world.run(seconds=seconds)


@pytest.mark.parametrize("stepped", [False, True])
@pytest.mark.parametrize(("t", "ias15"), [(40, 2.5e-8), (60, 2.9e-4), (70, 7.2e-3)])
def test_the_pythagorean_problem_is_solved_better_than_by_ias15(t: int, ias15: float, stepped: bool) -> None:
    """Bodies come within 0.4 mm of each other, a metre and more from the origin."""
    problem = PROBLEMS[f"pythagorean_t{t}"]
    world = problem.build(SimulationConfig(dt=problem.dt))
    go(world, problem.seconds, stepped=stepped)
    assert problem.error(world, 0) < 0.5 * ias15


@pytest.mark.parametrize("stepped", [False, True])
@pytest.mark.parametrize("light", [(0.01, 0.01), (1e-3, 1e-5)])
def test_lagrange_s_triangle_turns_a_hundred_times(light: tuple[float, float], stepped: bool) -> None:
    """A large mass and two light ones at the corners of a triangle of sides of 1 m: a stable solution."""
    masses = (1.0, *light)
    corners = Vector2(0.0, 0.0), Vector2(1.0, 0.0), Vector2(0.5, 0.75**0.5)
    total = math.fsum(masses)
    middle = (corners[1] * masses[1] + corners[2] * masses[2]) / total
    rate, world = math.sqrt(total), World(*standard_systems(), physics=PhysicsConfig(gravity_mode="planet"))
    for mass, corner in zip(masses, corners, strict=True):
        place = corner - middle
        world.spawn(Transform(place), Velocity((-rate * place.y, rate * place.x)), Mass(mass))
    go(world, 200.0 * math.pi / rate, stepped=stepped)
    assert world.plan.integrator.name == "dop853"
    ends = [Vector2(*place) for place in world.table(Transform)["position"][1:]]
    off = max((end - (corner - middle)).magnitude for end, corner in zip(ends, corners, strict=True))
    assert off < 6e-12


def comets(*at: float) -> World:
    """Return two bodies on an orbit of e = 0.9999 around a point that moves with neither."""
    config, laws = SimulationConfig(integrator="dop853"), PhysicsConfig(gravity_mode="planet")
    world = World(*standard_systems(), physics=laws, simulation=config)
    for sign in (-1.0, 1.0):
        place, speed = Vector2(*at) + Vector2(sign, 0.0), 0.5 * math.sqrt(1e-4 / 1.0)
        world.spawn(Transform(place), Velocity((0.0, sign * speed)), Mass(1.0))
    return world


def test_a_close_passage_far_from_the_origin_has_its_digits() -> None:
    here, there = comets(0.0, 0.0), comets(1024.0, -2048.0)
    apart = []
    for world in (here, there):
        world.run(seconds=60.0)
        a, b = world.table(Transform)["position"][1:]
        apart.append(b - a)
    assert apart[1] == pytest.approx(apart[0], abs=1e-7)
    ends = there.table(Transform)["position"][1:]
    assert ends.mean(axis=0) == pytest.approx((1024.0, -2048.0), abs=1e-12)


def test_where_a_fixed_body_pulls_the_origin_stays() -> None:
    world = comets(0.0, 0.0)
    world.spawn(Transform((5.0, 0.0)), Mass(1.0))
    world.run(seconds=1.0)
    gravity = world.schedule.forces[0]
    assert gravity.needs_origin(world)
    shifted = comets(3.0, 4.0)
    shifted.spawn(Transform((8.0, 4.0)), Mass(1.0))
    shifted.run(seconds=1.0)
    assert shifted.table(Transform)["position"][1:3] - (3.0, 4.0) == pytest.approx(
        world.table(Transform)["position"][1:3], abs=1e-12
    )
