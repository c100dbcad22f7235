"""Warnings of joints: those that contradict each other, those that hold what is held, and what they leave."""

from collections.abc import Iterator

import numpy as np

from physicslab.diagnostics.joints import joint_states
from physicslab.diagnostics.step_warnings import ModelWarning
from physicslab.kernels.joints.blocks import GIVES
from physicslab.state.joint_rows import Role
from physicslab.stepping.soft import Soft
from physicslab.world import World

STRETCH_LIMIT = 0.01
"""How far a joint may be apart, in lengths of what it holds: bridges, chains and welds stay below that under
10,000 times the load of a link, and two pins that contradict each other are as far apart as they are made."""


def joint_warnings(world: World) -> Iterator[ModelWarning]:
    """Yield the joint that is farthest apart, with the reason; and which are redundant."""
    states = joint_states(world)
    if not states:
        return
    dependent = _dependent(world)
    worst = max(states, key=lambda joint: joint.stretch / joint.size)
    limit = STRETCH_LIMIT * worst.size
    if worst.stretch > limit:
        what = "contradicts other joints: not all can be kept" if dependent else "does not hold what it joins"
        setting = "" if dependent else f"simulation.substeps = {2 * world.simulation.substeps}"
        yield ModelWarning.about(world, worst.entity, what, worst.stretch, "m", limit, setting)
    elif dependent:
        what = "rows of joints hold what others hold already: how they share the load is not determined"
        yield ModelWarning(None, what, float(dependent), "", 0.0, "one joint less")


def _dependent(world: World) -> int:
    """Return how many rows of joints depend on others, as far as the last stepper found that."""
    joints = world.joints
    if isinstance(world.stepper, Soft):
        known = len(joints.measured) == len(joints.scale)  # not before the first step
        return int(np.count_nonzero(joints.measured[: len(joints), GIVES])) if known else 0
    held = int(np.count_nonzero(joints.role == Role.HOLD))
    return max(0, held - joints.rank) if joints.rank >= 0 else 0
