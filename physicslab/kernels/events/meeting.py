"""When shapes meet that do not turn against each other and move under constant accelerations.

B's place against A is d + u t + w t^2 / 2. Two shapes meet at the first t >= 0 at which they touch or overlap
*and* approach: a pair that has just bounced does not meet again, however its gap was rounded. Times are
roots of polynomials: of second degree for straight outlines, and for round ones where the relative
acceleration is zero; else of fourth degree, found between the extrema, so that none is stepped over.
"""

import math

from physicslab.kernels import inlined

__all__ = ["box_normal", "meet_box_box", "meet_circle_box", "meet_circle_circle", "meet_line"]

_ROUNDING = 1e-14
"""Share of a speed, or of a length, that rounding may have made."""
_SEAM = 1e-12
"""Share of the size by which a side is taken as longer than it is: where side and corner join, no gap is
left."""


@inlined
def meet_line(gap: float, speed: float, pull: float, least: float) -> float:
    """Return the first t >= 0 at which gap + speed t + pull t^2 / 2 is <= 0 and decreases, or infinity.

    Rates of at least -``least`` count as zero. Squares of numbers other than zero must not underflow.
    """
    square = speed * speed - 2.0 * pull * gap
    if speed < -least:
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
def _height(
    dx: float, dy: float, ux: float, uy: float, wx: float, wy: float, reach: float, t: float
) -> tuple[float, float]:
    """Return (|d(t)|^2 - reach^2) / 2 and its rate."""
    x, y = dx + t * (ux + 0.5 * t * wx), dy + t * (uy + 0.5 * t * wy)
    distance = math.sqrt(x * x + y * y)
    return 0.5 * (distance - reach) * (distance + reach), x * (ux + t * wx) + y * (uy + t * wy)


@inlined
def _rate(dx: float, dy: float, ux: float, uy: float, wx: float, wy: float, t: float) -> tuple[float, float]:
    """Return the rate of |d(t)|^2 / 2 and its derivative."""
    x, y = dx + t * (ux + 0.5 * t * wx), dy + t * (uy + 0.5 * t * wy)
    vx, vy = ux + t * wx, uy + t * wy
    return x * vx + y * vy, vx * vx + vy * vy + x * wx + y * wy


@inlined
def _root(
    dx: float, dy: float, ux: float, uy: float, wx: float, wy: float, reach: float, low: float, high: float,
) -> float:  # fmt: skip
    """Return where |d|^2 - reach^2 crosses zero between ``low`` and ``high``, or its rate if reach < 0.

    The signs differ at the ends. Newton's step where it stays between them and shrinks fast, else half-way.
    """
    rising = (
        _rate(dx, dy, ux, uy, wx, wy, high)[0] > 0.0
        if reach < 0.0
        else _height(dx, dy, ux, uy, wx, wy, reach, high)[0] > 0.0
    )
    t = 0.5 * (low + high)
    for k in range(200):
        value, slope = (
            _rate(dx, dy, ux, uy, wx, wy, t) if reach < 0.0 else _height(dx, dy, ux, uy, wx, wy, reach, t)
        )
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
def _extrema(
    dx: float, dy: float, ux: float, uy: float, wx: float, wy: float, span: float
) -> tuple[float, float, float]:
    """Return three times within ``span`` at which |d| is extremal, in order; ``span`` if there are fewer."""
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
    low, before = 0.0, _rate(dx, dy, ux, uy, wx, wy, 0.0)[0]
    for k in range(3):
        high = first if k == 0 else (second if k == 1 else span)
        after = _rate(dx, dy, ux, uy, wx, wy, high)[0]
        if high > low and (before > 0.0) != (after > 0.0):
            t = _root(dx, dy, ux, uy, wx, wy, -1.0, low, high)
            if t1 == span:
                t1 = t
            elif t2 == span:
                t2 = t
            else:
                t3 = t
        low, before = high, after
    return t1, t2, t3


@inlined
def meet_circle_circle(
    dx: float, dy: float, ux: float, uy: float, wx: float, wy: float, reach: float, span: float,
    min_speed: float,
) -> float:  # fmt: skip
    """Return when the centres of two circles come within ``reach``, up to ``span``, or infinity.

    Here and below, approaches no faster than ``min_speed`` [m/s] are ignored.
    """
    height, rate = _height(dx, dy, ux, uy, wx, wy, reach, 0.0)
    distance = math.sqrt(dx * dx + dy * dy)
    least = distance * (_ROUNDING * (abs(ux) + abs(uy)) + min_speed)
    if height <= 0.0 and rate < -least:
        return 0.0
    if wx == 0.0 and wy == 0.0:
        # The chord, not |d|^2 |u|^2: it loses nothing when the speeds are large.
        cross, u2 = dx * uy - dy * ux, ux * ux + uy * uy
        square = reach * reach * u2 - cross * cross
        if rate >= -least or square < 0.0:
            return math.inf
        return 2.0 * height / (math.sqrt(square) - rate)
    if height <= 0.0 and rate <= 0.0 and ux * ux + uy * uy + dx * wx + dy * wy < 0.0:
        return 0.0  # at rest on each other, and pressed together
    t1, t2, t3 = _extrema(dx, dy, ux, uy, wx, wy, span)
    low, before = 0.0, height
    for k in range(4):
        high = t1 if k == 0 else (t2 if k == 1 else (t3 if k == 2 else span))
        if high <= low:
            continue
        after = _height(dx, dy, ux, uy, wx, wy, reach, high)[0]
        if after < before and after <= 0.0:
            if before > 0.0:
                return _root(dx, dy, ux, uy, wx, wy, reach, low, high)
            if low > 0.0:
                return low  # it turns before the two have come apart
        low, before = high, after
    return math.inf


@inlined
def _falling(gap: float, speed: float, pull: float, size: float, least: float) -> float:
    """Return when a line is crossed from outside; infinity for a body beyond it, which does not cross it."""
    # It would have to come out before it can come in again.
    comes_out = speed > 0.0 and pull < 0.0 and speed * speed > 2.0 * pull * gap
    if gap < -_SEAM * size and not comes_out:
        return math.inf
    return meet_line(gap, speed, pull, least)


@inlined
def meet_circle_box(
    px: float, py: float, qx: float, qy: float, wx: float, wy: float,
    half_x: float, half_y: float, radius: float, span: float, min_speed: float,
) -> float:  # fmt: skip
    """Return when a circle meets a box, up to ``span``, or infinity; all in the frame of the box."""
    size = half_x + half_y + radius
    least = _ROUNDING * (abs(qx) + abs(qy)) + min_speed
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
        if speed < -least:
            return 0.0
        if pull < 0.0 and speed * speed < -2.0 * pull * (radius - out):
            return max(speed, 0.0) / -pull
    best = math.inf
    for k in range(2):
        sign = 1.0 - 2.0 * k
        t = _falling(sign * px - half_x - radius, sign * qx, sign * wx, size, least)
        if t < best and abs(py + t * (qy + 0.5 * t * wy)) <= half_y + _SEAM * size:
            best = t
        t = _falling(sign * py - half_y - radius, sign * qy, sign * wy, size, least)
        if t < best and abs(px + t * (qx + 0.5 * t * wx)) <= half_x + _SEAM * size:
            best = t
    if out <= radius + _SEAM * size and min(out_x, out_y) == 0.0 and best == 0.0:
        return best
    for k in range(4):
        corner_x = half_x if k < 2 else -half_x
        corner_y = half_y if k % 2 == 0 else -half_y
        horizon = min(best, span)
        t = meet_circle_circle(px - corner_x, py - corner_y, qx, qy, wx, wy, radius, horizon, min_speed)
        if t < best:
            x, y = px + t * (qx + 0.5 * t * wx), py + t * (qy + 0.5 * t * wy)
            beyond_x = (x - corner_x) * math.copysign(1.0, corner_x) >= -_SEAM * size
            if beyond_x and (y - corner_y) * math.copysign(1.0, corner_y) >= -_SEAM * size:
                best = t
    return best


@inlined
def meet_box_box(
    dx: float, dy: float, ux: float, uy: float, wx: float, wy: float,
    ca: float, sa: float, cb: float, sb: float, ax: float, ay: float, bx: float, by: float,
    min_speed: float,
) -> tuple[float, int]:  # fmt: skip
    """Return when two boxes meet and which of eight normals then leads from A to B, or infinity and -1.

    Normals 0 to 3 are A's (+x, +y, -x, -y), 4 to 7 B's. In the plane of d, the two overlap within a convex
    outline of up to eight sides; they meet where d first crosses one of them while it is within the others.
    """
    best, face = math.inf, -1
    size = ax + ay + bx + by
    least = _ROUNDING * (abs(ux) + abs(uy)) + min_speed
    gap, nearest = -math.inf, -1
    for k in range(8):
        nx, ny, reach = box_normal(k, ca, sa, cb, sb, ax, ay, bx, by)
        apart = dx * nx + dy * ny - reach
        if apart > gap:
            gap, nearest = apart, k
    if gap <= 0.0:
        nx, ny, _ = box_normal(nearest, ca, sa, cb, sb, ax, ay, bx, by)
        speed, pull = ux * nx + uy * ny, wx * nx + wy * ny
        if speed < -least:
            return 0.0, nearest
        if pull < 0.0 and speed * speed < -2.0 * pull * -gap:
            return max(speed, 0.0) / -pull, nearest
    for k in range(8):
        nx, ny, reach = box_normal(k, ca, sa, cb, sb, ax, ay, bx, by)
        apart = dx * nx + dy * ny - reach
        t = _falling(apart, ux * nx + uy * ny, wx * nx + wy * ny, size, least)
        if t >= best:
            continue
        x, y = dx + t * (ux + 0.5 * t * wx), dy + t * (uy + 0.5 * t * wy)
        within = True
        for j in range(8):
            mx, my, limit = box_normal(j, ca, sa, cb, sb, ax, ay, bx, by)
            within = within and (j == k or x * mx + y * my - limit <= _SEAM * size)
        if within:
            best, face = t, k
    return best, face


@inlined
def box_normal(
    k: int, ca: float, sa: float, cb: float, sb: float, ax: float, ay: float, bx: float, by: float
) -> tuple[float, float, float]:
    """Return normal k of two boxes, and how far apart along it their centres are when they touch."""
    c, s = (ca, sa) if k < 4 else (cb, sb)
    turn_c, turn_s = abs(ca * cb + sa * sb), abs(ca * sb - sa * cb)
    upright = k % 2 == 1
    if k < 4:
        reach = ay + turn_s * bx + turn_c * by if upright else ax + turn_c * bx + turn_s * by
    else:
        reach = by + turn_s * ax + turn_c * ay if upright else bx + turn_c * ax + turn_s * ay
    sign = 1.0 if k % 4 < 2 else -1.0
    return (-sign * s if upright else sign * c), (sign * c if upright else sign * s), reach
