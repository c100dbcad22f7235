"""ThrustSystem: rockets, shakers and motors against closed forms, in every method, and what they give."""

from __future__ import annotations

import cmath
import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from physicslab import World, load_scene, save_scene
from physicslab.components import Mass, Shape, Spring, Thrust, Transform, Velocity
from physicslab.diagnostics.energy import measure_account
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.files.writer import write_scene
from physicslab.integrators import INTEGRATORS
from physicslab.kernels.clock import time_after
from physicslab.lab.accuracy.catalogue import PROBLEMS
from physicslab.prefabs import box
from physicslab.stepping.rigid import Rigid
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.standard import standard_systems
from physicslab.systems.thrust import ThrustSystem

METHODS = tuple(name for name in INTEGRATORS if name != "exact")


def empty(**simulation: Any) -> World:
    """Return an empty world without gravity."""
    laws = PhysicsConfig(gravity_mode="none")
    return World(*standard_systems(), physics=laws, simulation=SimulationConfig(**simulation))


def swung(integrator: str, dt: float) -> float:
    """Return how far off x is after 1 s of a force that swings, where nothing else acts."""
    world = empty(integrator=integrator, dt=dt, substeps=1)
    one = world.spawn(Transform(), Velocity(), Mass(2.0), Thrust((3.0, 0.0), frequency=0.7, phase=0.4))
    world.run(seconds=1.0)
    assert world.plan.integrator.name == integrator
    w = 2.0 * math.pi * 0.7
    exact = 3.0 / (2.0 * w * w) * (math.cos(0.4) - math.cos(w + 0.4) - w * math.sin(0.4))
    return abs(world.component(one, Transform).position.x - exact)


@pytest.mark.parametrize("integrator", METHODS)
def test_every_method_keeps_its_order_in_time(integrator: str) -> None:
    method = INTEGRATORS[integrator]
    if method.chooses_steps:
        assert swung(integrator, 0.1) < 1e-15
        return
    coarse, fine = swung(integrator, 0.125), swung(integrator, 0.0625)
    assert math.log2(coarse / fine) == pytest.approx(method.order, abs=0.6) or coarse < 1e-11


@pytest.mark.parametrize("integrator", METHODS)
@pytest.mark.parametrize("frame", ["world", "body"])
def test_its_account_has_all_that_it_gives(integrator: str, frame: str) -> None:
    world = empty(integrator=integrator, substeps=1)
    thrust = Thrust((1.0, 0.5), torque=0.3, frame=frame, at=(-0.2, 0.1), frequency=0.8)
    world.spawn(Transform((1.0, 2.0)), Velocity((0.3, 0.0), 0.5), Mass(1.5, 0.4), thrust)
    world.run(seconds=1.0)
    account = measure_account(world)
    error = 1e-12 if integrator != "rk4" else 1e-6
    assert account.energy["thrust"] == pytest.approx(account.change, abs=error)
    assert abs(account.energy["thrust"]) > 0.01
    assert account.momentum["numerical"].magnitude < 1e-13
    assert abs(account.angular_momentum["numerical"]) < error


@pytest.mark.parametrize("name", ["driven_0.5", "driven_1", "driven_2"])
def test_driven_oscillators_meet_their_closed_form(name: str) -> None:
    problem = PROBLEMS[name]
    worlds = problem.worlds(SimulationConfig())
    assert problem.finish(worlds) < 2e-14
    assert worlds[0].plan.integrator.name == "dop853"


def test_a_rocket_that_turns_flies_along_fresnels_integrals() -> None:
    world = empty()
    thrust = Thrust((3.0, 0.0), torque=1.0, frame="body")
    rocket = world.spawn(Transform(), Velocity(), Mass(2.0, 0.5), thrust)
    world.run(seconds=2.0)
    n, h = 4000, 2.0 / 4000  # v = the integral of F / m (cos t^2, sin t^2), as the angle is t^2: Simpson
    weights = [1.0, *(4.0 if i % 2 else 2.0 for i in range(1, n)), 1.0]
    speed = sum(w * cmath.exp(1j * (i * h) ** 2) for i, w in enumerate(weights)) * h / 3 * 1.5
    velocity = world.component(rocket, Velocity)
    assert (velocity.linear.x, velocity.linear.y) == pytest.approx((speed.real, speed.imag), abs=1e-12)
    assert velocity.angular == pytest.approx(4.0, rel=1e-14)
    assert "thrust turns" in world.plan.reason


def test_a_steady_push_is_solved_in_steps_of_any_length_and_has_no_closed_form() -> None:
    world = World(ThrustSystem(), IntegrateSystem())
    one = world.spawn(Transform(), Velocity(), Mass(2.0), Thrust((3.0, 1.0)))
    world.run(seconds=2.0)
    assert tuple(world.component(one, Transform).position) == pytest.approx((3.0, 1.0), rel=1e-14)
    world.simulation = SimulationConfig(integrator="exact")
    world.run(seconds=0.1)
    assert "ThrustSystem has no closed form" in world.plan.refused


@pytest.mark.parametrize("contacts", ["soft", "rigid"])
def test_what_rests_is_pushed_off_when_the_swing_exceeds_friction(contacts: str) -> None:
    world = World(*standard_systems(), simulation=SimulationConfig(contacts=contacts))
    box(world, (0.0, -0.5), width=50.0, height=1.0, static=True, friction=0.5)
    crate = box(world, (0.0, 0.5), width=1.0, height=1.0, friction=0.5)
    # F sin(2 pi t / 8), which exceeds mu m g at t = 4/3 s.
    world.add(crate, Thrust((9.81, 0.0), at=(0.0, -0.5), frequency=0.125, phase=-math.pi / 2))
    world.run(seconds=0.6)
    assert abs(world.component(crate, Velocity).linear.x) < 1e-6
    world.run(seconds=0.8)
    assert world.component(crate, Velocity).linear.x > 0.005
    if contacts == "rigid":
        assert isinstance(world.steppers.usable[0], Rigid)
        w, t = math.pi / 4, 1.4
        start = math.asin(0.5) / w
        speed = 9.81 * ((math.cos(w * start) - math.cos(w * t)) / w - 0.5 * (t - start))
        assert world.component(crate, Velocity).linear.x == pytest.approx(speed, abs=1e-9)
    account = measure_account(world)
    assert account.energy["thrust"] > 0.0
    assert account.momentum["numerical"].magnitude < 1e-9


def test_files_keep_it_and_refuse_what_it_cannot_be(tmp_path: Path) -> None:
    world = World()
    world.spawn(Thrust((1, 2), 3.0, "body", (0.1, 0.2), 0.5, 0.25), Shape.circle(1.0), Transform(), name="r")
    save_scene(world, tmp_path / "rocket.json")
    again = load_scene(tmp_path / "rocket.json")
    one, other = (w.component(w.entity("r"), Thrust) for w in (world, again))
    assert one.values() == other.values()
    with pytest.raises(InvalidValue, match=r"Thrust\.frequency = -1\.0: must be a finite number >= 0 Hz"):
        Thrust(frequency=-1.0)
    with pytest.raises(InvalidValue, match=r'Thrust\.frame = \'side\': must be one of "world", "body"'):
        Thrust(frame="side")


def test_of_the_bobs_that_are_shaken_alike_the_one_in_tune_swings_widest() -> None:
    world = load_scene("resonance")
    world.run(seconds=12.0)
    widest: dict[str, float] = {}
    for _ in world.stepping(seconds=1.0, stride=4):
        for entity in world.batch(Thrust).entities.tolist():
            name, y = world.label(entity), abs(world.component(entity, Transform).position.y)
            widest[name] = max(widest.get(name, 0.0), y)
    assert max(widest, key=lambda name: widest[name]) == "1 Hz"


def test_the_rocket_circles() -> None:
    world = load_scene("rocket")
    world.run(seconds=2.0 * math.pi)
    place = world.component(world.entity("circling"), Transform).position
    assert tuple(place) == pytest.approx((2.0, 0.0), abs=1e-9)


def test_how_a_rocket_moves_beside_soft_contacts_depends_not_on_when_it_is_opened() -> None:
    world = World(simulation=SimulationConfig(contacts="soft"))
    box(world, (0.0, -5.0), width=9.0, height=1.0, static=True)
    rocket = box(world, (0.0, 3.0), width=0.4, height=0.2)
    world.add(rocket, Thrust((0.0, 5.0), frame="body", at=(0.1, 0.0)))
    world.run(steps=5)
    assert world.component(rocket, Velocity).angular > 0.1
    again = load_scene(write_scene(world))
    for one in (world, again):
        one.run(steps=5)
    assert again.plan == world.plan
    assert again.component(rocket, Transform).position == world.component(rocket, Transform).position


@pytest.mark.parametrize("start", [0.0, 0.005])
@pytest.mark.parametrize("contacts", ["soft", "rigid"])
def test_a_swinging_force_has_the_same_times_in_single_steps_and_in_runs(contacts: str, start: float) -> None:
    """The clock of single steps was a sum, that of runs a product: places differed by 2e-15 m."""
    worlds = []
    for _ in range(2):
        world = World(simulation=SimulationConfig(contacts=contacts))
        box(world, (0.0, -0.5), width=50.0, height=1.0, static=True)
        one = box(world, (0.0, 0.4), width=0.4, height=0.4)
        other = box(world, (1.0, 1.2), width=0.4, height=0.4)
        world.add(one, Thrust((1.0, 0.0), frequency=1.3))
        world.spawn(Spring(one, other, rest_length=1.0, stiffness=30.0))
        world.run(seconds=start)
        worlds.append(world)
    stepped, ran = worlds
    for _ in range(47):
        stepped.step()
    ran.run(steps=47)
    assert write_scene(stepped) == write_scene(ran)


@pytest.mark.parametrize("integrator", [name for name in METHODS if not INTEGRATORS[name].chooses_steps])
def test_methods_of_fixed_steps_have_one_clock(integrator: str) -> None:
    stepped, ran = empty(integrator=integrator, dt=1.0 / 7.0), empty(integrator=integrator, dt=1.0 / 7.0)
    for world in (stepped, ran):
        world.spawn(Transform(), Velocity(), Mass(2.0), Thrust((3.0, 0.0), frequency=0.7, phase=0.4))
    for _ in range(47):
        stepped.step()
    ran.run(steps=47)
    assert stepped.time == ran.time == 47 * (1.0 / 7.0)
    assert write_scene(stepped) == write_scene(ran)


@given(
    start=st.one_of(st.floats(-2.0, 500.0), st.integers(0, 10**6).map(lambda n: n / 60)),
    dt=st.sampled_from([1 / 60, 0.01, 1 / 7, 1e-3]), steps=st.sampled_from([0, 1, 2, 9, 4096, 4100]),
)  # fmt: skip
@settings(max_examples=30)
def test_many_steps_of_the_clock_are_those_made_one_by_one(start: float, dt: float, steps: int) -> None:
    time = start
    for _ in range(steps):
        time = time_after(time, dt)
    assert time_after(start, dt, steps) == time
