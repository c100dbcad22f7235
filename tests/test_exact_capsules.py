"""Capsules in rigid contacts and in flight: impacts to rounding, at rest on side or end, among others."""

import math

import numpy as np
import pytest

from physicslab import World
from physicslab.components import Mass, Shape, Transform, Velocity
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.prefabs import box, capsule, circle
from physicslab.stepping.rigid import Rigid
from physicslab.systems.standard import standard_systems

G = 9.81


def ground(**physics: object) -> World:
    world = World(*standard_systems(), physics=PhysicsConfig(**physics))  # type: ignore[arg-type]
    box(world, (0, -0.5), width=20, height=1, static=True, restitution=0.5, friction=0.5)
    return world


def at(world: World, entity: int) -> tuple[float, float, float]:
    transform = world.component(entity, Transform)
    return transform.position.x, transform.position.y, transform.angle


@pytest.mark.parametrize("angle", [0.0, math.pi / 2])
def test_it_stays_as_it_is_put_down(angle: float) -> None:
    world = ground()
    height = 0.2 if angle == 0.0 else 0.7
    pill = capsule(world, (0, height), length=1, radius=0.2, angle=angle, restitution=0, friction=0.5)
    world.run(seconds=0.5)
    assert world.stepper is not None and world.stepper.name == "rigid"
    assert at(world, pill) == pytest.approx((0.0, height, angle), abs=1e-14)
    assert world.contacts.count == 1


def test_it_slides_on_two_points_as_far_as_friction_says() -> None:
    world = ground()
    pill = capsule(world, (0, 0.2), length=1, radius=0.2, velocity=(2, 0), restitution=0, friction=0.5)
    world.run(seconds=1.0)
    assert at(world, pill) == pytest.approx((4 / (2 * 0.5 * G), 0.2, 0.0), abs=1e-12)


def test_it_rocks_over_an_edge_and_falls() -> None:
    world = ground(bounds=(-20, -3, 20, 20))
    table = box(world, (0, 0.5), width=2, height=1, static=True, friction=0.5)
    pill = capsule(world, (1.1, 1.2), length=1, radius=0.2, restitution=0, friction=0.5)
    world.run(seconds=3.0)
    x, y, angle = at(world, pill)
    assert table and y == pytest.approx(0.2, abs=1e-9) and x > 1.0
    assert math.sin(angle) == pytest.approx(0.0, abs=1e-9)
    assert abs(measure_account(world).energy["numerical"]) < 1e-9


def test_one_upright_and_turning_end_on_meets_the_floor_in_time() -> None:
    """Its lower end is at y - cos(w t) / 2 - r: where that is 0 follows from the series of the motion."""
    world = ground()
    world.simulation = SimulationConfig(contacts="rigid")
    spin = 3.0
    capsule(world, (0, 3), length=1, radius=0.2, angle=math.pi / 2, angular_velocity=spin, restitution=0.5)
    while not world.collisions:
        world.step()
    t = float(world.contacts.impacts["time"][0])
    assert 3 - 0.5 * G * t * t - 0.5 * abs(math.cos(spin * t)) - 0.2 == pytest.approx(0.0, abs=1e-13)


@pytest.mark.parametrize("angle", [0.0, 0.4, math.pi / 2])
def test_one_that_does_not_turn_flies_in_closed_form(angle: float) -> None:
    world = ground()
    drop = 2.0
    height = drop + 0.5 * abs(math.sin(angle)) + 0.2
    pill = capsule(
        world, (0, height), length=1, radius=0.2, angle=angle, fixed_rotation=True, restitution=0.5,
        friction=0.2,
    )  # fmt: skip
    world.run(seconds=1.0)
    assert world.stepper is not None and world.stepper.name == "event_driven"
    fall = math.sqrt(2 * drop / G)
    assert world.contacts.impacts["time"][0] == pytest.approx(fall, rel=1e-14)
    t = 1.0 - fall
    assert at(world, pill)[1] == pytest.approx(
        height - drop + 0.5 * G * fall * t - 0.5 * G * t * t, abs=1e-13
    )


def core(world: World, entity: int) -> tuple[np.ndarray, float]:
    """Return the vertices (n, 2) and the radius [m] of a body."""
    shape, (x, y, angle) = world.component(entity, Shape), at(world, entity)
    half_x, half_y = 0.5 * (shape.width or shape.length), 0.5 * shape.height
    corners = {"circle": ((0, 0),), "capsule": ((1, 0), (-1, 0)), "box": ((1, 1), (-1, 1), (-1, -1), (1, -1))}
    c, s = math.cos(angle), math.sin(angle)
    places = np.array(corners[shape.kind]) * (half_x, half_y) @ np.array(((c, s), (-s, c))) + (x, y)
    return places, shape.radius


def gap(one: tuple[np.ndarray, float], other: tuple[np.ndarray, float]) -> float:
    """Return the gap of two bodies [m], by all their faces and vertices; negative where they overlap."""
    inside, outside = -math.inf, math.inf
    for a, b in ((one[0], other[0]), (other[0], one[0])):
        for k in range(len(a)):
            start, along = a[k], a[(k + 1) % len(a)] - a[k]
            length = math.hypot(*along)
            if length:
                normal = np.array((along[1], -along[0])) / length
                inside = max(inside, float(((b - start) @ normal).min()))
            for v in b - start:
                share = min(max(v @ along / length**2, 0.0), 1.0) if length else 0.0
                outside = min(outside, math.hypot(*(v - share * along)))
    crossing = inside <= 0.0 and len(one[0]) * len(other[0]) > 2
    return (inside if crossing else outside) - one[1] - other[1]


def thrown(seed: int) -> tuple[World, list[int]]:
    """Return capsules, boxes and discs that are thrown about between four walls."""
    random = np.random.default_rng(seed)
    physics = PhysicsConfig(
        gravity_mode="linear" if seed % 3 else "none", bounds=(-2.5, -2, 2.5, 3),
        bounds_restitution=float(random.choice([0, 0.5, 1])), bounds_friction=float(random.choice([0, 0.4])),
    )  # fmt: skip
    world = World(*standard_systems(), physics=physics, simulation=SimulationConfig(contacts="rigid"))
    bodies = []
    for n, place in enumerate(((-1.4, -1.2), (0.1, -0.2), (1.5, -1.1), (-1.1, 1.6), (1.4, 1.4))):
        options = {
            "velocity": tuple(random.normal(0, 3, 2)), "angular_velocity": float(random.normal(0, 4)),
            "restitution": float(random.choice([0, 0.5, 0.8, 1])),
            "friction": float(random.choice([0, 0.3, 0.8])),
            "mass": float(random.choice([0.3, 1, 5])), "angle": float(random.uniform(0, 6)),
        }  # fmt: skip
        if n == 1:
            bodies.append(box(world, place, width=0.7, height=0.5, **options))  # type: ignore[arg-type]
        elif n == 3:
            bodies.append(circle(world, place, radius=0.3, **options))  # type: ignore[arg-type]
        else:
            length, radius = float(random.uniform(0.1, 0.7)), float(random.uniform(0.05, 0.2))
            bodies.append(capsule(world, place, length=length, radius=radius, **options))  # type: ignore[arg-type]
    return world, bodies


def overlap(world: World, bodies: list[int]) -> float:
    """Return the deepest overlap of bodies and bounds [m]."""
    cores = [core(world, body) for body in bodies]
    deepest = max(-gap(one, other) for i, one in enumerate(cores) for other in cores[:i])
    for places, radius in cores:
        (left, low), (right, high) = places.min(axis=0) - radius, places.max(axis=0) + radius
        deepest = max(deepest, -2.5 - left, -2 - low, right - 2.5, high - 3)
    return deepest


def check_thrown(seed: int, steps: int) -> None:
    world, bodies = thrown(seed)
    energy = measure_energy(world).total
    for _ in range(steps):
        world.step()
        after = measure_energy(world).total
        assert after <= energy + 1e-10 * max(1.0, abs(energy))
        energy = after
        if world.steps % 5 == 0:
            assert overlap(world, bodies) < 1e-9
    booked = measure_account(world).energy
    assert abs(booked["numerical"]) <= 1e-10 * max(map(abs, booked.values()))
    (rigid,) = (stepper for stepper in world.steppers.usable if isinstance(stepper, Rigid))
    assert rigid.left_to_soft == 0 and world.collisions > 5


@pytest.mark.parametrize("seed", range(3))
def test_thrown_ones_keep_all_laws(seed: int) -> None:
    check_thrown(seed, 60)


@pytest.mark.slow
@pytest.mark.seeds
@pytest.mark.parametrize("seed", range(3, 43))
def test_many_thrown_ones_keep_all_laws(seed: int) -> None:
    check_thrown(seed, 180)


def test_a_heavy_one_is_not_moved_by_its_inertia() -> None:
    """An impact at the end of a capsule at rest gives it the velocities of a rod of its moment of inertia."""
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"))
    world.simulation = SimulationConfig(contacts="rigid")
    pill = capsule(world, (0, 0), length=1, radius=0.2, mass=2, restitution=1, friction=0)
    ball = circle(world, (0.4, 1), radius=0.1, mass=1, velocity=(0, -2), restitution=1, friction=0)
    world.run(seconds=1.0)
    inertia = world.component(pill, Mass).inertia
    impulse = 2 * 2 / (1 / 1 + 1 / 2 + 0.4**2 / inertia)
    moved, hit = world.component(pill, Velocity), world.component(ball, Velocity)
    assert moved.linear.y == pytest.approx(-impulse / 2, rel=1e-13)
    assert moved.angular == pytest.approx(-0.4 * impulse / inertia, rel=1e-13)
    assert hit.linear.y == pytest.approx(-2 + impulse, rel=1e-13)
