"""Runs of whole steps in one compiled call: the same bits as step by step, and the same figures."""

import math
from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from desk import bits
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from kept_contacts import kept_contacts

from physicslab.components import Drag, Mass, Name, Transform, Velocity
from physicslab.diagnostics.energy import measure_account
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.files.scene import load_scene
from physicslab.integrators.leapfrog import LEAPFROG
from physicslab.kernels.geometry.contact import AS_FOUND
from physicslab.kernels.near_counts import FOLLOWED
from physicslab.lab.bench.catalogue import SCENES as BENCH
from physicslab.lab.bench.random_scenes import random_scene
from physicslab.prefabs import box, circle
from physicslab.scenes import SCENES
from physicslab.state import masses
from physicslab.state.masses import Diverged
from physicslab.stepping.islands import Islands
from physicslab.stepping.soft import Soft
from physicslab.stepping.substeps import Substeps
from physicslab.systems.broad_phase import BroadPhaseSystem
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import Stage, System, at
from physicslab.world import World

STEPS = 150
LOOKING = ("Onlooker", "EachStage", "StepOnlooker")


class Onlooker(System):
    """Looks at every substep, so that the stages are gone through one by one."""

    @at(Stage.RELAX)
    def look(self, world: World, h: float) -> None:
        """See that it is there."""


class EachStage(System):
    """Looks at every stage, so that all systems are called at theirs."""


for number, stage in enumerate(dict(LEAPFROG.substep)):

    @at(stage)
    def look(self: EachStage, world: World, h: float) -> None:
        """See that it is there."""

    setattr(EachStage, f"look_{number}", look)


class StepOnlooker(System):
    """Looks at every step, so that each is made by itself."""

    @at(Stage.FINISH)
    def look(self, world: World, h: float) -> None:
        """See that it is there."""


def watched(world: World, by: System | None = None) -> World:
    """Return the world with a system that looks at every substep."""
    by = by or Onlooker()
    world.install(by)
    world.synchronise()
    assert by.name in (why_not_fused(world) or "")
    return world


def why_not_fused(world: World) -> str | None:
    """Return why steps of a world are not made in the compiled loop."""
    world.synchronise()
    last = world.steppers.usable[-1]
    if world.plan.collisions != "step" or not isinstance(last, Soft):
        return "collisions are not found within steps"
    return "; ".join(last.hooks) or None


def figures(world: World) -> tuple[object, ...]:
    """Return what a run leaves behind, apart from the state of motion."""
    sampled = {system.name for system in world.schedule.systems if system.sampled}
    timings = world.schedule.timings.items()
    calls = {name: timing.calls for name, timing in timings if name not in {*LOOKING, *sampled}}
    counts = world.steps, world.collisions, world.force_evaluations, world.step_divisions, world.substeps
    contacts = world.contacts
    near = (contacts.candidate_pairs, contacts.count, contacts.impulse_dt, contacts.max_penetration)
    return (*counts, *near, kept_contacts(contacts), world.bodies.force.tobytes(), calls)


def assert_alike(stepped: World, ran: World) -> None:
    """Assert that two worlds are in the same state, bit for bit, and have counted alike."""
    assert bits(stepped) == bits(ran)
    assert figures(stepped) == figures(ran)
    assert ran.time == pytest.approx(stepped.time, rel=1e-12)


def compiled_scenes() -> list[str]:
    """Return the built-in scenes that qualify, and are one island: a system that looks sees the whole world.

    Each island has as many sweeps as its contacts need, and what is looked at as many as all of them.
    """
    names = []
    for name in SCENES:
        world = load_scene(name)
        world.simulation = replace(world.simulation, contacts="soft")
        world.synchronise()
        if why_not_fused(world) is None and len(world.parts) == 1:
            names.append(name)
    return names


def test_scenes_that_touch_and_are_not_observed_qualify() -> None:
    assert {"stack", "pyramid", "dominoes", "pile", "gas", "billiards", "slope"} <= set(compiled_scenes())


@pytest.mark.parametrize("name", compiled_scenes())
def test_a_run_gives_the_bits_of_single_steps(name: str) -> None:
    stepped, ran = load_scene(name), load_scene(name)
    for world in (stepped, ran):
        world.simulation = replace(world.simulation, contacts="soft")
    watched(stepped)
    steps = 25 if name == "stack" else STEPS  # then it falls asleep, but where a system looks at substeps
    for _ in range(steps):
        stepped.step()
    ran.run(steps=steps)
    assert_alike(stepped, ran)


@pytest.mark.parametrize("name", ["sandbox", "dominoes", "pile", "spring_chain"])
def test_systems_that_are_called_one_by_one_give_the_same_bits(name: str) -> None:
    stepped, ran = load_scene(name), load_scene(name)
    for world in (stepped, ran):
        world.simulation = replace(world.simulation, contacts="soft", collisions="step")
    watched(stepped, EachStage()).run(steps=40)
    ran.run(steps=40)
    assert_alike(stepped, ran)


def test_other_methods_with_stages_are_compiled_too() -> None:
    stepped, ran = load_scene("billiards"), load_scene("billiards")
    for world in (stepped, ran):
        world.simulation = replace(
            world.simulation, contacts="soft", collisions="step", integrator="symplectic_euler"
        )
    watched(stepped, EachStage()).run(steps=60)
    ran.run(steps=60)
    assert why_not_fused(ran) is None and ran.collisions > 20
    assert bits(stepped) == bits(ran)


@pytest.mark.slow
def test_mixed_shapes_that_fall_into_a_funnel_give_the_same_bits() -> None:
    """Slots emptied within a step leave scalar pairs out of order, which both ways must put right."""
    stepped, ran = watched(BENCH["funnel_open"].build()), BENCH["funnel_open"].build()
    stepped.run(steps=76)
    ran.run(steps=76)
    assert bits(stepped) == bits(ran)


def test_it_leaves_for_the_blocks_in_the_middle_of_a_step() -> None:
    stepped, ran = watched(BENCH["pile_1000"].build()), BENCH["pile_1000"].build()
    stepped.run(steps=STEPS)
    ran.run(steps=STEPS)
    assert ran.contacts.wide.filled > 0
    assert_alike(stepped, ran)


@pytest.mark.parametrize("seed", [(163, 3), (163, 14), (162, 7)])
def test_pairs_that_stay_apart_in_a_step_are_passed_over_with_the_same_bits(seed: tuple[int, int]) -> None:
    """Where a system looks at substeps, all pairs are looked at in each of them."""
    stepped, ran = watched(random_scene(*seed)[0].build()), random_scene(*seed)[0].build()
    stepped.run(steps=90)
    followed = 0
    for _ in range(9):
        ran.run(steps=10)
        followed = max(followed, ran.contacts.counts[FOLLOWED])
    assert followed > 0
    assert stepped.contacts.counts[FOLLOWED] == 0
    assert_alike(stepped, ran)


def resting() -> World:
    """Return a box that is about to fall asleep."""
    world = World(*standard_systems(), simulation=SimulationConfig(sleeping=True))
    box(world, (0.0, -0.5), width=9.0, height=1.0, static=True, friction=0.5)
    box(world, (0.0, 0.5), width=1.0, height=1.0, friction=0.5)
    return world


@pytest.mark.parametrize("looked_at", [False, True])
def test_what_wakes_within_a_substep_is_kicked_by_gravity(looked_at: bool) -> None:
    world = watched(resting()) if looked_at else resting()
    world.run(steps=100)
    assert world.sleep.count == 1
    circle(world, (-2.0, 0.5), radius=0.3, velocity=(6.0, 0.0), friction=0.5)
    world.run(steps=60)
    assert world.sleep.count == 0
    assert abs(measure_account(world).momentum["numerical"].y) < 1e-12


def test_steps_that_are_passed_over_are_counted_alike() -> None:
    stepped, ran = resting(), resting()
    stepped.install(StepOnlooker())
    for world in (stepped, ran):
        world.run(steps=100)
        assert world.sleep.count == 1
        circle(world, (0.0, 4.0), radius=0.3, friction=0.5)
        world.run(steps=300)
        assert world.sleep.count == 2
    assert_alike(stepped, ran)


def test_single_steps_are_compiled_too() -> None:
    stepped, ran = watched(BENCH["circles_10"].build()), BENCH["circles_10"].build()
    for _ in range(STEPS):
        stepped.step()
        ran.step()
    assert_alike(stepped, ran)


bodies = st.tuples(
    st.booleans(),
    st.floats(-3.0, 3.0), st.floats(0.0, 4.0), st.floats(0.05, 0.6), st.floats(0.05, 0.6),
    st.floats(-8.0, 8.0), st.floats(-8.0, 8.0), st.floats(0.0, 1.0), st.floats(0.0, 1.0),
    st.floats(0.2, 4.0),
)  # fmt: skip


def scattered(given: list[tuple[float, ...]], pulled: bool, damping: float) -> World:
    """Return bodies thrown together within bounds."""
    laws = PhysicsConfig(
        gravity_mode="linear" if pulled else "none", bounds=(-3.5, -0.5, 3.5, 5.0), linear_damping=damping
    )
    world = World(*standard_systems(), physics=laws, simulation=SimulationConfig(collisions="step"))
    box(world, (0.0, -0.25), width=4.0, height=0.5, static=True)
    for disc, x, y, width, height, vx, vy, restitution, friction, mass in given:
        common = {"velocity": (vx, vy), "restitution": restitution, "friction": friction, "mass": mass}
        if disc:
            circle(world, (x, y), radius=width, **common)  # type: ignore[arg-type]
        else:
            box(world, (x, y), width=width, height=height, angle=vx, **common)  # type: ignore[arg-type]
    return world


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.lists(bodies, min_size=2, max_size=14), st.booleans(), st.sampled_from((0.0, 0.3)), st.integers(1, 7)
)
def test_random_scenes_give_the_same_bits(
    given: list[tuple[float, ...]], pulled: bool, damping: float, stride: int
) -> None:
    stepped, ran = watched(scattered(given, pulled, damping)), scattered(given, pulled, damping)
    ran.islands = Islands(ran.schedule, None)  # as one world, as the one that is looked at
    stepped.run(steps=40)
    assert list(ran.stepping(steps=40, stride=stride))[-1] == 40
    assert_alike(stepped, ran)


def test_a_time_that_is_no_multiple_of_the_step() -> None:
    stepped, ran = watched(load_scene("dominoes")), load_scene("dominoes")
    stepped.run(seconds=0.7123)
    ran.run(seconds=0.7123)
    assert ran.time == stepped.time
    assert_alike(stepped, ran)


def test_a_run_that_diverges_stops_at_the_same_step() -> None:
    def doomed() -> World:
        world = BENCH["circles_10"].build()
        circle(world, (0.0, 0.9e300), radius=0.1, velocity=(0.0, 1.1e300), name="comet")
        return world

    stepped, ran = watched(doomed()), doomed()
    with pytest.raises(Diverged) as one:
        stepped.run(steps=80)
    with pytest.raises(Diverged) as other:
        ran.run(steps=80)
    assert str(one.value) == str(other.value) and "comet" in str(one.value)
    assert ran.steps > 3
    assert (stepped.steps, stepped.time, stepped.force_evaluations) == (
        ran.steps,
        ran.time,
        ran.force_evaluations,
    )
    assert bits(stepped) == bits(ran) and np.isfinite(np.frombuffer(bits(ran))).all()


class OwnGravity(GravitySystem):
    """A system of a user."""

    @property
    def name(self) -> str:
        """The name of the system that it replaces."""
        return "GravitySystem"

    @at(Stage.FORCE)
    def pull(self, world: World, h: float) -> None:
        """Pull everything to the left."""
        world.bodies.force[:, 0] -= 1.0


def falling(*systems: System, **simulation: object) -> World:
    world = World(*systems, simulation=SimulationConfig(collisions="step", **simulation))  # type: ignore[arg-type]
    box(world, (0, -0.5), width=9.0, height=1.0, static=True)
    circle(world, (0.0, 1.0), radius=0.25)
    world.synchronise()
    return world


def test_it_gives_the_reason_where_it_cannot_run() -> None:
    own = [OwnGravity() if isinstance(system, GravitySystem) else system for system in standard_systems()]
    assert why_not_fused(falling(*standard_systems())) is None
    assert "GravitySystem" in (why_not_fused(falling(*own)) or "")
    assert why_not_fused(falling(*standard_systems(), integrator="symplectic_euler")) is None
    dragged = falling(*standard_systems())
    dragged.add(dragged.entities()[-1], Drag(linear=0.1))
    dragged.synchronise()
    assert why_not_fused(dragged) is None
    assert why_not_fused(load_scene("two_planets")) is not None


def test_a_change_between_runs_takes_effect() -> None:
    stepped, ran = watched(BENCH["circles_10"].build()), BENCH["circles_10"].build()
    for world in (stepped, ran):
        world.run(steps=20)
        disc = world.entities()[-1]
        world.component(disc, Velocity).linear = (3.0, 2.0)
        world.component(disc, Transform).position = (0.0, 3.0)
        world.run(steps=20)
        world.remove(disc)
        world.physics = PhysicsConfig(gravity=(1.0, -3.0))  # type: ignore[arg-type]
        world.run(steps=20)
    assert_alike(stepped, ran)


def test_the_cost_is_shared_out_among_the_systems() -> None:
    world = BENCH["circles_10"].build()
    world.run(steps=500)
    timings = world.schedule.timings
    assert math.isfinite(sum(timing.ms for timing in timings.values()))
    assert timings["ResolveSystem"].ms > 0.0 and timings["ContactSystem"].ms > 0.0


class Forgetful(System):
    """Lets the points of discs be found again in every substep."""

    @at(Stage.RELAX)
    def forget(self, world: World, h: float) -> None:
        """Mark none as found in the pose of now."""
        found = world.contacts.manifolds["found"]
        found[found == AS_FOUND] = 0


def test_discs_at_rest_keep_their_points_within_a_step_with_the_bits_of_finding_them_again() -> None:
    kept, found_again = BENCH["circles_10"].build(), BENCH["circles_10"].build()
    found_again.install(Forgetful())
    for world in (kept, found_again):
        world.run(steps=500)
    near = kept.contacts.manifolds[: kept.contacts.recorded]
    assert (near["found"][near["count"] > 0] == AS_FOUND).all() and kept.contacts.active >= 15
    assert bits(kept) == bits(found_again)


def test_a_step_after_which_nothing_was_edited_prepares_nothing_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world, calls = BENCH["circles_10"].build(), Counter[str]()
    world.run(steps=500)
    world.step()

    def count(owner: Any, name: str) -> None:
        original = getattr(owner, name)

        def counted(*arguments: Any) -> Any:
            calls[name] += 1
            return original(*arguments)

        monkeypatch.setattr(owner, name, counted)

    count(Schedule, "remake")
    count(masses, "_columns")
    for name in ("_fixed_arguments", "_settle"):
        count(Substeps, name)
    count(BroadPhaseSystem, "list_pairs")
    for _ in range(40):
        world.step()
    assert not calls
    world.component(world.entities()[-1], Mass).mass *= 1.1
    world.step()
    assert not calls, "masses are derived in every step"
    world.simulation = replace(world.simulation, substeps=5)
    world.step()
    assert calls["remake"] == 1 and calls["_fixed_arguments"] == 1


def test_costs_that_are_noted_later_belong_to_the_stepper_that_had_them() -> None:
    world, alike = BENCH["circles_10"].build(), BENCH["circles_10"].build()
    for each in (world, alike):
        for substeps in (4, 2, 3):
            each.simulation = replace(each.simulation, substeps=substeps)
            each.step()
            each.step()
            if each is alike:
                assert each.schedule.timings["IntegrateSystem"].calls > 0
    calls = {name: timing.calls for name, timing in world.schedule.timings.items()}
    assert calls == {name: timing.calls for name, timing in alike.schedule.timings.items()}
    assert calls["IntegrateSystem"] == 2 * 2 * (4 + 2 + 3)
    before = world.schedule.timings["ResolveSystem"].ms
    for _ in range(3):  # not one of them is timed
        world.step()
    assert world.schedule.timings["ResolveSystem"].ms > before


def test_a_name_lets_the_near_pairs_be_as_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    world = BENCH["pile_1000"].build()
    world.run(steps=400)
    entities, listed = world.entity_index.entities, 0

    def list_pairs(*_: Any) -> None:
        nonlocal listed
        listed += 1

    monkeypatch.setattr(BroadPhaseSystem, "list_pairs", list_pairs)
    for number in range(3):
        world.add(world.entities()[-1], Name(f"disc {number}"))
        world.step()
    assert not listed and world.entity_index.entities is entities
    monkeypatch.undo()
    circle(world, (0.0, 50.0))
    world.step()
    assert world.contacts.candidate_pairs > 0 and world.entity_index.entities is not entities
