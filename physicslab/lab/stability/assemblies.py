"""Many bodies on joints, beside contacts: a heap of ragdolls."""

import math
from functools import cache, partial

import numpy as np

from physicslab.components import Transform, Velocity
from physicslab.diagnostics.joints import joint_states
from physicslab.lab.stability.case import StabilityCase, part_of
from physicslab.lab.worlds import open_space
from physicslab.prefabs import container, ragdoll
from physicslab.world import World

_DOLLS = 6


def ragdoll_heap(count: int) -> World:
    """Return ragdolls of 71 kg that lie over each other and fall into a pit of 4 m."""
    world = open_space()
    container(world, width=4.0, height=3.0)
    for n in range(count):
        ragdoll(world, (0.3 * (n % 3 - 1), 1.0 + 1.4 * n), angle=1.5 if n % 2 else -1.5)
    return world


@cache  # two cases look at one run
def _heap() -> tuple[float, float]:
    """Return the largest gap of a heap of ragdolls [m], and the mean speed of its parts at last [m/s]."""
    world = ragdoll_heap(_DOLLS)
    world.run(seconds=8.0)
    speed = world.table(Velocity)["linear"][world.batch(Transform, Velocity).rows]
    widest = max(joint.largest_stretch for joint in joint_states(world))
    return widest, math.sqrt(float(np.mean(np.sum(speed * speed, axis=1))))


_case = partial(
    StabilityCase, group="joints", title=f"heap of {_DOLLS} ragdolls of 10 parts that fall up to 8 m, 8 s"
)

ASSEMBLIES = (
    _case(
        name="ragdolls_gap", unit="m", right="they stay together", figure="largest gap", limit=0.02,
        measure=partial(part_of, 0, _heap),
    ),
    _case(
        name="ragdolls_rest", unit="m/s", right="they come to rest", figure="mean speed at last", limit=0.1,
        measure=partial(part_of, 1, _heap),
    ),
)  # fmt: skip
