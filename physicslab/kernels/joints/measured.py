"""Measures of all terms of joints in a state of motion, and the loads on joints."""

from math import hypot

from physicslab.kernels import Numbers, Plain, Rows, Vectors, inlined, kernel
from physicslab.kernels.joints.blocks import Joints
from physicslab.kernels.joints.terms import ANGLE, MeasuredTerm, TermEnd, measure_term

VALUE, AX, AY, TURN_A, BX, BY, TURN_B, FIGURES = range(8)
"""The figures of a term, as :class:`physicslab.kernels.joints.terms.MeasuredTerm` has them."""


@inlined
def _measured(
    measure: int, i: int, j: int, anchor_a: Numbers, anchor_b: Numbers, axis: Numbers, position: Vectors,
    angle: Numbers,
) -> MeasuredTerm:  # fmt: skip
    """Return what a term between two rows measures where they are."""
    return measure_term(
        measure,
        TermEnd(position[i, 0], position[i, 1], angle[i], 0.0, 0.0, 0.0, anchor_a[0], anchor_a[1]),
        TermEnd(position[j, 0], position[j, 1], angle[j], 0.0, 0.0, 0.0, anchor_b[0], anchor_b[1]),
        axis[0], axis[1],
    )  # fmt: skip


@inlined
def _find_loads(joints: Joints, position: Vectors, angle: Numbers, forces: Numbers, span: float) -> None:
    """Set the loads of joints to the force on B and the torque on it about its anchor.

    On the world it is what A gets with the other sign. ``forces`` (n,) along the gradients of rows [N or N m]
    are impulses, where ``span`` is the time [s] over which they act; else that is 1.
    """
    loads = joints.loads
    loads[:] = 0.0
    for n in range(len(joints.measure)):
        a, b, owner = joints.a[n], joints.b[n], joints.owner[n]
        held = joints.held[owner]
        one = _measured(
            joints.measure[n], a, b, joints.anchor_a[n], joints.anchor_b[n], joints.axis[n], position, angle
        )
        pull = joints.scale[n] * (forces[joints.row[n]] / span)
        if held > 0 and (a == held or b == held):
            gx, gy = (one.bx, one.by) if b == held else (one.ax, one.ay)
            loads[owner, 0] += pull * gx
            loads[owner, 1] += pull * gy
        elif held == 0 and a > 0:
            loads[owner, 0] -= pull * one.ax
            loads[owner, 1] -= pull * one.ay
        if held == 0 and b > 0:
            loads[owner, 0] -= pull * one.bx
            loads[owner, 1] -= pull * one.by
        if joints.measure[n] == ANGLE and (a == held or b == held):
            loads[owner, 2] += pull if b == held else -pull


@inlined
def overloaded(joints: Joints, position: Vectors, angle: Numbers, forces: Numbers, span: float) -> bool:
    """Whether any joint bears less than its load, as :func:`_find_loads` finds it."""
    _find_loads(joints, position, angle, forces, span)
    for n in range(len(joints.bears)):
        load, bears = joints.loads[n], joints.bears[n]
        if hypot(load[0], load[1]) > bears[0] or abs(load[2]) > bears[1]:
            return True
    return False


@kernel
def find_loads(joints: Plain[Joints], position: Vectors, angle: Numbers, forces: Numbers) -> bool:
    """Set the loads of joints (j, 3) by the forces of rows (n,); return whether any bears less than that."""
    return overloaded(Joints(*joints), position, angle, forces, 1.0)


@kernel
def measure_terms(
    measure: Rows, a: Rows, b: Rows, anchor_a: Vectors, anchor_b: Vectors, axis: Vectors, position: Vectors,
    angle: Numbers, found: Vectors,
) -> None:  # fmt: skip
    """Set ``found`` (m, FIGURES) to what terms (m,) measure and to their gradients, where bodies are."""
    for n in range(len(measure)):
        one = _measured(measure[n], a[n], b[n], anchor_a[n], anchor_b[n], axis[n], position, angle)
        found[n, VALUE], found[n, AX], found[n, AY], found[n, TURN_A] = one.value, one.ax, one.ay, one.turn_a
        found[n, BX], found[n, BY], found[n, TURN_B] = one.bx, one.by, one.turn_b
