"""What contact steps book: friction, driven bodies, damping; the same stage by stage as in compiled steps."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from physicslab import World
from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.diagnostics.energy import Accounts, measure_account
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.bench.random_scenes import random_scene
from physicslab.state.state import State
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import Stage, System, at

GRAVITY = 9.81


class LooksAtImpacts(System):
    """Does nothing, at a stage within substeps: steps are then made stage by stage."""

    @at(Stage.IMPACT)
    def look(self, state: State, h: float) -> None:
        """Look."""


def world(staged: bool = False, gravity: float = -GRAVITY, contacts: str = "soft", **physics: float) -> World:
    others = (LooksAtImpacts(),) if staged else ()
    laws = PhysicsConfig(gravity=Vector2(0.0, gravity), **physics)  # type: ignore[arg-type]
    return World(
        *standard_systems(),
        *others,
        physics=laws,
        simulation=SimulationConfig(contacts=contacts, collisions="step"),
    )


def floor(of: World, friction: float = 0.5, restitution: float = 0.0, speed: float | None = None) -> None:
    moving = () if speed is None else (Velocity((0.0, speed)),)
    of.spawn(Transform((0.0, -0.5)), Shape.box(60.0, 1.0), Material(restitution, friction), *moving)


def box(of: World, x: float, y: float, *, mass: float = 2.0, v: tuple[float, float] = (0.0, 0.0)) -> None:
    of.spawn(Transform((x, y)), Velocity(v), Mass(mass), Shape.box(0.5, 0.5), Material(0.0, 0.5))


def closes(found: Accounts, *, turning: bool = True) -> None:
    """Assert that nothing is left of energy and momentum but rounding of the largest term.

    ``turning``: nor of angular momentum, as bodies that overlap, or turn on each other, leave.
    """
    terms = [abs(value) for value in found.energy.values()]
    assert abs(found.energy["numerical"]) <= 1e-11 * max(*terms, 1.0)
    for axis in ("x", "y"):
        terms = [abs(getattr(impulse, axis)) for impulse in found.momentum.values()]
        assert abs(getattr(found.momentum["numerical"], axis)) <= 1e-11 * max(*terms, 1.0)
    turned = found.angular_momentum
    rest = abs(turned["numerical"]) / max(*(abs(value) for value in turned.values()), 1.0)
    assert rest <= 1e-11 or not turning


STAGED = pytest.mark.parametrize("staged", [False, True])


@STAGED
def test_a_box_that_slides_to_rest_loses_its_motion_to_friction(staged: bool) -> None:
    of = world(staged)
    floor(of)
    box(of, 0.0, 0.25, v=(3.0, 0.0))
    of.run(seconds=1.5)
    found = measure_account(of)
    assert of.stepper is not None and of.stepper.name == ("contact" if staged else "fused_contact")
    # It sinks into the floor by 6e-6 m meanwhile, and the step in which it stops is as long as any other.
    assert found.energy["friction"] == pytest.approx(-9.0, rel=1e-8)
    assert abs(found.energy["contact"]) < 1e-4 and found.energy["impacts"] == 0.0
    closes(found)


@STAGED
def test_a_disc_that_begins_to_roll_loses_a_third(staged: bool) -> None:
    of = world(staged)
    floor(of)
    of.spawn(Transform((0.0, 0.25)), Velocity((3.0, 0.0)), Mass(2.0), Shape.circle(0.25), Material(0.0, 0.5))
    of.run(seconds=1.5)
    found = measure_account(of)
    assert found.energy["friction"] == pytest.approx(-3.0, rel=1e-12)
    closes(found)


@STAGED
def test_friction_at_rest_on_a_slope_does_no_work(staged: bool) -> None:
    of = world(staged)
    of.spawn(Transform((0.0, 0.0), 0.3), Shape.box(40.0, 1.0), Material(0.0, 0.5))
    up = np.array((-np.sin(0.3), np.cos(0.3))) * 0.75
    of.spawn(Transform(tuple(up), 0.3), Velocity(), Mass(2.0), Shape.box(0.5, 0.5), Material(0.0, 0.5))
    of.run(seconds=1.0)
    before = measure_account(of).energy
    of.run(seconds=1.0)
    after = measure_account(of)
    # Until it has sunk in, it slides by some 1e-6 m; then nothing moves.
    assert abs(after.energy["friction"] - before["friction"]) < 1e-11
    assert abs(after.energy["contact"] - before["contact"]) < 1e-11
    closes(after)


@STAGED
def test_a_floor_that_rises_lifts_a_box_by_its_work(staged: bool) -> None:
    of = world(staged)
    floor(of, speed=0.5)
    box(of, 0.0, 0.25, v=(0.0, 0.5))
    of.run(seconds=1.0)
    found = measure_account(of)
    assert found.energy["hand"] == pytest.approx(2.0 * GRAVITY * 0.5, rel=1e-11)
    assert found.momentum["hand"].y == pytest.approx(2.0 * GRAVITY, rel=1e-11)
    assert abs(found.momentum["contact"].y) < 1e-11
    closes(found)


@STAGED
def test_damping_takes_what_a_body_in_free_fall_does_not_keep(staged: bool) -> None:
    c, t, m, missed = 0.3, 0.5, 2.0, []
    # v' = g - c v, so v = (g / c) (1 - e^(-c t)) downwards; what is lost is the integral of m c v^2.
    limit, decay = GRAVITY / c, np.exp(-c * t)
    across = 0.5 * m * 9.0 * (1.0 - decay**2)
    down = m * c * limit**2 * (t - 2.0 * (1.0 - decay) / c + (1.0 - decay**2) / (2.0 * c))
    for dt in (1.0 / 60.0, 1.0 / 120.0):
        of = world(staged, linear_damping=c, angular_damping=0.2)
        of.simulation = replace(of.simulation, dt=dt)
        floor(of)
        box(of, 0.0, 9.0, mass=m, v=(3.0, 0.0))
        of.run(seconds=t)
        found = measure_account(of)
        missed.append(found.energy["damping"] + across + down)
        assert found.momentum["damping"].x == pytest.approx(-m * 3.0 * (1.0 - decay), rel=1e-12)
        closes(found)
    assert abs(missed[0]) < 1e-4 and missed[0] / missed[1] == pytest.approx(4.0, rel=0.01)  # of order 2


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from((0.0, 0.3, 0.9)), st.sampled_from((0.0, 0.4)), st.booleans())
@example(240, 0.3, 0.0, False)  # friction would give 1.7 mJ
def test_both_ways_to_make_a_step_book_the_same(seed: int, e: float, damping: float, driven: bool) -> None:
    random = np.random.default_rng(seed)
    both: list[Accounts] = []
    places, speeds = random.uniform(-2.0, 2.0, (6, 2)), random.uniform(-4.0, 4.0, (6, 2))
    for staged in (False, True):
        of = world(staged, linear_damping=damping, angular_damping=damping)
        floor(of, restitution=e, speed=0.2 if driven else None)
        for n, (place, speed) in enumerate(zip(places, speeds, strict=True)):
            where, shape = (place[0], place[1] + 2.5), Shape.box(0.5, 0.4) if n % 2 else Shape.circle(0.3)
            of.spawn(Transform(where), Velocity(tuple(speed), 1.0), Mass(1.0 + n), shape, Material(e, 0.3))
        of.run(seconds=1.0)
        both.append(measure_account(of))
        closes(both[-1], turning=False)
    for one, other in zip(both[0].energy.items(), both[1].energy.items(), strict=True):
        scale = max(1.0, *(abs(value) for value in both[0].energy.values()))
        assert one[0] == other[0] and abs(one[1] - other[1]) <= 1e-10 * scale
    turned = (found.angular_momentum for found in both)
    for one, other in zip(*(found.items() for found in turned), strict=True):
        assert one[0] == other[0] and abs(one[1] - other[1]) <= 1e-9 * scale
    assert both[0].energy["friction"] <= 0.0 and both[0].energy["impacts"] <= 1e-12


def test_a_step_that_fails_leaves_nothing_in_the_account() -> None:
    of = world()
    floor(of)
    box(of, 0.0, 2.0)
    of.run(steps=3)
    before = of.account.sums.copy()
    of.physics = PhysicsConfig(gravity=Vector2(0.0, -1e308))
    with pytest.raises(ArithmeticError):
        of.run(steps=9)
    assert np.array_equal(of.account.sums, before)


@STAGED
def test_what_turns_two_bodies_that_overlap_is_an_error_and_no_contact(staged: bool) -> None:
    of = world(staged, gravity=0.0)
    for x, spin in ((0.0, 2.0), (0.46, -1.0)):
        shape, rough = Shape.box(0.5, 0.5), Material(0.0, 0.5)
        of.spawn(Transform((x, x)), Velocity((0.0, -x), spin), Mass(2.0), shape, rough)
    of.synchronise()
    start = measure_account(of).now
    of.run(seconds=0.2)
    found = measure_account(of)
    # Nothing acts from outside: whatever the angular momentum has changed by, it should not have.
    assert abs(found.now.spin - start.spin) > 1e-6
    assert found.angular_momentum["numerical"] == pytest.approx(found.now.spin - start.spin, rel=1e-9)
    assert {cause for cause, given in found.angular_momentum.items() if given} == {"numerical"}
    closes(found, turning=False)


@pytest.mark.parametrize("way", ["fused_contact", "contact", "rigid", "wide"])
def test_every_way_to_make_a_step_has_the_same_budget(way: str) -> None:
    """A box falls by 5 cm, stays down and slides to rest."""
    count = 80 if way == "wide" else 1
    of = world(way == "contact", contacts="rigid" if way == "rigid" else "soft")
    floor(of)
    for n in range(count):
        box(of, n * 0.6 - 24.0, 0.3, mass=2.0, v=(1.0, 0.0))
    of.run(seconds=0.5)
    found = measure_account(of)
    assert of.stepper is not None and of.stepper.name == ("fused_contact" if way == "wide" else way)
    assert of.contacts.wide.filled == (80 if way == "wide" else 0)
    budget = {cause: given / count for cause, given in found.energy.items()}
    # The fall gives 0.98 J; friction within the impact stops part of the 1 J of sliding, and then the rest.
    fall, slower = 2.0 * GRAVITY * 0.05, 1.0 - 0.5 * math.sqrt(2.0 * GRAVITY * 0.05)
    assert budget["impacts"] + budget["contact"] == pytest.approx(slower**2 - 1.0 - fall, rel=2e-3)
    assert budget["friction"] == pytest.approx(-(slower**2), rel=4e-3)
    assert sum(budget.values()) == pytest.approx(-1.0 - 2.0 * GRAVITY * 0.05, rel=1e-3)
    closes(found)


def test_a_crowd_books_what_a_box_by_itself_does() -> None:
    budgets = []
    for count in (80, 1):
        of = world()
        of.simulation = replace(of.simulation, iterations=6)  # as many as 80 contacts get
        floor(of)
        for n in range(count):
            box(of, n * 0.6 - 24.0, 0.25, mass=1.0, v=(1.0, 0.0))
        of.run(seconds=0.5)
        assert of.contacts.wide.filled == (80 if count > 1 else 0)
        budgets.append({cause: given / count for cause, given in measure_account(of).energy.items()})
        closes(measure_account(of))
    assert budgets[1]["friction"] < -0.4999
    assert budgets[0] == pytest.approx(budgets[1], rel=0.01, abs=1e-6)
    assert budgets[0]["friction"] == pytest.approx(budgets[1]["friction"], rel=5e-6)


def test_a_pile_at_rest_books_nothing() -> None:
    """Friction at walls is booked beside what gravity does, before what it would give is refused."""
    pile = random_scene(601, 39)[0].build()  # capsules that wedge between walls, most contacts in blocks
    pile.run(steps=1500)
    before = measure_account(pile)
    pile.run(seconds=1.0)
    booked = measure_account(pile).after(before).energy
    assert max(map(abs, booked.values())) < 1e-8, booked


@pytest.mark.parametrize("integrator", ["leapfrog", "symplectic_euler"])
def test_a_box_at_rest_books_nothing(integrator: str) -> None:
    resting = world()
    resting.simulation = replace(resting.simulation, integrator=integrator, sleeping=False)
    floor(resting)
    box(resting, 0.0, 0.25)
    resting.run(seconds=5.0)
    before = measure_account(resting)
    resting.run(seconds=1.0)
    booked = measure_account(resting).after(before).energy
    assert max(map(abs, booked.values())) < 1e-12, booked
