"""Which method moves a world, and what is said of it."""

import pytest

from physicslab.components import Drag, Mass, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import Audit
from physicslab.diagnostics.run_report import RunRecord, run_report, run_summary
from physicslab.ecs import config
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.integrators import INTEGRATORS
from physicslab.prefabs import box
from physicslab.state.state import State
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.spring import SpringSystem
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import ForceSystem, Stage, at
from physicslab.view.workbench.figures import method_lines
from physicslab.world import World


def world_of(
    *bodies: tuple[object, ...], integrator: str = "auto", contacts: str = "auto", **physics: object
) -> World:
    settings = PhysicsConfig(**physics)  # type: ignore[arg-type]
    simulation = SimulationConfig(integrator=integrator, contacts=contacts)
    world = World(*standard_systems(), physics=settings, simulation=simulation)
    for body in bodies:
        world.spawn(*body)
    world.synchronise()
    return world


def ball(x: float = 0.0, *more: object) -> tuple[object, ...]:
    return (Transform((x, 1)), Velocity(), Mass(1), *more)


def two_discs(**settings: str) -> World:
    return world_of(ball(0, Shape.circle(1)), ball(9, Shape.circle(1)), **settings)


def planets(count: int, softening: float) -> World:
    bodies = [ball(float(n)) for n in range(count)]
    return world_of(*bodies, gravity_mode="planet", softening=softening)


@pytest.mark.parametrize(
    ("world", "name", "reason"),
    [
        (world_of(ball()), "exact", "uniform gravity alone: solved in closed form"),
        (world_of(ball(0, Spring(rest_length=0))), "exact", "springs to fixed points"),
        (world_of(ball(0, Drag(linear=1))), "exact", "linear drag"),
        (world_of(ball(2, Spring(rest_length=2.2, stiffness=1e4))), "blanes_moan", "conservative and smooth"),
        (world_of(ball(2, Spring(rest_length=0.5))), "dop853", "pressed together to nothing"),
        (world_of(ball(2), linear_damping=1e9, gravity_mode="none"), "exact", "linear drag"),
        (world_of(ball(2, Spring(rest_length=0.5)), linear_damping=1e9), "implicit_midpoint", "too fast"),
        (world_of(ball(2, Spring(rest_length=0.5, damping=1))), "dop853", "velocities"),
        (world_of(ball(0, Drag(quadratic=1))), "dop853", "velocities"),
        (world_of(ball(2, Spring(rest_length=0.5, stiffness=1e12))), "implicit_midpoint", "too fast"),
        (planets(3, 0.0), "dop853", "planets may come close"),
        (planets(240, 0.1), "leapfrog", "240 bodies attract each other, softened"),
        (planets(40, 0.0), "dop853", "planets may come close"),
        (two_discs(contacts="soft"), "leapfrog", "bodies can touch"),
        (two_discs(), "dop853", "contacts are rigid"),
    ],
)
def test_auto_chooses_by_what_there_is_and_says_why(world: World, name: str, reason: str) -> None:
    assert world.plan.integrator.name == name
    assert reason in world.plan.reason


def test_auto_chooses_again_when_the_content_changes() -> None:
    world = world_of(ball())
    spring = world.spawn(*ball(2, Spring(rest_length=2.2, stiffness=1e4)))
    world.synchronise()
    assert world.plan.integrator.name == "blanes_moan"
    world.component(spring, Spring).damping = 1.0
    world.step()
    assert world.plan.integrator.name == "dop853"
    world.remove(spring)
    world.synchronise()
    assert world.plan.integrator.name == "exact"


@pytest.mark.parametrize("name", ["leapfrog", "rk4", "dop853", "auto"])
def test_a_spring_moved_off_the_middle_turns_its_body_from_then_on(name: str) -> None:
    world = World(SpringSystem(), IntegrateSystem(), simulation=SimulationConfig(dt=1 / 200, integrator=name))
    spring = Spring(anchor_b=(1, 1), rest_length=0.3, stiffness=20)
    body = world.spawn(Transform(), Velocity(), Mass(1.0, 0.4), spring)
    world.run(seconds=0.1)
    spring.anchor_a = (0.5, 0.0)
    world.run(seconds=1.0)
    assert world.component(body, Transform).angle == pytest.approx(0.9504, abs=2e-3)
    assert tuple(world.component(body, Transform).position) == pytest.approx((0.9785, 0.9186), abs=2e-3)


def test_a_spring_pulled_nearly_through_its_end_is_followed() -> None:
    ends = []
    for name in ("auto", "dop853"):
        physics = PhysicsConfig(gravity_mode="none")
        world = World(*standard_systems(), physics=physics, simulation=SimulationConfig(integrator=name))
        spring = Spring(rest_length=1, stiffness=10)
        body = world.spawn(Transform((2, 0)), Velocity((0, 1e-6)), Mass(1), spring)
        world.run(seconds=5.0)
        ends.append(tuple(world.component(body, Transform).position))
    assert ends[0] == pytest.approx(ends[1], abs=1e-9)


def test_strong_drag_on_a_body_at_rest_at_the_origin_is_no_trap() -> None:
    world = World(*standard_systems())
    body = world.spawn(Transform(), Velocity(), Mass(1), Drag(quadratic=1e4))
    world.run(seconds=1.0)
    assert world.component(body, Transform).position.y == pytest.approx(-0.0313, abs=2e-4)


def test_a_chosen_method_that_cannot_run_is_refused_in_words() -> None:
    touching = two_discs(integrator="rk4")
    assert touching.plan.integrator.name == "leapfrog"
    assert touching.plan.refused == touching.plan.reason
    assert "rk4 was asked for" in touching.plan.reason
    planets = world_of(ball(0), ball(1), integrator="exact", gravity_mode="planet")
    assert "bodies attract each other" in planets.plan.refused


def test_every_name_of_the_contract_is_a_method() -> None:
    assert {"auto", *INTEGRATORS} == set(config.INTEGRATORS)
    for name, method in INTEGRATORS.items():
        assert method.name == name


class Wind(ForceSystem):
    """Blows to the right, from Python."""

    @at(Stage.FORCE)
    def blow(self, world: World, h: float) -> None:
        world.bodies.force[world.batch(Velocity, Mass).rows, 0] += 3.0


@pytest.mark.parametrize("name", ["rk4", "blanes_moan", "dop853", "implicit_midpoint", "leapfrog"])
def test_a_force_written_in_python_works_with_every_method_and_is_named(name: str) -> None:
    world = World(Wind(), IntegrateSystem(), simulation=SimulationConfig(integrator=name))
    body = world.spawn(Transform(), Velocity((0, 2)), Mass(2))
    world.run(seconds=2.0)
    assert tuple(world.component(body, Transform).position) == pytest.approx((3.0, 4.0), abs=1e-9)
    assert world.schedule.interpreted == ("Wind",)
    report = run_report(world, RunRecord("wind", Audit(world)))
    assert report["interpreted"] == ["Wind"]
    assert "Wind: computed by Python" in run_summary(report, "")


@pytest.mark.parametrize(("contacts", "stepper"), [("soft", "contact"), ("auto", "rigid")])
def test_a_force_written_in_python_is_named_beside_contacts_too(contacts: str, stepper: str) -> None:
    world = World(*standard_systems(), Wind(), simulation=SimulationConfig(contacts=contacts))
    box(world, (0, -0.5), width=20, height=1, static=True)
    box(world, (0, 0.5), width=1, height=1)
    world.step()
    assert world.stepper is not None and world.stepper.name == stepper
    assert world.schedule.interpreted == ("Wind",)
    assert run_report(world, RunRecord("wind", Audit(world)))["interpreted"] == ["Wind"]
    assert "Wind is computed by Python: slower" in [line.label for line in method_lines(world)]


def test_auto_keeps_to_one_evaluation_where_a_force_in_python_depends_on_no_velocity() -> None:
    class Steady(Wind):
        def depends_on_velocity(self, state: State) -> bool:
            return False

    world = World(Steady(), IntegrateSystem())
    world.spawn(Transform(), Velocity(), Mass())
    world.step()
    assert world.plan.reason == "the force of Steady has no compiled kernel"
    assert world.force_evaluations == world.simulation.substeps


def test_what_a_force_raises_reaches_the_caller() -> None:
    class Broken(Wind):
        @at(Stage.FORCE)
        def blow(self, world: World, h: float) -> None:
            raise ZeroDivisionError("no wind today")

    world = World(Broken(), IntegrateSystem())
    world.spawn(Transform(), Velocity(), Mass())
    with pytest.raises(ZeroDivisionError, match="no wind today"):
        world.run(seconds=1.0)


def test_a_force_that_overrides_a_compiled_one_is_the_one_that_acts() -> None:
    from physicslab.systems.gravity import GravitySystem

    class Levity(GravitySystem):
        @at(Stage.FORCE)
        def pull(self, world: World, h: float) -> None:
            world.bodies.force[world.batch(Velocity, Mass).rows, 1] += 1.0

    world = World(Levity(), IntegrateSystem())
    body = world.spawn(Transform(), Velocity(), Mass(1))
    world.run(seconds=1.0)
    assert world.component(body, Velocity).linear.y == pytest.approx(1.0)
