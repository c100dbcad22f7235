"""The figures of one joint: its force and torque, and the error that is left."""

import math
from typing import NamedTuple

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


def forces_of(state: State, joint: Joint) -> dict[int, Vector2]:
    """Return the force of a joint [N] on the row of each body that it holds, as in :func:`figures_of`."""
    joints, found = state.joints, dict[int, Vector2]()
    for row in range(joint.first, joint.first + joint.size):
        for n in (row, int(joints.second[row])):
            if n < 0:
                continue
            one, pull = (
                measured(joints.term(n), state.entity_index),
                float(joints.scale[n] * joints.force[row]),
            )
            for body, gradient in (
                (int(joints.a[n]), (one.ax, one.ay)),
                (int(joints.b[n]), (one.bx, one.by)),
            ):
                if body:
                    found[body] = found.get(body, Vector2()) + pull * Vector2(*gradient)
    return found


def figures_of(state: State, joint: Joint) -> JointFigures:
    """Return the figures of a joint, at the end of the last step or as their mean, where bodies are now."""
    joints, torque, largest = state.joints, 0.0, 0.0
    squares = {True: 0.0, False: 0.0}
    for row in range(joint.first, joint.first + joint.size):
        error = -float(joints.offset[row])
        for n in (row, int(joints.second[row])):
            if n < 0:
                continue
            one, scale = measured(joints.term(n), state.entity_index), float(joints.scale[n])
            error += scale * one.value
            for end, sign in ((joints.a[n], -1.0), (joints.b[n], 1.0)):
                if end == joint.b and joints.measure[n] == Measure.ANGLE:
                    torque += sign * scale * float(joints.force[row])
        if joints.role[row] == Role.LIMIT:
            error = min(error, 0.0)
        if joints.measure[row] != Measure.ANGLE:
            largest = max(largest, float(joints.largest[row]))
        if joints.role[row] != Role.MOTOR:
            squares[bool(joints.measure[row] == Measure.ANGLE)] += error * error
    stretch, twist = math.sqrt(squares[False]), math.sqrt(squares[True])
    return JointFigures(_force_on_b(state, joint), torque, stretch, twist, max(largest, stretch))


def _force_on_b(state: State, joint: Joint) -> Vector2:
    """Return the force on B [N]; on the world it is what A gets with the other sign."""
    forces = forces_of(state, joint)
    return forces.get(joint.b, Vector2()) if joint.b else -sum(forces.values(), Vector2())
