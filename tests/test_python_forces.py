"""Forces in Python see the time and the velocity of their stage, so that methods keep their order."""

import cmath
import math
from typing import Any

import pytest

from physicslab import World
from physicslab.components import Mass, Transform, Velocity
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.integrators import INTEGRATORS
from physicslab.kernels.forces.force_calls import force_kernel
from physicslab.prefabs import box
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import ForceSystem, Stage, at

FREE = PhysicsConfig(gravity_mode="none")
FIXED = [name for name, method in INTEGRATORS.items() if not method.chooses_steps]


class Drive(ForceSystem):
    """x'' = cos(2 t) - 4 x."""

    needs = (Velocity, Mass)

    @at(Stage.FORCE)
    def push(self, world: State, h: float) -> None:
        rows = world.batch(*self.needs).rows
        places = world.table(Transform)["position"][rows, 0]
        world.bodies.force[rows, 0] += math.cos(2.0 * world.time) - 4.0 * places


class Lorentz(ForceSystem):
    """a = 3 (vy, -vx): circles at the speed of the start."""

    needs = (Velocity, Mass)

    @at(Stage.FORCE)
    def push(self, world: State, h: float) -> None:
        rows = world.batch(*self.needs).rows
        v = world.table(Velocity)["linear"][rows]
        world.bodies.force[rows, 0] += 3.0 * v[:, 1]
        world.bodies.force[rows, 1] -= 3.0 * v[:, 0]


class StatedLorentz(Lorentz):
    """The same, and says so."""

    def depends_on_velocity(self, state: State) -> bool:
        return True


class Pull(Drive):
    """Denies to depend on velocities."""

    def depends_on_velocity(self, state: State) -> bool:
        return False


class DryFriction(ForceSystem):
    """1 N against the motion: it jumps where a body stops."""

    needs = (Velocity, Mass)

    @at(Stage.FORCE)
    def rub(self, world: State, h: float) -> None:
        rows = world.batch(*self.needs).rows
        for row in rows:
            world.bodies.force[row, 0] -= math.copysign(1.0, world.table(Velocity)["linear"][row, 0])


def place(world: World, body: int) -> complex:
    return complex(*world.component(body, Transform).position)


def driven(
    substeps: int, *, seconds: float = 50.0, stepped: bool = False, touching: bool = False, **simulation: Any
) -> float:
    """Return how far the driven oscillator is from x = t sin(2 t) / 4: after 50 s, -6.33 m."""
    config = SimulationConfig(dt=0.125, substeps=substeps, **simulation)
    systems = standard_systems() if touching else (IntegrateSystem(),)
    world = World(*systems, Drive(), physics=FREE, simulation=config)
    body = world.spawn(Transform(), Velocity(), Mass(1.0))
    if touching:
        box(world, (0, 5.5), width=1, height=1, static=True)
        box(world, (0, 7.5), width=1, height=1)
    if stepped:
        for _ in range(round(seconds / 0.125)):
            world.step()
    else:
        world.run(seconds=seconds)
    assert world.time == seconds
    return abs(place(world, body) - 0.25 * seconds * math.sin(2.0 * seconds))


@pytest.mark.parametrize("stepped", [False, True])
@pytest.mark.parametrize("name", FIXED)
def test_a_force_of_time_keeps_the_order_of_every_method(name: str, stepped: bool) -> None:
    if name == "exact":
        pytest.skip("there is no closed form of a force in Python")
    parts = 1 if name == "blanes_moan" else 8
    coarse, fine = (driven(n, seconds=10.0, integrator=name, stepped=stepped) for n in (parts, 2 * parts))
    stated, found = INTEGRATORS[name].order, math.log2(coarse / fine)
    assert stated - 0.1 < found < stated + (1.5 if name == "symplectic_euler" else 0.1)


@pytest.mark.parametrize("stepped", [False, True])
@pytest.mark.parametrize("name", ["auto", "dop853"])
def test_a_force_of_time_is_followed_to_rounding_by_what_chooses_its_steps(name: str, stepped: bool) -> None:
    assert driven(4, integrator=name, stepped=stepped) < 1e-11


def test_a_force_of_time_beside_contacts_keeps_the_order_of_leapfrog() -> None:
    coarse, fine = (driven(n, touching=True, contacts="soft") for n in (8, 16))
    assert math.log2(coarse / fine) == pytest.approx(2, abs=0.1)
    assert driven(8, touching=True) < 1e-11, "rigid contacts follow it, as what chooses its steps does"
    assert driven(16, touching=True, integrator="symplectic_euler") < 0.01


def test_the_time_of_a_stage_is_seen_and_the_clock_is_back_at_the_end_of_the_step() -> None:
    seen: list[float] = []

    class Watch(Drive):
        @at(Stage.FORCE)
        def push(self, world: State, h: float) -> None:
            seen.append(world.time)

        @at(Stage.FINISH)
        def look(self, world: State, h: float) -> None:
            seen.append(-world.time)

    config = SimulationConfig(dt=0.5, substeps=2, integrator="leapfrog")
    world = World(IntegrateSystem(), Watch(), physics=FREE, simulation=config)
    world.spawn(Transform(), Velocity(), Mass(1.0))
    world.time = 8.0
    world.step()
    assert seen == [8.125, 8.375, -8.0]
    assert world.time == 8.5


def test_what_a_force_raises_leaves_the_clock_alone() -> None:
    class Broken(Drive):
        @at(Stage.FORCE)
        def push(self, world: State, h: float) -> None:
            if world.time > 0.3:
                raise ZeroDivisionError("late")

    for systems in ((IntegrateSystem(),), standard_systems()):
        world = World(*systems, Broken(), physics=FREE, simulation=SimulationConfig(dt=0.25))
        for x in (0.0, 2.0):
            box(world, (x, 0), width=1, height=1)
        world.step()
        with pytest.raises(ZeroDivisionError, match="late"):
            world.step()
        assert world.time == 0.25


@force_kernel
def _drive(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add cos(2 t) - 4 x. ``indices``: where x stands, and the time."""
    force[indices[0]] += math.cos(2.0 * q[indices[1]]) - 4.0 * q[indices[0]]


class PackedDrive(ForceSystem):
    """The driven oscillator, compiled."""

    needs = (Velocity, Mass)

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        import numpy as np

        row = state.batch(*self.needs).rows[0]
        return PackedForce(_drive, np.zeros(0), np.array([layout.place[row], layout.clock]))


@pytest.mark.parametrize("touching", [False, True])
@pytest.mark.parametrize("name", ["leapfrog", "rk4", "blanes_moan", "dop853", "implicit_midpoint"])
def test_a_compiled_force_reads_the_time_too(name: str, touching: bool) -> None:
    ends = []
    for drive in (Drive(), PackedDrive()):
        systems = standard_systems() if touching else (IntegrateSystem(),)
        config = SimulationConfig(dt=0.1, integrator=name, tolerance=1e-13)
        world = World(*systems, drive, physics=FREE, simulation=config)
        body = world.spawn(Transform(), Velocity(), Mass(1.0))
        if touching:
            box(world, (0, 5.5), width=1, height=1, static=True)
        world.run(seconds=5.0)
        ends.append(place(world, body))
    assert ends[0] == pytest.approx(ends[1], abs=1e-10)
    assert abs(ends[1].real - 1.25 * math.sin(10.0)) < 0.02


def circling(force: ForceSystem, substeps: int = 4, *, touching: bool = False, **simulation: Any) -> World:
    """Return a world with a body in a magnetic field after 10 s; it is the first entity."""
    config = SimulationConfig(dt=0.1, substeps=substeps, **simulation)
    world = World(*standard_systems(), force, physics=FREE, simulation=config)
    world.spawn(Transform(), Velocity((1, 0)), Mass(1.0))
    if touching:
        box(world, (0, 5.5), width=1, height=1, static=True)
        box(world, (0, 7.5), width=1, height=1)
    world.run(seconds=10.0)
    return world


def off_circle(world: World) -> float:
    return abs(place(world, 1) - (1.0 - cmath.exp(-30j)) / 3j)


@pytest.mark.parametrize("force", [Lorentz(), StatedLorentz()])
def test_auto_follows_a_force_that_may_depend_on_velocities(force: ForceSystem) -> None:
    world = circling(force)
    assert world.plan.integrator.name == "dop853"
    assert "may depend on velocities" in world.plan.reason
    assert abs(world.component(1, Velocity).linear.magnitude - 1.0) < 1e-13
    assert off_circle(world) < 1e-13
    assert find_warnings(world) == ()


def test_auto_believes_a_force_that_denies_it() -> None:
    world = circling(Pull())
    assert world.plan.integrator.name == "leapfrog"


def test_a_force_of_velocity_beside_contacts_is_followed_where_it_states_it() -> None:
    def beside(force: ForceSystem, substeps: int = 4) -> World:
        return circling(force, substeps, touching=True, contacts="soft")

    coarse, fine = (off_circle(beside(StatedLorentz(), n)) for n in (2, 4))
    assert math.log2(coarse / fine) == pytest.approx(4, abs=0.1)
    assert beside(StatedLorentz()).plan.split_forces is INTEGRATORS["rk4"]
    assert beside(Lorentz()).plan.split_forces is None, "it may be a wind, and bodies sleep"
    for force in (Lorentz(), StatedLorentz()):
        assert off_circle(circling(force, touching=True)) < 1e-12, "with rigid contacts"


@pytest.mark.parametrize("touching", [False, True])
def test_leapfrog_that_was_asked_for_is_said_to_lose_its_order(touching: bool) -> None:
    world = circling(StatedLorentz(), touching=touching, integrator="leapfrog")
    (warning,) = find_warnings(world)
    assert warning.what == "StatedLorentz: leapfrog has order 1 where a force depends on velocities"
    assert warning.setting == f'simulation.integrator = "{"auto" if touching else "dop853"}"'
    assert find_warnings(circling(Pull(), touching=touching, integrator="leapfrog")) == ()
    assert find_warnings(circling(StatedLorentz(), integrator="rk4")) == ()


def test_a_force_that_jumps_is_followed_in_steps_of_one_length() -> None:
    world = World(DryFriction(), IntegrateSystem(), physics=FREE)
    body = world.spawn(Transform(), Velocity((1, 0)), Mass(1.0))
    world.run(seconds=2.0)
    assert world.plan.integrator.name == "rk4"
    assert world.plan.reason == "the force of DryFriction has no compiled kernel, and jumps"
    assert abs(world.component(body, Velocity).linear.x) < 1e-2
    assert place(world, body) == pytest.approx(0.5, abs=1e-2)
