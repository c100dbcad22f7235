"""When shapes meet that do not turn against each other and move under constant accelerations.

B's place against A is d + u t + w t^2 / 2. Two shapes meet at the first t >= 0 at which they touch or overlap
*and* approach: a pair that has just bounced does not meet again, however its gap was rounded. Times are
roots of polynomials: of second degree for straight outlines, and for round ones where the relative
acceleration is zero; else of fourth degree, found between the extrema, so that none is stepped over.
"""

import math
from typing import NamedTuple

from physicslab.kernels import inlined

ROUNDING = 1e-14
"""Share of a speed, or of a length, that rounding may have made."""
SEAM = 1e-12
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
def place_at(course: Course, t: float) -> tuple[float, float]:
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
    x, y = place_at(course, t)
    distance = math.sqrt(x * x + y * y)
    rate = x * (course.ux + t * course.wx) + y * (course.uy + t * course.wy)
    return 0.5 * (distance - reach) * (distance + reach), rate


@inlined
def _rate(course: Course, t: float) -> tuple[float, float]:
    """Return the rate of |d(t)|^2 / 2 and its derivative."""
    x, y = place_at(course, t)
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
def _first_crossing(course: Course, reach: float, span: float, height: float, side: float) -> float:
    """Return when a circle is crossed, from outside where ``side`` is 1, from within where it is -1.

    Or when one that is on the other side turns, before it has come back; infinity where neither is.
    """
    t1, t2, t3 = _extrema(course, span)
    low, before = 0.0, side * height
    for k in range(4):
        high = t1 if k == 0 else (t2 if k == 1 else (t3 if k == 2 else span))
        if high <= low:
            continue
        after = side * _height(course, reach, high)[0]
        if after < before and after <= 0.0:
            if before > 0.0:
                return _root(course, reach, low, high)
            if low > 0.0:
                return low
        low, before = high, after
    return math.inf


@inlined
def meet_circle(course: Course, reach: float, span: float, min_speed: float, side: float) -> float:
    """Return when a point comes to a circle about the origin, up to ``span``, or infinity.

    From outside where ``side`` is 1, from within where it is -1; where it is on the other side, or on the
    circle, at once if it goes on there, or is driven there. Approaches no faster than ``min_speed`` [m/s] are
    ignored.
    """
    dx, dy, ux, uy, wx, wy = course
    height, rate = _height(course, reach, 0.0)
    min_rate = math.sqrt(dx * dx + dy * dy) * (ROUNDING * (abs(ux) + abs(uy)) + min_speed)
    if side * height <= 0.0 and side * rate < -min_rate:
        return 0.0
    if side > 0.0 and wx == 0.0 and wy == 0.0:
        # The chord, not |d|^2 |u|^2: it loses nothing when the speeds are large.
        cross, u2 = dx * uy - dy * ux, ux * ux + uy * uy
        square = reach * reach * u2 - cross * cross
        if rate >= -min_rate or square < 0.0:
            return math.inf
        return 2.0 * height / (math.sqrt(square) - rate)
    bend = ux * ux + uy * uy + dx * wx + dy * wy
    if side * height <= 0.0 and side * rate <= 0.0 and side * bend < 0.0:
        return 0.0  # at rest there, and pressed on
    return _first_crossing(course, reach, span, height, side)


@inlined
def cross_line(gap: float, speed: float, pull: float, seam: float, min_rate: float) -> float:
    """Return when a line is crossed from outside; infinity for a body beyond it, which does not cross it."""
    # It would have to come out before it can come in again.
    comes_out = speed > 0.0 and pull < 0.0 and speed * speed > 2.0 * pull * gap
    if gap < -seam and not comes_out:
        return math.inf
    return meet_line(gap, speed, pull, min_rate)
