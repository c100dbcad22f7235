"""A wrong kick, a wrong drift and a lost impulse are errors of their true size, whatever makes the steps."""

from typing import Any

import numpy as np
import pytest
from mutations import FAULT, WRONG_DRIFTS, WRONG_KICKS, lost_impulses, mutated

from physicslab import World
from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.diagnostics.energy import Accounts, measure_account
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.state.state import State
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import Stage, System, at

G, MASS, STEPS = 9.81, 2.0, 6
WAYS = {
    "contact": {"contacts": "soft", "collisions": "step"},
    "fused_contact": {"contacts": "soft", "collisions": "step"},
    "event_driven": {"collisions": "exact"},
    "rigid": {"contacts": "rigid"},
}
"""How a scene is stepped so that a stepper is chosen."""
STEPPERS = pytest.mark.parametrize("stepper", WAYS)


class LooksAtImpacts(System):
    """Does nothing, at a stage within substeps: steps are then made stage by stage."""

    @at(Stage.IMPACT)
    def look(self, state: State, h: float) -> None:
        """Look."""


def world(stepper: str, gravity: float = G) -> World:
    return World(
        *standard_systems(),
        *((LooksAtImpacts(),) if stepper == "contact" else ()),
        physics=PhysicsConfig(gravity=Vector2(0.0, -gravity)),
        simulation=SimulationConfig(**WAYS[stepper]),  # type: ignore[arg-type]
    )


def disc(of: World, x: float, y: float, v: tuple[float, float] = (0.0, 0.0), e: float = 0.0) -> int:
    return of.spawn(Transform((x, y)), Velocity(v), Mass(MASS), Shape.circle(0.25), Material(e, 0.0))


def floor(of: World) -> None:
    of.spawn(Transform((0.0, -0.5)), Shape.box(60.0, 1.0), Material(0.0, 0.0))


def found(of: World, stepper: str) -> Accounts:
    assert of.stepper is not None and of.stepper.name == stepper
    return measure_account(of)


def energy(of: World) -> float:
    """Return kinetic energy and that of height, of discs that do not turn [J]."""
    rows = of.batch(Mass).rows
    linear, height = of.table(Velocity)["linear"][rows], of.table(Transform)["position"][rows, 1]
    return float(0.5 * MASS * (linear**2).sum() - MASS * of.physics.gravity.y * height.sum())


@STEPPERS
@pytest.mark.parametrize("faults", [WRONG_KICKS, WRONG_DRIFTS], ids=["kick", "drift"])
def test_a_wrong_fall_is_an_error_of_its_true_size(stepper: str, faults: dict[str, tuple[Any, Any]]) -> None:
    of = world(stepper)
    floor(of)
    disc(of, 0.0, 9.0)
    disc(of, 2.0, 9.0)
    start = energy(of)
    with mutated(*faults[stepper]):
        of.run(steps=STEPS)
    account, t = found(of, stepper), STEPS * of.simulation.dt
    # Nothing but gravity acts, so that what the energy has changed by is the error: of v = 1.001 g t, of the
    # way 1.001 g t^2 / 2, of both, or of the way of all steps after the first, which begin too fast.
    error, whole = energy(of) - start, 2 * MASS * (G * t) ** 2
    shares = [abs(error) / ((FAULT - 1.0) * whole) / share for share in (1.0, 0.5, 0.5 * (1.0 + 1.0 / STEPS))]
    assert any(share == pytest.approx(1.0, rel=2e-3) for share in shares)
    assert account.energy["numerical"] == pytest.approx(error, rel=1e-9)
    assert {cause for cause, given in account.energy.items() if given != 0.0} == {"numerical"}


@pytest.mark.parametrize("stepper", ["contact", "fused_contact", "rigid"])
def test_a_disc_that_fell_wrongly_and_lies_shows_what_it_has_gained(stepper: str) -> None:
    of = world(stepper)
    floor(of)
    disc(of, 0.0, 0.25 + 0.3)
    start = energy(of)
    with mutated(*WRONG_KICKS[stepper]):
        of.run(steps=24)
    account, fallen = found(of, stepper), MASS * G * 0.3
    assert energy(of) - start == pytest.approx(-fallen, rel=1e-3)
    # It has come down faster than it should, and the bounce has taken all of that.
    assert account.energy["impacts"] + account.energy["contact"] == pytest.approx(-FAULT * fallen, rel=5e-4)
    assert account.energy["numerical"] == pytest.approx((FAULT - 1.0) * fallen, rel=0.1)


@STEPPERS
@pytest.mark.parametrize("e", [0.0, 0.5])
def test_an_impulse_that_one_body_does_not_get_is_missing_in_its_account(stepper: str, e: float) -> None:
    of = world(stepper, gravity=0.0)
    disc(of, 0.0, 0.0, (2.5, 0.0), e)
    disc(of, 0.51, 0.0, (1.5, 0.0), e)
    check_what_is_lost(of, stepper, pairs=1, steps=2)


@pytest.mark.parametrize("stepper", ["contact", "fused_contact"])
def test_a_lost_push_of_what_overlaps_is_missing_too(stepper: str) -> None:
    of = world(stepper, gravity=0.0)
    for n in range(2):
        disc(of, 0.4 * n, 0.0, (1.5, 0.0))
    check_what_is_lost(of, stepper, pairs=1, steps=2)


@pytest.mark.parametrize("stepper", ["contact", "fused_contact"])
def test_so_it_is_of_wide_contacts(stepper: str) -> None:
    of = world(stepper, gravity=0.0)
    for n in range(64):
        disc(of, 0.0, float(n), (1e4, 0.0))
        disc(of, 0.495, float(n), (1e4, 0.0))
    # Of those that are found one after the other, the books take it that they act: J v, and not J^2 / 2 m.
    check_what_is_lost(of, stepper, pairs=64, steps=2, speed=1e4, exact=1e-2)
    assert of.contacts.wide.filled == 64


def check_what_is_lost(
    of: World, stepper: str, pairs: int, steps: int, speed: float = 1.5, exact: float = 1e-9
) -> None:
    """Check the accounts where every second body gets no impulse: it flies on at its ``speed`` [m/s]."""
    of.synchronise()
    rows, linear = of.batch(Mass).rows, of.table(Velocity)["linear"]
    before = linear[rows].copy()
    with lost_impulses(set(rows[1::2].tolist())):
        of.run(steps=steps)
    account, change = found(of, stepper), linear[rows] - before
    assert np.array_equal(linear[rows[1::2]], before[1::2])
    lost = -MASS * change[::2, 0].sum()  # what the others would have got
    assert lost > 1e-6 * pairs
    assert account.momentum["numerical"].x == pytest.approx(-lost, rel=1e-9 * speed)
    assert account.energy["numerical"] == pytest.approx(-lost * speed, rel=exact)
