"""What dampers, drag, fields, driven ends, springs and gravity give in smooth motion, and what is left."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from physicslab import World, load_scene
from physicslab.components import Drag, Mass, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import Accounts, measure_account
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.integrators import INTEGRATORS
from physicslab.kernels.forces.budget import ACCOUNTS, CLOCK, DAMPED, END
from physicslab.kernels.forces.force_calls import force_kernel
from physicslab.kernels.ode.closed_form_account import late_shares
from physicslab.ode import system as ode_system
from physicslab.ode.budget import BudgetLayout
from physicslab.state.masses import Diverged
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State
from physicslab.stepping.flow import Flow
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import ForceSystem, Stage, at

G = 9.81
METHODS = tuple(name for name, method in INTEGRATORS.items() if math.isfinite(method.order))
"""All but closed forms: a method that is added to the list is tested by that."""


def empty(integrator: str = "auto", dt: float = 0.01, *forces: ForceSystem, **physics: Any) -> World:
    """Return an empty world without gravity, with one step of the method in each of its own."""
    laws = PhysicsConfig(**({"gravity": (0.0, 0.0)} | physics))
    return World(
        *standard_systems(), *forces, physics=laws,
        simulation=SimulationConfig(dt=dt, substeps=1, integrator=integrator),
    )  # fmt: skip


def after(world: World, seconds: float) -> Accounts:
    """Return the accounts after a time, made by the flow of the method that was asked for."""
    world.run(seconds=seconds)
    assert isinstance(world.stepper, Flow)
    wanted = world.simulation.integrator
    assert wanted in ("auto", world.plan.integrator.name)
    return measure_account(world)


# ---- known answers -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(("integrator", "error"), [("exact", 1e-14), ("dop853", 1e-12), ("rk4", 1e-6)])
def test_a_damper_takes_what_the_oscillation_loses(integrator: str, error: float) -> None:
    m, k, c, x0, t = 1.5, 40.0, 0.6, 0.7, 3.0
    world = empty(integrator)
    world.spawn(Transform((1.0 + x0, 0)), Velocity(), Mass(m), Spring(rest_length=1, stiffness=k, damping=c))
    account = after(world, t)
    a, w = c / (2 * m), math.sqrt(k / m - (c / (2 * m)) ** 2)
    x = x0 * math.exp(-a * t) * (math.cos(w * t) + a / w * math.sin(w * t))
    v = -x0 * math.exp(-a * t) * (a * a + w * w) / w * math.sin(w * t)
    lost = 0.5 * k * x0 * x0 - 0.5 * k * x * x - 0.5 * m * v * v
    assert account.energy["damping"] == pytest.approx(-lost, rel=error)
    # A damper has pulled by c times the way, the spring by the rest.
    assert account.momentum["damping"].x == pytest.approx(-c * (x - x0), rel=10 * error)
    assert account.momentum["springs"].x == pytest.approx(m * v + c * (x - x0), rel=10 * error)
    assert abs(account.momentum["numerical"].x) < 1e-13


@pytest.mark.parametrize("integrator", ["leapfrog", "rk4", "dop853", "implicit_midpoint"])
def test_at_its_terminal_speed_drag_takes_what_gravity_gives(integrator: str) -> None:
    m, k, t = 2.0, 0.3, 4.0
    speed = math.sqrt(m * G / k)
    world = empty(integrator, gravity=(0.0, -G))
    world.spawn(Transform((1, 2)), Velocity((0, -speed)), Mass(m), Drag(0.0, k))
    account = after(world, t)
    assert account.energy["damping"] == pytest.approx(-m * G * speed * t, rel=1e-12)
    assert account.momentum["damping"].y == pytest.approx(m * G * t, rel=1e-12)
    assert account.momentum["gravity"].y == pytest.approx(-m * G * t, rel=1e-13)
    assert account.angular_momentum["gravity"] == pytest.approx(-m * G * t * 1.0, rel=1e-13)
    assert abs(account.energy["numerical"]) < 1e-11 * m * G * speed * t


def test_quadratic_drag_takes_the_energy_of_the_known_solution() -> None:
    m, k, v0, t = 0.8, 0.5, 3.0, 2.0
    world = empty("dop853")
    world.spawn(Transform((0, 2)), Velocity((v0, 0)), Mass(m), Drag(0.0, k))
    account = after(world, t)
    v = v0 / (1 + k * v0 * t / m)
    assert account.energy["damping"] == pytest.approx(0.5 * m * (v * v - v0 * v0), rel=1e-13)
    assert account.angular_momentum["damping"] == pytest.approx(-2.0 * m * (v - v0), rel=1e-13)


@pytest.mark.parametrize(
    ("integrator", "error"), [("leapfrog", 1e-3), ("blanes_moan", 1e-12), ("dop853", 1e-13)]
)
def test_a_driven_end_gives_what_it_pulls_times_its_speed(integrator: str, error: float) -> None:
    m, k, u, t = 1.3, 25.0, 0.4, 2.0
    world = empty(integrator)
    ball = world.spawn(Transform((0, 0)), Velocity(), Mass(m))
    hand = world.spawn(Transform((0, 0)), Velocity((u, 0)))
    world.spawn(Spring(ball, hand, rest_length=0, stiffness=k))
    account = after(world, t)
    work = m * u * u * (1.0 - math.cos(math.sqrt(k / m) * t))
    assert account.energy["hand"] == pytest.approx(work, rel=error)
    assert account.energy["damping"] == 0.0
    moved = world.component(ball, Velocity).linear.x
    assert account.momentum["springs"].x == pytest.approx(m * moved, rel=1e-12)


def test_an_end_that_turns_by_itself_gives_torque_times_its_turning() -> None:
    world = empty("dop853")
    ball = world.spawn(Transform((2, 0)), Velocity(), Mass(1.0))
    crank = world.spawn(Transform((0, 0)), Velocity((0, 0), 1.5))
    world.spawn(Spring(crank, ball, anchor_a=(0.3, 0), rest_length=1, stiffness=20, damping=0.2))
    account = after(world, 3.0)
    assert account.energy["hand"] > 0.05
    assert abs(account.energy["numerical"]) < 1e-12 * account.energy["hand"] + 1e-13
    assert abs(account.angular_momentum["numerical"]) < 1e-12


def test_damping_of_all_motion_takes_the_energy_of_what_slows_down() -> None:
    m, inertia, c, d, t = 2.0, 0.7, 0.3, 0.5, 2.0
    for integrator in ("exact", "rk4", "dop853", "leapfrog"):
        world = empty(integrator, linear_damping=c, angular_damping=d)
        world.spawn(Transform((0, 3)), Velocity((2, 0), 4.0), Mass(m, inertia))
        world.spawn(Transform((5, 3)), Velocity((2, 0), 4.0))  # driven: nothing slows it down
        account = after(world, t)
        linear, spin = m * 2.0, inertia * 4.0
        lost = -linear * math.expm1(-2 * c * t) - 0.5 * spin * 4.0 * math.expm1(-2 * d * t)
        error = 1e-9 if integrator == "rk4" else 1e-12
        assert account.energy["damping"] == pytest.approx(-lost, rel=error), integrator
        assert account.momentum["damping"].x == pytest.approx(linear * math.expm1(-c * t), rel=error)
        turned = spin * math.expm1(-d * t) - 3.0 * linear * math.expm1(-c * t)
        assert account.angular_momentum["damping"] == pytest.approx(turned, rel=error)
        assert abs(account.energy["numerical"]) < 1e-8 * lost


def test_a_body_that_cannot_turn_takes_its_torque_from_outside() -> None:
    world = empty("dop853", 0.01)
    rigid = world.spawn(Transform((0, 0)), Velocity(), Mass(1.0, fixed_rotation=True))
    free = world.spawn(Transform((2, 0.3)), Velocity((0, 1)), Mass(1.0, 0.1))
    world.spawn(Spring(rigid, free, anchor_a=(0.2, 0.4), anchor_b=(-0.1, 0.2), rest_length=1, stiffness=20))
    account = after(world, 2.0)
    assert abs(account.angular_momentum["springs"]) > 0.1
    assert abs(account.angular_momentum["numerical"]) < 1e-12
    assert account.momentum["springs"].magnitude < 1e-13


def test_damped_turning_is_followed_as_all_that_depends_on_velocities() -> None:
    world = empty("auto", gravity=(0.0, -G), angular_damping=0.5)
    world.spawn(
        Transform((0.3, -1)),
        Velocity(),
        Mass(1, 0.2),
        Spring(anchor_a=(0.1, 0.2), rest_length=0, stiffness=50),
    )
    account = after(world, 1.0)
    assert world.plan.integrator.name == "dop853", "blanes_moan has order 4 there"
    assert abs(account.energy["numerical"]) < 1e-13


# ---- fields ------------------------------------------------------------------------------------------------


class Wind(ForceSystem):
    """Pushes every body by (3 cos 2t, 1) N."""

    needs = (Velocity, Mass)

    def depends_on_velocity(self, state: State) -> bool:
        return False

    @at(Stage.FORCE)
    def push(self, state: State, h: float) -> None:
        state.bodies.force[state.batch(*self.needs).rows] += (3.0 * math.cos(2.0 * state.time), 1.0)


@pytest.mark.parametrize("integrator", METHODS)
def test_a_wind_in_python_gives_force_times_way(integrator: str) -> None:
    error = 1e-7 if integrator == "rk4" else 1e-13
    world = empty(integrator, 0.01, Wind())
    ball = world.spawn(Transform((1, 0)), Velocity((0.5, 0)), Mass(2.0))
    account = after(world, 3.0)
    velocity = world.component(ball, Velocity).linear
    gained = 0.5 * 2.0 * (velocity.x**2 + velocity.y**2 - 0.25)
    assert account.energy["fields"] == pytest.approx(gained, rel=error + 1e-14)
    assert account.momentum["fields"].x == pytest.approx(2.0 * (velocity.x - 0.5), rel=1e-12)
    assert abs(account.angular_momentum["numerical"]) < 1e-4


@force_kernel
def _pull_home(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add -4 x. ``indices``: where x stands."""
    force[indices[0]] -= 4.0 * q[indices[0]]


class PullHome(ForceSystem):
    """A spring to the line x = 0, compiled: with its energy, or with none."""

    needs = (Velocity, Mass)

    def potential_energy(self, state: State) -> float:
        rows = state.batch(*self.needs).rows
        return 2.0 * float(np.square(state.table(Transform)["position"][rows, 0]).sum())

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        row = state.batch(*self.needs).rows[0]
        return PackedForce(_pull_home, np.zeros(0), np.array([layout.place[row]]))


class Stored(PullHome):
    """The same, stating that it stores energy."""

    potential = "home"


@pytest.mark.parametrize("integrator", METHODS)
@pytest.mark.parametrize("kind", [PullHome, Stored])
def test_a_packed_force_of_ones_own_is_measured_around_it(integrator: str, kind: type[PullHome]) -> None:
    world = empty(integrator, 0.01, kind())
    ball = world.spawn(Transform((1, 2)), Velocity((0.0, 0.3)), Mass(1.0))
    account = after(world, 1.0)
    velocity = world.component(ball, Velocity).linear
    given = account.energy["fields"]
    if kind is Stored:
        assert given == 0.0
    else:
        assert given == pytest.approx(
            2.0 * math.sin(2.0) ** 2, rel=1e-3 if integrator != METHODS[0] else 0.02
        )
        assert given == pytest.approx(0.5 * velocity.x**2, rel=1e-12 if integrator != "rk4" else 1e-7)
    assert account.momentum["fields"].x == pytest.approx(velocity.x, rel=1e-12)
    assert account.angular_momentum["fields"] == pytest.approx(
        (world.component(ball, Transform).position.cross(velocity)) - 0.3, rel=1e-3
    )


# ---- torques -----------------------------------------------------------------------------------------------


@force_kernel
def _crank(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add a torque. ``parameters``: the torque; ``indices``: where the angle stands."""
    force[indices[0]] += parameters[0]


TORQUE = 0.3


class Crank(ForceSystem):
    """Turns the first body with Mass by a steady torque, compiled."""

    needs = (Velocity, Mass)
    turns = True

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        row = state.batch(*self.needs).rows[0]
        return PackedForce(_crank, np.array([TORQUE]), np.array([layout.turn[row]]))


class Silent(Crank):
    """The same, which does not say that it turns bodies."""

    turns = False


class CrankInPython(ForceSystem):
    """The same in Python, which need not say so."""

    needs = (Velocity, Mass)

    @at(Stage.FORCE)
    def turn(self, state: State, h: float) -> None:
        state.bodies.torque[state.batch(*self.needs).rows[0]] += TORQUE


def spun(world: World, contacts: bool, steps: int = 40) -> Accounts:
    """Return the accounts after a body has been turned, with others that rest on a floor or none."""
    inertia = 0.5
    wheel = world.spawn(Transform((0, 3)), Velocity((0.2, 0.1)), Mass(2.0, inertia))
    if contacts:
        world.spawn(Transform((0, -0.5)), Shape.box(20, 1))
        world.spawn(Transform((4, 0.5)), Velocity(), Mass(1.0), Shape.box(1, 1))
    world.run(steps=steps)
    account, t = measure_account(world), world.time
    spin = TORQUE / inertia * t
    assert world.component(wheel, Velocity).angular == pytest.approx(spin, rel=1e-13)
    assert account.energy["fields"] == pytest.approx(0.5 * inertia * spin**2, rel=0.03)
    assert account.angular_momentum["fields"] == pytest.approx(inertia * spin, rel=1e-13)
    if world.plan.integrator.order > 1:
        turned = world.component(wheel, Transform).angle
        assert turned == pytest.approx(0.5 * TORQUE / inertia * t * t, rel=1e-12)
        assert account.energy["fields"] == pytest.approx(TORQUE * turned, rel=1e-12)
        assert abs(account.energy["numerical"]) < 1e-12
    return account


@pytest.mark.parametrize("kind", [Crank, CrankInPython])
@pytest.mark.parametrize("integrator", [*METHODS, "exact"])
def test_a_torque_turns_and_works_in_flow(integrator: str, kind: type[ForceSystem]) -> None:
    world = empty(integrator, 0.01, kind())
    spun(world, contacts=False)
    assert isinstance(world.stepper, Flow)


@pytest.mark.parametrize("kind", [Crank, CrankInPython])
@pytest.mark.parametrize(("contacts", "stepper"), [("soft", "contact"), ("rigid", "rigid")])
def test_a_torque_turns_and_works_beside_contacts(
    contacts: str, stepper: str, kind: type[ForceSystem]
) -> None:
    laws = PhysicsConfig(gravity=Vector2(0.0, -G))
    simulation = SimulationConfig(dt=0.01, contacts=contacts)
    world = World(*standard_systems(), kind(), physics=laws, simulation=simulation)
    spun(world, contacts=True)
    assert world.stepper is not None and world.stepper.name == stepper


def test_a_compiled_torque_that_is_not_announced_is_refused() -> None:
    world = empty("rk4", 0.01, Silent())
    world.spawn(Transform(), Velocity(), Mass(1.0, 1.0))
    with pytest.raises(TypeError, match=r"Silent reads layout\.turn: set turns = True"):
        world.step()


# ---- gravity -----------------------------------------------------------------------------------------------


def test_a_fixed_sun_gives_momentum_and_no_energy() -> None:
    world = empty("dop853", 0.01, gravity_mode="planet", G=1.0)
    world.spawn(Transform((0.5, -0.25)), Mass(10.0))
    world.spawn(Transform((2, 0)), Velocity((0, 2)), Mass(1.0))
    world.spawn(Transform((-1.5, 1)), Velocity((1, 1.5)), Mass(0.5))
    account = after(world, 5.0)
    assert account.momentum["gravity"].magnitude > 0.1
    assert account.momentum["numerical"].magnitude < 1e-13
    assert abs(account.angular_momentum["numerical"]) < 1e-12
    assert abs(account.energy["numerical"]) < 1e-11


def test_planets_among_themselves_need_no_account() -> None:
    world = load_scene("two_planets")
    world.step()
    assert isinstance(world.stepper, Flow)
    assert world.stepper._ode.slots == {}
    assert len(world.stepper._ode.q) == world.stepper._ode.layout.clock + 1


def test_a_moved_origin_leaves_torques_about_the_first() -> None:
    world = empty("dop853", 0.05, gravity_mode="planet", G=1.0)
    world.spawn(Transform((100, 50)), Velocity((0.3, 0.5)), Mass(1.0), Drag(0.1))
    world.spawn(Transform((101, 50)), Velocity((0.3, -0.5)), Mass(1.0), Drag(0.2))
    world.synchronise()
    account = after(world, 2.0)
    assert isinstance(world.stepper, Flow) and world.stepper._ode.free_bodies == 2
    assert abs(account.angular_momentum["damping"]) > 1.0
    assert abs(account.angular_momentum["numerical"]) < 1e-11


# ---- what is left falls as the method's error does ---------------------------------------------------------


def smooth(integrator: str, dt: float, *, damped: bool) -> World:
    """Return three bodies on springs, one end driven, one fixed."""
    c = 1.0 if damped else 0.0
    world = empty(integrator, dt, gravity=(0.2, -G))
    a = world.spawn(
        Transform((0.3, -1.0)), Velocity((1, 0.2), 0.5), Mass(1, 0.2),
        Spring(anchor_a=(0.1, 0.2), anchor_b=(0, 1), rest_length=1, stiffness=50, damping=0.5 * c),
    )  # fmt: skip
    b = world.spawn(Transform((1.3, -2.0)), Velocity((1, 0.2)), Mass(2, 0.2), Drag(0.1 * c, 0.2 * c))
    hand = world.spawn(Transform((3, 0)), Velocity((0.3, 0.5), 1.0))
    world.spawn(Spring(a, b, anchor_a=(0.1, -0.3), rest_length=1, stiffness=40, damping=0.3 * c))
    world.spawn(Spring(b, hand, anchor_b=(0.2, 0.2), rest_length=1, stiffness=30, damping=0.3 * c))
    return world


KEEPS_BALANCE = "dop853", "implicit_midpoint"


@pytest.mark.parametrize("damped", [False, True])
@pytest.mark.parametrize("integrator", [name for name in METHODS if name not in KEEPS_BALANCE])
def test_what_is_left_falls_with_the_step_at_the_order_of_the_method(integrator: str, damped: bool) -> None:
    method = INTEGRATORS[integrator]
    # Forces that depend on velocities are kicks of order 2 at most, symmetric as the method may be.
    order = min(method.order, 2) if damped and method.positions_only else method.order
    coarse = 0.005 * 2 ** (order - 1) if order < 6 else 0.1
    left = [
        abs(after(smooth(integrator, dt, damped=damped), 1.0).energy["numerical"])
        for dt in (coarse, coarse / 2)
    ]
    assert left[0] > 1e-9
    assert left[1] < left[0] / 2 ** (order - 0.4)


@pytest.mark.parametrize("damped", [False, True])
@pytest.mark.parametrize("integrator", KEEPS_BALANCE)
def test_nothing_is_left_where_the_method_keeps_the_balance(integrator: str, damped: bool) -> None:
    account = after(smooth(integrator, 0.01, damped=damped), 2.0)
    assert abs(account.energy["numerical"]) < 1e-12 * max(map(abs, account.energy.values()))


def test_stiff_dampers_that_an_implicit_step_does_not_follow_leave_nothing() -> None:
    world = empty("implicit_midpoint", 0.05, gravity=(0.0, -G))
    before = world.spawn(
        Transform((1, 0)), Velocity((0, 3)), Mass(1), Spring(rest_length=0.5, stiffness=1e6, damping=1e4)
    )
    world.spawn(
        Transform((2, 0.5)),
        Velocity((0, 3)),
        Mass(2),
        Spring(b=before, rest_length=1, stiffness=1e4, damping=1e3),
    )
    account = after(world, 1.0)
    lost = account.energy["damping"]
    assert lost < -1.0
    assert abs(account.energy["numerical"]) < 1e-10 * abs(lost)


# ---- any scene ---------------------------------------------------------------------------------------------

_place = st.floats(-3.0, 3.0)
_some = st.floats(0.0, 1.0)


@st.composite
def scenes(draw: st.DrawFn) -> World:
    """Return a world of two to five bodies on springs, some driven, fixed or dragged."""
    integrator = draw(st.sampled_from(METHODS))
    world = empty(
        integrator, 0.004, gravity=(draw(_some), -G * draw(_some)),
        linear_damping=draw(st.sampled_from((0.0, 0.2))), angular_damping=draw(st.sampled_from((0.0, 0.3))),
    )  # fmt: skip
    bodies = []
    for number in range(draw(st.integers(2, 5))):
        parts: list[Any] = [Transform((2.0 * number, draw(_place)), draw(_place))]
        if draw(st.integers(0, 5)) > 0:
            parts.append(Velocity((draw(_place), draw(_place)), draw(_place)))
            if number == 0 or draw(st.integers(0, 3)) > 0:
                parts.append(Mass(0.5 + draw(_some), 0.2 + draw(_some), fixed_rotation=draw(st.booleans())))
                if draw(st.booleans()):
                    parts.append(Drag(draw(_some), draw(_some)))
        bodies.append(world.spawn(*parts))
    for number, body in enumerate(bodies):
        other = {"b": bodies[number - 1]} if number else {"anchor_b": (-2.0, draw(_place))}
        anchor = (0.2 * draw(_some), 0.1) if draw(st.booleans()) else (0.0, 0.0)
        damping = draw(st.sampled_from((0.0, 0.4)))
        world.spawn(Spring(body, anchor_a=anchor, rest_length=0.5, stiffness=20.0, damping=damping, **other))
    return world


@settings(max_examples=60, deadline=None)
@given(scenes())
def test_the_accounts_add_up_in_any_scene(world: World) -> None:
    try:
        world.run(seconds=0.1)
    except Diverged:  # the ends of a spring met, where its pull has no direction
        reject()
    account = measure_account(world)
    change = account.now.energy - account.start.energy
    largest = max(1e-3, *map(abs, account.energy.values()), abs(change))
    assert abs(sum(account.energy.values()) - change) <= 1e-9 * largest
    # What is left is the error of the method: dop853 and the implicit rule make none.
    if world.plan.integrator.name in ("dop853", "implicit_midpoint"):
        assert abs(account.energy["numerical"]) <= 1e-9 * largest
    size = max(1.0, *(impulse.magnitude for impulse in account.momentum.values()))
    assert account.momentum["numerical"].magnitude <= 1e-12 * size
    spin = max(1.0, *map(abs, account.angular_momentum.values()))
    allowed = {"rk4": 1e-7}.get(world.plan.integrator.name, 1e-11)
    if world.plan.integrator.name != "implicit_midpoint":  # of order 2 in that
        assert abs(account.angular_momentum["numerical"]) <= allowed * spin


# ---- beside the motion -------------------------------------------------------------------------------------


class NoAccounts(BudgetLayout):
    """Books nothing."""

    def __init__(self, state: State, layout: StateLayout, packed: Any, *rest: Any, **more: Any) -> None:
        super().__init__(state, layout, [], np.zeros(0), (), kicked=False)
        self.count = ACCOUNTS  # where kicks may write, and nothing reads
        self.places[[CLOCK, END, DAMPED]] = layout.clock, layout.clock + 1, layout.clock + 1

    def around(self, system: ForceSystem, force: PackedForce) -> list[PackedForce]:
        return [force]

    def damping(self, rates: Any, inverse_mass: Any) -> list[PackedForce]:
        return []


@pytest.mark.parametrize("integrator", METHODS)
def test_accounts_leave_the_bits_of_the_motion_alone(
    integrator: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    ends = []
    for keeper in (BudgetLayout, NoAccounts):
        monkeypatch.setattr(ode_system, "BudgetLayout", keeper)
        world = smooth(integrator, 0.01, damped=True)
        world.physics = PhysicsConfig(gravity=Vector2(0.2, -G), angular_damping=0.1)
        world.run(steps=40)
        booked = measure_account(world).energy["damping"]
        assert (booked != 0.0) == (keeper is BudgetLayout)
        ends.append(
            (world.table(Transform)["position"].tobytes(), world.table(Velocity)["angular"].tobytes())
        )
    assert ends[0] == ends[1]


def test_steps_one_by_one_book_what_a_run_books() -> None:
    for integrator in ("leapfrog", "rk4", "implicit_midpoint"):
        runs = []
        for single in (False, True):
            world = smooth(integrator, 0.01, damped=True)
            if single:
                for _ in range(30):
                    world.step()
            else:
                world.run(steps=30)
            runs.append(measure_account(world).energy)
        assert runs[0] == pytest.approx(runs[1], rel=1e-12, abs=1e-12), integrator


def test_a_step_that_fails_books_nothing() -> None:
    class Fails(Wind):
        @at(Stage.FORCE)
        def push(self, state: State, h: float) -> None:
            super().push(state, h)
            if state.time > 0.05:
                state.bodies.force[:] = math.nan

    world = empty("rk4", 0.01, Fails())
    world.spawn(Transform((1, 0)), Velocity((0.5, 0)), Mass(2.0), Drag(0.3))
    world.run(steps=4)
    before = world.account.sums.copy()
    with pytest.raises(Diverged):
        world.run(steps=4)
    made = world.account.sums.copy()
    assert np.isfinite(made).all()
    assert abs(measure_account(world).energy["numerical"]) < 1e-9
    with pytest.raises(Diverged):
        world.step()
    assert (world.account.sums == made).all() and (before != made).any()


def test_accounts_are_whole_blocks_behind_the_clock() -> None:
    world = smooth("rk4", 0.01, damped=True)
    world.step()
    assert isinstance(world.stepper, Flow)
    ode = world.stepper._ode
    assert len(ode.q) == ode.layout.clock + 1 + ACCOUNTS * len(ode.slots)
    assert ode.places[END] == len(ode.q)


@pytest.mark.parametrize("z", [1e-9, 0.05, 0.0999, 0.1001, 3.0, 50.0])
def test_shares_of_damped_falls_lose_no_digits(z: float) -> None:
    second, third = late_shares.py_func(z)  # type: ignore[attr-defined]
    terms = [(-z) ** k / math.factorial(k) for k in range(60)] if z < 20 else []
    if terms:
        assert second == pytest.approx(math.fsum(terms[2:]) / z**2, rel=1e-12)
        assert third == pytest.approx(-math.fsum(terms[3:]) / z**3, rel=1e-12)
    else:
        assert third == pytest.approx((z * z / 2 - z + 1) / z**3, rel=1e-14)


# ---- beside contacts ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("damping", [0.0, 0.5])
def test_split_forces_book_as_flows_do(damping: float) -> None:
    accounts = []
    for touching in (True, False):
        world = World(
            *standard_systems(), physics=PhysicsConfig(gravity=Vector2(0.3, -G)),
            simulation=SimulationConfig(dt=1 / 60, contacts="soft", collisions="step"),
        )  # fmt: skip
        a, b = (
            world.spawn(
                Transform((x, 1)), Velocity(), Mass(m, 0.1), *([Shape.circle(0.1)] if touching else [])
            )
            for x, m in ((0, 1.0), (0.7, 2.0))
        )
        hand = world.spawn(Transform((1.5, 1)), Velocity((0.2, 0.3)))
        world.spawn(Spring(a, anchor_b=(0, 1.5), rest_length=0.5, stiffness=100, damping=damping))
        for ends in ((a, b), (b, hand)):
            world.spawn(Spring(*ends, rest_length=0.6, stiffness=200, damping=damping))
        world.run(seconds=0.5)
        assert isinstance(world.stepper, Flow) != touching
        accounts.append(measure_account(world))
    beside, alone = accounts
    assert beside.energy == pytest.approx(alone.energy, abs=1e-7)
    assert beside.angular_momentum == pytest.approx(alone.angular_momentum, abs=1e-7)
    for name, impulse in alone.momentum.items():
        assert (beside.momentum[name] - impulse).magnitude < 1e-7, name
    assert abs(beside.energy["numerical"]) < 1e-8
    assert abs(beside.energy["hand"]) > 0.1
