"""Diagnostics: energies and momenta against numbers worked out by hand."""

import math

import pytest

from physicslab import load_scene
from physicslab.components import Held, Mass, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import Audit, measure_account, measure_energy, measure_momentum
from physicslab.diagnostics.quantities import Reading, why_undefined
from physicslab.diagnostics.run_report import RunRecord, run_report
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import circle
from physicslab.state.account import Energy
from physicslab.state.state import State
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.spring import SpringSystem
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import ForceSystem, Stage, System, at
from physicslab.world import World


def test_kinetic_energy_and_momenta() -> None:
    world = World(systems=())
    world.spawn(Transform((1, 2)), Velocity((3, 4), 5), Mass(2), Shape.circle(0.5))
    world.spawn(Transform((-1, 0)), Velocity((0, -2)), Mass(3))
    energy, momentum = measure_energy(world), measure_momentum(world)
    assert energy.kinetic_linear == 0.5 * 2 * 25 + 0.5 * 3 * 4
    assert energy.kinetic_angular == 0.5 * 0.25 * 25
    assert energy.kinetic == energy.total == 31 + 3.125
    assert momentum.linear == Vector2(2 * 3, 2 * 4 - 3 * 2)
    assert momentum.angular == 2 * (1 * 4 - 2 * 3) + 0.25 * 5 + 3 * (-1 * -2)


def test_only_what_forces_move_counts() -> None:
    world = World(systems=())
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


def test_an_audit_keeps_the_largest_change_and_books_what_an_edit_brought() -> None:
    world = World(IntegrateSystem())
    velocity = world.component(world.spawn(Transform(), Velocity((2, 0)), Mass(1)), Velocity)
    world.step(0.01)
    audit = Audit(world)
    assert (audit.initial, audit.change, audit.error) == (2.0, 0.0, 0.0)
    for speed in (2.2, 1.0, 2.0):
        velocity.linear = (speed, 0)
        audit.sample(world)
    assert audit.largest_change == 1.5 and audit.change == pytest.approx(1.5 / 2.42)
    assert audit.causes == ("edits",) and audit.error == 0.0
    assert audit.latest.total == 2.0 and audit.notable == {}


def test_shares_from_nothing_are_of_the_kinetic_energy_seen() -> None:
    world = World(GravitySystem(), IntegrateSystem())
    world.spawn(Transform(), Velocity(), Mass(1))
    audit = Audit(world)
    assert audit.change == 0.0
    world.run(seconds=1.0)
    audit.sample(world)
    assert audit.latest.kinetic == pytest.approx(0.5 * 9.81**2)
    assert audit.error < 1e-12 and audit.exchanged == pytest.approx(0.5 * 9.81**2)


def test_what_a_driven_body_gives_is_energy_exchanged() -> None:
    """It was 981 times what was exchanged, of which it was left out as what a hand gives."""
    world = World(*standard_systems())
    world.spawn(Transform(), Velocity((0.0, 0.01)), Shape("box", width=2.0, height=0.2))
    world.spawn(Transform((0.0, 0.35)), Velocity(), Mass(10.0), Shape("box", width=0.5, height=0.5))
    audit = Audit(world)
    world.run(seconds=1.0)
    audit.sample(world)
    assert audit.exchanged == pytest.approx(0.981, rel=2e-3) and audit.change == pytest.approx(1.0, rel=2e-3)


class Brake(System):
    """Takes a tenth of the velocity within every substep, and books nothing."""

    @at(Stage.KICK)
    def take(self, world: World, dt: float) -> None:
        world.table(Velocity)["linear"][1:] *= 0.9


class Leak(IntegrateSystem):
    """Moves bodies and takes a tenth of their velocity each time: an error of the method."""

    @at(Stage.DRIFT)
    def drift(self, state: State, h: float) -> None:
        super().drift(state, h)
        state.table(Velocity)["linear"][1:] *= 0.9


@pytest.mark.parametrize("stage", [Stage.KICK, Stage.PREPARE, Stage.FINISH])
def test_what_a_system_of_ones_own_writes_is_measured_and_no_error(stage: Stage) -> None:
    brake = type("Brake", (System,), {"take": at(stage)(Brake.take)})
    world = World(brake(), IntegrateSystem())
    ball = world.spawn(Transform((2, 1)), Velocity((1, -0.5)), Mass(2))
    for _ in range(5):
        world.step(0.01)
    account = measure_account(world)
    cause = "fields" if stage is Stage.KICK else "edits"
    assert account.energy[cause] < -0.3 and account.momentum[cause].x < -0.5
    place, velocity = world.component(ball, Transform).position, world.component(ball, Velocity).linear
    assert account.angular_momentum[cause] == pytest.approx(2.0 * place.cross(velocity) + 4.0, abs=1e-13)
    assert abs(account.energy["numerical"]) < 1e-13 and account.momentum["numerical"].magnitude < 1e-13


def test_the_momentum_of_friction_is_not_measured_by_itself_and_said_so() -> None:
    world = load_scene("slope")
    record = RunRecord("slope", Audit(world))
    report = run_report(world, record)
    assert report["momentum_account"]["friction"] is report["angular_momentum_account"]["friction"] is None
    assert math.isnan(Reading(world).value("impulse x: friction"))
    assert "not measured" in why_undefined(world, "angular impulse: friction", None)
    assert why_undefined(world, "impulse x: contact", None) == ""


def test_what_no_account_has_is_an_error_and_the_largest_is_kept() -> None:
    world = World(Leak())
    velocity = world.component(world.spawn(Transform(), Velocity((1, 0)), Mass(2)), Velocity)
    audit = Audit(world)
    world.step(0.01)
    audit.sample(world)
    lost = 1.0 - velocity.linear.magnitude_squared
    assert 0.1 < lost < 1.0
    assert audit.account.energy["numerical"] == pytest.approx(-lost) and audit.error == pytest.approx(lost)
    assert audit.causes == ()
    velocity.linear = (1, 0)
    audit.sample(world)
    assert audit.account.energy["edits"] == pytest.approx(lost), "the error is not mended by an edit"
    assert audit.error == pytest.approx(lost)


def test_an_audit_begins_when_it_is_made_and_a_whole_one_with_the_accounts() -> None:
    world = World(IntegrateSystem())
    velocity = world.component(world.spawn(Transform(), Velocity((1, 0)), Mass(2)), Velocity)
    world.step(0.01)
    velocity.linear = (2, 0)
    world.step(0.01)
    later, whole = Audit(world), Audit(world, whole=True)
    assert (later.initial, later.account.energy["edits"]) == (4.0, 0.0)
    assert (whole.initial, whole.account.energy["edits"]) == (1.0, 3.0)
    velocity.linear = (3, 0)
    later.sample(world)
    assert later.account.energy["edits"] == 5.0 and later.account.change == 5.0


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


def test_shares_do_not_depend_on_where_the_origin_is() -> None:
    found = []
    for height in (0.0, 1000.0):
        world = gas(height, restitution=0.8, friction=0.4)
        audit = Audit(world)
        for _ in world.stepping(seconds=1.0):
            audit.sample(world)
        found.append((audit.change, audit.error))
    (change, error), (high_change, high_error) = found
    assert high_change == pytest.approx(change, rel=1e-6) and change > 0.05
    assert high_error == pytest.approx(error, abs=1e-9)


def test_what_impacts_and_friction_take_is_no_error() -> None:
    world = gas(0.0, restitution=0.5, friction=0.4)
    audit = Audit(world)
    for _ in world.stepping(seconds=3.0):
        audit.sample(world)
    assert audit.change > 0.5
    assert {"impacts", "friction"} & set(audit.causes) and audit.error < 0.02


def test_an_audit_does_not_hide_what_is_no_number() -> None:
    world = World(IntegrateSystem())
    world.spawn(Transform(), Velocity((1, 0)), Mass(1))
    world.step(0.01)
    audit = Audit(world)
    world.table(Velocity)["linear"][1] = math.nan
    audit.sample(world)
    world.table(Velocity)["linear"][1] = 1.0
    audit.sample(world)
    assert math.isnan(audit.change)
