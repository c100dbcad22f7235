"""Impacts of soft contacts: the restitution asked for, friction's cone, momenta and energy, at any step."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from compiled import compiled
from numpy.typing import NDArray

from physicslab import World
from physicslab.components import Mass, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy, measure_momentum
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.kernels import near_counts
from physicslab.kernels.constraint import impact_law
from physicslab.lab.worlds import floor
from physicslab.prefabs import BodyOptions, box, circle, regular_polygon
from physicslab.systems.standard import standard_systems

G = 9.81
stronge_impulse: Any = compiled(impact_law.stronge_impulse)


def laboratory(*, dt: float = 1 / 60, substeps: int = 4, **physics: Any) -> World:
    """Return an empty world with soft contacts within steps, whose impacts are logged."""
    config = SimulationConfig(contacts="soft", collisions="step", dt=dt, substeps=substeps, sleeping=False)
    world = World(*standard_systems(), physics=PhysicsConfig(**physics), simulation=config)
    world.contacts.read = True
    return world


def motion(world: World, entity: int) -> NDArray[np.float64]:
    """Return both speeds and the angular velocity."""
    found = world.component(entity, Velocity)
    return np.array((found.linear.x, found.linear.y, found.angular))


def reached(world: World, body: int) -> tuple[float, float, float]:
    """Step to the first impact of a body with the floor, whose surface is y = 0.

    Returns e reached, energy after over before, and J_t / J_n.
    """
    start, place = motion(world, body), world.component(body, Transform)
    x, y = place.position.x, place.position.y
    g = world.physics.gravity.magnitude if world.physics.gravity_mode == "linear" else 0.0
    while not world.contacts.logged:
        world.step()
        assert world.time < 3.0
    assert world.contacts.logged == 1
    impact, mass = world.contacts.impacts[0], world.component(body, Mass)
    t = float(impact["time"])
    before = np.array((start[0], start[1] - g * t, start[2]))
    after = motion(world, body)
    after[1] += g * (world.time - t)
    centre = np.array((x + start[0] * t, y + start[1] * t - 0.5 * g * t * t))
    masses = np.array((mass.mass, mass.mass, mass.inertia))
    impulse = masses * (after - before)
    # The arm goes by the impulse: its moment about the centre is what has turned the body.
    arm_y = -centre[1]
    arm_x = (impulse[2] + arm_y * impulse[0]) / impulse[1]
    speeds = [v[1] + v[2] * arm_x for v in (before, after)]
    energies = [0.5 * float(masses @ v**2) for v in (before, after)]
    return -speeds[1] / speeds[0], energies[1] / energies[0], impulse[0] / impulse[1]


@pytest.mark.parametrize("e", [0.5, 0.8, 1.0])
@pytest.mark.parametrize("mu", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("degrees", [10, 20, 30])
def test_a_cube_leaves_its_corner_with_the_restitution_asked_for(degrees: float, e: float, mu: float) -> None:
    world, angle = laboratory(), math.radians(degrees)
    box(world, (0, -0.5), width=20, height=1, static=True, restitution=e, friction=mu)
    y = 1.0 + 0.5 * (math.sin(angle) + math.cos(angle))
    cube = box(world, (0, y), width=1, height=1, angle=angle, restitution=e, friction=mu)
    found, energy, edge = reached(world, cube)
    assert found == pytest.approx(e, abs=1e-9)
    assert energy <= 1.0 + 1e-12 and abs(edge) <= mu * (1.0 + 1e-12)


@pytest.mark.parametrize("degrees", [45, 60])
@pytest.mark.parametrize("mu", [0.3, 1.0])
def test_an_elastic_rod_leaves_its_end_as_fast(degrees: float, mu: float) -> None:
    world, angle = laboratory(gravity_mode="none"), math.radians(degrees)
    box(world, (0, -0.5), width=20, height=1, static=True, restitution=1, friction=mu)
    y = 0.1 + 0.5 * (2 * math.sin(angle) + 0.02 * math.cos(angle))
    rod = box(world, (0, y), width=2, height=0.02, angle=angle, velocity=(0, -1), restitution=1, friction=mu)
    found, energy, _ = reached(world, rod)
    assert found == pytest.approx(1.0, abs=1e-9)
    assert energy <= 1.0 + 1e-12


def sliding_rod(mu: float, e: float) -> tuple[World, int]:
    """Return a rod that falls on its end and slides, by which it would gain energy by Newton's law."""
    world, angle = laboratory(gravity_mode="none"), math.radians(45)
    box(world, (0, -0.5), width=20, height=1, static=True, restitution=e, friction=mu)
    y = 0.1 + 0.5 * (2 * math.sin(angle) + 0.02 * math.cos(angle))
    rod = box(
        world, (0, y), width=2, height=0.02, angle=angle, velocity=(0.8, -1), restitution=e, friction=mu
    )
    return world, rod


@pytest.mark.parametrize("e", [0.95, 1.0])
def test_a_rod_that_would_gain_energy_goes_by_the_work_of_the_normal_force(e: float) -> None:
    world, rod = sliding_rod(0.3, e)
    mass = world.component(rod, Mass)
    arm_x, arm_y = -math.cos(math.radians(45)) * np.array((0.99, 1.01))
    each, turn = 1.0 / mass.mass, 1.0 / mass.inertia
    kn, kt, between = each + turn * arm_x**2, each + turn * arm_y**2, -turn * arm_x * arm_y
    # The sliding stops, and turns round, for friction does not hold what would need between / kt.
    assert abs(between) / kt > 0.3
    normal, tangent = stronge_impulse(impact_law.PointResponse(kn, kt, between, -1.0, 0.8), e, 0.3)
    found, energy, edge = reached(world, rod)
    assert found == pytest.approx(kn * normal + between * tangent - 1.0, abs=1e-9)
    assert edge == pytest.approx(tangent / normal, abs=1e-9)
    assert energy < 1.0


@pytest.mark.parametrize(("mu", "told"), [(0.3, True), (0.0, False)])
def test_an_impact_that_goes_by_energy_is_told(mu: float, told: bool) -> None:
    world, _ = sliding_rod(mu, 1.0)
    world.run(seconds=0.3)
    found = [warning for warning in find_warnings(world) if "Stronge's law" in warning.what]
    assert world.collisions == 1 and [warning.value for warning in found] == ([1.0] if told else [])
    assert all(str(warning).count(": 1;") == 1 for warning in found)


def test_restitutions_of_several_points_that_were_lowered_are_told_apart_from_that() -> None:
    world, _ = sliding_rod(0.3, 1.0)
    world.contacts.counts[near_counts.LOWERED] = 2
    found = [str(warning) for warning in find_warnings(world)]
    assert [
        text for text in found if "several points at once have a lower restitution" in text and ": 2;" in text
    ]
    assert not [text for text in found if "Stronge's law" in text]


def test_a_box_that_falls_flat_with_speed_turns_alike_in_its_mirror_image() -> None:
    found = []
    for sign in (1.0, -1.0):
        world = laboratory()
        box(world, (0, -0.5), width=20, height=1, static=True, restitution=0.5, friction=0.4)
        crate = box(world, (0, 1.5), width=1, height=1, velocity=(sign * 2, 0), restitution=0.5, friction=0.4)
        world.run(seconds=0.5)
        assert world.collisions == 1
        found.append(motion(world, crate) * (sign, 1.0, sign))
    assert np.allclose(found[0], found[1], rtol=0.0, atol=1e-12)
    assert found[0] == pytest.approx(
        [0.0, 0.5 * G * math.sqrt(2.0 / G) - G * (0.5 - math.sqrt(2.0 / G)), 0.0], abs=1e-9
    )


def aimed(random: np.random.Generator, number: int, spin: float) -> tuple[World, list[int], float]:
    """Return two bodies that fly at each other: of all pairs of shapes, with spin; and mu."""
    e = float(random.choice((0.3, 0.8, 1.0, random.random())))
    mu = float(random.choice((0.0, 0.1, 0.5, 1.0, 1.5 * random.random())))
    dt = float(random.choice((1 / 240, 1 / 960)))
    world, bodies = laboratory(dt=dt, substeps=1, gravity_mode="none"), []
    heading = random.uniform(0, math.tau)
    towards = np.array((math.cos(heading), math.sin(heading)))
    for k, sign in enumerate((-1.0, 1.0)):
        start = sign * 0.9 * towards + 0.5 * random.uniform(-1, 1) * np.array((-towards[1], towards[0]))
        velocity = -sign * random.uniform(0.5, 3.0) * towards + random.normal(0, 0.2, 2)
        options: Any = {
            "mass": float(10 ** random.uniform(-1, 1)), "velocity": (velocity[0], velocity[1]),
            "angular_velocity": float(random.normal(0, spin)), "angle": float(random.uniform(-3, 3)),
            "restitution": e, "friction": mu,
        }  # fmt: skip
        if (number >> k) & 1:
            bodies.append(circle(world, (start[0], start[1]), radius=random.uniform(0.2, 0.5), **options))
        else:
            width, height = random.uniform(0.3, 0.9, 2)
            bodies.append(box(world, (start[0], start[1]), width=width, height=height, **options))
    return world, bodies, mu


@pytest.mark.parametrize("most", [40, pytest.param(400, marks=pytest.mark.slow)])
@pytest.mark.parametrize("spin", [1.0, 4.0])
def test_random_impacts_keep_momenta_and_gain_no_energy(
    spin: float, most: int, pytestconfig: pytest.Config
) -> None:
    count = max(40, round(most * pytestconfig.getoption("effort")))
    random, met = np.random.default_rng(20261122), 0
    for number in range(count):
        world, bodies, mu = aimed(random, number, spin)
        world.synchronise()
        momentum, energy = measure_momentum(world), measure_energy(world).kinetic
        scale = sum(
            float(np.abs(motion(world, body)) @ (m.mass, m.mass, m.inertia))
            for body in bodies
            for m in (world.component(body, Mass),)
        )
        for _ in range(1500):
            world.step()
            if world.contacts.logged:
                break
        met += world.contacts.logged > 0
        after = measure_momentum(world)
        assert (after.linear - momentum.linear).magnitude <= 1e-12 * scale, number
        assert after.angular == pytest.approx(momentum.angular, abs=1e-12 * scale), number
        assert measure_energy(world).kinetic <= energy * (1.0 + 1e-12), number
        impacts = world.contacts.impacts
        pushed, rubbed = impacts["normal_impulse"], np.abs(impacts["tangent_impulse"])
        assert (pushed > 0.0).all() and (rubbed <= mu * pushed * (1.0 + 1e-12)).all(), number
    assert met > 0.75 * count


@pytest.mark.parametrize("spin", [2.0, 8.0, -25.0])
def test_a_corner_that_turns_into_a_disc_meets_it_at_its_own_time(spin: float) -> None:
    """Whatever the step: between the disc's way and the way of the corner nothing is put off."""
    found = []
    for dt in (1 / 240, 1 / 960, 1 / 3840):
        world = laboratory(dt=dt, substeps=1, gravity_mode="none")
        box(world, (0, 0), width=0.8, height=0.4, angular_velocity=spin, restitution=0.7, friction=0.3)
        disc = circle(world, (1.0, 0.1), radius=0.3, velocity=(-0.5, 0), restitution=0.7, friction=0.3)
        while not world.contacts.logged:
            world.step()
        impact = world.contacts.impacts[0]
        names = "time", "x", "y", "normal_x", "approach_speed", "normal_impulse", "tangent_impulse"
        found.append((*(float(impact[name]) for name in names), *motion(world, disc)))
    assert found[0] == pytest.approx(found[2], abs=1e-9)
    assert found[1] == pytest.approx(found[2], abs=1e-9)


@pytest.mark.parametrize("speed", [0.01, 0.02, 0.04, 0.08])
@pytest.mark.parametrize("falling", [False, True])
def test_slow_discs_exchange_their_speeds(speed: float, falling: bool) -> None:
    world = laboratory()
    if not falling:
        box(world, (0, -0.5), width=60, height=1, static=True, restitution=1, friction=0)
    one, other = (
        circle(world, (x, 0.5), radius=0.5, velocity=(v, 0), restitution=1, friction=0)
        for x, v in ((-1.01, speed), (0, 0))
    )
    world.run(seconds=2.0)
    assert [motion(world, one)[0], motion(world, other)[0]] == pytest.approx([0.0, speed], abs=1e-12)


@pytest.mark.parametrize("dt", [1 / 60, 1 / 960, 1 / 3840])
def test_an_oblique_impact_is_as_exact_with_finer_steps(dt: float) -> None:
    world = laboratory(dt=dt, gravity_mode="none")
    one = circle(world, (-1.2, 0.7), radius=0.5, velocity=(2, 0), restitution=1, friction=0)
    other = circle(world, (0, 0), radius=0.5, restitution=1, friction=0)
    world.run(seconds=0.6)
    normal = np.array((math.sqrt(1.0 - 0.49), -0.7))
    given = 2.0 * normal[0] * normal
    assert motion(world, other)[:2] == pytest.approx(given, abs=1e-12)
    assert motion(world, one)[:2] == pytest.approx((2.0, 0.0) - given, abs=1e-12)


@pytest.mark.parametrize("restitution", [0.0, 0.5])
@pytest.mark.parametrize("above", [0.005, 0.01, 0.03])
def test_what_slides_over_a_floor_is_held_by_it_when_another_falls_on_it(
    restitution: float, above: float
) -> None:
    # As it slides it would not meet the floor in that substep, which was known before the impact.
    world, law = laboratory(gravity_mode="none"), BodyOptions(friction=0.0, restitution=restitution)
    floor(world, friction=0.0, restitution=restitution)
    half = 0.1 * math.sqrt(3.0)
    low = regular_polygon(world, (0.0, half + 0.0015), corners=6, radius=0.2, **law)
    high = circle(world, (0.0, 2.0 * half + 0.2015 + above), radius=0.2, **law)
    world.component(low, Velocity).linear = Vector2(1.0, 0.0)
    world.component(high, Velocity).linear = Vector2(1.0, -5.0)
    deepest = 0.0
    for _ in range(4):
        world.step()
        deepest = max(deepest, half - world.component(low, Transform).position.y)
    assert world.component(low, Velocity).linear.y != 0.0 or restitution == 0.0
    assert deepest < 1e-4  # up to 0.01


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("shape", ["disc", "hexagon", "box"])
@pytest.mark.parametrize("gap", [0.004, 0.009, 0.015])
def test_what_an_impact_throws_at_another_meets_it_in_the_same_substep(
    gap: float, shape: str, restitution: float
) -> None:
    # Both rest before: the way of the second one in the rest of the substep is up to 2 cm. A disc has a
    # record of pairs within a fiftieth of both radii.
    gap *= 0.5 if shape == "disc" else 1.0
    world, law = laboratory(gravity_mode="none"), BodyOptions(friction=0.0, restitution=restitution, mass=1.0)
    made, place = [], 0.0
    for apart in (0.0, 0.03, gap):
        place += apart + 0.4
        if shape == "disc":
            made.append(circle(world, (place, 0.0), radius=0.2, **law))
        elif shape == "hexagon":
            side = 0.4 / math.sqrt(3.0)
            hexagon = regular_polygon(world, (place, 0.0), corners=6, radius=side, **law)
            world.component(hexagon, Transform).angle = math.pi / 2
            made.append(hexagon)
        else:
            made.append(box(world, (place, 0.0), width=0.4, height=0.4, **law))
    world.component(made[0], Velocity).linear = Vector2(6.0, 0.0)
    deepest = 0.0
    for _ in range(3):
        world.step()
        places = [world.component(entity, Transform).position.x for entity in made]
        deepest = max(deepest, *(0.4 - after + before for before, after in pairwise(places)))
    assert deepest < 1e-3  # up to 0.02
    speeds = [motion(world, entity)[0] for entity in made]
    assert sum(speeds) == pytest.approx(6.0, abs=1e-12)
    assert speeds[1] < speeds[2] + 1e-9
    if restitution == 1.0:
        assert speeds == pytest.approx([0.0, 0.0, 6.0], abs=1e-9)
