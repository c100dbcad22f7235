"""Impacts that one body has at one moment are resolved together, and it is told that no law demands that."""

import math

import numpy as np
import pytest

from physicslab import World
from physicslab.components import Transform, Velocity, Weld
from physicslab.diagnostics.energy import measure_account, measure_energy, measure_momentum
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.prefabs import box, circle
from physicslab.systems.standard import standard_systems

TOLD = "leave open how more than two share"


def empty(*, gravity: bool = False, **simulation: object) -> World:
    physics = PhysicsConfig(gravity_mode="linear" if gravity else "none")
    return World(*standard_systems(), physics=physics, simulation=SimulationConfig(**simulation))  # type: ignore[arg-type]


def told(world: World) -> list[str]:
    return [str(warning) for warning in find_warnings(world) if TOLD in warning.what]


def rack(order: list[int], rows: int, e: float, mu: float) -> World:
    """Return a triangle of touching discs, made in some order, and a disc that is about to hit its tip."""
    world = empty()
    places = [(row * math.sqrt(0.75), k - 0.5 * row) for row in range(rows) for k in range(row + 1)]
    discs = [(place, (0.0, 0.0)) for place in places]
    discs.append(((-2.0, 0.0), (2.0, 0.0)))
    for n in order:
        place, velocity = discs[n]
        circle(world, place, radius=0.5, velocity=velocity, restitution=e, friction=mu, name=f"disc{n}")
    return world


def velocities(world: World, count: int) -> np.ndarray:
    each = [world.component(world.entity(f"disc{n}"), Velocity) for n in range(count)]
    return np.array([(v.linear.x, v.linear.y, v.angular) for v in each])


@pytest.mark.parametrize("contacts", ["auto", "rigid", "soft"])
def test_a_disc_breaks_two_others_symmetrically(contacts: str) -> None:
    world = empty(contacts=contacts)
    circle(
        world, (-0.5 - math.sqrt(0.75), 0), radius=0.5, velocity=(2, 0), restitution=1, friction=0, name="c"
    )
    for name, y in (("u", 0.5), ("l", -0.5)):
        circle(world, (0, y), radius=0.5, restitution=1, friction=0, name=name)
    world.run(seconds=0.5)
    found = [world.component(world.entity(name), Velocity).linear for name in "cul"]
    assert [tuple(v) for v in found] == [
        pytest.approx(v, abs=1e-14)
        for v in ((-0.4, 0), (1.2, 0.4 * math.sqrt(3)), (1.2, -0.4 * math.sqrt(3)))
    ]
    (line,) = told(world)
    assert "c, u, l" in line or "c, l, u" in line


@pytest.mark.parametrize("rows", [2, 3, 4])
@pytest.mark.parametrize(("e", "mu"), [(1.0, 0.0), (0.7, 0.0), (0.6, 0.4)])
def test_mirrored_and_permuted_racks_do_the_same(rows: int, e: float, mu: float) -> None:
    count = rows * (rows + 1) // 2 + 1
    random = np.random.default_rng(rows)
    orders = [list(range(count)), list(range(count))[::-1], random.permutation(count).tolist()]
    worlds = [rack(order, rows, e, mu) for order in orders]
    energy = measure_energy(worlds[0]).total
    for world in worlds:
        world.run(seconds=0.8)
        assert measure_energy(world).total <= energy * (1 + 1e-14)
        assert measure_momentum(world).linear.x == pytest.approx(2.0, abs=1e-13)
    first, *others = (velocities(world, count) for world in worlds)
    for other in others:
        assert other == pytest.approx(first, abs=1e-12)
    mirrored = [
        n for row in range(rows) for n in range(row * (row + 1) // 2, (row + 1) * (row + 2) // 2)[::-1]
    ]
    assert first[[*mirrored, count - 1]] * (1, -1, -1) == pytest.approx(first, abs=1e-12)
    assert told(worlds[0])


def test_a_disc_that_falls_into_a_groove_jumps_straight_up() -> None:
    world = empty(gravity=True, collisions="exact")
    for side in (1, -1):
        place = (side * (5 * math.cos(1) + 0.5 * math.sin(1)), 5 * math.sin(1) - 0.5 * math.cos(1))
        box(world, place, width=10, height=1, angle=side * 1.0, static=True, restitution=1, friction=0)
    ball = circle(world, (0, 3), radius=0.5, restitution=1, friction=0)
    world.run(seconds=1.5)
    assert world.collisions > 0
    assert world.component(ball, Transform).position.x == pytest.approx(0, abs=1e-12)


def test_cradles_pass_on_one_after_the_other_and_that_is_told() -> None:
    for gap in (0.0, 0.5):
        world = empty()
        for n in range(3):
            place, speed = (n * (1 + gap) - (1 if n == 0 else 0), 0), (1 if n == 0 else 0, 0)
            circle(world, place, radius=0.5, velocity=speed, restitution=1, friction=0, name=f"disc{n}")
        world.run(seconds=2.5)
        assert velocities(world, 3)[:, 0] == pytest.approx((0, 0, 1), abs=1e-14) and world.collisions == 2
        assert bool(told(world)) is (gap == 0.0), "one after the other, the law of each is enough"


def test_a_box_that_lands_on_two_tiles_is_determined() -> None:
    world = empty(gravity=True)
    for x in (-1, 1):
        box(world, (x, -0.5), width=2, height=1, static=True, restitution=1, friction=0)
    box(world, (0, 1), width=1, height=1, restitution=1, friction=0)
    world.run(seconds=0.5)
    assert world.collisions and not told(world)


@pytest.mark.parametrize(
    "way", [{}, {"contacts": "rigid", "collisions": "auto"}, {"contacts": "soft", "collisions": "step"}]
)
def test_all_that_an_impact_takes_is_booked_as_impacts(way: dict[str, str]) -> None:
    """A third of the energy of sliding goes in the bounce; nothing that lasts rubs anything off."""
    world = empty(gravity=True, **way)
    box(world, (0, -0.5), width=60, height=1, static=True, restitution=1, friction=1)
    circle(world, (0, 0.9), radius=0.2, velocity=(2, 0), restitution=1, friction=1)
    world.run(seconds=0.5)
    found = measure_account(world).energy
    assert world.collisions == 1 and found["friction"] == 0.0
    assert found["impacts"] == pytest.approx(-2 / 3, rel=1e-12)


@pytest.mark.parametrize("welded", [False, True])
def test_what_is_welded_together_is_one_body(*, welded: bool) -> None:
    world = empty(gravity=False, contacts="rigid")
    plank = box(world, (0, 0), width=4, height=0.5, mass=2, restitution=0.5, friction=0.3)
    feet = [
        box(world, (x, 1), width=0.5, height=0.5, velocity=(0, -1), restitution=0.5, friction=0.3)
        for x in (-1, 1)
    ]
    if welded:
        world.spawn(Weld(feet[0], feet[1], (1, 0), (-1, 0)))
    world.run(seconds=1.0)
    assert world.component(plank, Velocity).linear.y < -0.1 and world.contacts.logged >= 2
    assert bool(told(world)) is not welded
