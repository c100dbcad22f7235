"""Diagnostics: energies and momenta against numbers worked out by hand."""

import math

import pytest

from physicslab.components import Held, Mass, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import Drift, Energy, measure_energy, measure_momentum
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import circle
from physicslab.state.state import State
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.spring import SpringSystem
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import ForceSystem, Stage, at
from physicslab.world import World


def test_kinetic_energy_and_momenta() -> None:
    world = World()
    world.spawn(Transform((1, 2)), Velocity((3, 4), 5), Mass(2), Shape.circle(0.5))
    world.spawn(Transform((-1, 0)), Velocity((0, -2)), Mass(3))
    energy, momentum = measure_energy(world), measure_momentum(world)
    assert energy.kinetic_linear == 0.5 * 2 * 25 + 0.5 * 3 * 4
    assert energy.kinetic_angular == 0.5 * 0.25 * 25
    assert energy.kinetic == energy.total == 31 + 3.125
    assert momentum.linear == Vector2(2 * 3, 2 * 4 - 3 * 2)
    assert momentum.angular == 2 * (1 * 4 - 2 * 3) + 0.25 * 5 + 3 * (-1 * -2)


def test_only_what_forces_move_counts() -> None:
    world = World()
    world.spawn(Transform((1, 1)), Velocity((3, 4), 5))
    world.spawn(Transform((1, 1)), Velocity((3, 4), 5), Mass(2, 1), Held())
    world.spawn(Transform((1, 1)), Mass(2))
    spinning = world.spawn(Transform(), Velocity((0, 0), 5), Mass(2, 1, fixed_rotation=True))
    assert measure_energy(world) == Energy(0.0, 0.0, {})
    assert measure_momentum(world).angular == 0.0
    world.component(spinning, Mass).fixed_rotation = False
    world.component(spinning, Velocity).angular = 2.0
    assert measure_energy(world).kinetic_angular == 2.0


def test_every_force_reports_what_it_stores() -> None:
    class Wind(ForceSystem):
        potential = "wind"

        @at(Stage.FORCE)
        def blow(self, world: World, h: float) -> None: ...

        def potential_energy(self, state: State) -> float:
            return 7.0

    world = World(GravitySystem(), SpringSystem(), Wind())
    world.spawn(Transform((0, 3)), Velocity(), Mass(2), Spring(rest_length=1, stiffness=10))
    energy = measure_energy(world)
    assert energy.potential == {"gravity": pytest.approx(2 * 9.81 * 3), "spring": 20.0, "wind": 7.0}
    assert energy.total == pytest.approx(58.86 + 20 + 7)
    world.physics = PhysicsConfig(gravity_mode="none")
    assert measure_energy(world).potential == {"spring": 20.0, "wind": 7.0}


def test_measuring_follows_changes_at_once_and_changes_nothing() -> None:
    world = World(GravitySystem())
    ball = world.spawn(Transform(), Velocity((2, 0)), Mass(1))
    assert measure_energy(world).kinetic == 2.0
    world.component(ball, Mass).mass = 3.0
    assert measure_energy(world).kinetic == 6.0
    world.add(ball, Velocity((0, 1)))
    assert measure_energy(world).kinetic == 1.5
    assert (world.time, world.force_evaluations) == (0.0, 0)
    world.remove(ball)
    assert measure_energy(world).total == 0.0


def test_drift_keeps_the_largest_departure() -> None:
    world = World(IntegrateSystem())
    velocity = world.component(world.spawn(Transform(), Velocity((2, 0)), Mass(1)), Velocity)
    drift = Drift(world)
    assert (drift.initial.total, drift.relative) == (2.0, 0.0)
    for speed in (2.2, 1.0, 2.0):
        velocity.linear = (speed, 0)
        drift.sample(world)
    assert drift.largest == 1.5 and drift.relative == pytest.approx(1.5 / 2.42)
    assert drift.causes == () and drift.error == drift.relative
    assert drift.latest.total == 2.0


def test_drift_from_nothing_is_relative_to_the_kinetic_energy_seen() -> None:
    world = World(GravitySystem(), IntegrateSystem())
    ball = world.spawn(Transform(), Velocity(), Mass(1))
    drift = Drift(world)
    assert drift.relative == 0.0
    world.run(seconds=1.0)
    drift.sample(world)
    assert drift.latest.kinetic == pytest.approx(0.5 * 9.81**2)
    assert drift.relative < 1e-12
    world.component(ball, Transform).position = (0, 0)
    drift.sample(world)
    assert drift.relative == pytest.approx(1.0)


def gas(height: float, restitution: float, friction: float = 0.0) -> World:
    """Return a gas of discs in bounds that stand so high [m]."""
    bounds = (-2.0, height - 2.0, 2.0, height + 2.0)
    world = World(*standard_systems(), physics=PhysicsConfig(bounds=bounds, bounds_friction=0.0))
    for i in range(6):
        place = (0.7 * (i % 3) - 0.7, height + 0.7 * (i // 3) - 0.4)
        circle(
            world, place, radius=0.2, velocity=(1.0 + i, 2.0 - i), restitution=restitution, friction=friction
        )
    return world


def test_drift_does_not_depend_on_where_the_origin_is() -> None:
    found = []
    for height in (0.0, 1000.0):
        world = gas(height, restitution=0.8, friction=0.4)
        drift = Drift(world)
        for _ in world.stepping(seconds=1.0):
            drift.sample(world)
        found.append((drift.relative, drift.error))
    (change, error), (high_change, high_error) = found
    assert high_change == pytest.approx(change, rel=1e-6) and change > 0.05
    assert error is not None and high_error == pytest.approx(error, abs=1e-9)


def test_what_impacts_and_friction_take_is_no_drift() -> None:
    world = gas(0.0, restitution=0.5, friction=0.4)
    drift = Drift(world)
    for _ in world.stepping(seconds=3.0):
        drift.sample(world)
    assert drift.causes == ("impacts and friction",)
    assert drift.relative > 0.5
    assert drift.error is not None and drift.error < 0.02


def test_energy_that_is_gained_is_drift_whatever_takes_some() -> None:
    world = gas(0.0, restitution=0.5, friction=0.4)
    drift = Drift(world)
    world.table(Velocity)["linear"][1:] *= 2.0
    drift.sample(world)
    assert drift.error == pytest.approx(0.75)


def test_where_something_is_driven_no_change_is_called_drift() -> None:
    world = gas(0.0, restitution=0.5)
    world.spawn(Transform((0.0, -1.5)), Velocity((1.0, 0.0)))
    drift = Drift(world)
    world.run(seconds=0.5)
    drift.sample(world)
    assert drift.error is None and "bodies that are driven" in drift.causes


def test_drift_does_not_hide_what_is_no_number() -> None:
    world = World()
    world.spawn(Transform(), Velocity((1, 0)), Mass(1))
    drift = Drift(world)
    world.table(Velocity)["linear"][1] = math.nan
    drift.sample(world)
    world.table(Velocity)["linear"][1] = 1.0
    drift.sample(world)
    assert math.isnan(drift.relative)
