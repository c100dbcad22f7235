"""What changed energy and momentum: accounts add up, edits and hands have their own, nothing else does."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable

import numpy as np
import pytest
from crowds import crowd
from desk import FRAME, Desk, empty_world
from hypothesis import example, given, settings
from hypothesis import strategies as st
from recording import RecordingCanvas

from physicslab.cli import main
from physicslab.components import (
    Charge,
    Drag,
    Held,
    Mass,
    Material,
    Medium,
    Pin,
    Shape,
    Spring,
    Transform,
    Velocity,
)
from physicslab.components.quantities import ENERGY_CAUSES, MOMENTUM_CAUSES, UNMEASURED_MOMENTA
from physicslab.diagnostics.energy import ENERGY_ACCOUNTS, MOMENTUM_ACCOUNTS, Accounts, Audit, measure_account
from physicslab.diagnostics.quantities import Reading
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene, read_scene
from physicslab.history import (
    AddComponent,
    Command,
    History,
    Remove,
    RemoveComponent,
    SetField,
    SetPhysics,
    Spawn,
)
from physicslab.kernels import accounts as rows
from physicslab.prefabs import box, circle, pendulum
from physicslab.scenes import SCENES
from physicslab.state.masses import Diverged
from physicslab.state.state import State
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import ForceSystem, Stage, System, at
from physicslab.world import World

SMALL = ("drop", "pendulum", "slope", "stack", "newtons_cradle", "two_planets", "bounces", "dominoes")
"""Scenes that are quick to run more than once."""
ERRORS = {"sandbox": 1e-8, "pendulum": 1e-11, "droplets": 2e-4}
"""Where springs or molecules act that are not solved in closed form: the error of their method."""
TWO_POINTS = {
    "pyramid": 1e-4, "pile": 1e-4, "bridge": 1e-4, "dominoes": 1e-5, "billiards": 1e-5, "gas": 1e-5,
    "sandbox": 1e-6, "seesaw": 1e-4, "crane": 1e-4, "ragdoll": 1e-4,
}  # fmt: skip
"""Scenes with soft contacts: how much the angular momentum is off."""
EXACT = 1e-9
"""Of the other scenes: nothing but rounding is left."""


def largest_term(account: Accounts) -> float:
    """Return the largest number that goes into the sum of the energies."""
    return max(abs(account.now.energy), abs(account.start.energy), *map(abs, account.energy.values()))


def check_sums(account: Accounts) -> None:
    """Check that the accounts, the error among them, add up to the change of energy and of momenta."""
    scale = largest_term(account)
    assert sum(account.energy.values()) == pytest.approx(account.change, abs=1e-9 * scale)
    change = Vector2(account.now.px - account.start.px, account.now.py - account.start.py)
    linear, turning = account.momentum.values(), account.angular_momentum.values()
    sizes = [1.0, *(value.magnitude for value in linear)]
    assert (sum(linear, Vector2()) - change).magnitude <= 1e-9 * max(sizes)
    turned = account.now.spin - account.start.spin
    assert sum(turning) == pytest.approx(turned, abs=1e-9 * max(1.0, *map(abs, turning)))


def with_simulation(world: World, **changes: object) -> World:
    world.simulation = dataclasses.replace(world.simulation, **changes)  # type: ignore[arg-type]
    return world


# ---- names -------------------------------------------------------------------------------------------------


def test_every_row_of_the_account_has_a_name_and_every_name_a_row() -> None:
    measured = tuple(cause for cause in MOMENTUM_CAUSES if cause not in UNMEASURED_MOMENTA)
    assert tuple(ENERGY_ACCOUNTS) == ENERGY_CAUSES and tuple(MOMENTUM_ACCOUNTS) == measured
    assert sorted({**MOMENTUM_ACCOUNTS, **ENERGY_ACCOUNTS}.values()) == list(range(rows.CAUSES))


def test_an_edit_before_the_first_step_is_an_edit_to_an_audit_that_has_begun() -> None:
    """It was an error of the method: accounts begin with the first step."""
    world = load_scene("drop")
    audit = Audit(world)
    world.component("ball", Velocity).linear = (3.0, 0.0)
    world.run(seconds=0.1)
    audit.sample(world)
    assert audit.account.energy["edits"] == pytest.approx(0.5 * 3.0**2 - 0.5 * 1.0**2)
    assert audit.account.momentum["edits"] == Vector2(2.0, 0.0)
    check_sums(audit.account)
    assert audit.error < 1e-12


# ---- sums --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SCENES)
def test_the_error_of_every_scene_is_that_of_its_method(name: str) -> None:
    world = load_scene(name)
    audit = Audit(world)
    for _ in world.stepping(seconds=2.0, stride=10):
        audit.sample(world)
    check_sums(audit.account)
    assert audit.error <= ERRORS.get(name, EXACT), (audit.account.energy, world.stepper)


@pytest.mark.parametrize("name", SCENES)
def test_the_momentum_of_every_scene_is_booked_to_rounding(name: str) -> None:
    world = load_scene(name)
    world.run(seconds=2.0)
    account = measure_account(world)
    exchanged = max(1.0, *(value.magnitude for value in account.momentum.values()))
    assert account.momentum["numerical"].magnitude <= 1e-9 * exchanged, account.momentum
    turned = max(1.0, *map(abs, account.angular_momentum.values()))
    # Impulses on bodies that overlap, or have moved since their points were found, act at two points, one on
    # each: of all that gravity and motion turn in that time about the origin, that is this share.
    rows = world.batch(Mass, Velocity).rows
    reach = (world.table(Mass)["mass"][rows] * np.hypot(*world.table(Transform)["position"][rows].T)).sum()
    fastest = 2.0 * world.physics.gravity.magnitude + np.hypot(*world.table(Velocity)["linear"][rows].T).max()
    allowed = 1e-9 * turned + TWO_POINTS.get(name, 0.0) * reach * fastest
    assert abs(account.angular_momentum["numerical"]) <= allowed, account.angular_momentum


@pytest.mark.parametrize("contacts", ["soft", "auto"])
@pytest.mark.parametrize("sleeping", [True, False])
@pytest.mark.parametrize("name", ["stack", "slope", "dominoes", "drop"])
def test_the_error_is_rounding_however_contacts_are_found(name: str, sleeping: bool, contacts: str) -> None:
    world = with_simulation(load_scene(name), sleeping=sleeping, contacts=contacts)
    audit = Audit(world)
    for _ in world.stepping(seconds=3.0, stride=10):
        audit.sample(world)
    check_sums(audit.account)
    assert audit.error <= EXACT, audit.account.energy


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10_000))
@example(1568)  # an overshooting damper
def test_the_accounts_of_random_scenes_add_up(seed: int) -> None:
    try:
        world = read_scene(crowd(seed))
        audit = Audit(world)
        for _ in world.stepping(steps=40, stride=7):
            audit.sample(world)
            check_sums(audit.account)
    except Diverged:
        return
    account = measure_account(world)
    for name in ("impacts", "damping"):
        assert account.energy[name] <= 1e-12 * largest_term(account), f"{name} gives no energy"
    assert account.energy["edits"] == 0.0


class Watching(ForceSystem):
    """A force of nothing in Python: contacts then go stage by stage."""

    potential = "nothing"

    @at(Stage.FORCE)
    def look(self, world: World, dt: float) -> None:
        """Do nothing."""


@pytest.mark.parametrize("name", ["stack", "slope", "dominoes"])
def test_staged_and_fused_contacts_book_the_same(name: str) -> None:
    fused, staged = (with_simulation(load_scene(name), contacts="soft") for _ in range(2))
    staged.install(Watching())
    for world in (fused, staged):
        world.run(seconds=1.5)
    assert fused.stepper is not None and staged.stepper is not None
    assert fused.stepper.name != staged.stepper.name
    one, other = measure_account(fused), measure_account(staged)
    assert one.now == pytest.approx(other.now, rel=1e-9, abs=1e-9)
    for cause, value in one.energy.items():
        assert other.energy[cause] == pytest.approx(value, abs=1e-9 * largest_term(one)), cause


@pytest.mark.parametrize("name", SMALL)
def test_a_window_changes_no_figure(name: str) -> None:
    desk, headless = Desk(load_scene(name), RecordingCanvas((1280, 720))), load_scene(name)
    desk.frames(61)
    while headless.steps < desk.world.steps:
        headless.step(FRAME)
    assert headless.steps == desk.world.steps > 50
    assert measure_account(desk.world).energy == measure_account(headless).energy
    assert measure_account(desk.world).momentum == measure_account(headless).momentum


def test_measuring_changes_nothing() -> None:
    world = load_scene("stack")
    world.run(steps=10)
    sums = world.account.sums.copy()
    world.component(world.entities()[1], Velocity).linear = (1.0, 0.0)
    first, second = measure_account(world), measure_account(world)
    assert first == second and (world.account.sums == sums).all() and first.energy["edits"] > 0.0


def test_two_worlds_never_mix() -> None:
    alone = [load_scene(name) for name in ("stack", "slope")]
    for world in alone:
        world.run(steps=60)
    pair = [load_scene(name) for name in ("stack", "slope")]
    for _ in range(60):
        for world in pair:
            world.step()
    for one, other in zip(alone, pair, strict=True):
        assert measure_account(one).energy == pytest.approx(measure_account(other).energy, abs=1e-12)


# ---- edits -------------------------------------------------------------------------------------------------


def falling() -> tuple[History, int]:
    """Return a ball of 2 kg that has fallen for a while, 3 m/s fast to the side."""
    world = World(*standard_systems(), physics=PhysicsConfig())
    ball = circle(world, (0, 50), mass=2.0, velocity=(3.0, 0.0))
    history = History(world)
    history.step(0.01, steps=20)
    return history, ball


EDITS: dict[str, tuple[Callable[[int], Command], Callable[[World, int], float]]] = {
    "velocity": (
        lambda ball: SetField(ball, "Velocity", "linear", (0.0, 5.0)),
        lambda world, ball: 25.0 - world.component(ball, Velocity).linear.magnitude_squared,
    ),
    "mass": (
        lambda ball: SetField(ball, "Mass", "mass", 6.0),
        lambda world, ball: 2.0 * measure_account(world).now.energy,
    ),
    "gravity": (
        lambda ball: SetPhysics({"gravity": Vector2(0.0, -1.62)}),
        lambda world, ball: 2.0 * (1.62 - 9.81) * world.component(ball, Transform).position.y,
    ),
    "place": (
        lambda ball: SetField(ball, "Transform", "position", (0.0, 60.0)),
        lambda world, ball: 2.0 * 9.81 * (60.0 - world.component(ball, Transform).position.y),
    ),
    "removal": (Remove, lambda world, ball: -measure_account(world).now.energy),
    "another body": (
        lambda ball: Spawn([Transform((9, 4)), Velocity((1, 0)), Mass(3.0)]),
        lambda world, ball: 3.0 * 9.81 * 4.0 + 1.5,
    ),
}


@pytest.mark.parametrize("edit", EDITS)
def test_an_edit_has_its_own_account_which_undo_takes_back(edit: str) -> None:
    history, ball = falling()
    make, brought = EDITS[edit]
    world = history.world
    before, expected = measure_account(world), brought(world, ball)
    assert before.energy["edits"] == 0.0 and abs(expected) > 1.0
    history.do(make(ball))
    after = measure_account(world)
    assert after.energy["edits"] == pytest.approx(expected, rel=1e-12)
    history.step(0.01, steps=5)
    later = measure_account(world)
    assert later.energy["edits"] == pytest.approx(expected, rel=1e-12)
    assert abs(later.energy["numerical"]) <= EXACT * largest_term(later)
    check_sums(later)
    history.undo()
    assert measure_account(world) == after
    history.undo()
    assert measure_account(world) == before
    history.redo()
    assert measure_account(world) == after
    history.redo()
    assert measure_account(world) == later


def test_a_refused_edit_and_a_failed_step_leave_nothing() -> None:
    history, ball = falling()
    before = measure_account(history.world)
    with pytest.raises(InvalidValue):
        history.do(SetField(ball, "Mass", "mass", -1.0))
    assert measure_account(history.world) == before
    history.do(SetField(ball, "Velocity", "linear", (1e308, 0.0)))
    history.do(SetField(ball, "Transform", "position", (1e300, 0.0)))
    with pytest.raises(Diverged):
        history.step(1e90)
    for _ in range(2):
        history.undo()
    assert measure_account(history.world) == before


def test_an_account_begins_with_the_first_step() -> None:
    world = empty_world()
    ball = circle(world, (0, 5), mass=1.0)
    world.component(ball, Velocity).linear = (2.0, 0.0)
    assert not any(measure_account(world).energy.values()), "what was made before the first step is the start"
    world.step(0.01)
    world.component(ball, Velocity).linear = (0.0, 0.0)
    account = measure_account(world)
    assert account.energy["edits"] != 0.0 and account.since == 0.0


# ---- hands -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("contacts", [True, False])
def test_a_hand_that_lifts_a_box_gives_m_g_h(contacts: bool) -> None:
    world = empty_world()
    if contacts:
        box(world, (0, -0.5), width=20.0, height=1.0, static=True)
    crate = box(world, (0, 0.25), width=0.5, height=0.5, mass=4.0)
    history = History(world)
    history.step(steps=30 if contacts else 0)
    history.step(1e-9)
    before = measure_account(world)
    history.write(AddComponent(crate, Held()))
    for _ in range(60):
        history.write(SetField(crate, "Velocity", "linear", (0.0, 1.5)))
        history.step()
    history.write(SetField(crate, "Velocity", "linear", (0.0, 0.0)))
    history.write(RemoveComponent(crate, "Held"))
    history.step(1e-9)
    account = measure_account(world).after(before)
    lifted = 60 * 1.5 * world.simulation.dt
    assert account.energy["hand"] == pytest.approx(4.0 * 9.81 * lifted, rel=1e-9)
    assert account.energy["edits"] == 0.0
    assert abs(account.energy["numerical"]) <= EXACT * largest_term(account)


def test_an_edit_while_a_hand_takes_hold_is_no_work_of_the_hand() -> None:
    history, ball = falling()
    world = history.world
    history.write(AddComponent(ball, Held()))
    held = measure_account(world).energy["hand"]
    history.do(Spawn([Transform((9, 4)), Velocity((1, 0)), Mass(3.0)]))
    history.step(0.01)
    energy = measure_account(world).energy
    assert energy["hand"] == held and energy["edits"] == pytest.approx(3.0 * 9.81 * 4.0 + 1.5)


def test_a_driven_plate_that_lifts_a_box_gives_m_g_h() -> None:
    world = empty_world()
    world.spawn(Transform((0, -0.5)), Velocity((0, 0.5)), Shape.box(4.0, 1.0))
    crate = box(world, (0, 0.25), width=0.5, height=0.5, mass=4.0, restitution=0.0)
    world.component(crate, Velocity).linear = (0.0, 0.5)
    world.run(seconds=0.5)
    before, low = measure_account(world), world.component(crate, Transform).position.y
    world.run(seconds=2.0)
    account = measure_account(world).after(before)
    lifted = world.component(crate, Transform).position.y - low
    assert lifted == pytest.approx(1.0, abs=1e-3)
    assert account.energy["hand"] == pytest.approx(4.0 * 9.81 * lifted, rel=1e-9)
    assert abs(account.energy["numerical"]) <= EXACT * largest_term(account)


# ---- known answers -----------------------------------------------------------------------------------------


def test_one_bounce_takes_what_restitution_says() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=20.0, height=1.0, static=True, restitution=0.6, friction=0.0)
    circle(world, (0, 2.25), radius=0.25, mass=3.0, restitution=0.6, friction=0.0)
    world.run(seconds=0.9)
    account = measure_account(world)
    assert world.collisions == 1
    assert account.energy["impacts"] == pytest.approx(-(1.0 - 0.36) * 3.0 * 9.81 * 2.0, rel=1e-12)


def test_a_box_that_slides_to_rest_gives_all_its_motion_to_friction() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=40.0, height=1.0, static=True, friction=0.4)
    box(world, (-5, 0.25), width=0.5, height=0.5, mass=2.0, friction=0.4, velocity=(3.0, 0.0),
        fixed_rotation=True)  # fmt: skip
    world.run(seconds=2.0)
    assert measure_account(world).energy["friction"] == pytest.approx(-0.5 * 2.0 * 9.0, rel=1e-8)


def test_a_disc_that_begins_to_roll_gives_a_third_to_friction() -> None:
    world = empty_world()
    box(world, (0, -0.5), width=80.0, height=1.0, static=True, friction=0.4)
    circle(world, (-5, 0.25), radius=0.25, mass=2.0, friction=0.4, velocity=(3.0, 0.0))
    world.run(seconds=2.0)
    assert measure_account(world).energy["friction"] == pytest.approx(-0.5 * 2.0 * 9.0 / 3.0, rel=1e-12)


def test_what_a_damper_takes_is_damping() -> None:
    world = empty_world()
    pendulum(world, (0, 3), length=1.0, stiffness=200.0, damping=2.0)
    world.run(seconds=2.0)
    account = measure_account(world)
    assert account.energy["damping"] < -1e-3
    assert abs(account.energy["numerical"]) < 1e-6 * abs(account.energy["damping"])


@pytest.mark.parametrize(("gravity", "coulomb"), [("none", 0.5), ("planet", 0.0), ("planet", 0.5)])
def test_what_a_damper_takes_is_damping_where_other_forces_kick_too(gravity: str, coulomb: float) -> None:
    world = empty_world(gravity=(0.0, 0.0))
    world.physics = dataclasses.replace(world.physics, gravity_mode=gravity, coulomb_constant=coulomb)
    with_simulation(world, integrator="leapfrog", contacts="soft", dt=1 / 240)
    left, right = circle(world, (0, 0), radius=0.2), circle(world, (2, 0), radius=0.2, velocity=(1, 1))
    for disc in (left, right):
        world.add(disc, Charge(1.0))
    world.spawn(Spring(a=left, b=right, rest_length=1.5, stiffness=20.0, damping=2.0))
    world.run(seconds=0.5)
    account = measure_account(world)
    assert account.energy["damping"] < -1.0
    assert abs(account.energy["numerical"]) < 1e-4 * abs(account.energy["damping"])


@pytest.mark.parametrize("integrator", ["auto", "leapfrog"])
@pytest.mark.parametrize("speed", [(0.0, 0.0), (2.0, 0.0), (-0.5, 0.3)])
def test_a_damper_at_a_driven_plate_takes_what_its_drive_gives_too(
    integrator: str, speed: tuple[float, float]
) -> None:
    world = with_simulation(
        empty_world(gravity=(0.0, 0.0)), integrator=integrator, contacts="soft", dt=1 / 960
    )
    disc = circle(world, (1, 0), radius=0.2, mass=2.0, velocity=(0.0, 0.3), restitution=0.5)
    plate = world.spawn(Transform((0, 0)), Velocity(speed, 0.3), Shape.box(0.4, 0.4), Material(0.5))
    world.spawn(Spring(a=disc, b=plate, rest_length=0.5, stiffness=20.0, damping=2.0))
    world.run(seconds=0.4)
    account = measure_account(world)
    assert account.energy["damping"] < -0.1
    assert abs(account.energy["numerical"]) < 1e-3 * abs(account.energy["damping"])


@pytest.mark.parametrize("damping", [0.0, 2.0])
def test_what_turns_a_point_mass_on_against_a_spring_is_driven(damping: float) -> None:
    """A body without a Shape turns steadily: what keeps it so works against a spring beside its middle."""
    world = with_simulation(empty_world(), integrator="leapfrog", contacts="soft", dt=1 / 480)
    point = world.spawn(Transform((0, 0)), Velocity((1.0, 0.0), 5.0), Mass(2.0))
    disc = circle(world, (1, 1), radius=0.2)
    circle(world, (3, 1), radius=0.2)
    world.spawn(
        Spring(a=point, b=disc, anchor_a=(0.3, 0.0), rest_length=0.5, stiffness=20.0, damping=damping)
    )
    world.run(seconds=1.0)
    account = measure_account(world)
    assert abs(account.energy["hand"]) > 0.5
    assert abs(account.energy["numerical"]) < 2e-3 * abs(account.energy["hand"])


class LooksAtKicks(System):
    """Makes steps those of contacts, though nothing can touch."""

    @at(Stage.KICK)
    def look(self, state: State, h: float) -> None:
        """Do nothing."""


@pytest.mark.parametrize("beside", ["disc", "system"])
@pytest.mark.parametrize("cause", ["fields", "damping"])
def test_what_a_pool_gives_and_takes_by_kicks_is_that_of_fields_and_of_damping(
    cause: str, beside: str
) -> None:
    """A box comes in by a side wall, where the pressure of the fluid works; drag is of the first order."""
    errors = []
    for dt in (1 / 60, 1 / 240):
        world = with_simulation(empty_world(), integrator="leapfrog", contacts="soft", dt=dt)
        drag = 20.0 if cause == "damping" else 0.0
        world.spawn(
            Transform((3, -1)), Shape.box(4.0, 4.0), Medium(density=50.0, viscosity=drag, flow=(0.5, 0.0))
        )
        box(world, (0, 0), width=0.6, height=0.4, mass=10.0, velocity=(2.0, 0.0), angle=0.3)
        if beside == "disc":
            circle(world, (-2, 0))
        else:
            world.install(LooksAtKicks())
        world.run(seconds=0.5)
        account = measure_account(world)
        assert abs(account.energy[cause]) > 1.0
        errors.append(abs(account.energy["numerical"]))
    assert errors[0] < 0.03 * abs(account.energy[cause])
    assert errors[1] < 0.35 * errors[0]


def test_a_pin_that_is_closed_in_a_pool_is_no_motion_that_the_fluid_slows() -> None:
    errors = []
    for dt in (1 / 240, 1 / 960):
        world = with_simulation(empty_world(), integrator="leapfrog", contacts="soft", dt=dt)
        world.spawn(Transform((0, -1)), Shape.box(9.0, 4.0), Medium(density=25.0, viscosity=0.7))
        plate = box(world, (-1, 0), width=0.4, height=0.3, mass=0.7)
        circle(world, (3, 0), radius=0.2)
        world.spawn(Pin(a=plate, anchor_a=(0.0, 0.0), anchor_b=(0.0, 0.0)))
        world.run(seconds=0.2)
        errors.append(abs(measure_account(world).energy["numerical"]))
    assert errors[1] < min(0.5 * errors[0], 0.1)


def test_at_its_terminal_speed_a_body_gives_all_its_weight_does_to_drag() -> None:
    world = empty_world()
    ball = circle(world, (0, 5), mass=2.0, velocity=(0.0, -2.0 * 9.81))
    world.add(ball, Drag(linear=1.0))
    world.run(seconds=1.0)
    account = measure_account(world)
    assert account.energy["damping"] == pytest.approx(-2.0 * 9.81 * 2.0 * 9.81, rel=1e-9)
    assert account.momentum["damping"].y == pytest.approx(2.0 * 9.81, rel=1e-9)


def test_a_ballistic_pendulum_loses_what_the_masses_say() -> None:
    world = empty_world(gravity=(0.0, 0.0))
    bob = pendulum(world, (0, 3), length=2.0, stiffness=1e4)
    weight = world.component(bob, Mass).mass
    world.add(bob, Material(restitution=0.0, friction=0.0))
    height = world.component(bob, Transform).position.y
    world.component(bob, Velocity).linear = (0.0, 0.0)
    circle(world, (-3.0, height), radius=0.05, mass=0.1, velocity=(20.0, 0.0), restitution=0.0, friction=0.0)
    while not world.collisions:
        world.step()
    effective = 1.0 / (1.0 / 0.1 + 1.0 / weight)
    assert measure_account(world).energy["impacts"] == pytest.approx(-0.5 * effective * 400.0, rel=1e-6)


@pytest.mark.parametrize(
    ("method", "order", "scene", "dt"),
    [("leapfrog", 2, "two_planets", 0.05), ("blanes_moan", 6, "two_planets", 0.5)],
)
def test_the_error_falls_with_the_step_at_the_order_of_the_method(
    method: str, order: int, scene: str, dt: float
) -> None:
    errors = []
    for substeps in (1, 2):
        world = with_simulation(load_scene(scene), integrator=method, substeps=substeps, dt=dt)
        audit = Audit(world)
        for _ in world.stepping(seconds=5.0, stride=1):
            audit.sample(world)
        errors.append(audit.error)
    assert errors[1] > 1e-10
    assert order - 0.2 < math.log2(errors[0] / errors[1]) < order + 1.2, "energy may converge faster"


class Wind(ForceSystem):
    """A steady push on every body with mass, which stores nothing."""

    @at(Stage.FORCE)
    def push(self, world: World, dt: float) -> None:
        """Push."""
        world.bodies.force[world.batch(Mass).rows, 0] += 2.0


def test_the_work_of_a_force_in_python_is_that_of_a_field() -> None:
    world = empty_world(gravity=(0.0, 0.0))
    world.install(Wind())
    ball = circle(world, (0, 5), mass=4.0)
    world.run(seconds=1.0)
    account, way = measure_account(world), world.component(ball, Transform).position.x
    assert way == pytest.approx(0.25, rel=1e-6)
    assert account.energy["fields"] == pytest.approx(2.0 * way, rel=1e-9)
    assert account.momentum["fields"].x == pytest.approx(2.0, rel=1e-9)


def test_gravity_gives_momentum_and_no_energy() -> None:
    world = empty_world()
    circle(world, (1.5, 50), mass=2.0)
    world.run(seconds=1.0)
    account = measure_account(world)
    assert account.momentum["gravity"].y == pytest.approx(-2.0 * 9.81, rel=1e-9)
    assert account.angular_momentum["gravity"] == pytest.approx(-2.0 * 9.81 * 1.5, rel=1e-9)
    assert account.change == pytest.approx(0.0, abs=1e-9 * largest_term(account))


# ---- what people and scripts see ---------------------------------------------------------------------------


def test_the_document_of_a_run_adds_up(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "slope", "--seconds", "2", "--json", "-"]) == 0
    report = json.loads(capsys.readouterr().out)
    energy, account = report["energy"], report["account"]
    assert list(account) == [*ENERGY_CAUSES, "numerical"]
    assert list(report["momentum_account"]) == [*MOMENTUM_CAUSES, "numerical"]
    assert list(report["angular_momentum_account"]) == [*MOMENTUM_CAUSES, "numerical"]
    scale = max(abs(energy["initial"]), abs(energy["final"]))
    assert sum(account.values()) == pytest.approx(energy["final"] - energy["initial"], abs=1e-12 * scale)
    assert energy["changed_by"] and set(energy["changed_by"]) <= set(ENERGY_CAUSES)


def test_the_words_of_a_run_tell_where_the_energy_went(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "drop", "--seconds", "3"]) == 0
    words = capsys.readouterr().out
    assert "impacts took 21.886 J" in words and "friction took" not in words and "drift" not in words
    assert "J of energy by the method" in words


def test_every_account_can_be_plotted_and_metered() -> None:
    world = load_scene("slope")
    world.run(seconds=1.0)
    reading, account = Reading(world), measure_account(world)
    for cause, value in account.energy.items():
        name = "error of energy" if cause == "numerical" else f"account: {cause}"
        assert reading.value(name) == value
    for cause, vector in account.momentum.items():
        names = [f"error of momentum {axis}" if cause == "numerical" else f"impulse {axis}: {cause}"
                 for axis in "xy"]  # fmt: skip
        assert [reading.value(name) for name in names] == list(vector)
    assert reading.value("error of angular momentum") == account.angular_momentum["numerical"]
    assert reading.value("total energy") == account.now.energy


def test_an_energy_that_is_not_finite_reaches_neither_a_file_nor_a_screen() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0), mass=1.0)
    world.step(0.01)
    desk = Desk(world, RecordingCanvas((1280, 720)))
    desk.window.level = "Engineer"
    world.component(ball, Velocity).linear = (1e200, 0.0)
    desk.key("space")
    desk.frames(30)
    world.component(ball, Velocity).linear = (1.0, 0.0)
    desk.frames(30)
    words = " ".join((*desk.ui.words, *desk.ui.rows.values()))
    assert "nan" not in words.lower() and "inf J" not in words
    desk.key("space")
    desk.frames(30)
    assert all(map(math.isfinite, measure_account(world).energy.values())), "the accounts began again"
