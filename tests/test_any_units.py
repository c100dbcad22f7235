"""No constant of the engine has a unit: a scene in other units of length, mass and time moves alike."""

from collections.abc import Callable
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab.components import Spring, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box, circle
from physicslab.world import World

type Fill = Callable[[int], tuple[float, float, float]]
"""Returns x and y [m] and the mass [kg] of body number n."""

PILES: dict[str, Fill] = {
    "falls": lambda n: (0.3 * (n % 3), 0.5 + 0.55 * n, 1.0),
    "in each other": lambda n: (0.02 * n, 0.6 + 0.05 * (n % 3), 1.0),
    "heavy on light": lambda n: (0.01 * n, 0.25 + 0.5 * n, 64.0 if n % 2 else 1.0),
}


def moved(fill: Fill, metre: float, kilogram: float, second: float) -> np.ndarray:
    """Return places, turns, velocities and spins of a pile in other units after 40 steps, in those of SI."""
    speed = metre / second
    physics = PhysicsConfig(gravity=Vector2(0.0, -9.81 * speed / second))
    world = World(physics=physics, simulation=SimulationConfig(dt=second / 64, contacts="soft"))
    box(world, (0.0, -0.5 * metre), width=40 * metre, height=metre, static=True, friction=0.5)
    bodies = []
    for n in range(14):
        x, y, mass = fill(n)
        at, mass = (x * metre, y * metre), mass * kilogram
        if n % 3:
            bodies.append(box(world, at, width=0.5 * metre, height=0.4 * metre, mass=mass, restitution=0.3))
        else:
            bodies.append(circle(world, at, radius=0.25 * metre, mass=mass, friction=0.4))
    for a, b in pairwise(bodies[:4]):
        stiffness = 100.0 * kilogram / second**2
        world.spawn(Spring(a, b, rest_length=0.5 * metre, stiffness=stiffness, damping=kilogram / second))
    world.run(steps=40)
    place, velocity = world.table(Transform), world.table(Velocity)
    columns = (
        place["position"] / metre,
        velocity["linear"] / speed,
        place["angle"],
        velocity["angular"] * second,
    )
    return np.concatenate([column.ravel() for column in columns])


@cache
def usual(pile: str) -> np.ndarray:
    """Return a pile as it has moved in metres, kilograms and seconds."""
    return moved(PILES[pile], 1.0, 1.0, 1.0)


@pytest.mark.parametrize("pile", PILES)
@given(length=st.integers(-20, 30), mass=st.integers(-30, 40), time=st.integers(-8, 15))
def test_a_pile_in_other_units_has_the_same_bits(pile: str, length: int, mass: int, time: int) -> None:
    assert np.array_equal(moved(PILES[pile], 2.0**length, 2.0**mass, 2.0**time), usual(pile))
