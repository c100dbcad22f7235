"""What is light carries what is heavy: rest goes by weights, and costs what rest of equal bodies costs."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from physicslab import World
from physicslab.components import Material, Transform
from physicslab.ecs.config import SimulationConfig
from physicslab.kernels.accounts import ENERGY, OVERLAP
from physicslab.kernels.solver.finer import SUNK
from physicslab.prefabs import box, circle
from physicslab.stepping.rigid import Rigid
from physicslab.systems.standard import standard_systems

ORDERS: dict[str, Callable[[int, float], list[float]]] = {
    "upwards": lambda n, ratio: [ratio ** (k / (n - 1)) for k in range(n)],
    "alternating": lambda n, ratio: [ratio if k % 2 else 1.0 for k in range(n)],
    "heavy below": lambda n, ratio: [1.0 if k % 2 else ratio for k in range(n)],
}


def tower(world: World, masses: list[float], slope: float = 0.0) -> list[int]:
    c, s = math.cos(slope), math.sin(slope)
    box(world, (0.5 * s, -0.5 * c), width=60, height=1, angle=slope, static=True, restitution=0, friction=0.5)
    heights = [0.5 * k + 0.25 for k in range(len(masses))]
    return [
        box(world, (-s * y, c * y), width=0.5, height=0.5, angle=slope, mass=m, restitution=0, friction=0.5)
        for y, m in zip(heights, masses, strict=True)
    ]


def groove(world: World, masses: list[float]) -> list[int]:
    c, s, r = 0.5, math.sqrt(0.75), 0.25
    for side in (1, -1):
        place = (side * (5 * c + 0.5 * s), 5 * s - 0.5 * c)
        box(
            world,
            place,
            width=10,
            height=1,
            angle=side * math.pi / 3,
            static=True,
            restitution=0,
            friction=0.5,
        )
    rows = [(row, k) for row in range(4) for k in range(row + 1)]
    return [
        circle(world, ((2 * k - row) * r, r / c + row * r * math.sqrt(3)), radius=r, mass=m, restitution=0,
               friction=0.5)
        for (row, k), m in zip(rows, masses, strict=False)
    ]  # fmt: skip


def rested(build: Callable[[World, list[float]], list[int]], masses: list[float]) -> tuple[int, float]:
    """Return the force evaluations of 20 steps, and how far anything has moved after the first [m]."""
    world = World(*standard_systems(), simulation=SimulationConfig(contacts="rigid"))
    bodies = build(world, masses)
    world.run(steps=1)
    places = [world.component(body, Transform).position for body in bodies]
    before = world.force_evaluations
    world.run(steps=20)
    stepper = world.stepper
    assert isinstance(stepper, Rigid)
    assert (stepper.by_impulses, stepper.left_to_soft, stepper.energy_added) == (0, 0, 0.0)
    assert world.account.sums[OVERLAP, ENERGY] == 0.0
    after = [world.component(body, Transform).position for body in bodies]
    moved = max((now - then).magnitude for now, then in zip(after, places, strict=True))
    return world.force_evaluations - before, moved


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize(("count", "ratio"), [(4, 1e6), (10, 1e3), (12, 1e6)])
@pytest.mark.parametrize("slope", [0.0, 0.02])
def test_towers_of_all_masses_rest_as_those_of_equal_ones_do(
    order: str, count: int, ratio: float, slope: float
) -> None:
    build = lambda world, masses: tower(world, masses, slope)  # noqa: E731
    evaluations, moved = rested(build, ORDERS[order](count, ratio))
    assert moved <= 1e-14, "places of up to 6 m are rounded to 1e-15"
    assert evaluations <= 20 * 25, "a piece of motion a step at most"


@pytest.mark.parametrize("order", ORDERS)
def test_so_do_discs_in_a_groove(order: str) -> None:
    assert rested(groove, ORDERS[order](10, 1e3)) == rested(groove, [1.0] * 10)


@pytest.mark.parametrize("order", ORDERS)
def test_what_slides_under_a_load_slides_as_one_body(order: str) -> None:
    """On a smooth slope all have one acceleration: nothing leans or lags, whatever the masses."""
    world = World(*standard_systems(), simulation=SimulationConfig(contacts="rigid"))
    bodies = tower(world, ORDERS[order](6, 1e3), 0.02)
    world.component(world.entities()[0], Material).friction = 0.0
    world.run(seconds=0.5)
    way = 0.5 * 9.81 * math.sin(0.02) * 0.25
    heights = np.arange(6) * 0.5 + 0.25
    for body, y in zip(bodies, heights.tolist(), strict=True):
        place = world.component(body, Transform).position
        assert place.x == pytest.approx(-math.sin(0.02) * y - way * math.cos(0.02), abs=1e-12)
        assert place.y == pytest.approx(math.cos(0.02) * y - way * math.sin(0.02), abs=1e-12)


def test_one_load_on_a_crowd_presses_a_light_body_in_no_farther_than_its_spring_allows() -> None:
    world = World(*standard_systems(), simulation=SimulationConfig(contacts="soft"))
    box(world, (0, -0.5), width=60, height=1, static=True, friction=0.5)
    for row in range(10):
        for column in range(30 - row):
            place = (column + 0.5 * row - 15, 0.25 + 0.5 * row)
            box(world, place, width=1, height=0.5, mass=10, friction=0.5)
    box(world, (-0.5, 5.2), width=1, height=0.4, mass=0.1, friction=0.5)
    box(world, (-0.5, 5.65), width=1, height=0.5, mass=20, friction=0.5)
    world.run(steps=120)
    assert world.contacts.max_penetration < SUNK * 0.4  # .27 m where the spring knew no load
    assert world.substeps == world.simulation.substeps  # of the world, not of one contact
