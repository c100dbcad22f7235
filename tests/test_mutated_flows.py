"""Errors put into the kernels of smooth motion are seen as errors of the method, of their true size.

The kernels run as Python, so that none is compiled. Each is wrong in one line, by a thousandth.
"""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from physicslab import World
from physicslab.components import Drag, Mass, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import Accounts, measure_account
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.integrators import INTEGRATORS
from physicslab.kernels import interpreter, python_fallback
from physicslab.kernels.forces import force_calls, packed_forces, springs
from physicslab.kernels.ode import classical, damped_flow, dop853, implicit, propagate, splitting, spring_flow
from physicslab.state.state import State
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import ForceSystem, Stage, at

G = 9.81
WRONG = 1.001
type Change = tuple[Any, str, str]

KICK: Change = (
    force_calls.accelerate_over,
    "acceleration[i] *= inverse_mass[i]",
    "acceleration[i] *= 1.001 * inverse_mass[i]",
)
"""What makes every method that calls forces kick too hard; powers are not touched by it."""
DRIFTS: dict[Any, Change] = {
    splitting.split: (splitting.split, "drift * v[i])", "1.001 * drift * v[i])"),
    classical.rk4: (classical.rk4, "q_low[i], q_sum[i])", "q_low[i], 1.001 * q_sum[i])"),
    dop853.dop853: (dop853.dop853, "taken * moved)", "1.001 * taken * moved)"),
    implicit.implicit_midpoint: (implicit.implicit_midpoint, "span * x[i])", "1.001 * span * x[i])"),
}
"""What makes the loop of each kind of method drift too far: a method with a new one has a new line here."""


@contextmanager
def changed(*changes: Change) -> Iterator[None]:
    """Run kernels as Python, each of these with one piece of its source replaced by another."""
    originals = [(function, function.py_func) for function, _, _ in changes]
    try:
        for function, old, new in changes:
            source = textwrap.dedent(inspect.getsource(function.py_func))
            assert source.count(old) == 1, f"{old!r} is {source.count(old)} times in {function.__name__}"
            body = source[source.index("def ") :].replace(old, new)
            names: dict[str, Any] = {}
            exec(body, function.py_func.__globals__, names)
            function.py_func = names[function.__name__]
        _forget()
        with interpreter.interpreted():
            yield
    finally:
        for function, original in originals:
            function.py_func = original
        _forget()


def _forget() -> None:
    """Let the Python of every kernel be made again."""
    python_fallback.fallback_of.cache_clear()
    interpreter.entry_of.cache_clear()
    python_fallback._modules.clear()


class Wind(ForceSystem):
    """Pushes every body with Mass by (0.6, 0.2) N and 0.1 N m, in Python."""

    needs = (Velocity, Mass)

    @at(Stage.FORCE)
    def push(self, state: State, h: float) -> None:
        rows = state.batch(*self.needs).rows
        state.bodies.force[rows] += (0.6, 0.2)
        state.bodies.torque[rows] += 0.1


def air(integrator: str, physics: PhysicsConfig, *forces: ForceSystem, contacts: str = "auto") -> World:
    """Return an empty world with one step of the method in each of its own."""
    # A drift that is too far jumps at the end of each step, which dop853 would follow to a finer tolerance.
    simulation = SimulationConfig(
        dt=0.005, substeps=1, integrator=integrator, tolerance=1e-3, contacts=contacts
    )
    return World(*standard_systems(), *forces, physics=physics, simulation=simulation)


def swing(integrator: str, *forces: ForceSystem) -> World:
    """Return a body that turns on a spring to a driven end, with drag, in the air."""
    world = air(integrator, PhysicsConfig(gravity=Vector2(0.3, -G)), *forces)
    ball = world.spawn(Transform((0.8, -0.5)), Velocity((0.5, 0.2), 0.3), Mass(1.2, 0.3), Drag(0.1, 0.05))
    hand = world.spawn(Transform((0, 0)), Velocity((0.3, 0.1)))
    world.spawn(Spring(ball, hand, anchor_a=(0.1, 0.2), rest_length=0.6, stiffness=15, damping=0.3))
    return world


def stepped(world: World, steps: int, stepper: str = "flow") -> Accounts:
    """Return the accounts after some steps, each made by itself."""
    for _ in range(steps):
        world.step()
    assert {part.stepper.name for part in world.parts if part.stepper is not None} == {stepper}
    wished = world.simulation.integrator
    assert wished in ("auto", world.plan.integrator.name)
    return measure_account(world)


def seen(make: Callable[[], World], steps: int, *changes: Change, stepper: str = "flow") -> Seen:
    """Return what the accounts say of a world whose kernels are changed, and of it as it is."""
    with changed():
        right = stepped(make(), steps, stepper)
    with changed(*changes):
        return Seen(stepped(make(), steps, stepper), right)


class Seen:
    """The accounts of a run with wrong kernels, beside those of a run with right ones."""

    def __init__(self, account: Accounts, right: Accounts) -> None:
        self.account, self.right = account, right
        self.error = account.energy["numerical"] - right.energy["numerical"]
        self.own = 2e-3 * abs(right.energy["numerical"])  # the method's error is another on another path
        self.stored = sum(account.parts.potential.values())

        self.speed2 = 2.0 / 1.2 * account.parts.kinetic_linear

    def kinetic(self, start: float) -> float:
        """Return the kinetic energy that was gained since ``start`` [J]."""
        return self.account.parts.kinetic - start


def energies(world: World) -> tuple[float, float]:
    """Return the kinetic and the potential energy at the start [J]."""
    with changed():
        parts = measure_account(world).parts
    return parts.kinetic, sum(parts.potential.values())


@pytest.mark.parametrize("in_python", [False, True])
@pytest.mark.parametrize("name", [name for name, method in INTEGRATORS.items() if method.name != "exact"])
def test_a_wrong_kick_is_an_error_of_its_true_size(name: str, in_python: bool) -> None:
    def make() -> World:
        return swing(name, *([Wind()] if in_python else []))

    found = seen(make, 20, KICK)
    # All that changes velocities is a thousandth too large, and the works of all forces are what they are.
    gained = found.kinetic(energies(make())[0])
    assert abs(gained) > 0.1
    assert found.error == pytest.approx(gained * (1.0 - 1.0 / WRONG), rel=0.02, abs=found.own)


@pytest.mark.parametrize("name", [name for name, method in INTEGRATORS.items() if method.name != "exact"])
def test_a_wrong_drift_is_an_error_of_its_true_size(name: str) -> None:
    kernel = INTEGRATORS[name].kernels[0]
    found = seen(lambda: swing(name), 20, DRIFTS[kernel])
    # What is stored changes by a thousandth more than the work of the forces that store it.
    gained = found.stored - energies(swing(name))[1]
    assert abs(gained) > 0.1
    assert found.error == pytest.approx(gained * (1.0 - 1.0 / WRONG), rel=0.1, abs=found.own)


@pytest.mark.parametrize("name", ["leapfrog", "rk4"])
@pytest.mark.parametrize(
    ("force", "change"),
    [
        (
            "gravity",
            (
                packed_forces.uniform_gravity,
                "parameters[0], parameters[1]",
                "parameters[0], 1.001 * parameters[1]",
            ),
        ),
        (
            "spring",
            (
                springs.pull_ends,
                "force[a] += fx\n    force[a + 1] += fy",
                "force[a] += 1.001 * fx\n    force[a + 1] += 1.001 * fy",
            ),
        ),
        (
            "damping",
            (
                packed_forces.drag,
                "force[i] -= fx\n        force[i + 1] -= fy",
                "force[i] -= 1.001 * fx\n        force[i + 1] -= 1.001 * fy",
            ),
        ),
    ],
)
def test_a_force_that_is_wrong_in_the_motion_alone_is_an_error(name: str, force: str, change: Change) -> None:
    def make() -> World:
        world = air(name, PhysicsConfig(gravity=Vector2(0.0, -G)))
        world.spawn(
            Transform((0.9, -0.5)), Velocity((0.5, 0.2)), Mass(1.2), Drag(0.1, 0.5),
            Spring(anchor_b=(0, 0), rest_length=0.6, stiffness=15),
        )  # fmt: skip
        return world

    found = seen(make, 20, change)
    with changed():
        before = measure_account(make()).parts.potential
    work = found.account.energy["damping"]
    if force != "damping":
        work = before[force] - found.account.parts.potential[force]
    assert abs(work) > 1e-3
    assert found.error == pytest.approx((WRONG - 1.0) * work, rel=0.02, abs=found.own)


@pytest.mark.parametrize("name", ["symplectic_euler", "leapfrog", "blanes_moan"])
def test_a_wrong_kick_is_no_damping_of_all_motion(name: str) -> None:
    def make() -> World:
        world = air(name, PhysicsConfig(gravity=Vector2(0.3, -G), linear_damping=2.0, angular_damping=1.0))
        world.spawn(Transform((0, 0)), Velocity((2.0, 0.5), 3.0), Mass(1.2, 0.3), Drag(0.1))
        return world

    wrong = "change = (acceleration[i] / c - v[i]) * gain"
    found = seen(make, 20, (splitting.split, wrong, wrong.replace("= ", "= 1.001 * ")))
    moved = 0.5 * 1.2 * (found.speed2 - 4.25)  # no force turns it: that is damped in closed form
    assert abs(moved) > 0.1
    assert found.error == pytest.approx(moved * (1.0 - 1.0 / WRONG), rel=0.02, abs=found.own)


@pytest.mark.parametrize("damping", [0.0, 0.5, 2.0 * 15**0.5, 40.0])
@pytest.mark.parametrize("suffix", ["", "_v"])
def test_what_a_closed_form_gets_wrong_is_no_work_of_its_damper(suffix: str, damping: float) -> None:
    def make() -> World:
        world = air("exact", PhysicsConfig(gravity=Vector2(0.0, -G)))
        world.spawn(
            Transform((0, -0.9)), Velocity((0, -0.2)), Mass(1.0), Drag(0.1),
            Spring(anchor_b=(0, 0), rest_length=0.6, stiffness=15, damping=damping),
        )  # fmt: skip
        world.spawn(Transform((3, 0)), Velocity((2, 1)), Mass(1.0), Drag(0.3))
        return world

    x, y = f"c * along{suffix} - s * across{suffix}", f"s * along{suffix} + c * across{suffix}"
    found = seen(make, 1, (propagate.propagate, f"{x}, {y}", f"1.001 * ({x}), 1.001 * ({y})"))
    assert abs(found.right.energy["numerical"]) < 1e-14
    energy = found.account.now.energy - found.right.now.energy
    assert abs(energy) > 1e-5
    assert found.error == pytest.approx(energy, rel=1e-6)
    assert found.account.energy["damping"] == found.right.energy["damping"]


def beside_a_floor(*parts: Any, damping: float = 0.0) -> World:
    """Return a disc on a spring above a floor, which it may touch and does not."""
    world = air("auto", PhysicsConfig(gravity=Vector2(0.0, -G)), contacts="soft")
    world.spawn(Transform((0, -5)), Shape.box(10, 1))
    world.spawn(
        Transform((0.5, 0)), Velocity((0.3, 1)), Mass(1.2), Shape.circle(0.1), *parts,
        Spring(anchor_b=(0, 1), rest_length=0.6, stiffness=15, damping=damping),
    )  # fmt: skip
    return world


@pytest.mark.parametrize("kind", ["kick", "drift", "force"])
@pytest.mark.parametrize("method", ["spring_splitting", "damped", "dop853"])
def test_beside_contacts_what_is_wrong_between_them_is_an_error(method: str, kind: str) -> None:
    def make() -> World:
        damping = 0.3 if method == "damped" else 0.0
        return beside_a_floor(*([Drag(0.2, 0.1)] if method == "dop853" else []), damping=damping)

    flow, full = spring_flow, damped_flow
    changes: dict[tuple[str, str], tuple[Change, ...]] = {
        ("spring_splitting", "kick"): (
            (flow._kick_and_drift, "speed[i] + kick * (", "speed[i] + 1.001 * kick * ("),
            (flow._advance, "speed[i] += kick * (", "speed[i] += 1.001 * kick * ("),
        ),
        ("spring_splitting", "drift"): ((flow._kick_and_drift, "drift * v", "1.001 * drift * v"),),
        ("spring_splitting", "force"): ((flow._pull, "at, share * dx, share * dy",
                                         "at, 1.001 * share * dx, 1.001 * share * dy"),),
        ("damped", "kick"): ((full._change, "speed[i] += share", "speed[i] += 1.001 * share"),),
        ("damped", "drift"): ((full._drift, "+= span * speed[i]", "+= 1.001 * span * speed[i]"),),
        ("damped", "force"): ((full._evaluate, "tension = take(", "tension = 1.001 * take("),),
        ("dop853", "kick"): (KICK,),
        ("dop853", "drift"): (DRIFTS[dop853.dop853],),
        ("dop853", "force"): ((springs.pull_ends, "force[a] += fx\n    force[a + 1] += fy",
                               "force[a] += 1.001 * fx\n    force[a + 1] += 1.001 * fy"),),
    }  # fmt: skip
    with changed():
        start = measure_account(make()).parts
    found = seen(
        make, 20, *changes[method, kind], stepper="contact" if method == "dop853" else "fused_contact"
    )
    now, share = found.account.parts, 1.0 - 1.0 / WRONG
    expected = {
        "kick": share * (now.kinetic - start.kinetic),
        "drift": share * (found.stored - sum(start.potential.values())),
        "force": (WRONG - 1.0) * (start.potential["spring"] - now.potential["spring"]),
    }[kind]
    assert abs(expected) > 1e-4
    assert found.error == pytest.approx(expected, rel=0.1, abs=found.own)
