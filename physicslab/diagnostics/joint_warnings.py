"""Warnings of joints: those that contradict each other, those that hold what is held, and what they leave."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from physicslab.diagnostics.joints import joint_states
from physicslab.diagnostics.step_warnings import ModelWarning
from physicslab.kernels.joints.blocks import GIVES
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
        told = bool(dependent.any())
        what = "contradicts other joints: not all can be kept" if told else "does not hold what it joins"
        setting = "" if told else f"simulation.substeps = {2 * world.simulation.substeps}"
        yield ModelWarning.about(world, worst.entity, what, worst.stretch, "m", limit, setting)
    elif dependent.any():
        first = int(np.flatnonzero(dependent)[0])
        joint = next(joint for joint in world.joints.joints if joint.own.start <= first < joint.own.stop)
        what = "holds what other joints hold already: how they share the load is not determined (rows)"
        count = float(np.count_nonzero(dependent))
        yield ModelWarning.about(world, joint.entity, what, count, "", 0.0, "one joint less")


def _dependent(world: World) -> NDArray[np.bool_]:
    """Return which rows of joints (n,) depend on others, as far as the last stepper found that."""
    joints = world.joints
    if isinstance(world.stepper, Soft):
        known = len(joints.measured) == len(joints.scale)  # not before the first step
        return joints.measured[: len(joints), GIVES] != 0.0 if known else np.zeros(len(joints), np.bool_)
    return joints.dependent
