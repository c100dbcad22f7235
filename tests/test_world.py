"""World: entities and components, contexts of its own, steps and times."""

import gc
import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import esper
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab.components import Mass, Name, Shape, Spring, Transform, Velocity
from physicslab.ecs.config import MIN_TIME, PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.spring import SpringSystem
from physicslab.systems.system import Stage, System, at
from physicslab.world import World


class Meddler(System):
    """Does something to the world in the middle of a step."""

    def __init__(self, deed: Any) -> None:
        self.deed = deed

    @at(Stage.FORCE)
    def meddle(self, world: World, h: float) -> None:
        self.deed(world)


def swarm(seed: int, count: int = 5) -> World:
    """Return a world of attracting bodies on springs."""
    random = np.random.default_rng(seed)
    physics = PhysicsConfig(gravity_mode="planet", softening=0.1)
    world = World(GravitySystem(), SpringSystem(), IntegrateSystem(), physics=physics)
    bodies = [
        world.spawn(
            Transform(random.normal(size=2)), Velocity(random.normal(size=2)), Mass(random.uniform(1, 2))
        )
        for _ in range(count)
    ]
    world.spawn(Spring(bodies[0], bodies[-1], rest_length=0.5, stiffness=20))
    return world


def state(world: World) -> list[float]:
    world.synchronise()
    columns = (world.table(Transform)["position"], world.table(Velocity)["linear"])
    return [float(value) for column in columns for value in column.ravel()]


# ---- entities and components -------------------------------------------------------------------------------


def test_spawn_and_remove() -> None:
    world = World()
    ball = world.spawn(Transform((0, 5)), Mass(2.0), name="ball")
    assert world.entities() == [ball] and world.entity("ball") == ball
    assert world.has(ball, Mass) and not world.has(ball, Velocity)
    assert {type(part) for part in world.components(ball)} == {Transform, Mass, Name}
    world.remove(ball)
    assert world.entities() == [] and not world.has(ball, Mass)


def test_what_is_not_there_is_named() -> None:
    world = World()
    ball = world.spawn(Transform(), name="ball")
    with pytest.raises(KeyError, match="ball has no Mass"):
        world.component(ball, Mass)
    with pytest.raises(KeyError, match="no entity has the id 'bat'"):
        world.entity("bat")
    missing: list[Any] = [
        lambda: world.remove(99), lambda: world.component(99, Mass), lambda: world.add(99, Mass()),
        lambda: world.discard(99, Mass), lambda: world.components(99),
    ]  # fmt: skip
    for ask in missing:
        with pytest.raises(KeyError, match="there is no entity 99 in this world"):
            ask()
    assert world.discard(ball, Mass) is None


def test_spawn_refuses_types_and_doubles() -> None:
    world = World()
    with pytest.raises(TypeError, match=r"write Velocity\(\.\.\.\)"):
        world.spawn(Transform(), Velocity)
    with pytest.raises(TypeError, match=r"write Velocity\(\.\.\.\)"):
        world.add(world.spawn(Transform()), Velocity)
    with pytest.raises(ValueError, match="an entity has one Transform, not 2"):
        world.spawn(Transform(), Transform())
    with pytest.raises(ValueError, match="an entity has one Name, not 2"):
        world.spawn(Name("a"), name="b")


def test_what_is_read_while_a_world_is_built_is_followed_once() -> None:
    world = World()
    first = world.spawn(Transform(), Velocity(), Mass(1.0))
    assert world.component(first, Mass).inertia == 0.0
    followed = world.revision
    for n in range(20):
        last = world.spawn(Transform((n, 0.0)), Velocity(), Mass(2.0))
        assert world.component(first, Mass).mass == 1.0
        assert world.component(last, Transform).position.x == n
    assert world.revision == followed
    world.component(last, Transform).position = (0.0, 7.0)
    assert world.table(Transform)["position"][-1, 1] == 7.0
    world.add(first, Shape.circle(2.0))
    assert world.component(first, Mass).inertia == 2.0
    assert world.component(last, Mass).mass == 2.0
    world.remove(last)
    with pytest.raises(KeyError):
        world.component(last, Mass)


def test_clear_leaves_nothing_behind() -> None:
    world = World()
    doomed, _ = world.spawn(Transform()), world.spawn(Velocity())
    esper.delete_entity(doomed)
    world.clear()
    assert esper.get_component(Velocity) == []
    world.step()
    assert world.entities() == [] and len(world.entity_index) == 1


def test_what_is_about_to_be_deleted_is_not_there_any_more() -> None:
    world = World()
    ball = world.spawn(Transform(), name="ball")
    esper.delete_entity(ball)
    assert world.entities() == [] and not world.has(ball, Transform)
    with pytest.raises(KeyError, match="no entity has the id 'ball'"):
        world.entity("ball")


def test_changes_while_iterating() -> None:
    world = World(IntegrateSystem())
    for i in range(10):
        world.spawn(Transform((i, 0)), Velocity())
    for entity, transform in esper.get_component(Transform):
        if transform.position.x >= 5:
            world.remove(entity)
        else:
            world.add(entity, Mass())
            world.spawn(Transform((transform.position.x + 0.5, 0)))
    world.step()
    positions = sorted(world.component(entity, Transform).position.x for entity in world.entities())
    assert positions == [0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5]
    assert len(world.batch(Mass, Velocity)) == 5


def test_changes_from_inside_a_system() -> None:
    spawned: list[int] = []

    def meddle(world: World) -> None:
        if spawned:
            return
        spawned.append(world.spawn(Transform((1, 0)), Velocity((1, 0))))
        assert world.component(spawned[0], Velocity).linear == Vector2(1, 0)
        world.component(spawned[0], Velocity).linear = (2, 0)
        world.remove(old)
        esper.add_component(kept, Mass(3.0))

    world = World(Meddler(meddle), IntegrateSystem(), simulation=SimulationConfig(dt=1.0))
    old, kept = world.spawn(Transform(), Velocity((1, 0))), world.spawn(Transform(), Velocity((1, 0)))
    handle = world.component(old, Transform)
    world.step(1.0)
    assert world.component(spawned[0], Transform).position == Vector2(
        1, 0
    )  # takes part from the next step on
    world.step(1.0)
    assert world.component(spawned[0], Transform).position == Vector2(3, 0)
    assert world.component(kept, Transform).position == Vector2(2, 0)
    assert world.component(kept, Mass).mass == 3.0
    assert world.entities() == [kept, *spawned]
    assert handle.position == Vector2(1, 0)  # where it was when the step that removed it ended


# ---- contexts ----------------------------------------------------------------------------------------------


@given(st.lists(st.booleans(), max_size=12), st.integers(0, 5))
def test_worlds_stepped_in_turn_do_as_each_alone(turns: list[bool], seed: int) -> None:
    first, second = swarm(seed), swarm(seed + 1, 7)
    for turn in turns:
        (first if turn else second).step()
    alone = swarm(seed), swarm(seed + 1, 7)
    for turn in sorted(turns):
        alone[0 if turn else 1].step()
    assert [state(first), state(second)] == [state(world) for world in alone]


def test_the_same_steps_give_the_same_bits() -> None:
    first, second = swarm(3), swarm(3)
    for world in (first, second):
        world.run(seconds=1.0)
    assert state(first) == state(second)
    for world in (first, second):
        for _ in range(60):
            world.step(1 / 60)
    assert state(first) == state(second)


def test_blank_rows_change_no_bits() -> None:
    world, clean = World(GravitySystem(), IntegrateSystem()), World(GravitySystem(), IntegrateSystem())
    for gapped in (True, False):
        made = world if gapped else clean
        for i in range(20):
            if gapped:
                made.remove(made.spawn(Transform(), Velocity(), Mass()))
                made.synchronise()
            made.spawn(Transform((i, 0.1)), Velocity((0.3, i)), Mass(1 + i))
        made.run(steps=10)
    moved = [[w.component(e, Transform).position for e in w.entities()] for w in (world, clean)]
    assert moved[0] == moved[1]


def test_the_newest_world_is_active_until_another_is_activated() -> None:
    first, second = World(), World()
    entity = esper.create_entity(Transform())
    assert second.entities() == [entity] and first.entities() == []
    first.activate()
    esper.create_entity(Transform((1, 1)))
    assert esper.component_for_entity(1, Transform).position == Vector2(1, 1)
    first.step()
    second.step()
    assert esper.current_world == first.context


def test_a_context_is_left_as_it_was_found_when_a_system_raises() -> None:
    def fail(world: World) -> None:
        raise RuntimeError("on purpose")

    failing, other = World(Meddler(fail)), World(IntegrateSystem())
    ball = other.spawn(Transform(), Velocity((1, 0)))
    for _ in range(2):
        with pytest.raises(RuntimeError, match="on purpose"):
            failing.step()
        assert esper.current_world == other.context
    assert (failing.time, failing.steps) == (0.0, 0)
    failing.spawn(Transform(), name="still here")
    assert failing.has(failing.entity("still here"), Transform)
    other.step(1.0)
    assert other.component(ball, Transform).position.x == 1.0


def test_a_system_cannot_step_the_world_that_calls_it() -> None:
    world = World(Meddler(lambda world: world.step()))
    with pytest.raises(RuntimeError, match="cannot step the world that is calling it"):
        world.step()


def test_contexts_go_with_their_worlds() -> None:
    gc.collect()
    before = set(esper.list_worlds())
    worlds = [swarm(seed) for seed in range(5)]
    for world in worlds:
        world.step()
    assert len(esper.list_worlds()) >= len(before) + 4
    del world, worlds
    gc.collect()
    assert set(esper.list_worlds()) <= before | {"default"}


def test_a_world_forgotten_while_another_works_does_not_come_back() -> None:
    worlds = [World(), World()]
    context = worlds[1].context
    assert esper.current_world == context
    with worlds[0].active():
        worlds.pop()
        gc.collect()
    assert context not in esper.list_worlds()
    assert esper.current_world == "default"


# ---- time --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("dt", [0.0, -1.0, math.nan, math.inf])
def test_step_refuses_a_bad_dt(dt: float) -> None:
    world = World()
    with pytest.raises(ValueError, match=r"dt = .*: must be a finite number from 1e-100 to 1e\+100 s"):
        world.step(dt)
    assert (world.time, world.steps) == (0.0, 0)


def test_run_refuses_what_is_no_time() -> None:
    world = World()
    odd: list[dict[str, Any]] = [{"seconds": -1.0}, {"seconds": math.nan}, {"seconds": math.inf}]
    odd += [{"steps": -1}, {"steps": 2.5}, {"steps": True}]
    for given_time in odd:
        with pytest.raises(ValueError, match=r"(seconds|steps) = .*: must be a"):
            world.run(**given_time)
    for none_or_both in ({}, {"seconds": 1.0, "steps": 1}):
        with pytest.raises(TypeError, match="either seconds or steps"):
            world.run(**none_or_both)  # type: ignore[arg-type]
    assert world.steps == 0


@given(st.floats(1e-4, 2.0), st.floats(0.0, 3.0), st.floats(0.0, 100.0))
def test_run_lands_on_the_very_time(dt: float, seconds: float, start: float) -> None:
    seconds = min(seconds, 100 * dt)
    simulation = SimulationConfig(dt=dt, substeps=1)
    world = World(IntegrateSystem(), simulation=simulation)
    ball = world.spawn(Transform(), Velocity((1, 0)))
    world.time = start
    times = [world.time for _ in world.stepping(seconds=seconds)]
    assert world.time == start + seconds
    assert times == sorted(times) and (not times or times[-1] == world.time)
    assert world.steps <= math.ceil(seconds / dt * (1 + 1e-12))
    # The bodies have moved for that time too, not only the clock.
    assert world.component(ball, Transform).position.x == pytest.approx(seconds, rel=1e-13, abs=MIN_TIME)


@pytest.mark.parametrize(
    ("seconds", "steps", "shortest"),
    [(1.0, 10, 0.1), (0.3, 3, 0.1), (0.25, 3, 0.05), (0.05, 1, 0.05), (0.0, 0, None), (0.1 + 1e-12, 1, 0.1)],
)
def test_the_last_step_is_shortened(seconds: float, steps: int, shortest: float | None) -> None:
    lengths: list[float] = []

    class Watch(System):
        @at(Stage.FINISH)
        def note(self, world: World, h: float) -> None:
            lengths.append(h)

    world = World(Watch(), simulation=SimulationConfig(dt=0.1))
    world.run(seconds=seconds)
    assert world.steps == steps == len(lengths)
    assert lengths[:-1] == [0.1] * (steps - 1)
    if shortest is not None:
        assert lengths[-1] == pytest.approx(shortest, rel=1e-9)


def test_steps_keep_a_clock_without_rounding() -> None:
    world = World()
    world.run(steps=3000)
    assert world.time == 3000 * (1 / 60)
    world.step(0.5)
    assert (world.time, world.steps) == (3000 * (1 / 60) + 0.5, 3001)


# ---- configuration -----------------------------------------------------------------------------------------


def test_configuration_is_replaced_at_any_time() -> None:
    world = World(GravitySystem(), IntegrateSystem())
    ball = world.spawn(Transform(), Velocity(), Mass())
    world.step(0.1)
    assert world.component(ball, Velocity).linear.y == pytest.approx(-0.981)
    world.physics = PhysicsConfig(gravity=Vector2(10, 0))
    world.simulation = SimulationConfig(dt=0.1, substeps=1, integrator="symplectic_euler")
    world.synchronise()
    assert world.plan.integrator.name == "symplectic_euler"
    world.step(0.1)
    assert world.component(ball, Velocity).linear.x == pytest.approx(1.0)
    assert world.force_evaluations == 1  # the closed form before took none


@pytest.fixture(autouse=True)
def _start_from_esper_s_own_context() -> Iterator[None]:
    esper.switch_world("default")
    yield


def test_a_step_longer_than_the_scenes_own_is_divided_so_that_no_substep_is_longer() -> None:
    long, short = load_scene("stack"), load_scene("stack")
    for world in (long, short):  # how long bodies have rested is looked at at the end of a step
        world.simulation = replace(world.simulation, sleeping=False, contacts="soft")
    assert long.step_divisions == 1
    long.step(2.0)
    assert (long.step_divisions, long.steps, long.time) == (120, 1, 2.0)
    short.run(seconds=2.0)
    boxes = short.table(Transform)["position"]
    assert abs(long.table(Transform)["position"] - boxes).max() < 1e-9
    long.step()
    assert long.step_divisions == 1


def test_where_forces_alone_act_a_long_step_is_divided_unless_the_method_is_exact() -> None:
    world = World(GravitySystem(), IntegrateSystem(), simulation=SimulationConfig(integrator="rk4"))
    world.spawn(Transform(), Velocity(), Mass(1.0))
    world.step(1.0)
    assert world.step_divisions == 60
    world.simulation = SimulationConfig(integrator="exact")
    world.step(1.0)
    assert world.step_divisions == 1


def test_the_last_step_of_a_run_may_take_in_a_rest_undivided() -> None:
    world = load_scene("stack")
    world.step(world.simulation.dt * 1.001)
    assert world.step_divisions == 1


def test_a_step_that_would_have_to_be_divided_beyond_measure_is_refused() -> None:
    world = load_scene("stack")
    with pytest.raises(ValueError, match=r"dt = 1000000000.0: must be at most 100000 times simulation.dt"):
        world.step(1e9)
    assert (world.time, world.steps) == (0.0, 0)
    world.step()
