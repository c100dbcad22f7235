"""Exact solutions, against references of twenty digits and against the engine."""

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from physicslab import load_scene
from physicslab.components import Mass, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_account
from physicslab.diagnostics.reference_solution import reference_solution
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.kernels.ode.kepler import move_two
from physicslab.state.masses import Diverged
from physicslab.systems.standard import standard_systems
from physicslab.world import World

type Motion = NDArray[np.float64]

AFTER_200_PI_PLUS_1 = {
    0.0: (0.5403023058681397174009, 0.8414709848078965066525),
    0.5: (-0.4279672455611135512613, 0.8637757010451036723824),
    0.9: (-1.187188466345863385846, 0.4175276387397642323308),
    0.99: (-1.339314318191828685311, 0.1321809070607890006155),
}


def propagate_kepler(
    place: NDArray[np.float64], speed: NDArray[np.float64], mu: float, t: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    places, rates = np.zeros((4, 2)), np.zeros((4, 2))
    places[1], rates[1] = place, speed
    move_two(places, rates, np.array((1.0, 0.0)), mu, np.array((t,)), np.zeros((1, 4)), np.zeros((1, 4)))
    return places[1], rates[1]


@pytest.mark.parametrize("e", AFTER_200_PI_PLUS_1)
def test_kepler_orbits_against_the_reference(e: float) -> None:
    start, speed = np.array((1.0 - e, 0.0)), np.array((0.0, math.sqrt((1 + e) / (1 - e))))
    place, _ = propagate_kepler(start, speed, 1.0, 1.0)
    assert place == pytest.approx(AFTER_200_PI_PLUS_1[e], abs=1e-14 / (1.0 - e))


def by_mpmath(
    places: Motion, rates: Motion, weight: tuple[float, float], t: float
) -> tuple[list[mpmath.mpf], list[mpmath.mpf]]:
    """Return places and velocities of both (4,), of 120 digits: Gauss's f and g, with G = 1."""
    mass, total, t = mpmath.matrix(weight), mpmath.mpf(weight[0]) + weight[1], mpmath.mpf(t)
    q, v = mpmath.matrix(places[:2].ravel()), mpmath.matrix(rates[:2].ravel())
    x, u = q[2:] - q[:2], v[2:] - v[:2]
    r, radial = mpmath.norm(x), (x.T * u)[0]
    root = mpmath.sqrt((2 * total / r - (u.T * u)[0]) or mpmath.mpf(10) ** -40)  # imaginary on a hyperbola

    def parts(s: mpmath.mpf) -> tuple[mpmath.mpf, ...]:
        c1, c2 = mpmath.sin(root * s) / root, (1 - mpmath.cos(root * s)) / root**2
        c3 = (s - c1) / root**2
        return c1.real, c2.real, c3.real, (r * c1 + radial * c2 + total * c3).real

    high = min(t / r, 1 / abs(root))
    while parts(high)[3] < t:
        high *= 2
    low = mpmath.mpf(0)
    for _ in range(400):
        middle = (low + high) / 2
        low, high = (low, middle) if parts(middle)[3] > t else (middle, high)
    c1, c2, c3, _ = parts(low)
    after = (r * mpmath.cos(root * low) + radial * c1 + total * c2).real
    moved = -total * c2 / r * x + (t - total * c3) * u
    gained = -total * c1 / (r * after) * x - total * c2 / after * u
    drift = (mass[0] * v[:2] + mass[1] * v[2:]) / total
    one, other = -mass[1] / total, mass[0] / total
    ends = [*(q[:2] + t * drift + one * moved), *(q[2:] + t * drift + other * moved)]
    return ends, [*(v[:2] + one * gained), *(v[2:] + other * gained)]


@pytest.mark.parametrize(("far", "speed", "ratio", "t"), [
    ((0.8, 0.6), (-0.6, 0.8), 1.0, 100.0),  # a circle
    ((1.0, 0.0), (0.0, 0.3), 0.25, 1e-9),
    ((1.0, 0.0), (0.0, 0.3), 1e-12, 2e6 * math.pi),  # many periods
    ((1.0, 0.0), (1.2, 7e-4), 1e-3, 1e3),  # e = 0.999999, out and back through the pericentre
    ((2e5, 1.0), (-3.1e-3, 0.0), 0.5, 1e8),  # nearly a parabola, through a passage at 1e-7 of the distance
    ((2.0, 0.0), (0.0, 1.0), 0.0, 300.0),  # a parabola about a fixed body
    ((-9.0, 0.03), (1.0, 0.0), 1e-6, 14.0),  # a flyby, inbound
    ((-1e6, 1.0), (4.0, 0.0), 1.0, 1e6),
    ((3.0, 4.0), (6.0, 8.0), 1.0, 1e5),  # straight away
    ((3.0, 4.0), (-0.3, -0.4), 1.0, 3.0),  # straight in, until shortly before they meet
])  # fmt: skip
def test_two_bodies_are_right_to_the_last_digit(
    far: tuple[float, float], speed: tuple[float, float], ratio: float, t: float
) -> None:
    places, rates = np.array([(0.0, 0.0), far, (0, 0), (0, 0)]), np.array([(0.0, 0), speed, (0, 0), (0, 0)])
    if ratio:
        places[:2] += 0.1 * far[0], -0.3
        rates[:2] += 0.01, 0.003
    q, v, weight = np.zeros((1, 4)), np.zeros((1, 4)), (1.0, ratio)
    with mpmath.workdps(120):
        true = by_mpmath(places, rates, weight, t)
        move_two(places, rates, np.array(weight), 1.0, np.array((t,)), q, v)
        for ours, theirs in zip((q[0], v[0]), true, strict=True):
            for body in (slice(2), slice(2, 4)):
                off = mpmath.norm(mpmath.matrix(ours[body]) - mpmath.matrix(theirs[body]))
                assert off <= 1.2e-16 * mpmath.norm(mpmath.matrix(theirs[body])), body


orbit = st.floats(-3, 3).filter(lambda x: abs(x) > 0.05)


@given(orbit, orbit, st.floats(-3, 3), st.floats(-3, 3), st.floats(0, 20))
def test_kepler_orbits_keep_energy_and_lead_back(x: float, y: float, u: float, v: float, t: float) -> None:
    if abs(x * v - y * u) < 1e-6:
        return  # straight through the middle, where every digit is lost
    places, rates = np.zeros((4, 2)), np.zeros((4, 2))
    places[1], rates[1] = (x, y), (u, v)
    parts = np.array((1.0, 0.0)), 1.0, np.array((t,)), np.zeros((1, 4)), np.zeros((1, 4))
    energy = 0.5 * (u * u + v * v) - 1 / math.hypot(x, y)
    move_two(places, rates, *parts)
    there, then = places[1], rates[1]
    lost = 1e-15 * (1 + then @ then + 1 / np.hypot(*there))  # both parts of it are rounded
    assert 0.5 * then @ then - 1 / np.hypot(*there) == pytest.approx(energy, abs=lost)
    assert there[0] * then[1] - there[1] * then[0] == pytest.approx(x * v - y * u, rel=1e-9)
    rates[:] = -rates
    move_two(places, rates, *parts)
    assert places[1] == pytest.approx((x, y), abs=1e-15)


def world_of(*bodies: tuple[object, ...], integrator: str, **physics: object) -> World:
    settings = PhysicsConfig(**physics)  # type: ignore[arg-type]
    world = World(*standard_systems(), physics=settings, simulation=SimulationConfig(integrator=integrator))
    for body in bodies:
        world.spawn(*body)
    return world


def test_two_bodies_that_both_move_are_followed_and_the_error_falls_with_the_method() -> None:
    errors = {}
    for name in ("symplectic_euler", "leapfrog", "rk4", "dop853", "auto"):
        world = world_of(
            (Transform((1, 0)), Velocity((0.3, 0.4)), Mass(1)),
            (Transform((-1, 0)), Velocity((0.1, -0.3)), Mass(2)),
            integrator=name, gravity_mode="planet",
        )  # fmt: skip
        known = reference_solution(world)
        assert known is not None and known.what == "attraction between two bodies"
        assert known.error(world) == 0.0
        world.run(seconds=3.0)
        errors[name] = known.error(world)
    assert errors["symplectic_euler"] > 10 * errors["leapfrog"] > 1000 * errors["rk4"]
    assert errors["dop853"] < 1e-12
    assert errors["auto"] == 0.0  # it is the same solution


def test_two_that_fall_straight_into_each_other_are_left_to_a_method_that_says_so() -> None:
    world = world_of(
        (Transform((1, 0)), Velocity(), Mass(1)), (Transform((-1, 0)), Velocity(), Mass(2)),
        integrator="auto", gravity_mode="planet",
    )  # fmt: skip
    assert reference_solution(world) is None
    with pytest.raises(Diverged, match=r"point 1 falls into point 2, .*softening > 0 keeps it finite"):
        world.run(seconds=3.0)


@pytest.mark.parametrize("star", [(), (Velocity((0.3, -0.2)),)])
def test_orbits_in_closed_form_keep_books_and_come_back(star: tuple[Velocity, ...]) -> None:
    world = world_of(
        (Transform((5, -3)), *star, Mass(2)), (Transform((6, -3)), Velocity((0.1, 1.2)), Mass(0.5)),
        integrator="exact", gravity_mode="planet",
    )  # fmt: skip
    bodies = [entity for entity in world.entities() if world.has(entity, Mass)]
    start = [world.component(entity, Transform).position for entity in bodies]
    for _ in range(300):
        world.step()
    assert world.plan.integrator.name == "exact"
    account = measure_account(world)
    assert abs(account.energy["numerical"]) < 1e-13
    assert account.momentum["numerical"].magnitude < 1e-13
    assert abs(account.angular_momentum["numerical"]) < 1e-12
    for entity in bodies:
        if world.has(entity, Velocity):
            body = world.component(entity, Velocity)
            body.linear = -body.linear
    for _ in range(300):
        world.step()
    ends = [world.component(entity, Transform).position for entity in bodies]
    assert np.array([(*end,) for end in ends]) == pytest.approx(
        np.array([(*one,) for one in start]), abs=1e-12
    )


def test_a_fixed_star_pulls_by_its_mass_alone() -> None:
    world = world_of(
        (Transform((0, 0)), Mass(2)), (Transform((1, 0)), Velocity((0, 1.2)), Mass(5)),
        integrator="dop853", gravity_mode="planet",
    )  # fmt: skip
    known = reference_solution(world)
    assert known is not None
    world.run(seconds=5.0)
    assert known.error(world) < 1e-12


def test_a_spring_in_line_and_a_thrown_ball_are_known() -> None:
    spring = Spring(rest_length=1, stiffness=40, damping=0.5)
    for body in (
        (Transform((1.2, 0)), Velocity(), Mass(1), spring),
        (Transform(), Velocity((3, 4)), Mass(1)),
    ):
        world = world_of(body, integrator="rk4", gravity_mode="none")
        known = reference_solution(world)
        assert known is not None
        world.run(seconds=2.0)
        assert 0.0 <= known.error(world) < 1e-6


def test_what_has_no_solution_has_none() -> None:
    swinging = (Transform((2, 0)), Velocity(), Mass(1), Spring(rest_length=1))
    assert reference_solution(world_of(swinging, integrator="auto")) is None
    assert reference_solution(load_scene("solar_system")) is None
    touching = [(Transform((x, 0)), Velocity(), Mass(1), Shape.circle(1)) for x in (2, 9)]
    assert reference_solution(world_of(*touching, integrator="auto")) is None
    assert reference_solution(World()) is None


def test_orbits_near_the_largest_numbers_are_moved_by_a_method_that_can() -> None:
    world = world_of(
        (Transform((0, 0)), Mass(1e300)), (Transform((1e150, 0)), Velocity((0, 1e10)), Mass(1)),
        integrator="auto", gravity_mode="planet",
    )  # fmt: skip
    world.run(steps=3)
    assert world.time == pytest.approx(3 * world.simulation.dt)
