"""Many bodies on joints, beside contacts: a bridge under a heavy ball, a heap of ragdolls."""

import math
from functools import cache, partial

import numpy as np

from physicslab.components import Transform, Velocity
from physicslab.diagnostics.joints import joint_states
from physicslab.lab.stability.case import StabilityCase, part_of
from physicslab.lab.worlds import largest, open_space, place
from physicslab.prefabs import bridge, circle, container, ragdoll
from physicslab.world import World

_SECONDS = 8.0
_DOLLS = 6


def _widest(world: World) -> float:
    """Return the largest distance of points that joints hold together [m], in the run of a case."""
    steps = round(_SECONDS / world.simulation.dt)
    return largest(world, steps, lambda: max(joint.stretch for joint in joint_states(world)), every=2)


def loaded_bridge() -> World:
    """Return a bridge of 30 planks of 20 kg over 15 m, on whose middle a ball of 1,000 kg is put."""
    world = open_space()
    planks = bridge(world, (0.0, 0.0), (15.0, 0.0), mass=20.0)
    lowest = min(place(world, plank).y for plank in planks)
    circle(world, (7.5, lowest + 1.06), radius=1.0, mass=1_000.0)
    return world


def ragdoll_heap(count: int) -> World:
    """Return ragdolls of 71 kg that lie over each other and fall into a pit of 4 m."""
    world = open_space()
    container(world, width=4.0, height=3.0)
    for n in range(count):
        ragdoll(world, (0.3 * (n % 3 - 1), 1.0 + 1.4 * n), angle=1.5 if n % 2 else -1.5)
    return world


def _bridge_gap() -> float:
    """Return the largest gap of a loaded bridge, in lengths of a plank."""
    world = loaded_bridge()
    return _widest(world) / (1.05 * 15.0 / 30)


@cache  # two cases look at one run
def _heap() -> tuple[float, float]:
    """Return the largest gap of a heap of ragdolls [m], and the mean speed of its parts at last [m/s]."""
    world = ragdoll_heap(_DOLLS)
    widest = _widest(world)
    speed = world.table(Velocity)["linear"][world.batch(Transform, Velocity).rows]
    return widest, math.sqrt(float(np.mean(np.sum(speed * speed, axis=1))))


_case = partial(StabilityCase, group="joints")

ASSEMBLIES = (
    _case(
        name="bridge_30", title="bridge of 30 planks of 20 kg under a ball of 1,000 kg, 8 s",
        right="its planks stay together", figure="largest gap, in lengths of a plank", limit=0.01,
        measure=_bridge_gap,
    ),
    _case(
        name="ragdolls_gap", unit="m", title=f"heap of {_DOLLS} ragdolls of 10 parts, 8 s", limit=0.02,
        right="they stay together", figure="largest gap", measure=partial(part_of, 0, _heap),
    ),
    _case(
        name="ragdolls_rest", unit="m/s", title=f"heap of {_DOLLS} ragdolls of 10 parts, 8 s", limit=0.05,
        right="they come to rest", figure="mean speed at last", measure=partial(part_of, 1, _heap),
    ),
)  # fmt: skip
