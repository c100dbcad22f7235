"""What friction, contacts, driven bodies and corrections give where contacts are rigid."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from physicslab import World
from physicslab.components import (
    Charge,
    Drag,
    Mass,
    Material,
    Medium,
    Shape,
    Spring,
    Thrust,
    Transform,
    Velocity,
)
from physicslab.diagnostics.energy import Accounts, measure_account
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.prefabs import circle
from physicslab.state.state import State
from physicslab.stepping import rigid_motion
from physicslab.stepping.rigid import Rigid
from physicslab.systems.standard import standard_systems

G = 9.81


def laboratory(dt: float = 1 / 60, **physics: Any) -> World:
    """Return an empty world with rigid contacts and gravity."""
    return World(
        *standard_systems(), physics=PhysicsConfig(**({"gravity": (0.0, -G)} | physics)),
        simulation=SimulationConfig(dt=dt, contacts="rigid"),
    )  # fmt: skip


def floor(world: World, friction: float, *, angle: float = 0.0) -> None:
    """Add a floor whose surface goes through the origin."""
    place = (0.5 * math.sin(angle), -0.5 * math.cos(angle))
    world.spawn(Transform(place, angle), Shape.box(200, 1), Material(0.0, friction))


def block(world: World, x: float, *, speed: float = 0.0, mass: float = 2.0, friction: float = 0.5) -> int:
    """Add a box of one metre on the floor."""
    return world.spawn(
        Transform((x, 0.5)), Velocity((speed, 0)), Mass(mass), Shape.box(1, 1), Material(0.0, friction)
    )


def after(world: World, seconds: float) -> Accounts:
    """Return the accounts after a time, all of it made by rigid contacts."""
    world.run(seconds=seconds)
    assert isinstance(world.stepper, Rigid)
    assert world.stepper.left_to_soft == 0
    return measure_account(world)


# ---- known answers -----------------------------------------------------------------------------------------


def test_a_block_that_slides_to_rest_has_rubbed_off_all_its_energy() -> None:
    world = laboratory()
    floor(world, 0.5)
    block(world, 0.0, speed=3.0)
    account = after(world, 1.5)
    assert account.energy["friction"] == pytest.approx(-0.5 * 2.0 * 9.0, rel=1e-14)
    assert abs(account.energy["numerical"]) < 1e-13
    assert account.momentum["contact"].x == pytest.approx(-6.0, rel=1e-12)
    assert account.momentum["contact"].y == pytest.approx(2.0 * G * 1.5, rel=1e-13)
    assert account.momentum["numerical"].magnitude < 1e-12
    assert abs(account.angular_momentum["numerical"]) < 1e-12


def test_a_disc_that_slides_until_it_rolls_has_rubbed_off_a_third() -> None:
    """Its speed goes from v to 2/3 v; it rolls on for ever."""
    world = laboratory()
    floor(world, 0.3)
    disc = world.spawn(Transform((0, 0.5)), Velocity((3, 0)), Mass(2), Shape.circle(0.5), Material(0.0, 0.3))
    account = after(world, 1.0)
    assert world.component(disc, Velocity).linear.x == pytest.approx(2.0, rel=1e-12)
    assert account.energy["friction"] == pytest.approx(-0.5 * 2.0 * 9.0 / 3.0, rel=1e-13)
    assert abs(account.energy["numerical"]) < 1e-13


def test_on_a_slope_friction_takes_its_force_times_the_way() -> None:
    angle, mu, m, t = math.radians(25), 0.2, 2.0, 1.0
    world = laboratory()
    floor(world, mu, angle=angle)
    normal = np.array((-math.sin(angle), math.cos(angle)))
    world.spawn(
        Transform(tuple(0.5 * normal), angle), Velocity(), Mass(m), Shape.box(1, 1), Material(0.0, mu)
    )
    account = after(world, t)
    way = 0.5 * G * (math.sin(angle) - mu * math.cos(angle)) * t * t
    assert account.energy["friction"] == pytest.approx(-mu * m * G * math.cos(angle) * way, rel=1e-11)
    assert abs(account.energy["numerical"]) < 1e-12


def test_a_belt_gives_twice_what_the_block_keeps() -> None:
    """A block laid on a belt at speed u gains m u^2 / 2, and as much is rubbed off."""
    u, m, mu = 1.5, 2.0, 0.4
    world = laboratory()
    world.spawn(Transform((0, -0.5)), Velocity((u, 0)), Shape.box(200, 1), Material(0.0, mu))
    block(world, 0.0, friction=mu)
    account = after(world, 2.0 * u / (mu * G))
    assert account.energy["hand"] == pytest.approx(m * u * u, rel=1e-12)
    assert account.energy["friction"] == pytest.approx(-0.5 * m * u * u, rel=1e-12)
    assert abs(account.energy["numerical"]) < 1e-12
    assert account.momentum["contact"].x == pytest.approx(m * u, rel=1e-12)


def test_a_lift_gives_the_weight_times_its_way() -> None:
    world = laboratory()
    world.spawn(Transform((0, -0.5)), Velocity((0, 0.8)), Shape.box(200, 1), Material(0.0, 0.5))
    body = block(world, 0.0)
    world.component(body, Velocity).linear = (0, 0.8)
    account = after(world, 1.0)
    assert account.energy["hand"] == pytest.approx(2.0 * G * 0.8, rel=1e-12)
    assert abs(account.energy["numerical"]) < 1e-12


def test_what_lies_still_is_held_for_all_of_the_time() -> None:
    world = laboratory()
    floor(world, 0.5)
    block(world, 3.0)
    account = after(world, 2.0)
    assert account.momentum["gravity"].y == pytest.approx(-2.0 * G * 2.0, rel=1e-13)
    assert account.momentum["contact"].y == pytest.approx(2.0 * G * 2.0, rel=1e-13)
    assert account.angular_momentum["contact"] == pytest.approx(2.0 * G * 2.0 * 3.0, rel=1e-13)
    assert all(value == pytest.approx(0.0, abs=1e-13) for value in account.energy.values())


def test_a_damped_spring_and_drag_beside_friction_leave_nothing() -> None:
    world = laboratory(1 / 60, linear_damping=0.1, angular_damping=0.2)
    floor(world, 0.3)
    body = block(world, 0.0, speed=2.0, friction=0.3)
    disc = world.spawn(
        Transform((3, 0.5)), Velocity((-1, 0)), Mass(1), Shape.circle(0.5), Material(0.0, 0.3), Drag(0.1, 0.2)
    )
    world.spawn(Spring(body, disc, rest_length=2, stiffness=20, damping=0.5))
    account = after(world, 1.0)
    assert account.energy["friction"] < -0.5
    assert account.energy["damping"] < -0.5
    assert abs(account.energy["numerical"]) < 1e-12 * abs(account.energy["damping"])
    # What begins to stick is stopped where the event was located: the rest of its speed is that of contact.
    assert account.momentum["numerical"].magnitude < 1e-12
    assert abs(account.angular_momentum["numerical"]) < 1e-11


# ---- corrections -------------------------------------------------------------------------------------------


def test_moving_apart_what_overlaps_is_booked_as_overlap() -> None:
    world = laboratory()
    floor(world, 0.5)
    body = block(world, 0.0)
    world.component(body, Transform).position = (0, 0.5 - 3e-4)
    account = after(world, 0.5)
    assert account.energy["overlap"] == pytest.approx(2.0 * G * 3e-4, rel=1e-11)
    assert isinstance(world.stepper, Rigid)
    assert account.energy["overlap"] == pytest.approx(world.stepper.energy_added, rel=1e-12)
    assert abs(account.energy["numerical"]) < 1e-14


FORCES: dict[str, tuple[dict[str, Any], list[Any]]] = {
    "thrust": ({}, [Thrust(force=(3.0, 50.0))]),
    "drag": ({}, [Drag(linear=2.0, quadratic=1.0)]),
    "magnet": ({"magnetic_field": 2.0}, [Charge(1.0)]),
    "field": ({"electric_field": (3.0, 5.0)}, [Charge(1.0)]),
    "damping": ({"linear_damping": 1.0}, []),
    "spring": ({}, [Spring("b", anchor_b=(0.0, 3.0), rest_length=0.5, stiffness=20.0, damping=1.0)]),
    "current": ({}, []),
}


@pytest.mark.parametrize("name", FORCES)
def test_forces_that_store_nothing_give_nothing_where_bodies_are_moved_apart(name: str) -> None:
    physics, parts = FORCES[name]
    world = laboratory(**({"gravity": (0.0, 0.0)} | physics))
    ball = circle(world, (0.0, 1.0), radius=0.2, velocity=(1.0, 2.0), name="b")
    circle(world, (0.0, 1.3999), radius=0.2, mass=2.0, velocity=(1.0, 1.0))
    for part in parts:
        world.add(ball, part)
    if name == "current":
        world.spawn(Transform(), Shape.box(20, 20), Medium(viscosity=0.5, flow=(5.0, 9.0)))
    found = after(world, 1 / 60).energy
    assert found["numerical"] == pytest.approx(0.0, abs=1e-12)
    assert (abs(found["overlap"]) > 1e-4) == (name in ("field", "spring"))
    added = [warning for warning in find_warnings(world) if "moving bodies apart" in warning.what]
    assert bool(added) == (name in ("field", "spring")), "a warning of what is rounding alone"


@pytest.mark.parametrize(("kind", "lost"), [("box", 9.0), ("circle", 3.0)])
def test_short_steps_by_impulses_book_what_forces_do(
    monkeypatch: pytest.MonkeyPatch, kind: str, lost: float
) -> None:
    """At rest an impulse gives back what gravity has taken: by the mean velocity, that is no work."""
    monkeypatch.setattr(rigid_motion, "_MAX_WORK", 0)
    world = laboratory()
    floor(world, 0.5)
    own = Shape.box(1, 1) if kind == "box" else Shape.circle(0.5)
    world.spawn(Transform((0, 0.5)), Velocity((3, 0)), Mass(2), own, Material(0.0, 0.5))
    account = after(world, 1.5)
    assert isinstance(world.stepper, Rigid) and world.stepper.by_impulses > 20
    taken = account.energy["friction"] + account.energy["contact"]
    assert taken == pytest.approx(-lost, rel=1e-3)
    assert abs(account.energy["numerical"]) < 1e-12
    assert account.momentum["numerical"].magnitude < 1e-12


def test_a_refused_step_leaves_no_bookings(monkeypatch: pytest.MonkeyPatch) -> None:
    world = laboratory()
    floor(world, 0.5)
    block(world, 0.0, speed=3.0)
    world.step()
    stepper = world.stepper
    assert isinstance(stepper, Rigid)
    before = world.account.sums.copy()
    real = rigid_motion.RigidMotion.step

    def refused(self: Any, scene: Any, state: State, at: float, h: float) -> Any:
        made = real(self, scene, state, at, h)
        state.account.sums[:] += 1.0  # as an impact within the step would
        made.refused = "as the test wants it"
        return made

    monkeypatch.setattr(rigid_motion.RigidMotion, "step", refused)
    made = stepper.advance(world, 1 / 60, 1)
    assert made.steps == 0
    assert (world.account.sums == before).all()


def test_accounts_leave_the_bits_of_the_motion_alone() -> None:
    """Whether something is driven, far away, makes room for another account, and changes no bit."""
    ends = []
    for driven in (False, True):
        world = laboratory()
        floor(world, 0.3)
        body = block(world, 0.0, speed=2.0, friction=0.3)
        disc = world.spawn(
            Transform((3, 0.5)), Velocity((-1, 0), 3.0), Mass(1), Shape.circle(0.5), Material(0.0, 0.3)
        )
        if driven:
            world.spawn(Transform((0, 50)), Velocity((0.1, 0)))
        world.run(seconds=1.0)
        assert isinstance(world.stepper, Rigid)
        own = [world.component(entity, Transform) for entity in (body, disc)]
        ends.append([(place.position.x, place.position.y, place.angle) for place in own])
    assert ends[0] == ends[1]


# ---- any scene ---------------------------------------------------------------------------------------------


def scattered(seed: int) -> World:
    """Return discs and boxes that fall on a floor, some dragged, two on a spring; the floor may go on."""
    random = np.random.default_rng(seed)
    world = laboratory(1 / 60, linear_damping=float(random.choice((0.0, 0.1))))
    goes = [Velocity((float(random.uniform(-1, 1)), 0))] if seed % 3 == 0 else []
    world.spawn(Transform((0, -0.5)), *goes, Shape.box(40, 1), Material(0.5, 0.5))
    bodies = []
    for number in range(2 + seed % 4):
        x, y, vx, vy, angle, spin = random.uniform(
            (-0.2, 0.6, -3, -1, -1, -3), (0.2, 1.5, 3, 1, 1, 3)
        ).tolist()
        parts = [Drag(0.1, 0.1)] if number % 3 == 0 else []
        shape = Shape.circle(0.4) if random.random() < 0.5 else Shape.box(0.8, 0.6)
        mass = Mass(float(random.uniform(0.5, 2)), fixed_rotation=bool(random.random() < 0.1))
        material = Material(float(random.choice((0.0, 0.5))), float(random.choice((0.0, 0.3, 0.8))))
        place = Transform((1.2 * number - 3 + x, y), angle)
        bodies.append(world.spawn(place, Velocity((vx, vy), spin), mass, shape, material, *parts))
    world.spawn(Spring(bodies[0], bodies[1], rest_length=1, stiffness=30, damping=0.3))
    return world


@pytest.mark.parametrize("seed", range(12))
def test_nothing_but_rounding_is_left_in_any_scene(seed: int) -> None:
    world = scattered(seed)
    world.run(seconds=1.0)
    stepper = world.stepper
    assert isinstance(stepper, Rigid) and stepper.left_to_soft == 0
    account = measure_account(world)
    change = account.now.energy - account.start.energy
    largest = max(abs(change), *map(abs, account.energy.values()))
    assert abs(sum(account.energy.values()) - change) <= 1e-12 * largest
    assert account.momentum["numerical"].magnitude < 1e-11
    assert abs(account.angular_momentum["numerical"]) < 1e-9
    if not stepper.by_impulses:  # the error of those is of order one
        assert abs(account.energy["numerical"]) < 1e-9 * largest
    assert account.energy["friction"] <= 0.0
    assert account.energy["damping"] < 0.0
