"""When shapes meet that do not turn against each other and move under constant accelerations.

B's place against A is d + u t + w t^2 / 2. Two shapes meet at the first t >= 0 at which they touch or overlap
*and* approach: a pair that has just bounced does not meet again, however its gap was rounded. Times are
roots of polynomials: of second degree for straight outlines, and for round ones where the relative
acceleration is zero; else of fourth degree, found between the extrema, so that none is stepped over.
"""

import math
from typing import NamedTuple

from physicslab.kernels import inlined
from physicslab.kernels.geometry.outline import Outline

__all__ = ["Course", "box_normal", "meet_box_box", "meet_circle_box", "meet_circle_circle", "meet_line"]

_ROUNDING = 1e-14
"""Share of a speed, or of a length, that rounding may have made."""
_SEAM = 1e-12
"""Share of the size by which a side is taken as longer than it is: where side and corner join, no gap is
left."""


class Course(NamedTuple):
    """Where B is seen from A (dx, dy) [m], its velocity (ux, uy) [m/s] and acceleration (wx, wy) [m/s^2]."""

    dx: float
    dy: float
    ux: float
    uy: float
    wx: float
    wy: float


@inlined
def _at(course: Course, t: float) -> tuple[float, float]:
    """Return where B is at the time t [m]."""
    dx, dy, ux, uy, wx, wy = course
    return dx + t * (ux + 0.5 * t * wx), dy + t * (uy + 0.5 * t * wy)


@inlined
def meet_line(gap: float, speed: float, pull: float, min_rate: float) -> float:
    """Return the first t >= 0 at which gap + speed t + pull t^2 / 2 is <= 0 and decreases, or infinity.

    Rates of at least -``min_rate`` count as zero. Squares of numbers other than zero must not underflow.
    """
    square = speed * speed - 2.0 * pull * gap
    if speed < -min_rate:
        if gap <= 0.0:
            return 0.0
        return 2.0 * gap / (math.sqrt(square) - speed) if square >= 0.0 else math.inf
    if pull >= 0.0:
        return math.inf
    speed = max(speed, 0.0)
    if square < 0.0:  # below all the time: it decreases from its maximum
        return -speed / pull
    return -(speed + math.sqrt(square)) / pull


@inlined
def _height(course: Course, reach: float, t: float) -> tuple[float, float]:
    """Return (|d(t)|^2 - reach^2) / 2 and its rate."""
    x, y = _at(course, t)
    distance = math.sqrt(x * x + y * y)
    rate = x * (course.ux + t * course.wx) + y * (course.uy + t * course.wy)
    return 0.5 * (distance - reach) * (distance + reach), rate


@inlined
def _rate(course: Course, t: float) -> tuple[float, float]:
    """Return the rate of |d(t)|^2 / 2 and its derivative."""
    x, y = _at(course, t)
    vx, vy = course.ux + t * course.wx, course.uy + t * course.wy
    return x * vx + y * vy, vx * vx + vy * vy + x * course.wx + y * course.wy


@inlined
def _root(course: Course, reach: float, low: float, high: float) -> float:
    """Return where |d|^2 - reach^2 crosses zero between ``low`` and ``high``, or its rate if reach < 0.

    The signs differ at the ends. Newton's step where it stays between them and shrinks fast, else half-way.
    """
    rising = (_rate(course, high) if reach < 0.0 else _height(course, reach, high))[0] > 0.0
    t = 0.5 * (low + high)
    for k in range(200):
        value, slope = _rate(course, t) if reach < 0.0 else _height(course, reach, t)
        if value == 0.0:
            return t
        if (value > 0.0) == rising:
            high = t
        else:
            low = t
        newer = t - value / slope if slope != 0.0 else low
        if not low < newer < high or k % 8 == 7:
            newer = 0.5 * (low + high)
        if newer == t or high - low <= 2e-16 * high or abs(newer - t) <= 1e-17 * high:
            return newer
        t = newer
    return t


@inlined
def _extrema(course: Course, span: float) -> tuple[float, float, float]:
    """Return three times within ``span`` at which |d| is extremal, in order; ``span`` if there are fewer."""
    dx, dy, ux, uy, wx, wy = course
    # The derivative of the rate is u^2 + d.w + 3 u.w t + 3/2 w^2 t^2: between its zeros the rate is monotone.
    a = 1.5 * (wx * wx + wy * wy)
    b = 3.0 * (ux * wx + uy * wy)
    c = ux * ux + uy * uy + dx * wx + dy * wy
    first, second = span, span
    square = b * b - 4.0 * a * c
    if square > 0.0:
        q = -0.5 * (b + math.copysign(math.sqrt(square), b))
        one, two = q / a, c / q if q != 0.0 else 0.0
        first = min(max(min(one, two), 0.0), span)
        second = min(max(max(one, two), 0.0), span)
    t1, t2, t3 = span, span, span
    low, before = 0.0, _rate(course, 0.0)[0]
    for k in range(3):
        high = first if k == 0 else (second if k == 1 else span)
        after = _rate(course, high)[0]
        if high > low and (before > 0.0) != (after > 0.0):
            t = _root(course, -1.0, low, high)
            if t1 == span:
                t1 = t
            elif t2 == span:
                t2 = t
            else:
                t3 = t
        low, before = high, after
    return t1, t2, t3


@inlined
def meet_circle_circle(course: Course, reach: float, span: float, min_speed: float) -> float:
    """Return when the centres of two circles come within ``reach``, up to ``span``, or infinity.

    Here and below, approaches no faster than ``min_speed`` [m/s] are ignored.
    """
    dx, dy, ux, uy, wx, wy = course
    height, rate = _height(course, reach, 0.0)
    distance = math.sqrt(dx * dx + dy * dy)
    min_rate = distance * (_ROUNDING * (abs(ux) + abs(uy)) + min_speed)
    if height <= 0.0 and rate < -min_rate:
        return 0.0
    if wx == 0.0 and wy == 0.0:
        # The chord, not |d|^2 |u|^2: it loses nothing when the speeds are large.
        cross, u2 = dx * uy - dy * ux, ux * ux + uy * uy
        square = reach * reach * u2 - cross * cross
        if rate >= -min_rate or square < 0.0:
            return math.inf
        return 2.0 * height / (math.sqrt(square) - rate)
    if height <= 0.0 and rate <= 0.0 and ux * ux + uy * uy + dx * wx + dy * wy < 0.0:
        return 0.0  # at rest on each other, and pressed together
    t1, t2, t3 = _extrema(course, span)
    low, before = 0.0, height
    for k in range(4):
        high = t1 if k == 0 else (t2 if k == 1 else (t3 if k == 2 else span))
        if high <= low:
            continue
        after = _height(course, reach, high)[0]
        if after < before and after <= 0.0:
            if before > 0.0:
                return _root(course, reach, low, high)
            if low > 0.0:
                return low  # it turns before the two have come apart
        low, before = high, after
    return math.inf


@inlined
def _falling(gap: float, speed: float, pull: float, size: float, min_rate: float) -> float:
    """Return when a line is crossed from outside; infinity for a body beyond it, which does not cross it."""
    # It would have to come out before it can come in again.
    comes_out = speed > 0.0 and pull < 0.0 and speed * speed > 2.0 * pull * gap
    if gap < -_SEAM * size and not comes_out:
        return math.inf
    return meet_line(gap, speed, pull, min_rate)


@inlined
def _meet_corners(
    course: Course, half_x: float, half_y: float, radius: float, best: float, span: float, min_speed: float
) -> float:
    """Return when a circle meets a corner of a box from beyond both its sides, if that is before ``best``."""
    px, py, qx, qy, wx, wy = course
    seam = _SEAM * (half_x + half_y + radius)
    for k in range(4):
        corner_x = half_x if k < 2 else -half_x
        corner_y = half_y if k % 2 == 0 else -half_y
        horizon = min(best, span)
        to_corner = Course(px - corner_x, py - corner_y, qx, qy, wx, wy)
        t = meet_circle_circle(to_corner, radius, horizon, min_speed)
        if t < best:
            x, y = _at(course, t)
            beyond_x = (x - corner_x) * math.copysign(1.0, corner_x) >= -seam
            if beyond_x and (y - corner_y) * math.copysign(1.0, corner_y) >= -seam:
                best = t
    return best


@inlined
def meet_circle_box(
    course: Course, half_x: float, half_y: float, radius: float, span: float, min_speed: float
) -> float:
    """Return when a circle meets a box, up to ``span``, or infinity; all in the frame of the box."""
    px, py, qx, qy, wx, wy = course
    size = half_x + half_y + radius
    min_rate = _ROUNDING * (abs(qx) + abs(qy)) + min_speed
    out_x, out_y = max(abs(px) - half_x, 0.0), max(abs(py) - half_y, 0.0)
    out = math.sqrt(out_x * out_x + out_y * out_y)
    if out < radius:  # they overlap: the nearest place of the outline decides
        nx, ny = math.copysign(out_x, px), math.copysign(out_y, py)
        if out > 0.0:
            nx, ny = nx / out, ny / out
        elif half_x - abs(px) < half_y - abs(py):
            nx = math.copysign(1.0, px)
        else:
            ny = math.copysign(1.0, py)
        speed, pull = qx * nx + qy * ny, wx * nx + wy * ny
        if speed < -min_rate:
            return 0.0
        if pull < 0.0 and speed * speed < -2.0 * pull * (radius - out):
            return max(speed, 0.0) / -pull
    best = math.inf
    for k in range(2):
        sign = 1.0 - 2.0 * k
        t = _falling(sign * px - half_x - radius, sign * qx, sign * wx, size, min_rate)
        if t < best and abs(py + t * (qy + 0.5 * t * wy)) <= half_y + _SEAM * size:
            best = t
        t = _falling(sign * py - half_y - radius, sign * qy, sign * wy, size, min_rate)
        if t < best and abs(px + t * (qx + 0.5 * t * wx)) <= half_x + _SEAM * size:
            best = t
    if out <= radius + _SEAM * size and min(out_x, out_y) == 0.0 and best == 0.0:
        return best
    return _meet_corners(course, half_x, half_y, radius, best, span, min_speed)


@inlined
def meet_box_box(course: Course, a: Outline, b: Outline, min_speed: float) -> tuple[float, int]:
    """Return when two boxes meet and which of eight normals then leads from A to B, or infinity and -1.

    Normals 0 to 3 are A's (+x, +y, -x, -y), 4 to 7 B's. In the plane of d, the two overlap within a convex
    outline of up to eight sides; they meet where d first crosses one of them while it is within the others.
    """
    dx, dy, ux, uy, wx, wy = course
    best, face = math.inf, -1
    size = a.half_x + a.half_y + b.half_x + b.half_y
    min_rate = _ROUNDING * (abs(ux) + abs(uy)) + min_speed
    gap, nearest = -math.inf, -1
    for k in range(8):
        nx, ny, reach = box_normal(k, a, b)
        apart = dx * nx + dy * ny - reach
        if apart > gap:
            gap, nearest = apart, k
    if gap <= 0.0:
        nx, ny, _ = box_normal(nearest, a, b)
        speed, pull = ux * nx + uy * ny, wx * nx + wy * ny
        if speed < -min_rate:
            return 0.0, nearest
        if pull < 0.0 and speed * speed < -2.0 * pull * -gap:
            return max(speed, 0.0) / -pull, nearest
    for k in range(8):
        nx, ny, reach = box_normal(k, a, b)
        apart = dx * nx + dy * ny - reach
        t = _falling(apart, ux * nx + uy * ny, wx * nx + wy * ny, size, min_rate)
        if t >= best:
            continue
        x, y = _at(course, t)
        within = True
        for j in range(8):
            mx, my, limit = box_normal(j, a, b)
            within = within and (j == k or x * mx + y * my - limit <= _SEAM * size)
        if within:
            best, face = t, k
    return best, face


@inlined
def box_normal(k: int, a: Outline, b: Outline) -> tuple[float, float, float]:
    """Return normal k of two boxes, and how far apart along it their centres are when they touch."""
    turn_c, turn_s = abs(a.c * b.c + a.s * b.s), abs(a.c * b.s - a.s * b.c)
    one, other = (a, b) if k < 4 else (b, a)
    upright = k % 2 == 1
    if upright:
        reach = one.half_y + turn_s * other.half_x + turn_c * other.half_y
    else:
        reach = one.half_x + turn_c * other.half_x + turn_s * other.half_y
    sign = 1.0 if k % 4 < 2 else -1.0
    return (-sign * one.s if upright else sign * one.c), (sign * one.c if upright else sign * one.s), reach
