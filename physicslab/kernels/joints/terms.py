"""The measure of one term of a joint's row between two bodies, its gradient, and its part of Jdot v.

The anchor at B is seen from that at A: d = (x_B - x_A) + (r_B - r_A), differences first, so that a joint far
from the origin keeps its digits. Three of the four measures are n . d with a unit vector n: an axis of the
world, one that turns with A, or the direction of d. With the gradient J a measure changes by J v in a second,
and J v by J a + Jdot v.
"""

import math
from typing import NamedTuple

from physicslab.kernels import always_inlined

ALONG, ALONG_A, DISTANCE, ANGLE = range(4)
"""n . d with an axis n of the world [m]; the same with an axis that turns with A; the length of d [m]; the
angle of B less that of A [rad]."""
HOLD, LIMIT, MOTOR = range(3)
"""Demand of a row on its quantity g: g = 0; g >= 0; dg/dt = target."""


class TermEnd(NamedTuple):
    """A body at an end of a term: place [m], angle [rad], their rates; the anchor in its own frame [m]."""

    x: float
    y: float
    angle: float
    vx: float
    vy: float
    spin: float
    anchor_x: float
    anchor_y: float


class MeasuredTerm(NamedTuple):
    """The measure [m or rad]; its gradient by x, y and angle of A, and of B; Jdot v [m/s^2 or rad/s^2]."""

    value: float
    ax: float
    ay: float
    turn_a: float
    bx: float
    by: float
    turn_b: float
    rate: float


@always_inlined
def measure_term(measure: int, a: TermEnd, b: TermEnd, axis_x: float, axis_y: float) -> MeasuredTerm:
    """Return what a term measures between A and B.

    ``axis_x`` and ``axis_y`` are the axis of ``ALONG``, in the world, or of ``ALONG_A``, in A's frame. A
    distance of zero has no direction: its gradient is zero.
    """
    ca, sa, cb, sb = math.cos(a.angle), math.sin(a.angle), math.cos(b.angle), math.sin(b.angle)
    return measure_turned(measure, a, b, ca, sa, cb, sb, axis_x, axis_y)


@always_inlined
def measure_turned(
    measure: int, a: TermEnd, b: TermEnd, ca: float, sa: float, cb: float, sb: float, axis_x: float,
    axis_y: float,
) -> MeasuredTerm:  # fmt: skip
    """Return the same, with the cosines and sines of both angles."""
    if measure == ANGLE:
        return MeasuredTerm(b.angle - a.angle, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0)
    rax, ray = ca * a.anchor_x - sa * a.anchor_y, sa * a.anchor_x + ca * a.anchor_y
    rbx, rby = cb * b.anchor_x - sb * b.anchor_y, sb * b.anchor_x + cb * b.anchor_y
    dx, dy = (b.x - a.x) + (rbx - rax), (b.y - a.y) + (rby - ray)
    nx, ny, length = axis_x, axis_y, 0.0
    if measure == ALONG_A:
        nx, ny = ca * axis_x - sa * axis_y, sa * axis_x + ca * axis_y
    elif measure == DISTANCE:
        length = math.sqrt(dx * dx + dy * dy)
        if length == 0.0:
            return MeasuredTerm(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        nx, ny = dx / length, dy / length
    value, turn_a, turn_b = nx * dx + ny * dy, rax * ny - ray * nx, rbx * ny - rby * nx
    rate = a.spin * a.spin * (rax * nx + ray * ny) - b.spin * b.spin * (rbx * nx + rby * ny)
    if measure != ALONG:
        across = nx * ((b.vy - a.vy) + (b.spin * rbx - a.spin * rax))
        across -= ny * ((b.vx - a.vx) - (b.spin * rby - a.spin * ray))
        if measure == DISTANCE:
            value = length
            rate += across * (across / length)
        else:
            turn_a -= nx * dy - ny * dx
            rate += a.spin * (2.0 * across - a.spin * value)
    return MeasuredTerm(value, -nx, -ny, -turn_a, nx, ny, turn_b, rate)
