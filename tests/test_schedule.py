"""Schedule: order, what runs, what is left out and why, and what it costs."""

import time
from collections.abc import Sequence
from typing import Any, ClassVar

import pytest

from physicslab.components import Mass, Shape, Spring, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.kernels import ask_before_compiling
from physicslab.state.state import State
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.spring import SpringSystem
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import ForceSystem, Stage, System, at
from physicslab.world import World


class Recorder(System):
    """Notes every call that it gets."""

    def __init__(self) -> None:
        self.calls: list[tuple[str, float]] = []

    @at(Stage.PREPARE)
    def prepare(self, world: World, h: float) -> None:
        self.calls.append(("prepare", h))

    @at(Stage.FORCE)
    def force(self, world: World, h: float) -> None:
        self.calls.append(("force", h))

    @at(Stage.KICK)
    def kick(self, world: World, h: float) -> None:
        self.calls.append(("kick", h))

    @at(Stage.DRIFT)
    def drift(self, world: World, h: float) -> None:
        self.calls.append(("drift", h))

    @at(Stage.FINISH)
    def finish(self, world: World, h: float) -> None:
        self.calls.append(("finish", h))


class Louder(Recorder):
    """Overrides a marked method without marking it again."""

    def force(self, world: World, h: float) -> None:
        self.calls.append(("louder", h))


def left_out(world: World) -> dict[str, str]:
    world.synchronise()
    return {system.name: system.reason for system in world.schedule.left_out}


def running(world: World) -> list[str]:
    world.synchronise()
    return [system.name for system in world.schedule.running]


# ---- order -------------------------------------------------------------------------------------------------


def test_stages_come_in_the_integrators_order() -> None:
    recorder = Recorder()
    world = World(recorder, simulation=SimulationConfig(dt=1.0, substeps=2, integrator="symplectic_euler"))
    world.step(1.0)
    substep = [("force", 0.5), ("kick", 0.5), ("drift", 0.5)]
    assert recorder.calls == [("prepare", 1.0), *substep, *substep, ("finish", 1.0)]

    recorder.calls.clear()
    world.simulation = SimulationConfig(dt=1.0, substeps=1, integrator="leapfrog")
    world.step(1.0)
    names = [name for name, _ in recorder.calls]
    assert names == ["prepare", "drift", "force", "kick", "kick", "drift", "finish"]
    shares = {"force": 1.0, "kick": 1.0, "drift": 1.0, "prepare": 1.0, "finish": 1.0}
    assert {name: sum(h for called, h in recorder.calls if called == name) for name in names} == shares


def test_systems_of_one_stage_run_in_the_order_given() -> None:
    order: list[str] = []

    class First(System):
        @at(Stage.FORCE)
        def note(self, world: World, h: float) -> None:
            order.append(type(self).__name__)

    class Second(First):
        pass

    World(First(), Second(), simulation=SimulationConfig(substeps=1)).step()
    World(Second(), First(), simulation=SimulationConfig(substeps=1)).step()
    assert order == ["First", "Second", "Second", "First"]


def test_an_override_keeps_its_stage() -> None:
    louder = Louder()
    World(louder, simulation=SimulationConfig(dt=1.0, substeps=1)).step(1.0)
    assert ("louder", 1.0) in louder.calls and ("force", 1.0) not in louder.calls


def test_frame_stages_run_when_called() -> None:
    frames: list[float] = []

    class Drawing(System):
        @at(Stage.RENDER)
        def draw(self, world: World, dt: float) -> None:
            frames.append(dt)

    world = World(Drawing())
    world.step()
    assert frames == []
    world.frame(Stage.RENDER, 0.016)
    assert frames == [0.016]


# ---- what runs ---------------------------------------------------------------------------------------------


def test_an_empty_world_runs_nothing_and_says_why() -> None:
    world = World(*standard_systems())
    assert running(world) == []
    reasons = left_out(world)
    assert reasons["AccelerateSystem"] == "nothing moves"
    assert reasons["GravitySystem"] == "nothing that moves has Mass"
    assert reasons["SpringSystem"] == "no Spring in the scene"
    assert reasons["IntegrateSystem"] == "no Transform and Velocity in the scene"
    assert reasons["BroadPhaseSystem"] == reasons["ContactSystem"] == "no Shape in the scene"
    world.step()


def test_one_falling_ball_needs_no_contacts() -> None:
    world = World(*standard_systems())
    world.spawn(Transform(), Velocity(), Mass(), Shape.circle(1))
    assert running(world) == ["AccelerateSystem", "GravitySystem", "IntegrateSystem"]
    assert left_out(world)["ContactSystem"] == "only one Shape in the scene, and no bounds"


@pytest.mark.parametrize(
    ("physics", "reason"),
    [
        (PhysicsConfig(gravity_mode="none"), "gravity is switched off"),
        (PhysicsConfig(gravity=(0, 0)), "gravity is zero"),  # type: ignore[arg-type]
        (PhysicsConfig(gravity_mode="planet"), "fewer than two bodies attract each other"),
    ],
)
def test_gravity_is_left_out_by_the_physics(physics: PhysicsConfig, reason: str) -> None:
    world = World(GravitySystem())
    world.spawn(Transform(), Velocity(), Mass())
    assert running(world) == ["AccelerateSystem", "GravitySystem"]
    world.physics = physics
    assert left_out(world) == {"GravitySystem": reason}
    assert not world.has_forces
    world.physics = PhysicsConfig()
    assert running(world) == ["AccelerateSystem", "GravitySystem"]


def test_a_spring_brings_its_system_and_the_last_takes_it_away() -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"))
    ball = world.spawn(Transform((1, 0)), Velocity(), Mass())
    world.step()
    assert "SpringSystem" in left_out(world) and world.force_evaluations == 0
    world.add(ball, Spring(rest_length=0.5))
    world.step()
    assert "SpringSystem" in running(world) and world.force_evaluations > 0
    world.discard(ball, Spring)
    world.step()
    assert left_out(world)["SpringSystem"] == "no Spring in the scene"


def test_a_system_is_looked_up_only_while_it_runs() -> None:
    world = World(GravitySystem(), SpringSystem())
    world.spawn(Transform(), Velocity(), Mass())
    world.synchronise()
    assert isinstance(world.schedule.find(GravitySystem), GravitySystem)
    assert world.schedule.find(SpringSystem) is None


def test_what_a_system_refuses_is_refused_again() -> None:
    class Picky(System):
        @at(Stage.FORCE)
        def work(self, world: World, h: float) -> None: ...

        def attach(self, state: State) -> None:
            if len(state.batch(Velocity)):
                raise ValueError("not like this")

    world = World(Picky())
    ball = world.spawn(Transform(), Velocity())
    for _ in range(3):
        with pytest.raises(ValueError, match="not like this"):
            world.step()
    world.discard(ball, Velocity)
    world.step()
    assert world.steps == 1


# ---- cost --------------------------------------------------------------------------------------------------


def test_timings_count_calls() -> None:
    class Onlooker(System):
        @at(Stage.KICK)
        def look(self, world: World, h: float) -> None:
            """Do nothing, within the step: the stages have to be gone through one by one."""

    world = World(GravitySystem(), SpringSystem(), IntegrateSystem(), Onlooker())
    world.spawn(Transform(), Velocity(), Mass())
    world.run(steps=3)
    timings = world.schedule.timings
    assert {name: timing.calls for name, timing in timings.items()} == {
        "AccelerateSystem": 3 * 4 * 3,  # clear and two half kicks
        "GravitySystem": 3 * 4,
        "IntegrateSystem": 3 * 4 * 2,
        "Onlooker": 3 * 4 * 2,
    }
    assert all(0 < timing.ms < 1000 for timing in timings.values())


def test_a_world_counts_the_time_that_its_kernels_take_and_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []

    def wait(missing: Sequence[Any]) -> None:
        asked.extend(missing)
        time.sleep(0.02)

    world = World(GravitySystem(), IntegrateSystem(), simulation=SimulationConfig(integrator="leapfrog"))
    world.spawn(Transform(), Velocity(), Mass())
    world.run(steps=1)
    assert world.stepper is not None and world.stepper.kernels
    before = world.compile_s
    world.run(steps=1)
    assert world.compile_s == before, "all are loaded"
    for jitted in world.stepper.kernels:  # as in a process that has not called them yet
        monkeypatch.setattr(jitted, "compiled", False)
        monkeypatch.setattr(jitted, "compile", lambda _: None)
    ask_before_compiling(wait)
    try:
        world.run(steps=1)
    finally:
        ask_before_compiling(None)
    assert set(asked) >= set(world.stepper.kernels)
    assert world.compile_s - before >= 0.02
    later = World(GravitySystem())
    assert later.compile_s == 0.0, "what others waited for before"


def test_in_a_compiled_run_the_loop_is_timed_and_the_forces_are_counted() -> None:
    world = World(GravitySystem(), IntegrateSystem(), simulation=SimulationConfig(integrator="leapfrog"))
    world.spawn(Transform(), Velocity(), Mass())
    world.run(steps=3)
    timings = world.schedule.timings
    assert (timings["IntegrateSystem"].calls, timings["GravitySystem"].calls) == (3, 3 * 4)
    assert timings["IntegrateSystem"].ms > 0.0 == timings["GravitySystem"].ms


# ---- mistakes ----------------------------------------------------------------------------------------------


def test_mistakes_in_a_system_are_reported_when_the_world_is_made() -> None:
    class Silent(System):
        def work(self, world: World, h: float) -> None: ...

    class Doubled(System):
        @at(Stage.FORCE)
        def one(self, world: World, h: float) -> None: ...

        @at(Stage.FORCE)
        def two(self, world: World, h: float) -> None: ...

    class Powerless(ForceSystem):
        potential: ClassVar[str | None] = "nothing"

        @at(Stage.KICK)
        def pull(self, world: World, h: float) -> None: ...

    gravity: Any = GravitySystem
    not_a_system: Any = "gravity"
    with pytest.raises(TypeError, match=r"write GravitySystem\(\)"):
        World(gravity)
    with pytest.raises(TypeError, match="'gravity' is no System"):
        World(not_a_system)
    with pytest.raises(TypeError, match="Silent has no method marked"):
        World(Silent())
    with pytest.raises(TypeError, match=r"Doubled: one and two are both at Stage\.FORCE"):
        World(Doubled())
    with pytest.raises(
        TypeError, match=r"Powerless is a ForceSystem and packs no force and has no method marked"
    ):
        World(Powerless())
    with pytest.raises(ValueError, match="GravitySystem is in the schedule twice"):
        World(GravitySystem(), GravitySystem())


@pytest.mark.parametrize("stage", ["force", 3, None, "Stage.FORCE"])
def test_a_stage_that_is_none_is_refused(stage: Any) -> None:
    with pytest.raises(TypeError, match=r"@at takes a Stage, got .*write @at\(Stage\.FORCE\)"):
        at(stage)


def test_nothing_runs_before_a_schedule_is_made() -> None:
    schedule = Schedule([Recorder()])
    assert not schedule.runs(Stage.FORCE) and schedule.running == ()
    schedule.remake(World())
    assert schedule.runs(Stage.FORCE)
