"""A change of feature is an event: discs and boxes over edges and seams, at whatever moment of a step."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from physicslab import World
from physicslab.components import Spring, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.kernels.accounts import ENERGY, IMPACTS
from physicslab.prefabs import box, circle
from physicslab.systems.standard import standard_systems

G = 9.81
NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)


def laboratory(dt: float, gravity: tuple[float, float] = (0.0, -G)) -> World:
    return World(
        *standard_systems(),
        physics=PhysicsConfig(gravity=Vector2(*gravity)),
        simulation=SimulationConfig(dt=dt, contacts="rigid"),
    )


def pose(world: World, entity: int) -> NDArray[np.float64]:
    found = world.component(entity, Transform)
    return np.array((found.position.x, found.position.y, found.angle))


def over_the_edge(r: float, x: float, v: float, share: float, seconds: float) -> tuple[float, float]:
    """Return where a disc is that began at ``x`` before an edge, with ``share`` r^2 as its moment of inertia.

    Its energy gives the speed at each angle around the corner, and the time to get there is the integral of
    its inverse; it leaves where the corner would have to pull.
    """
    left = seconds + x / v
    if left <= 0.0:
        return x + v * seconds, r

    def time_to(angle: float) -> float:
        at = 0.5 * angle * (NODES + 1.0)
        speeds = np.sqrt(v * v + 2.0 * G * r * (1.0 - np.cos(at)) / (1.0 + share))
        return float(0.5 * angle * (WEIGHTS * r / speeds).sum())

    leaves = math.acos((v * v / (G * r) + 2.0 / (1.0 + share)) / (1.0 + 2.0 / (1.0 + share)))
    low, high = 0.0, leaves
    if time_to(leaves) > left:
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if time_to(middle) < left else (low, middle)
        return r * math.sin(low), r * math.cos(low)
    flies, speed = left - time_to(leaves), math.sqrt(G * r * math.cos(leaves))
    c, s = math.cos(leaves), math.sin(leaves)
    return r * s + speed * c * flies, r * c - speed * s * flies - 0.5 * G * flies * flies


@pytest.mark.parametrize("rolls", [False, True])
def test_a_disc_goes_over_an_edge_at_whatever_moment(rolls: bool) -> None:
    draw = random.Random(f"edge {rolls}")
    for _ in range(20):
        r, dt = draw.uniform(0.1, 0.8), draw.choice((1 / 60, 1 / 240, 1e-3))
        v = draw.uniform(0.2, 0.4 if rolls else 0.9) * math.sqrt(G * r)
        x, tilt = -draw.uniform(0.01, 0.3), draw.choice((0.0, draw.uniform(-3.0, 3.0)))
        seconds = -x / v + draw.uniform(0.05, 0.15 if rolls else 0.5)  # before it begins to slip
        c, s = math.cos(tilt), math.sin(tilt)
        world = laboratory(dt, (G * s, -G * c))  # the whole scene is turned, and its gravity
        turn = np.array(((c, -s), (s, c)))
        place, motion = turn @ (x, r), turn @ (v, 0.0)
        box(
            world, tuple(turn @ (-5.0, -0.5)), width=10, height=1, angle=tilt, static=True,
            friction=1.0, restitution=0.5,
        )  # fmt: skip
        disc = circle(
            world, tuple(place), radius=r, velocity=tuple(motion), friction=400.0 if rolls else 0.0,
            restitution=0.5,
        )  # fmt: skip
        if rolls:
            world.component(disc, Velocity).angular = -v / r
        world.run(seconds=seconds)
        found = turn.T @ pose(world, disc)[:2]
        share = 0.5 if rolls else 0.0
        expected = over_the_edge(r, x, v, share, seconds)
        assert found == pytest.approx(expected, abs=1e-11), (r, v, x, dt, seconds, found - expected)
        assert world.collisions == 0
        assert world.account.sums[IMPACTS, ENERGY] == 0.0, "an impact that is none"


def slides_off(world: World, draw: random.Random) -> int:
    """Add a box that slides over the edge of a table, and may tip."""
    mu = draw.choice((0.0, 0.2, 0.5))
    box(world, (-5, -0.5), width=10, height=1, static=True, friction=mu, restitution=0.0)
    height, velocity = draw.uniform(0.1, 0.6), (draw.uniform(0.5, 3), 0.0)
    place = (-draw.uniform(0.3, 1.2), 0.5 * height)
    width = draw.uniform(0.2, 1)
    return box(world, place, width=width, height=height, velocity=velocity, friction=mu, restitution=0.0)


def stands_on_a_corner(world: World, draw: random.Random) -> int:
    """Add a box that stands on a corner, which slides over an edge."""
    mu, angle = draw.choice((0.0, 0.2, 0.5)), draw.uniform(0.1, 1.4)
    box(world, (-5, -0.5), width=10, height=1, static=True, friction=mu, restitution=0.0)
    width, height = draw.uniform(0.2, 1), draw.uniform(0.1, 0.6)
    place = (-draw.uniform(0.0, 0.3), 0.5 * (width * math.sin(angle) + height * math.cos(angle)))
    return box(
        world, place, width=width, height=height, angle=angle, velocity=(draw.uniform(-0.5, 2), 0.0),
        friction=mu, restitution=0.0,
    )  # fmt: skip


def crosses_a_seam(world: World, draw: random.Random) -> int:
    """Add a box or a disc that crosses the joint of two floors of different friction."""
    for floor, mu in ((-5, draw.choice((0.0, 0.1, 0.3))), (5, draw.choice((0.1, 0.6)))):
        box(world, (floor, -0.5), width=10, height=1, static=True, friction=mu, restitution=0.5)
    half, x, velocity = draw.uniform(0.1, 0.4), -draw.uniform(0.5, 1.2), (draw.uniform(0.5, 3), 0.0)
    if draw.random() < 0.5:
        return circle(world, (x, half), radius=half, velocity=velocity, friction=1.0, restitution=0.5)
    long = draw.uniform(0.2, 1)
    return box(
        world, (x, half), width=long, height=2 * half, velocity=velocity, friction=1.0, restitution=0.5
    )


def enters_a_corner(world: World, draw: random.Random) -> int:
    """Add a disc that rolls up a slope, and back."""
    slope = draw.uniform(0.1, 0.7)
    c, s = math.cos(slope), math.sin(slope)
    box(world, (-5, -0.5), width=10, height=1, static=True, friction=draw.choice((0.0, 0.3)))
    box(world, (5 * c + 0.5 * s, 5 * s - 0.5 * c), width=10, height=1, angle=slope, static=True, friction=0.2)
    r, velocity = draw.uniform(0.1, 0.3), (draw.uniform(0.5, 2.5), 0.0)
    return circle(world, (-draw.uniform(0.3, 1), r), radius=r, velocity=velocity, restitution=0.0)


def lies_on_a_planet(world: World, draw: random.Random) -> int:
    """Add a box that slides and turns over on a disc."""
    r, half = draw.uniform(0.5, 2), draw.uniform(0.05, 0.2)
    circle(world, (0, -r), radius=r, static=True, friction=draw.choice((0.0, 0.5)), restitution=0.0)
    velocity = (draw.uniform(-2, 2), 0.0)
    return box(world, (0.05, half), width=draw.uniform(0.2, 1), height=2 * half, velocity=velocity)


def rolls_off_a_moving_box(world: World, draw: random.Random) -> int:
    """Add a disc that leaves a box which slides on a floor itself."""
    box(world, (0, -1.5), width=20, height=1, static=True, friction=0.2)
    mu, mass = draw.choice((0.0, 0.2, 1.0)), draw.uniform(2, 10)
    box(world, (-1, -0.5), width=2, height=1, velocity=(draw.uniform(-1, 1), 0.0), friction=mu, mass=mass)
    r = draw.uniform(0.1, 0.3)
    velocity = (draw.uniform(0.5, 2), 0.0)
    return circle(world, (-draw.uniform(0.1, 0.4), r), radius=r, velocity=velocity, friction=mu)


@pytest.mark.parametrize(
    "fill",
    [
        slides_off, stands_on_a_corner, crosses_a_seam, enters_a_corner, lies_on_a_planet,
        rolls_off_a_moving_box,
    ],
)  # fmt: skip
def test_other_steps_meet_the_same_changes(fill: Callable[[World, random.Random], Any]) -> None:
    """A change at the end of a step is met exactly in any case: steps of other lengths have it elsewhere."""
    for seed in range(4):
        places, impacts = [], []
        for dt in (1 / 60, 1 / 61.7, 1 / 240.5):
            world = laboratory(dt)
            body = fill(world, random.Random(f"{fill.__name__} {seed}"))
            world.run(seconds=0.6)
            places.append(pose(world, body))
            impacts.append(world.collisions)
        assert len(set(impacts)) == 1
        for other in places[1:]:
            assert other == pytest.approx(places[0], abs=1e-11)


# ---- a speed that is just reached --------------------------------------------------------------------------


@pytest.mark.parametrize("dt", [0.1, 1 / 60, 0.004, 1e-3])
def test_a_block_just_reaches_the_speed_of_a_belt(dt: float) -> None:
    """It slides, is carried until the spring is as strong as friction, and swings once: then it grazes."""
    k, mu, belt = 20.0, 0.25, 0.4
    world = laboratory(dt)
    floor = box(world, (0, -0.5), width=400, height=1, static=True, restitution=0.0, friction=mu)
    world.add(floor, Velocity((belt, 0.0)))
    block = box(world, (0, 0.1), width=0.4, height=0.2, mass=1.0, restitution=0.0, friction=mu)
    world.spawn(Spring(block, None, anchor_b=(-1.0, 0.1), rest_length=1.0, stiffness=k))
    world.run(seconds=2.0)
    rate, middle = math.sqrt(k), mu * G / k
    carried = math.asin(belt * rate / (mu * G)) / rate
    slips = carried + (middle - middle * (1.0 - math.cos(rate * carried))) / belt
    expected = middle + belt / rate * math.sin(rate * (2.0 - slips))
    assert pose(world, block)[0] == pytest.approx(expected, abs=1e-14 / dt)


@pytest.mark.parametrize("dt", [1 / 60, 1e-3])
def test_a_block_comes_to_rest_on_an_incline(dt: float) -> None:
    """It stops after v^2 / 2 a, however near to that moment a step ends."""
    slope, mu = 0.3, 0.6
    c, s = math.cos(slope), math.sin(slope)
    slows = G * (mu * c - s)
    for n in range(1, 6):
        v = slows * (n * dt + (n - 3) * 3e-6 + 0.1)
        world = laboratory(dt, (-G * s, -G * c))
        box(world, (0, -0.5), width=20, height=1, static=True, friction=mu)
        block = box(world, (0, 0.1), width=0.6, height=0.2, friction=mu, velocity=(-v, 0.0), restitution=0.0)
        world.run(seconds=0.3)
        assert pose(world, block)[0] == pytest.approx(-0.5 * v * v / slows, abs=1e-13)
