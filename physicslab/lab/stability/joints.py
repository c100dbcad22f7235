"""Joints: heavy loads at their ends, and such as contradict each other."""

from collections.abc import Callable
from functools import partial

import numpy as np

from physicslab.components import Mass, Pin, Shape, Transform, Velocity
from physicslab.diagnostics.joints import joint_states
from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import energy_change, floor, largest, open_space
from physicslab.world import World

_LINK = 0.5
"""The length of a link [m]."""


def _pinned(links: int, heavy: float, contacts: str = "auto") -> World:
    """Return a chain of bars of 1 kg let go level, held at one end, with a ``heavy`` last one [kg]."""
    world, last = open_space(contacts=contacts), None
    for i in range(links):
        mass = heavy if i == links - 1 else 1.0
        parts = Transform(((i + 0.5) * _LINK, 0.0)), Velocity(), Mass(mass), Shape.box(_LINK, 0.05)
        bar, at = world.spawn(*parts), (0.0 if last is None else 0.5 * _LINK, 0.0)
        world.spawn(Pin(a=last, b=bar, anchor_a=at, anchor_b=(-0.5 * _LINK, 0.0)))
        last = bar
    return world


def _stretched(make: Callable[[], World], seconds: float) -> float:
    """Return the largest distance of points that joints hold together, in lengths of a link."""
    world = make()
    steps = round(seconds / world.simulation.dt)
    return largest(world, steps, lambda: max(joint.stretch for joint in joint_states(world)) / _LINK)


def _contradicted(contacts: str) -> float:
    """Return how fast a bar is at last whose two pins are farther apart than its holes [m/s]."""
    world = open_space(contacts=contacts)
    floor(world, Vector2(0.0, -5.0))
    bar = world.spawn(Transform(), Velocity(), Mass(1.0), Shape.box(1.0, 0.1))
    for side in (-1.0, 1.0):
        world.spawn(Pin(b=bar, anchor_a=(0.6 * side, 0.0), anchor_b=(0.5 * side, 0.0)))
    world.run(seconds=5.0)
    velocity = world.table(Velocity)
    return float(np.abs(velocity["linear"]).max() + np.abs(velocity["angular"]).max())


def _unequal() -> float:
    """Return the change of energy of a double pendulum of 1 g and 1,000 t, of what its fall exchanges."""
    world = _pinned(2, 1e9)
    return energy_change(world, world.stepping(seconds=5.0))


_case = partial(StabilityCase, group="joints")

JOINTS = (
    _case(
        name="pins_soft_100kg", title="chain of 20 bars on pins let go level, 100 kg at the end, soft, 5 s",
        right="its links stay together", figure="largest gap, in lengths of a link", limit=0.05,
        measure=partial(_stretched, partial(_pinned, 20, 100.0, contacts="soft"), 5.0),
    ),
    _case(
        name="pins_unequal", title="double pendulum of bars of 1 and 1e9 kg let go level, 5 s",
        right="the energy stays", figure="largest change of energy", limit=1e-8, measure=_unequal,
    ),
    *(
        _case(
            name=f"pins_contradict_{contacts}", unit="m/s", limit=1e-3,
            title=f"bar whose pins are 20 % farther apart than its holes, {contacts} contacts, 5 s",
            right="it comes to rest between them", figure="speed at last",
            measure=partial(_contradicted, contacts),
        )
        for contacts in ("soft", "rigid")
    ),
)  # fmt: skip
