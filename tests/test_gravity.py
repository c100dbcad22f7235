"""GravitySystem: m g, or the inverse square between planets, and the energy that belongs to each."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab.components import Held, Mass, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy, measure_momentum, summation
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.kernels.forces.inverse_square import TREE_THRESHOLD
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.world import World

AT_ONCE = SimulationConfig(substeps=1, integrator="symplectic_euler")
"""Forces are those at the positions given."""


def planets(G: float = 1.0, softening: float = 0.0, law: str = "clamp") -> World:
    physics = PhysicsConfig(gravity_mode="planet", G=G, softening=softening, softening_law=law)
    return World(GravitySystem(), physics=physics, simulation=AT_ONCE)


def pull_of_pair(r: float, softening: float, law: str) -> tuple[float, float]:
    """Return the force on the left of two bodies r apart, of 2 and 3 kg with G = 5, and their energy."""
    world = planets(5.0, softening, law)
    world.spawn(Transform((-0.25 * r, 0)), Velocity(), Mass(2))
    world.spawn(Transform((0.75 * r, 0)), Velocity(), Mass(3))
    energy = measure_energy(world).potential["gravity"]
    world.step(1e-9)
    assert world.bodies.force[1].tolist() == (-world.bodies.force[2]).tolist()
    return float(world.bodies.force[1, 0]), energy


# ---- linear ------------------------------------------------------------------------------------------------


def test_everything_with_mass_falls_alike() -> None:
    world = World(GravitySystem())
    bodies = [world.spawn(Transform(), Velocity((1, 0)), Mass(mass)) for mass in (0.1, 1, 1000)]
    world.step(0.5)
    for body in bodies:
        assert tuple(world.component(body, Velocity).linear) == pytest.approx((1, -9.81 / 2), rel=1e-14)
    assert world.bodies.force[1:].tolist() == [[0, -0.1 * 9.81], [0, -9.81], [0, -1000 * 9.81]]


def test_what_is_not_pulled() -> None:
    world = World(GravitySystem())
    world.spawn(Transform(), Velocity(), Mass())
    others = [world.spawn(Transform(), Velocity()), world.spawn(Transform(), Velocity(), Mass(), Held())]
    world.step()
    assert all(world.component(body, Velocity).linear == Vector2() for body in others)


def test_energy_of_a_height() -> None:
    world = World(GravitySystem(), physics=PhysicsConfig(gravity=Vector2(3, -10)))
    world.spawn(Transform((2, 7)), Velocity(), Mass(4))
    world.spawn(Transform((2, 7)), Mass(4))  # static: its energy never changes and does not count
    assert measure_energy(world).potential == {"gravity": -4 * (3 * 2 - 10 * 7)}


# ---- planet ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", ["clamp", "plummer"])
@given(r=st.floats(1e-3, 1e3))
def test_inverse_square(law: str, r: float) -> None:
    force, energy = pull_of_pair(r, 0.0, law)
    assert force == pytest.approx(5 * 2 * 3 / r**2, rel=1e-12)
    assert energy == pytest.approx(-5 * 2 * 3 / r, rel=1e-12)


@given(r=st.floats(1e-3, 10.0), softening=st.floats(0.01, 5.0))
def test_clamp_holds_the_distance_at_the_softening(r: float, softening: float) -> None:
    force, _ = pull_of_pair(r, softening, "clamp")
    assert force == pytest.approx(30 / max(r, softening) ** 2, rel=1e-12)


@given(r=st.floats(1e-3, 10.0), softening=st.floats(0.01, 5.0))
def test_plummer_softens_smoothly(r: float, softening: float) -> None:
    force, energy = pull_of_pair(r, softening, "plummer")
    assert force == pytest.approx(30 * r / (r**2 + softening**2) ** 1.5, rel=1e-12)
    assert energy == pytest.approx(-30 / math.hypot(r, softening), rel=1e-12)


@pytest.mark.parametrize("law", ["clamp", "plummer"])
@pytest.mark.parametrize("r", [0.01, 0.3, 0.99, 1.01, 3.0])
def test_the_force_is_the_slope_of_the_energy(law: str, r: float) -> None:
    step = 1e-5
    slope = (pull_of_pair(r + step, 1.0, law)[1] - pull_of_pair(r - step, 1.0, law)[1]) / (2 * step)
    assert pull_of_pair(r, 1.0, law)[0] == pytest.approx(slope, rel=1e-8)


def test_clamp_s_energy_has_no_jump_at_the_softening() -> None:
    just_inside, just_outside = (pull_of_pair(r, 1.0, "clamp")[1] for r in (1 - 1e-12, 1 + 1e-12))
    assert just_inside == pytest.approx(just_outside, rel=1e-11)


@pytest.mark.parametrize("law", ["clamp", "plummer"])
@pytest.mark.parametrize("softening", [0.0, 0.5])
def test_coincident_bodies_do_not_pull(law: str, softening: float) -> None:
    world = planets(1.0, softening, law)
    pair = [world.spawn(Transform((1, 2)), Velocity(), Mass(2)) for _ in range(2)]
    world.step(0.1)
    assert all(world.component(body, Velocity).linear == Vector2() for body in pair)
    assert math.isfinite(measure_energy(world).potential["gravity"])


def test_superposition() -> None:
    world = planets(2.0)
    places, masses = np.array([[0.0, 0], [3, 0], [0, 4], [-1, -1]]), [1.0, 2.0, 5.0, 0.5]
    for place, mass in zip(places, masses, strict=True):
        world.spawn(Transform(place), Velocity(), Mass(mass))
    world.step(1e-9)
    for i in range(4):
        expected = sum(
            2.0 * masses[i] * masses[j] * (places[j] - places[i]) / np.linalg.norm(places[j] - places[i]) ** 3
            for j in range(4)
            if j != i
        )
        assert world.bodies.force[1 + i] == pytest.approx(expected, rel=1e-12)


def test_a_static_mass_attracts_and_stays() -> None:
    world = planets()
    sun, planet = world.spawn(Transform(), Mass(100)), world.spawn(Transform((10, 0)), Velocity(), Mass(1))
    world.step(0.1)
    assert world.component(planet, Velocity).linear.x == pytest.approx(-0.1, rel=1e-12)
    assert world.component(sun, Transform).position == Vector2()


def test_what_is_held_or_kinematic_takes_no_part() -> None:
    world = planets()
    free = world.spawn(Transform(), Velocity(), Mass(1))
    other = world.spawn(Transform((0, 2)), Velocity(), Mass(4))
    held = world.spawn(Transform((1, 0)), Velocity(), Mass(1000), Held())
    world.spawn(Transform((-1, 0)), Velocity((0, 0)))
    world.step(0.1)
    assert tuple(world.component(free, Velocity).linear) == pytest.approx((0, 0.1), abs=1e-15)
    assert world.component(held, Velocity).linear == Vector2()

    world.discard(held, Held)
    world.step(0.1)
    assert world.component(free, Velocity).linear.x == pytest.approx(100, rel=1e-3)
    assert world.component(other, Velocity).linear.x > 0


def test_momentum_is_conserved() -> None:
    physics = PhysicsConfig(gravity_mode="planet", softening=0.05)
    simulation = SimulationConfig(dt=0.001, substeps=1)
    world = World(GravitySystem(), IntegrateSystem(), physics=physics, simulation=simulation)
    random = np.random.default_rng(1)
    for _ in range(6):
        place, motion = random.normal(size=2), random.normal(size=2)
        world.spawn(Transform(place), Velocity(motion), Mass(random.uniform(0.1, 10)))
    before = measure_momentum(world)
    world.run(steps=10_000)
    after = measure_momentum(world)
    assert (after.linear - before.linear).magnitude < 1e-12 * before.linear.magnitude
    assert after.angular == pytest.approx(before.angular, rel=1e-11)


def test_modes_switch_while_running() -> None:
    world = World(GravitySystem(), simulation=AT_ONCE)
    ball = world.spawn(Transform((1, 0)), Velocity(), Mass(1))
    world.spawn(Transform((0, 0)), Mass(4))
    velocity = world.component(ball, Velocity)
    world.step(0.1)
    assert velocity.linear.y == pytest.approx(-0.981)
    velocity.linear = (0, 0)
    world.physics = PhysicsConfig(gravity_mode="planet")
    world.step(0.1)
    assert tuple(velocity.linear) == pytest.approx((-0.4, 0), abs=1e-15)
    velocity.linear = (0, 0)
    world.physics = PhysicsConfig(gravity_mode="none")
    world.step(0.1)
    assert velocity.linear == Vector2()


@pytest.mark.parametrize(
    ("n", "said"), [(100, ""), (101, "each pair of 101"), (TREE_THRESHOLD, "Barnes-Hut tree of 8000")]
)
def test_how_it_sums_is_said(n: int, said: str) -> None:
    world = planets(1e-6, 0.1, "plummer")
    for x, y in np.random.default_rng(8).uniform(-10.0, 10.0, (n, 2)):
        world.spawn(Transform((x, y)), Velocity(), Mass(1.0))
    world.synchronise()
    assert summation(world).startswith(said) and bool(summation(world)) == bool(said)
    world.physics = PhysicsConfig(gravity_mode="linear")
    world.synchronise()
    assert summation(world) == ""


@pytest.mark.parametrize("mode", ["linear", "planet"])
def test_no_kernel_of_the_other_mode_is_waited_for(mode: str) -> None:
    world = World(GravitySystem(), physics=PhysicsConfig(gravity_mode=mode))
    [system] = (each for each in world.schedule.systems if isinstance(each, GravitySystem))
    names = [kernel.__name__ for kernel in system.kernels_for(world)]
    assert ("inverse_square" in names) == (mode == "planet")
    assert ("uniform_gravity" in names) == (mode == "linear")
