"""The figures of one joint: its force and torque, and the error that is left."""

import math
from typing import NamedTuple

import numpy as np

from physicslab.ecs.vector import Vector2
from physicslab.state.joint_rows import Measure, Role, measured
from physicslab.state.joints import Joint
from physicslab.state.state import State


class JointFigures(NamedTuple):
    """Force [N] and torque about its anchor [N m] on B; the errors left [m, rad], the largest so far [m]."""

    force: Vector2
    torque: float
    stretch: float
    twist: float
    largest_stretch: float


def figures_of(state: State, joint: Joint) -> JointFigures:
    """Return the figures of a joint, at the end of the last step or as their mean, where bodies are now."""
    joints, force, torque, largest = state.joints, np.zeros(2), 0.0, 0.0
    squares = {True: 0.0, False: 0.0}
    for row in range(joint.first, joint.first + joint.size):
        error = -float(joints.offset[row])
        for n in (row, int(joints.second[row])):
            if n < 0:
                continue
            one, scale = measured(joints.term(n), state.entity_index), float(joints.scale[n])
            error += scale * one.value
            pull = scale * float(joints.force[row])
            ends = (joints.a[n], (one.ax, one.ay), -1.0), (joints.b[n], (one.bx, one.by), 1.0)
            for end, gradient, sign in ends:
                if end == joint.b:
                    force += pull * np.array(gradient)
                    torque += sign * pull if joints.measure[n] == Measure.ANGLE else 0.0
        if joints.role[row] == Role.LIMIT:
            error = min(error, 0.0)
        if joints.measure[row] != Measure.ANGLE:
            largest = max(largest, float(joints.largest[row]))
        if joints.role[row] != Role.MOTOR:
            squares[bool(joints.measure[row] == Measure.ANGLE)] += error * error
    stretch, twist = math.sqrt(squares[False]), math.sqrt(squares[True])
    return JointFigures(Vector2(*force.tolist()), torque, stretch, twist, max(largest, stretch))
