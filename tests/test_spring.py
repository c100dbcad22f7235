"""SpringSystem: Hooke and damping, anchors and torques, and springs whose bodies go."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab.components import Held, Mass, Name, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy, measure_momentum
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import circle
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.spring import SpringSystem
from physicslab.world import World

AT_ONCE = SimulationConfig(substeps=1, integrator="symplectic_euler")
"""Forces are those at the positions given."""


def springs() -> World:
    return World(SpringSystem(), simulation=AT_ONCE)


def pull_on(world: World, *entities: int) -> list[tuple[list[float], float]]:
    """Return force and torque on each body, as things are now."""
    world.step(1e-12)
    world.add_up_forces()
    rows = [world.entity_index.row_of[entity] for entity in entities]
    return [(world.bodies.force[row].tolist(), float(world.bodies.torque[row])) for row in rows]


# ---- force -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("x", "force"), [(3.0, -50 * (3 - 1)), (1.0, 0.0), (0.25, 50 * 0.75)])
def test_hooke(x: float, force: float) -> None:
    world = springs()
    ball = world.spawn(Transform((x, 0)), Velocity(), Mass(), Spring(rest_length=1, stiffness=50))
    assert pull_on(world, ball)[0][0] == [pytest.approx(force), 0.0]
    assert measure_energy(world).potential["spring"] == pytest.approx(0.5 * 50 * (x - 1) ** 2)


@pytest.mark.parametrize(("velocity", "force"), [((2, 0), -6.0), ((-2, 0), 6.0), ((0, 5), 0.0)])
def test_damping_opposes_the_change_of_length(velocity: tuple[float, float], force: float) -> None:
    world = springs()
    spring = Spring(rest_length=4, stiffness=50, damping=3)
    ball = world.spawn(Transform((4, 0)), Velocity(velocity), Mass(), spring)
    assert pull_on(world, ball)[0][0] == [pytest.approx(force), 0.0]


def test_two_bodies_with_anchors() -> None:
    world = springs()
    a = world.spawn(Transform((0, 0), math.pi / 2), Velocity(), Mass(1, 1))
    b = world.spawn(Transform((4, 0)), Velocity(), Mass(1, 1))
    # A is turned a quarter: its anchor (1, 0) is at (0, 1). B's is at (3, 1): the line is 3 m long, level.
    world.spawn(Spring(a, b, (1, 0), (-1, 1), rest_length=1, stiffness=10))
    (on_a, torque_a), (on_b, torque_b) = pull_on(world, a, b)
    assert on_a == pytest.approx([20, 0]) and on_b == pytest.approx([-20, 0])
    assert torque_a == pytest.approx(-20)  # (0, 1) x (20, 0)
    assert torque_b == pytest.approx(20)  # (-1, 1) x (-20, 0)


def test_damping_includes_the_turning_of_anchors() -> None:
    world = springs()
    wheel = world.spawn(Transform(), Velocity((0, 0), 2.0), Mass(1, 1))
    world.add(wheel, Spring(anchor_a=(0, 1), anchor_b=(-3, 1), rest_length=3, stiffness=1, damping=5))
    # The anchor moves at w x r = (-2, 0), towards the wall: the spring shortens at 2 m/s, pushing with 10 N.
    [(force, torque)] = pull_on(world, wheel)
    assert force == pytest.approx([10, 0]) and torque == pytest.approx(-10)


def test_ends_that_meet_have_no_line() -> None:
    world = springs()
    ball = world.spawn(Transform((1, 1)), Velocity((3, 4)), Mass(), Spring(anchor_b=(1, 1), damping=2))
    assert pull_on(world, ball) == [([0.0, 0.0], 0.0)]
    assert math.isfinite(measure_energy(world).total)


coordinate = st.floats(-5, 5)
pair = st.tuples(coordinate, coordinate)


@given(pair, pair, pair, pair, st.floats(0, 3), st.floats(0, 100), st.floats(0, 10))
def test_forces_are_equal_and_opposite(
    at_a: tuple[float, float], at_b: tuple[float, float], anchor_a: tuple[float, float],
    anchor_b: tuple[float, float], angle: float, stiffness: float, damping: float,
) -> None:  # fmt: skip
    world = springs()
    a = world.spawn(Transform(at_a, angle), Velocity((1, 2), 3), Mass(1, 1))
    b = world.spawn(Transform(at_b, -angle), Velocity((-2, 1), -1), Mass(2, 1))
    world.spawn(Spring(a, b, anchor_a, anchor_b, 1.0, stiffness, damping))
    (on_a, torque_a), (on_b, torque_b) = pull_on(world, a, b)
    assert on_a == [-on_b[0], -on_b[1]]
    about_the_origin = (
        torque_a + torque_b + Vector2(*at_a).cross(Vector2(*on_a)) + Vector2(*at_b).cross(Vector2(*on_b))
    )
    assert about_the_origin == pytest.approx(0, abs=1e-11 * (1 + math.hypot(*on_a)))


def test_the_force_is_the_slope_of_the_energy() -> None:
    def energy(x: float, y: float, angle: float) -> float:
        world = springs()
        body = world.spawn(Transform((x, y), angle), Velocity(), Mass(1, 1))
        world.spawn(Spring(body, None, (0.5, 0.25), (2, -1), rest_length=0.7, stiffness=30))
        found = measure_energy(world).potential["spring"]
        [((fx, fy), torque)] = pull_on(world, body)
        slopes.append((fx, fy, torque))
        return found

    slopes: list[tuple[float, float, float]] = []
    pose, step = np.array([0.3, 0.4, 0.5]), 1e-5
    energy(*pose)
    for i in range(3):
        there, back = pose.copy(), pose.copy()
        there[i] += step
        back[i] -= step
        assert slopes[0][i] == pytest.approx(-(energy(*there) - energy(*back)) / (2 * step), rel=1e-7)


# ---- motion ------------------------------------------------------------------------------------------------


def test_an_oscillation_has_its_period() -> None:
    world = World(SpringSystem(), IntegrateSystem(), simulation=SimulationConfig(dt=0.001))
    spring = Spring(rest_length=0, stiffness=9)
    ball = world.spawn(Transform((2, 0)), Velocity(), Mass(4), spring)  # omega = 3/2
    world.run(seconds=5.0)
    assert world.component(ball, Transform).position.x == pytest.approx(2 * math.cos(7.5), rel=1e-6)


def test_a_damped_oscillation_loses_energy_by_the_formula() -> None:
    world = World(SpringSystem(), IntegrateSystem(), simulation=SimulationConfig(dt=0.0005))
    ball = world.spawn(Transform((3, 0)), Velocity(), Mass(2), Spring(rest_length=2, stiffness=50, damping=1))
    world.run(seconds=2.0)
    decay, omega = 1 / 4, math.sqrt(25 - 1 / 16)
    expected = math.exp(-decay * 2) * (math.cos(omega * 2) + decay / omega * math.sin(omega * 2))
    assert world.component(ball, Transform).position.x - 2 == pytest.approx(expected, abs=2e-4)


def test_a_pendulum_on_a_stiff_spring() -> None:
    world = World(GravitySystem(), SpringSystem(), IntegrateSystem(), simulation=SimulationConfig(dt=0.0005))
    k, m, g, swing = 1e4, 1.0, 9.81, 0.05
    length = 1.0 + m * g / k
    bob = world.spawn(Transform((length * math.sin(swing), -length * math.cos(swing))), Velocity(), Mass(m))
    world.add(bob, Spring(rest_length=1.0, stiffness=k))
    transform = world.component(bob, Transform)
    before = measure_energy(world).total
    xs = [transform.position.x for _ in world.stepping(seconds=2.6)]
    crossings = [i - xs[i] / (xs[i] - xs[i - 1]) for i in range(1, len(xs)) if xs[i - 1] * xs[i] < 0]
    period = 2 * math.pi * math.sqrt(length / g) * (1 + swing**2 / 16)
    assert (crossings[2] - crossings[0]) * world.simulation.dt == pytest.approx(period, rel=1e-5)
    assert measure_energy(world).total == pytest.approx(before, rel=1e-6)


def test_momenta_are_conserved() -> None:
    world = World(SpringSystem(), IntegrateSystem())
    a = world.spawn(Transform((0, 0)), Velocity((1, 0), 2), Mass(1, 0.5))
    b = world.spawn(Transform((2, 0)), Velocity((0, 2), -1), Mass(3, 0.2))
    world.spawn(Spring(a, b, (0.3, 0.1), (-0.2, 0.4), rest_length=1, stiffness=40, damping=0.5))
    before = measure_momentum(world)
    world.run(steps=2000)
    after = measure_momentum(world)
    assert tuple(after.linear) == pytest.approx(tuple(before.linear), rel=1e-12)
    assert after.angular == pytest.approx(before.angular, rel=1e-11)


def test_a_held_end_pulls_and_is_not_pulled() -> None:
    world = World(SpringSystem(), IntegrateSystem())
    hand = world.spawn(Transform(), Velocity(), Mass(), Held())
    ball = world.spawn(Transform((2, 0)), Velocity(), Mass())
    world.spawn(Spring(hand, ball, rest_length=1))
    world.step(0.1)
    assert world.component(hand, Transform).position == Vector2()
    assert world.component(ball, Velocity).linear.x < 0


# ---- ends --------------------------------------------------------------------------------------------------


def test_a_spring_goes_with_its_body() -> None:
    world = springs()
    kept, gone = world.spawn(Transform()), world.spawn(Transform((1, 0)), Velocity(), Mass())
    own = world.spawn(Spring(kept, gone))
    named = world.spawn(Spring(gone, kept), Name("rope"))
    world.add(kept, Spring(None, gone))
    world.step()
    world.remove(gone)
    world.step()
    assert world.entities() == [kept]
    assert not world.has(own, Spring) and not world.has(named, Spring) and not world.has(kept, Spring)
    assert "SpringSystem" in [system.name for system in world.schedule.left_out]


def test_a_spring_goes_with_its_body_when_that_was_the_newest() -> None:
    world = springs()
    kept, gone = world.spawn(Transform(), Velocity(), Mass()), world.spawn(Transform((1, 0)))
    world.add(kept, Spring(None, gone))
    world.step()
    world.remove(gone)
    world.step()
    assert world.entities() == [kept] and not world.has(kept, Spring)


def test_another_body_may_come_before_the_next_step_when_that_of_a_spring_is_gone() -> None:
    world = World()
    ends = [circle(world, (float(x), 0.0), radius=0.2) for x in range(2)]
    spring = world.spawn(Spring(ends[0], ends[1]))
    world.step()
    world.remove(ends[0])
    new = circle(world, (5.0, 5.0), radius=0.2)
    world.step()
    assert world.entities() == [ends[1], new] and not world.has(spring, Spring)


@pytest.mark.parametrize(("spring", "field", "value"), [(Spring(1, 2), "b", 2), (Spring(None, 1), "a", 3)])
def test_an_end_that_is_no_body_is_refused_by_name(spring: Spring, field: str, value: int) -> None:
    world = springs()
    ball, _without_transform = world.spawn(Transform()), world.spawn(Velocity())
    rope = world.spawn(spring, name="rope")
    for _ in range(2):
        with pytest.raises(
            InvalidValue, match=f"rope: Spring.{field} = {value}: must be an entity with a Transform"
        ):
            world.step()
    world.remove(rope)
    world.step()
    assert world.has(ball, Transform)


@pytest.mark.parametrize("make", [World, springs])
def test_an_end_that_is_nothing_is_refused_when_the_spring_is_made(make: Callable[[], World]) -> None:
    world = make()
    ball = world.spawn(Transform())
    for spring, field in ((Spring(99, None), "a"), (Spring(ball, 99), "b")):
        for attempt in (lambda: world.spawn(spring), lambda: world.add(ball, spring)):  # noqa: B023
            with pytest.raises(InvalidValue, match=f"Spring.{field} = 99: must be an entity of this world"):
                attempt()
    assert world.entities() == [ball]


def test_ends_are_fixed() -> None:
    world = springs()
    world.spawn(Transform())
    spring = world.component(world.spawn(Spring(1)), Spring)
    with pytest.raises(AttributeError, match=r"Spring\.b is fixed"):
        spring.b = 1
    spring.stiffness = 7
    assert world.table(Spring)["stiffness"].max() == 7


def test_rows_may_move_under_a_spring() -> None:
    world = World(SpringSystem(), IntegrateSystem(), simulation=AT_ONCE, physics=PhysicsConfig())
    crowd = [world.spawn(Transform((9, 9))) for _ in range(40)]
    a, b = world.spawn(Transform()), world.spawn(Transform((3, 0)), Velocity(), Mass())
    world.spawn(Spring(a, b, rest_length=1, stiffness=10))
    assert pull_on(world, b)[0][0] == pytest.approx([-20, 0])
    for entity in crowd:
        world.remove(entity)
    assert pull_on(world, b)[0][0] == pytest.approx([-20, 0])
    assert len(world.entity_index) == 4
