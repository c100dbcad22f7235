"""The figures of all joints: their forces and torques, and the errors that are left."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.kernels.joints.measured import AX, BX, FIGURES, VALUE, find_loads, measure_terms
from physicslab.state.joint_rows import Measure, Role
from physicslab.state.state import State

type Numbers = NDArray[np.float64]
"""A float64 array (n,), or of the shape that a function says."""


class JointFigures(NamedTuple):
    """Arrays (n,) of all joints, at the end of the last step or as its mean, where bodies are now.

    Forces on B (n, 2) [N], torques on B about its anchor [N m], errors of lengths and places [m] and of
    angles [rad], the largest error of the first so far [m], and the length that it is compared with [m]:
    that of the arms, and of a rod or a rope.
    """

    force: Numbers
    torque: Numbers
    stretch: Numbers
    twist: Numbers
    largest_stretch: Numbers
    size: Numbers


def measured_terms(state: State, position: Numbers | None = None, angle: Numbers | None = None) -> Numbers:
    """Return what terms measure and their gradients (m, FIGURES), where bodies are.

    Or at places (rows, 2) [m] and angles (rows,) [rad].
    """
    joints, transform = state.joints, state.table(Transform)
    found = np.zeros((len(joints.measure), FIGURES))
    state.compile((measure_terms,))
    measure_terms(
        joints.measure, joints.a, joints.b, joints.anchor_a, joints.anchor_b, joints.axis,
        transform["position"] if position is None else position,
        transform["angle"] if angle is None else angle, found,
    )  # fmt: skip
    return found


def errors_of_rows(state: State, terms: Numbers) -> Numbers:
    """Return the quantities g (n,) of all rows by what their terms measure."""
    errors = -state.joints.offset
    np.add.at(errors, state.joints.row, state.joints.scale * terms[:, VALUE])
    return errors


def forces_on(state: State, row: int) -> dict[int, Numbers]:
    """Return the force (2,) [N] of each joint, by its number, that holds the body of a row."""
    terms, pulls = _pulls(state)
    joints, owner, found = state.joints, state.joints.owner, dict[int, Numbers]()
    for ends, gradient in ((joints.a, terms[:, AX : AX + 2]), (joints.b, terms[:, BX : BX + 2])):
        for n in np.flatnonzero(ends == row).tolist():
            joint = int(owner[n])
            found[joint] = found.get(joint, np.zeros(2)) + pulls[n] * gradient[n]
    return dict(sorted(found.items()))


def forces_on_all(state: State) -> Numbers:
    """Return the sum of the forces of joints on each row (rows, 2) [N]; row 0 is the world."""
    (terms, pulls), total = _pulls(state), np.zeros((len(state.entity_index), 2))
    np.add.at(total, state.joints.a, pulls[:, None] * terms[:, AX : AX + 2])
    np.add.at(total, state.joints.b, pulls[:, None] * terms[:, BX : BX + 2])
    return total


def is_overloaded(
    state: State, forces: Numbers | None = None, places: tuple[Numbers, Numbers] | None = None
) -> bool:
    """Find the loads of joints where bodies are; return whether any joint bears less than its own.

    By the ``forces`` (n,) of rows [N or N m], which are those of the joints unless others are given; or at
    ``places`` (rows, 2) [m] with angles (rows,) [rad].
    """
    joints, transform = state.joints, state.table(Transform)
    if not joints.joints:
        return False
    state.compile((find_loads,))
    position, angle = places or (transform["position"], transform["angle"])
    return bool(find_loads(joints.plain, position, angle, joints.force if forces is None else forces))


def _pulls(state: State) -> tuple[Numbers, Numbers]:
    """Return what terms measure, and the force along the gradient of each [N or N m]."""
    return measured_terms(state), state.joints.scale * state.joints.force[state.joints.row]


def figures_of(state: State) -> JointFigures:
    """Return the figures of all joints."""
    joints, terms = state.joints, measured_terms(state)
    is_overloaded(state)
    force, torque = joints.loads[:, :2].copy(), joints.loads[:, 2].copy()
    rows, angles = joints.owner[: len(joints)], joints.measure[: len(joints)] == Measure.ANGLE
    error = errors_of_rows(state, terms)
    error = np.where(joints.role == Role.LIMIT, np.minimum(error, 0.0), error)
    square = np.where(joints.role == Role.MOTOR, 0.0, error * error)
    stretch, twist, largest = np.zeros((3, len(joints.joints)))
    np.add.at(stretch, rows[~angles], square[~angles])
    np.add.at(twist, rows[angles], square[angles])
    np.maximum.at(largest, rows[~angles], joints.largest[~angles])
    stretch, twist = np.sqrt(stretch), np.sqrt(twist)
    return JointFigures(force, torque, stretch, twist, np.maximum(largest, stretch), _sizes(state))


def _sizes(state: State) -> Numbers:
    """Return the length (n,) that the error of each joint is compared with [m]."""
    joints = state.joints
    first, a, b = (np.array([joint[k] for joint in joints.joints], np.int64) for k in (2, 4, 5))
    arms = [
        np.where(body > 0, np.hypot(*anchor[first].T), 0.0)
        for body, anchor in ((a, joints.anchor_a), (b, joints.anchor_b))
    ]
    lengths = np.where(joints.measure[first] == Measure.DISTANCE, np.abs(joints.offset[first]), 0.0)
    size, reach = np.maximum(lengths, np.maximum(*arms)), state.bodies.shapes.reach
    bodies = np.maximum(np.where(a > 0, reach[a], 0.0), np.where(b > 0, reach[b], 0.0))
    size = np.where(size > 0.0, size, bodies)
    sizes: Numbers = np.where(size > 0.0, size, 1.0)
    return sizes
