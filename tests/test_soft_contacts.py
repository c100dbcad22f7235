"""Soft contacts: what rests, slides and topples is right to an error that falls with the step."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from physicslab import Vector2, World
from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.contacts.arguments import inverse_in, motion_of, near_in
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.files.scene import load_scene
from physicslab.kernels.near_counts import ACTIVE
from physicslab.kernels.solver.lone_sweep import sweep_contacts
from physicslab.prefabs import box, circle
from physicslab.systems.standard import standard_systems

G = 9.81
STEPS = [1 / 60 / 2**k for k in range(7)]
ROUNDING = 1e-11


def laboratory(dt: float, gravity: tuple[float, float] = (0.0, -G), **physics: Any) -> World:
    """Return an empty world with soft contacts."""
    config = SimulationConfig(contacts="soft", collisions="step", dt=dt, sleeping=False)
    laws = PhysicsConfig(gravity=Vector2(*gravity), **physics)
    return World(*standard_systems(), physics=laws, simulation=config)


def place(world: World, entity: int) -> Vector2:
    """Return where a body is."""
    return world.component(entity, Transform).position


def stacked(dt: float, count: int, size: float = 1.0, shifts: Any = None) -> tuple[World, list[int]]:
    """Return boxes on each other, each moved sideways by a share of its size."""
    world = laboratory(dt)
    box(world, (0, -0.5), width=40, height=1, static=True)
    boxes = [
        box(world, (0.0 if shifts is None else size * shifts[i], (i + 0.5) * size), width=size, height=size)
        for i in range(count)
    ]
    return world, boxes


def sunk(count: int, dt: float) -> float:
    world, boxes = stacked(dt, count)
    world.run(seconds=2.0)
    assert all(place(world, one).x == 0.0 for one in boxes)
    return abs(place(world, boxes[-1]).y - count + 0.5)


def on_incline(mu: float, dt: float) -> float:
    world, angle = laboratory(dt), math.pi / 6.0
    along, normal = Vector2.from_angle(angle), Vector2.from_angle(angle).perpendicular
    box(world, normal * -0.5, width=40, height=1, angle=angle, static=True, friction=mu)
    block = box(world, normal * 0.5, width=1, height=1, angle=angle, friction=mu)
    world.run(seconds=1.0)
    way = 0.5 * G * max(0.0, math.sin(angle) - mu * math.cos(angle))
    return (place(world, block) - normal * 0.5 + along * way).magnitude


def stopped(dt: float) -> float:
    world = laboratory(dt)
    box(world, (0, -0.5), width=40, height=1, static=True, friction=0.3)
    block = box(world, (0, 0.5), width=1, height=1, friction=0.3, velocity=(3, 0))
    world.run(seconds=2.0)
    return abs(place(world, block).x - 9.0 / (2.0 * 0.3 * G))


def spun(dt: float) -> float:
    mu, spin, r, side = 0.5, 20.0, 0.5, math.sqrt(0.5)
    world = laboratory(dt)
    for x, angle in ((-4.5 - 1.0, -math.pi / 4), (5.5, math.pi / 4)):
        middle = (math.copysign(5.0 * side + 0.5 * side, x), 5.0 * side - 0.5 * side)
        box(world, middle, width=10, height=1, angle=angle, static=True, friction=mu)
    disc = circle(world, (0, r / side), radius=r, friction=mu, angular_velocity=spin)
    slowing = mu * G / (side * (1 + mu * mu)) / (0.5 * r)
    world.run(seconds=spin / slowing + 0.3)
    return abs(world.component(disc, Transform).angle - spin * spin / (2.0 * slowing))


def toppled(dt: float) -> float:
    width, height, off, seconds = 0.5, 1.0, 0.05, 0.4
    arm, balance = 0.5 * math.hypot(width, height), math.atan2(width, height)
    rate = G * arm / ((width**2 + height**2) / 12.0 + arm * arm)
    x, v, h = off, 0.0, seconds / 4000
    for _ in range(4000):  # velocity Verlet: 1e-9
        v += 0.5 * h * rate * math.sin(x)
        x += h * v
        v += 0.5 * h * rate * math.sin(x)
    world = laboratory(dt)
    box(world, (0, -0.5), width=40, height=1, static=True, friction=5)
    at = (arm * math.sin(off), arm * math.cos(off))
    leaning = box(world, at, width=width, height=height, angle=-balance - off, friction=5)
    world.run(seconds=seconds)
    return abs(world.component(leaning, Transform).angle + balance + x)


CASES: dict[str, Callable[[float], float]] = {
    "stack of 1": lambda dt: sunk(1, dt),
    "stack of 10": lambda dt: sunk(10, dt),
    "stack of 20": lambda dt: sunk(20, dt),
    "slides down an incline": lambda dt: on_incline(0.4, dt),
    "held on an incline": lambda dt: on_incline(0.6, dt),
    "slides to a stop": stopped,
    "spins in a groove": spun,
    "topples": toppled,
}


@pytest.mark.parametrize("case", CASES)
def test_errors_fall_with_the_step(case: str) -> None:
    errors = [max(CASES[case](dt), ROUNDING) for dt in STEPS]
    assert errors[0] < 5e-3
    assert errors[-1] == ROUNDING or math.log2(errors[0] / errors[-1]) / (len(errors) - 1) >= 0.9


@pytest.mark.parametrize(("count", "size"), [(10, 0.1), (10, 0.05), (10, 0.02), (5, 0.01), (20, 0.1)])
@pytest.mark.parametrize("in_line", [True, False])
def test_towers_of_small_cubes_stand(count: int, size: float, in_line: bool) -> None:
    shifts = np.zeros(count) if in_line else np.random.default_rng(count).uniform(-0.01, 0.01, count)
    world, boxes = stacked(1 / 60, count, size, shifts)
    world.run(seconds=10.0)
    for i, one in enumerate(boxes):
        assert place(world, one).x == pytest.approx(size * shifts[i], abs=0.05 * size)
    assert place(world, boxes[-1]).y == pytest.approx((count - 0.5) * size, abs=0.1 * size)


def tiled(shape: str, mu: float, dt: float, speed: float) -> tuple[World, int]:
    """Return what slides without friction, or a plank or a rolling disc, on tiles of 1 m."""
    world = laboratory(dt)
    for i in range(16):
        box(world, (i - 1.5, -0.5), width=1, height=1, static=True, friction=mu)
    if shape == "disc":
        r = 0.25
        spin = -speed / r if mu else 0.0
        return world, circle(
            world, (-1, r), radius=r, velocity=(speed, 0), angular_velocity=spin, friction=mu
        )
    return world, box(world, (-1, 0.05), width=1, height=0.1, velocity=(speed, 0), friction=mu)


@pytest.mark.parametrize("dt", STEPS[:4])
def test_a_plank_slides_over_seams_to_where_it_would_stop(dt: float) -> None:
    world, plank = tiled("plank", 0.3, dt, 5.0)
    world.run(seconds=3.0)
    assert place(world, plank).x + 1.0 == pytest.approx(25.0 / (2.0 * 0.3 * G), abs=1e-4)


@pytest.mark.parametrize(("shape", "mu"), [("plank", 0.0), ("disc", 0.0), ("disc", 0.3)])
@pytest.mark.parametrize("speed", [0.5, 5.0])
def test_what_nothing_slows_keeps_its_speed_over_seams(shape: str, mu: float, speed: float) -> None:
    for dt in STEPS[:3]:
        world, body = tiled(shape, mu, dt, speed)
        world.run(seconds=2.0)
        assert world.component(body, Velocity).linear.x == pytest.approx(speed, rel=1e-9)


@pytest.mark.parametrize("height", [0.0, 0.02, 0.2])
def test_a_step_is_no_seam(height: float) -> None:
    """A wall, and a step of a fifth of the height, stop a box; what is level does not."""
    world = laboratory(1 / 60)
    box(world, (0, -0.5), width=10, height=1, static=True, friction=0)
    box(world, (10, height - 0.5), width=10, height=1, static=True, friction=0)
    crate = box(world, (0, 0.05), width=1, height=0.1, velocity=(2, 0), friction=0)
    world.run(seconds=4.0)
    assert (place(world, crate).x > 6.0) is (height == 0.0)


def test_a_smooth_slide_round_a_planet_keeps_its_energy() -> None:
    drifts = []
    for dt in (1 / 60, 1 / 120):
        world = laboratory(dt, gravity_mode="planet")
        mass, r = 1000.0, 5.5
        speed = 0.5 * math.sqrt(mass / r)
        world.spawn(Transform((0, 0)), Shape.circle(5.0), Material(0.0, 0.0), Mass(mass))
        rider = circle(world, (0, r), radius=0.5, mass=1e-3, velocity=(-speed, 0), friction=0)
        world.run(seconds=20.0)
        drifts.append(abs(world.component(rider, Velocity).linear.magnitude / speed - 1.0))
    assert drifts[0] < 1e-5 and drifts[1] < 0.3 * drifts[0]


@pytest.mark.parametrize(("dt", "largest"), [(1 / 60, 1e-4), (1 / 240, 1e-5)])
def test_mirror_images_of_boxes_that_fall_on_their_corners_stay_mirror_images(
    dt: float, largest: float
) -> None:
    found = []
    for sign in (1.0, -1.0):
        world = laboratory(dt)
        box(world, (0, -0.5), width=40, height=1, static=True)
        boxes = [
            box(world, (sign * 0.2 * i, 1.0 + 1.5 * i), width=1, height=0.6, angle=sign * (0.3 + 0.2 * i))
            for i in range(2)
        ]
        world.run(seconds=1.0)
        found.append([(sign * place(world, one).x, place(world, one).y) for one in boxes])
    assert np.abs(np.subtract(found[0], found[1])).max() < largest


@pytest.mark.parametrize("dt", [1 / 60, 1 / 240, 1 / 960, 1 / 3840])
@pytest.mark.parametrize(("sign", "order"), [(-1.0, 1), (1.0, -1)])
def test_two_boxes_that_fall_on_each_other_go_alike_mirrored_and_in_another_order(
    dt: float, sign: float, order: int
) -> None:
    """As the first point of a pair does, so does the second; and of two faces the better holds the points.

    What is left is rounding, which each bounce of a corner magnifies.
    """
    found = []
    for side, way in ((1.0, 1), (sign, order)):
        world = laboratory(dt)
        box(world, (0, -0.5), width=100, height=1, static=True, friction=0.6, restitution=0.5)
        boxes = [
            box(world, (side * x, y), width=1, height=1, angle=side * angle, friction=0.6, restitution=0.5)
            for x, y, angle in ((0.1, 0.57, 0.02), (-0.1, 1.62, 0.04))[::way]
        ][::way]
        world.run(seconds=1.5)
        angles = [side * world.component(one, Transform).angle for one in boxes]
        found.append([(side * place(world, one).x, place(world, one).y) for one in boxes] + [tuple(angles)])
    assert np.abs(np.subtract(found[0], found[1])).max() < 1e-11


def a_crate(world: World) -> int:
    return box(world, (0, 0.5), width=1, height=1, friction=0.6)


def a_ball(world: World) -> int:
    return circle(world, (0, 0.5), radius=0.5, friction=0.6)


@pytest.mark.parametrize("make", [a_crate, a_ball])
def test_friction_that_is_taken_away_holds_no_more(make: Callable[[World], int]) -> None:
    """The impulse of friction from before the edit was applied in each substep: a crate stood for ever."""
    world = laboratory(1 / 60)
    world.physics = replace(world.physics, gravity=Vector2(2.0, -9.81))
    box(world, (0, -0.5), width=40, height=1, static=True, friction=0.6)
    body = make(world)
    world.run(seconds=0.5)
    velocity, spin = world.component(body, Velocity).linear, world.component(body, Velocity).angular
    world.component(body, Material).friction = 0.0
    world.run(seconds=0.5)
    now = world.component(body, Velocity)
    assert now.linear.x == pytest.approx(velocity.x + 1.0, abs=1e-3)
    assert now.angular == pytest.approx(spin, abs=1e-3)


@pytest.mark.parametrize("iterations", [None, 4, 8, 32, 64])
def test_the_swaying_of_a_tower_decays_however_often_it_is_swept(iterations: int | None) -> None:
    """Sweeps hardly reach it, and a contact spring stiffer than they carry feeds it."""
    world = laboratory(1 / 60)
    world.simulation = replace(world.simulation, iterations=iterations)
    box(world, (0, -0.5), width=20, height=1, static=True)
    for i in range(12):
        box(world, (0, 0.1 + 0.2 * i), width=0.32, height=0.2, velocity=(0.02 * (i / 12) ** 2, 0))
    speeds = []
    for _ in range(120):
        world.run(steps=5)
        speeds.append(float(np.abs(world.table(Velocity)["linear"]).max()))
    assert max(speeds[-12:]) < 0.5 * max(speeds[12:24])


def test_only_contacts_of_bodies_that_impulses_have_changed_are_solved_again() -> None:
    world = load_scene("sandbox")
    world.run(steps=3)
    motion, inverse = motion_of(world), inverse_in(world)
    counts, *_, pairs, points = near_in(world)
    contacts = pairs, points, int(counts[ACTIVE])
    last, soft = np.zeros(len(inverse[0]), np.int64), (240.0, 1.0, 0.9, 0.1, 10.0, 0.5, 0.1)
    motion[2][...] += 0.1
    before = motion[2].copy()
    assert sweep_contacts(contacts, motion, soft, (5, 4, last), True) == (False, 0.0, 0.0)
    assert (motion[2] == before).all() and contacts[-1] > 10
    moving = pairs[0]["a"] if pairs[0]["mass_a"] > 0.0 else pairs[0]["b"]
    last[moving] = 4
    assert sweep_contacts(contacts, motion, soft, (5, 4, last), True)[0]
    assert last[moving] == 5 and (motion[2][moving] != before[moving]).any()
    unlike = (motion[2] != before).any(axis=1)
    assert 0 < np.count_nonzero(unlike) < len(before) and (last[unlike] == 5).all()
    assert (last[inverse[0] == 0.0] == 0).all()
