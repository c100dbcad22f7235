"""Bodies: what rows weigh, Newton's second law, damping, and runs that diverge."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab.components import Held, Mass, Shape, Transform, Velocity
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.state.masses import Diverged
from physicslab.state.state import State
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import ForceSystem, Stage, System, at
from physicslab.world import World

NO_GRAVITY = PhysicsConfig(gravity_mode="none")


class Push(ForceSystem):
    """The same force and torque on every row."""

    def __init__(self, force: tuple[float, float], torque: float = 0.0) -> None:
        self.force, self.torque = force, torque

    def depends_on_velocity(self, state: State) -> bool:
        return False

    @at(Stage.FORCE)
    def push(self, world: World, h: float) -> None:
        world.bodies.force += self.force
        world.bodies.torque += self.torque


def weights(*components: Any) -> tuple[float, float]:
    """Return the inverse mass and inertia of a lone entity."""
    world = World()
    world.spawn(*components)
    world.synchronise()
    return float(world.bodies.inverse_mass[1]), float(world.bodies.inverse_inertia[1])


def test_presence_decides_what_a_body_weighs() -> None:
    disc = Shape.circle(0.5)
    assert weights(Transform(), Velocity(), Mass(2.0), disc) == (0.5, 4.0)  # I = m r^2 / 2
    assert weights(Transform(), Velocity(), Mass(6.0), Shape.box(1, 1)) == (1 / 6, 1.0)  # m (w^2 + h^2) / 12
    assert weights(Transform(), Velocity(), Mass(2.0, inertia=8.0)) == (0.5, 0.125)
    assert weights(Transform(), Velocity(), Mass(2.0)) == (0.5, 0.0)  # a point does not turn
    assert weights(Transform(), Velocity(), Mass(2.0, fixed_rotation=True), Shape.box(1, 1)) == (0.5, 0.0)
    assert weights(Transform(), Mass(2.0), Shape.box(1, 1)) == (0.0, 0.0)  # static
    assert weights(Transform(), Velocity(), Shape.box(1, 1)) == (0.0, 0.0)  # kinematic
    assert weights(Transform(), Velocity(), Mass(2.0), Held()) == (0.0, 0.0)


@pytest.mark.parametrize(("name", "size"), [("radius", -1.0), ("radius", 0.0), ("radius", float("nan"))])
def test_a_size_that_is_written_to_its_column_is_checked(name: str, size: float) -> None:
    world = World(*standard_systems())
    world.spawn(Transform((0, 2)), Velocity(), Mass(1.0), Shape.circle(0.5), name="ball")
    world.spawn(Transform(), Shape.box(9.0, 1.0))
    world.step()
    world.table(Shape)[name][1] = size
    with pytest.raises(InvalidValue, match=r"ball: Shape\.radius"):
        world.step()


def test_a_step_that_is_broken_off_is_taken_back() -> None:
    class Broken(System):
        @at(Stage.FINISH)
        def fail(self, world: World, h: float) -> None:
            raise KeyboardInterrupt

    world = World(*standard_systems(), Broken())
    ball = world.spawn(Transform((0, 2)), Velocity((1, 0)), Mass(1.0))
    with pytest.raises(KeyboardInterrupt):
        world.step()
    assert (world.time, world.steps) == (0.0, 0)
    assert world.component(ball, Transform).position == Vector2(0, 2)
    assert world.component(ball, Velocity).linear == Vector2(1, 0)


def test_forces_and_torques_change_velocities() -> None:
    world = World(Push((3.0, -6.0), 2.0), simulation=SimulationConfig(dt=0.5))
    ball = world.spawn(Transform(), Velocity((1, 1), 1), Mass(2.0, inertia=4.0))
    world.step(0.5)
    velocity = world.component(ball, Velocity)
    assert velocity.linear == Vector2(1 + 3 / 2 * 0.5, 1 - 6 / 2 * 0.5)
    assert velocity.angular == 1 + 2 / 4 * 0.5


def test_what_is_infinitely_heavy_is_not_pushed() -> None:
    world = World(Push((100.0, 100.0), 100.0), IntegrateSystem())
    kinematic = world.spawn(Transform(), Velocity((1, 0), 2))
    held = world.spawn(Transform(), Velocity((0, 1)), Mass(1, 1), Held())
    static = world.spawn(Transform((5, 5)), Mass(1, 1))
    world.step(1.0)
    assert world.component(kinematic, Velocity).linear == Vector2(1, 0)
    assert world.component(kinematic, Transform).angle == 2.0
    assert world.component(held, Transform).position == Vector2(0, 1)
    assert world.component(static, Transform).position == Vector2(5, 5)


def test_forces_end_with_their_system() -> None:
    world = World(GravitySystem(), physics=PhysicsConfig(linear_damping=1e-9))
    ball = world.spawn(Transform(), Velocity(), Mass())
    world.step(0.1)
    falling = world.component(ball, Velocity).linear.y
    world.physics = PhysicsConfig(gravity_mode="none", linear_damping=1e-9)
    world.step(0.1)
    assert world.component(ball, Velocity).linear.y == pytest.approx(falling, rel=1e-9)
    assert not world.bodies.force.any()


@pytest.mark.parametrize("integrator", ["leapfrog", "symplectic_euler"])
@given(st.floats(1e-6, 50.0), st.floats(0.01, 1.0), st.integers(1, 8))
def test_damping_is_the_exact_exponential(
    integrator: str, rate: float, seconds: float, substeps: int
) -> None:
    speed = 7.0
    physics = PhysicsConfig(gravity_mode="none", linear_damping=rate, angular_damping=2 * rate)
    world = World(physics=physics, simulation=SimulationConfig(substeps=substeps, integrator=integrator))
    ball = world.spawn(Transform(), Velocity((speed, 0), speed), Mass(1.0, 1.0))
    world.step(seconds)
    velocity = world.component(ball, Velocity)
    assert velocity.linear.x == pytest.approx(speed * math.exp(-rate * seconds), rel=1e-12)
    assert velocity.angular == pytest.approx(speed * math.exp(-2 * rate * seconds), rel=1e-12)


def test_terminal_speed_is_exact_too() -> None:
    world = World(GravitySystem(), physics=PhysicsConfig(linear_damping=2.0))
    ball = world.spawn(Transform(), Velocity(), Mass(3.0))
    world.run(seconds=0.7)
    expected = -9.81 / 2.0 * (1 - math.exp(-2.0 * 0.7))
    assert world.component(ball, Velocity).linear.y == pytest.approx(expected, rel=1e-12)


def test_damping_leaves_what_is_driven_alone() -> None:
    world = World(physics=PhysicsConfig(gravity_mode="none", linear_damping=5.0, angular_damping=5.0))
    wheel = world.spawn(Transform(), Velocity((1, 0), 3))
    world.step(1.0)
    assert world.component(wheel, Velocity).linear == Vector2(1, 0)
    assert world.component(wheel, Velocity).angular == 3.0


def test_fixed_rotation_keeps_its_angle() -> None:
    world = World(Push((0, 0), 5.0), IntegrateSystem())
    free = world.spawn(Transform((0, 0), 0.3), Velocity((0, 0), 2.0), Mass(1, 1))
    mass = Mass(1, 1, fixed_rotation=True)
    fixed = world.spawn(Transform((0, 0), 0.3), Velocity((0, 0), 2.0), mass)
    world.run(steps=10)
    assert world.component(fixed, Transform).angle == 0.3
    assert world.component(fixed, Velocity).angular == 0.0
    assert world.component(free, Transform).angle > 0.3
    mass.fixed_rotation = False
    world.run(steps=10)
    assert world.component(fixed, Transform).angle > 0.3


@pytest.mark.parametrize(
    ("component", "column", "value"),
    [
        ("Transform", "position", math.nan),
        ("Transform", "angle", math.inf),
        ("Velocity", "linear", -math.inf),
        ("Velocity", "angular", math.nan),
    ],
)
def test_a_run_that_diverges_says_what_and_when(component: str, column: str, value: float) -> None:
    world = World(IntegrateSystem(), physics=NO_GRAVITY)
    world.spawn(Transform(), Velocity())
    world.spawn(Transform(), Velocity(), name="comet")
    world.run(seconds=0.5)
    tables = {"Transform": world.table(Transform), "Velocity": world.table(Velocity)}
    tables[component][column][2] = value
    if component == "Velocity":
        component = "Transform"  # where a substep has carried it
    with pytest.raises(Diverged, match=rf"comet: {component} is no longer finite at t = 0\.75 s"):
        world.step(0.25)
    assert world.time == 0.5


def test_a_velocity_alone_can_diverge() -> None:
    world = World(Push((math.inf, 0.0)))
    world.spawn(Transform(), Velocity(), Mass())
    with pytest.raises(Diverged, match="point 1: Velocity is no longer finite"):
        world.step()


def test_large_but_finite_values_have_not_diverged() -> None:
    world = World(IntegrateSystem(), physics=NO_GRAVITY)
    huge = 9.9e302
    far = world.spawn(Transform((0.0, 1e299)), Velocity((-huge, huge * 1e-9)))
    world.step(1e-3)
    assert world.component(far, Transform).position.x < -9e299, "as far as a file may hold"
    assert np.isfinite(list(world.component(far, Transform).position)).all()
