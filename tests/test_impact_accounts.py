"""The accounts of impacts in worlds: by soft steps, rigid contacts, and from impact to impact."""

from __future__ import annotations

import dataclasses
import functools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from physicslab import World, load_scene
from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.diagnostics.energy import Accounts, measure_account
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.kernels import accounts
from physicslab.prefabs import box, circle
from physicslab.state.state import State
from physicslab.stepping.accounting import balance_of
from physicslab.systems.resolve import ResolveSystem
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import Stage, System, at

G = 9.81
WAYS = ("soft", "rigid", "exact")


def laboratory(way: str, *, gravity: float = 0.0, **simulation: Any) -> World:
    """Return an empty world that resolves impacts in one of three ways."""
    if way == "exact":
        simulation |= {"collisions": "exact"}
    else:
        simulation |= {"contacts": way, "collisions": "step"}
    physics = PhysicsConfig(gravity=Vector2(0.0, -gravity), gravity_mode="linear" if gravity else "none")
    return World(*standard_systems(), physics=physics, simulation=SimulationConfig(**simulation))


def check_closed(found: Accounts, share: float = 1e-9) -> None:
    """Check that no error is left, of energy or of momentum."""
    largest = max(abs(found.start.energy), *(abs(value) for value in found.energy.values()))
    assert abs(found.energy["numerical"]) <= share * largest
    pushes = max(sum(map(abs, (p.x, p.y))) for p in found.momentum.values())
    largest = max(abs(found.start.px), abs(found.start.py), pushes)
    assert max(map(abs, found.momentum["numerical"])) <= share * largest


# ---- known answers -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("e", [0.3, 0.8, 1.0])
def test_one_bounce_takes_what_restitution_says(way: str, e: float) -> None:
    world = laboratory(way, gravity=G)
    box(world, (0, -0.5), width=10, height=1, static=True, restitution=1.0, friction=0.5)
    circle(world, (0, 2.25), radius=0.25, mass=3.0, restitution=e, friction=0.5)
    world.run(seconds=math.sqrt(4.0 / G) + 0.05)
    found = measure_account(world)
    assert world.collisions == 1
    assert found.energy["impacts"] == pytest.approx(-(1.0 - e * e) * 3.0 * G * 2.0, rel=1e-9, abs=1e-9)
    assert found.momentum["impacts"].y == pytest.approx(3.0 * (1.0 + e) * math.sqrt(4.0 * G), rel=1e-9)
    assert found.energy["friction"] == 0.0
    check_closed_energy(found)


def check_closed_energy(found: Accounts, share: float = 1e-11) -> None:
    """Check that impacts and friction explain all of the energy."""
    explained = found.energy["impacts"] + found.energy["friction"]
    assert found.now.energy - found.start.energy == pytest.approx(explained, abs=share * found.start.energy)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("ratio", [1.0, 100.0])
def test_a_bullet_that_stays_in_its_target_loses_what_momentum_does_not_need(way: str, ratio: float) -> None:
    world = laboratory(way)
    circle(world, (-1, 0), radius=0.1, mass=1.0, velocity=(7, 0), restitution=0.0)
    circle(world, (0, 0), radius=0.5, mass=ratio, restitution=0.0)
    world.run(seconds=0.5)
    found = measure_account(world)
    assert found.energy["impacts"] == pytest.approx(-0.5 * 49.0 * ratio / (1.0 + ratio), rel=1e-12)
    assert abs(found.energy["numerical"]) <= 1e-12 * 49.0
    assert not any(map(any, (found.momentum["impacts"], found.momentum["hand"])))


@pytest.mark.parametrize("way", ["soft", "exact"])
def test_a_racket_gives_its_work_and_the_impact_takes_its_share(way: str) -> None:
    """A racket of infinite mass: 2 kg come at 3 m/s, e = 0.5, the racket moves against them at 1 m/s."""
    world = laboratory(way)
    world.spawn(Transform((0, 0)), Velocity((1.0, 0.0)), Shape.box(0.2, 2.0), Material(restitution=0.5))
    circle(world, (1, 0.3), radius=0.2, mass=2.0, velocity=(-3, 0), restitution=0.5)
    world.run(seconds=0.5)
    found, impulse = measure_account(world), 2.0 * 1.5 * 4.0
    assert found.energy["impacts"] == pytest.approx(-0.5 * 2.0 * 16.0 * 0.75, rel=1e-12)
    assert found.energy["hand"] == pytest.approx(impulse, rel=1e-12)
    assert found.momentum["hand"].x == pytest.approx(impulse, rel=1e-12)
    assert found.angular_momentum["hand"] == pytest.approx(-0.3 * impulse, rel=1e-9)
    assert found.momentum["impacts"].x == 0.0
    assert abs(found.energy["numerical"]) <= 1e-12 * impulse


def test_sliding_discs_lose_in_an_impact_what_the_formula_says() -> None:
    """A disc that does not spin meets a wall at 45 degrees and sticks there: 1/3 of the sliding's energy."""
    world = laboratory("exact")
    box(world, (1, 0), width=1, height=20, static=True, restitution=1.0, friction=1.0)
    circle(world, (0, 0), radius=0.2, mass=1.0, velocity=(2, 2), restitution=1.0, friction=1.0)
    world.run(seconds=0.5)
    found = measure_account(world)
    assert found.energy["impacts"] == pytest.approx(-0.5 * 4.0 / 3.0, rel=1e-12)
    assert found.energy["friction"] == 0.0


# ---- random pairs ------------------------------------------------------------------------------------------


@st.composite
def pairs(draw: st.DrawFn, boxes: bool) -> list[dict[str, Any]]:
    """Draw two bodies that fly at each other, one perhaps fixed."""
    number = st.floats(-1.0, 1.0)
    bodies = []
    for side in (-1.0, 1.0):
        kind = draw(st.sampled_from(("circle", "box"))) if boxes else "circle"
        size = draw(st.floats(0.2, 1.0))
        shape = (
            {"radius": 0.5 * size}
            if kind == "circle"
            else {"width": size, "height": draw(st.floats(0.2, 1.0))}
        )
        bodies.append(
            shape | {
                "position": (side * 0.9, 0.2 * draw(number)),
                "mass": 10.0 ** draw(st.floats(-2.0, 2.0)),
                "velocity": (-side * draw(st.floats(1.0, 5.0)), draw(number)),
                "angular_velocity": 3.0 * draw(number) if boxes or kind == "circle" else 0.0,
                "angle": draw(number),
                "restitution": draw(st.floats(0.05, 1.0)),
                "friction": draw(st.floats(0.0, 1.5)),
            }
        )  # fmt: skip
    if draw(st.booleans()):
        bodies[1] |= {"static": True, "velocity": (0.0, 0.0), "angular_velocity": 0.0}
    return bodies


def _add(world: World, bodies: list[dict[str, Any]]) -> None:
    for body in bodies:
        options = {key: value for key, value in body.items() if key != "position"}
        if options.get("static"):
            for name in ("mass", "velocity", "angular_velocity"):
                options.pop(name)
        (circle if "radius" in body else box)(world, body["position"], **options)


class Bystander(System):
    """Acts at impacts, so that the systems of that stage are called."""

    @at(Stage.IMPACT)
    def act(self, state: State, h: float) -> None:
        """Do nothing."""


def watch_stages(world: World, monkeypatch: pytest.MonkeyPatch) -> list[NDArray[np.float64]]:
    """Return a list that is filled with what each stage of impacts leaves unexplained, as shares.

    They are those of energy, momentum and angular momentum.
    """
    missed: list[NDArray[np.float64]] = []
    resolve = ResolveSystem.resolve_impacts

    @functools.wraps(resolve)
    def watched(system: ResolveSystem, state: State, h: float) -> None:
        forces = world.schedule.forces
        before, booked = balance_of(state, forces), state.account.sums.copy()
        impacts = state.collisions
        resolve(system, state, h)
        if state.collisions > impacts:
            change = np.subtract(balance_of(state, forces), before)
            booked = state.account.sums - booked
            mass, velocity = state.table(Mass)["mass"], state.table(Velocity)["linear"]
            momentum = float(np.abs(mass[:, None] * velocity).sum())
            energy = np.abs(booked[:, 0]).sum() + abs(before.energy)
            assert booked[[accounts.IMPACTS, accounts.FRICTION], 0].max() <= 1e-12 * energy
            left = np.abs(change - booked.sum(axis=0)) / (energy, momentum, momentum, 10.0 * momentum)
            # A body that touches two others, each at its own moment, may keep its angular momentum less well.
            if state.collisions > impacts + 1 or state.contacts.count > 1:
                left[3] = 0.0
            missed.append(left)

    monkeypatch.setattr(ResolveSystem, "resolve_impacts", watched)
    return missed


_ON_THE_FLOOR: list[dict[str, Any]] = [
    {"radius": 0.5, "position": (-0.9, 0.0), "mass": 1.0, "velocity": (2.0, 0.0),
     "restitution": 0.125, "friction": 1.0},
    {"radius": 0.5, "position": (0.9, 0.0), "mass": 1.0, "velocity": (-1.0, 1.0), "angular_velocity": 3.0,
     "restitution": 1.0, "friction": 1.0},
]  # fmt: skip


@settings(max_examples=40, deadline=None)
@given(pairs(boxes=True), st.sampled_from((0.0, G)), st.floats(-2.0, 2.0))
@example(_ON_THE_FLOOR, G, 0.0)
def test_each_stage_of_impacts_is_explained_to_rounding(
    bodies: list[dict[str, Any]], g: float, floor: float
) -> None:
    """Also with a floor that moves, and turns."""
    with pytest.MonkeyPatch.context() as patch:
        world = laboratory("soft", gravity=g)
        world.install(Bystander())
        _add(world, bodies)
        driven = Velocity((0.1, floor), 0.3 * floor), Shape.box(6.0, 0.5)
        world.spawn(Transform((0, -1.5)), *driven, Material(restitution=0.7, friction=0.5))
        missed = watch_stages(world, patch)
        world.run(steps=40)
    assert np.max(missed, initial=0.0) <= 1e-12


@pytest.mark.parametrize("name", ["pile", "gas", "dominoes"])
def test_each_stage_of_impacts_of_a_crowd_is_explained(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    world = load_scene(name)
    world.simulation = dataclasses.replace(world.simulation, contacts="soft", collisions="step")
    world.install(Bystander())
    missed = watch_stages(world, monkeypatch)
    world.run(steps=40)
    assert missed and np.max(missed) <= 1e-12


@settings(max_examples=60, deadline=None)
@given(pairs(boxes=True))
@pytest.mark.parametrize("way", ["soft", "rigid"])
def test_accounts_explain_a_random_impact(way: str, bodies: list[dict[str, Any]]) -> None:
    world = laboratory(way)
    _add(world, bodies)
    found = measure_account(world)
    for _ in range(30):
        before = world.account.sums.copy()
        world.step()
        if way == "rigid" and world.contacts.count:
            break  # what stays in contact slides on in a smooth piece of motion, which is no impact
        found = measure_account(world)
        change = world.account.sums - before
        assert change[accounts.IMPACTS, 0] <= 1e-12 * found.start.energy
        assert change[accounts.FRICTION, 0] <= 1e-15 * found.start.energy  # seen: 3e-20 of 5.5 J
    check_closed(found)


@settings(max_examples=60, deadline=None)
@given(pairs(boxes=False), st.sampled_from((0.0, G)))
def test_accounts_explain_random_impacts_at_exact_times(bodies: list[dict[str, Any]], g: float) -> None:
    world = laboratory("exact", gravity=g)
    world.physics = PhysicsConfig(
        gravity=Vector2(0.0, -g), gravity_mode="linear" if g else "none", bounds=(-3, -2, 3, 2),
        bounds_restitution=0.9, bounds_friction=0.4,
    )  # fmt: skip
    _add(world, bodies)
    world.run(steps=20)
    found = measure_account(world)
    largest = max(map(abs, (*found.start[:1], *found.energy.values(), found.now.energy)))
    assert abs(found.energy["numerical"]) <= 1e-12 * largest
    pushes = [abs(x) for name, p in found.momentum.items() if name != "numerical" for x in p]
    assert max(map(abs, found.momentum["numerical"])) <= 1e-12 * max(*pushes, abs(found.start.px), 1e-3)
    turns = [abs(x) for name, x in found.angular_momentum.items() if name != "numerical"]
    assert abs(found.angular_momentum["numerical"]) <= 1e-11 * max(*turns, abs(found.start.spin), 1e-3)


# ---- the ballistic scenes ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["drop", "bounces", "newtons_cradle"])
def test_nothing_is_left_of_a_ballistic_scene_that_comes_to_rest(name: str) -> None:
    world = load_scene(name)
    world.run(seconds=2.0)
    found = measure_account(world)
    if name == "newtons_cradle":  # springs hold it: what the method errs by is no rounding
        assert found.energy["impacts"] == pytest.approx(0.0, abs=1e-12)
        return
    assert world.collisions
    largest = max(map(abs, found.energy.values()))
    assert abs(found.energy["numerical"]) <= 1e-12 * largest * world.collisions


def test_single_steps_and_a_leap_book_the_same() -> None:
    """A leap that finds a body at rest goes back, and so does the account."""
    sums = []
    for steps in (1, 240):
        world = laboratory("exact", gravity=G)
        box(world, (0, -0.5), width=10, height=1, static=True, restitution=0.5, friction=0.5)
        circle(world, (0, 1.25), radius=0.25, velocity=(1, 0), restitution=0.5, friction=0.5)
        for _ in range(240 // steps):
            world.run(steps=steps)
        sums.append(world.account.sums.copy())
    assert sums[0][accounts.IMPACTS] == pytest.approx(sums[1][accounts.IMPACTS], rel=1e-9)
    assert sums[0][accounts.FRICTION] == pytest.approx(sums[1][accounts.FRICTION], rel=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_resting_and_ballistic_bodies_beside_each_other_are_all_accounted_for(seed: int) -> None:
    """What rests goes by the contact step, back and forth in time between the impacts of the others."""
    random = np.random.default_rng(seed)
    physics = PhysicsConfig(bounds=(-3, -2, 3, 4), bounds_restitution=0.7, bounds_friction=0.4)
    simulation = SimulationConfig(contacts="soft", collisions="exact")
    world = World(*standard_systems(), physics=physics, simulation=simulation)
    circle(world, (-2, -1.6), radius=0.4, velocity=(0.5, 0), restitution=0.5, friction=0.3)
    circle(world, (1, -1.7), radius=0.3, restitution=0.5, friction=0.3)
    for place, e in (((0, 1), 0.8), ((1.5, 1), 0.6)):
        velocity = tuple(random.normal(0.0, 3.0, 2))
        circle(world, place, radius=0.3, velocity=velocity, angular_velocity=3.0, restitution=e, friction=0.4)
    box(
        world, (-1, 2), width=0.6, height=0.4, fixed_rotation=True,
        velocity=tuple(random.normal(0.0, 3.0, 2)), restitution=0.6, friction=0.5,
    )  # fmt: skip
    for steps in (1, 1, 1, 90, 1, 60):
        world.run(steps=steps)
        found = measure_account(world)
        largest = max(map(abs, found.energy.values()))
        assert abs(found.energy["numerical"]) <= 1e-11 * (largest + found.start.energy)
        pushes = abs(found.momentum["gravity"].y) + abs(found.momentum["impacts"].y)
        assert max(map(abs, found.momentum["numerical"])) <= 1e-12 * (pushes + 1.0)
        # The arms of soft contacts do not lead to one point: angular momentum is theirs to err in.
        assert abs(found.angular_momentum["numerical"]) <= 1e-4 * pushes
    assert world.collisions > 20 and found.energy["contact"] != 0.0


def test_the_account_is_kept_where_no_impact_is_read() -> None:
    """The log of the contact step has no length then; the account is the same."""
    found = []
    for read in (False, True):
        world = load_scene("gas")
        world.contacts.read = read
        world.run(seconds=0.25)
        found.append(world.account.sums.copy())
        assert (world.contacts.logged > 0) == read
    assert np.array_equal(found[0], found[1])
    assert found[0][accounts.IMPACTS, 1:].any()
