"""The end of a smooth segment of motion: functions that fall below zero, and when the first of them does."""

import math

from physicslab.kernels import Numbers, Vectors, always_inlined, inlined
from physicslab.kernels.ode.dop853_tableau import LAST
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid.constraints import constrained_acceleration, rates_without_forces
from physicslab.kernels.rigid.curve import curve_is_exact, fit_curve, place_bodies, place_on_curve
from physicslab.kernels.rigid.detect import TIE
from physicslab.kernels.rigid.equations import SLIDES_ON, STICKS, UNKNOWN, Equations
from physicslab.kernels.rigid.features import RigidScene
from physicslab.kernels.rigid.joint_points import measure
from physicslab.kernels.rigid.passing import time_apart
from physicslab.kernels.rigid.smooth_segment import SHORT_LAST, Stages, make_segment
from physicslab.kernels.rigid.touching import NO_SPEED, SLOW, find_open, moved_closer

PRESSES, HOLDS, SLIDES, REACHES, APART = 0, 1, 2, 3, 4
"""Quantities that must stay positive: a normal force, the rest of the friction cone, a sliding speed, the
distance to the end of a feature, a gap."""
_CLEAR, ALLOWED, FASTEST, _CLEAR_AFTER, STARTS = 5, 6, 7, 8, 9
"""The rows of what is noted at a start that hold how far pairs are apart at least, how far they may come
together, and how fast at most [m/s]; how far they are apart at least at the end; the number of rows."""
_CLOSED = 1e-13
"""Share of a size by which a gap may change by rounding."""
_NO_FORCE = 1e-9
"""Share of the largest force that is rounding."""
_SIZE_ROUNDING = 1e-14
"""Share of a size that is rounding."""
_HALVINGS = 40
"""How often a segment is halved to find a time at which a point that has bounced is above the other body."""
_TRIALS = 120
"""Largest number of trials to locate an event."""
_STEEP = 1e-7
"""Share of a segment below which rounding may be most of a slope."""
_LOCATED = 1e-13
"""Share of a segment by which its end may be past the event, and to which that is located on its curve."""
_BY_SLOPE = 6
"""Trials that follow the slope of the curve; later ones do without it."""
_LOOKS = 64
"""Largest number of moments at which a pair is looked at that may meet and part within a segment."""
_KEPT_Q, _KEPT_V = LAST + 2, LAST + 3
"""Rows of the pushes that keep a state while others are looked at."""
_CUTS = 16
"""Largest number of times that an event is found to come after another one."""


@inlined
def _value(
    kind: int, index: int, scene: RigidScene, equations: Equations, count: int, scratch: Equations,
    q: Numbers, v: Numbers,
) -> float:  # fmt: skip
    """Return what must stay positive, of a point that is measured in the state or of a pair."""
    if kind == APART:
        _, gap, _ = find_open(scene, equations, count, scratch, index, q, v)
        return gap
    value: float = equations.measures[index, F.MARGIN]
    if kind <= HOLDS:
        value = equations.vectors[UNKNOWN, 2 * index]
        if kind == HOLDS:
            rubbing = abs(equations.vectors[UNKNOWN, 2 * index + 1])
            value = equations.measures[index, F.MU] * value - rubbing
    elif kind == SLIDES:
        sliding = equations.measures[index, F.VT]
        value = sliding if equations.points[index, F.STATUS] == SLIDES_ON else -sliding
    return value


@inlined
def _time_to_fall(height: float, speed: float, acceleration: float) -> float:
    """Return when a height that changes at an even rate is zero [s]."""
    if acceleration >= 0.0 and speed >= 0.0:
        return math.inf
    root = speed * speed - 2.0 * acceleration * height
    if root < 0.0:
        return math.inf
    if speed < 0.0:
        return 2.0 * height / (math.sqrt(root) - speed)
    return (speed + math.sqrt(root)) / -acceleration


@always_inlined
def note_start(
    scene: RigidScene, equations: Equations, count: int, scratch: Equations, q: Numbers, v: Numbers,
    acceleration: Numbers, start: Vectors,
) -> float:  # fmt: skip
    """Note all functions at the start of a segment, and distances of pairs.

    ``start`` is (STARTS, points or pairs).
    Returns when the first gap would close if all went on as it begins [s].
    """
    soonest = math.inf
    for kind in range(APART):
        for i in range(count):
            start[kind, i] = _value(kind, i, scene, equations, count, scratch, q, v)
    for p in range(len(scene.pairs)):
        n, start[APART, p], start[_CLEAR, p] = find_open(scene, equations, count, scratch, p, q, v)
        for k in range(n):
            height = max(scratch.measures[k, F.GAP], _CLOSED * scene.coefficients[p, 2])
            opening, _ = rates_without_forces(scene, scratch, k, acceleration)
            soonest = min(soonest, _time_to_fall(height, scratch.measures[k, F.VN], opening))
    return soonest


@inlined
def _can_end(kind: int, i: int, equations: Equations) -> bool:
    """Whether a function can end the segment."""
    if kind in (HOLDS, SLIDES):
        sticks: bool = equations.points[i, F.STATUS] == STICKS
        rubs: bool = equations.measures[i, F.MU] > 0.0
        return sticks if kind == HOLDS else rubs and not sticks
    return True


@inlined
def _allowance(
    kind: int, i: int, scene: RigidScene, equations: Equations, start: float, rest: float
) -> float:
    """Return how far a function may fall that begins at zero: by as much as is treated as zero.

    A corner at the end of a face is on it as long as both are level.
    """
    if kind == SLIDES:
        return SLOW * rest if start <= SLOW * rest else 0.0
    if kind < REACHES:
        return 0.0
    size, least = scene.coefficients[i if kind == APART else equations.points[i, F.PAIR], 2], _CLOSED
    if kind == REACHES:
        radius, points = scene.shapes.radius, equations.points
        least = _CLOSED if radius[points[i, F.ONE]] + radius[points[i, F.OTHER]] > 0.0 else 2.0 * TIE
    allowance: float = least * size - min(start, 0.0) if start <= least * size else 0.0
    return allowance


@inlined
def _noise(kind: int, index: int, scene: RigidScene, equations: Equations, rest: float) -> float:
    """Return by how much rounding may change a function."""
    if kind <= HOLDS:
        force: float = abs(equations.vectors[UNKNOWN, 2 * index])
        return _NO_FORCE * force
    if kind == SLIDES:
        return NO_SPEED * rest
    size: float = scene.coefficients[index if kind == APART else equations.points[index, F.PAIR], 2]
    return _SIZE_ROUNDING * size


@inlined
def _first_event(
    scene: RigidScene, equations: Equations, count: int, scratch: Equations, start: Vectors, stages: Stages,
    q: Numbers, rest: float, last_kind: int, last: int,
) -> tuple[int, int]:  # fmt: skip
    """Return which function fell below zero first within the segment: kind and index, -1 if none did.

    One is left out: that at which the segment was cut.
    """
    first_kind, first, earliest, force = -1, -1, math.inf, 0.0
    for i in range(count):
        force = max(force, max(equations.vectors[UNKNOWN, 2 * i], start[PRESSES, i]))
    for kind in range(5):
        for i in range(len(scene.pairs) if kind == APART else count):
            before = start[kind, i]
            if kind == APART:
                start[_CLEAR_AFTER, i] = math.inf
                if start[_CLEAR, i] > moved_closer(scene, i, q, stages.q):
                    continue
            if (kind == last_kind and i == last) or not _can_end(kind, i, equations):
                continue
            allowance = _allowance(kind, i, scene, equations, before, rest)
            if kind == APART:
                _, after, clear = find_open(scene, equations, count, scratch, i, stages.q, stages.v)
                start[_CLEAR_AFTER, i] = clear
            else:
                after = _value(kind, i, scene, equations, count, scratch, stages.q, stages.v)
            after += allowance
            if after < (-_NO_FORCE * force if kind <= HOLDS else 0.0):
                before = max(before + allowance, 0.0)
                if before / (before - after) < earliest:
                    first_kind, first, earliest = kind, i, before / (before - after)
    return first_kind, first


@inlined
def _first_meeting(
    scene: RigidScene, equations: Equations, count: int, scratch: Equations, start: Vectors, stages: Stages,
    q: Numbers, v: Numbers, h: float, end: float, fitted: bool, short: bool,
) -> tuple[int, float]:  # fmt: skip
    """Return which pair meets first before the ``end`` of a segment, at which it is apart: -1 if none does.

    And a time at which it overlaps [s]. So do corners that sweep past each other. A pair cannot meet before
    it has come as far as it is apart: at its highest speed, or along the way between its points.
    """
    index, met, kept_q, kept_v = -1, end, stages.pushes[_KEPT_Q], stages.pushes[_KEPT_V]
    looked, last_stage = False, SHORT_LAST if short else LAST
    for p in range(len(scene.pairs)):
        clear, after, rate = start[_CLEAR, p], start[_CLEAR_AFTER, p], start[FASTEST, p]
        is_row, met_before = scene.pairs[p, 2] >= F.FIRST_ROW, clear <= TIE * scene.coefficients[p, 2]
        if is_row or met_before or not math.isfinite(after) or not clear + after < rate * met:
            continue
        if not looked:
            looked = True
            for i in range(len(q)):
                kept_q[i], kept_v[i] = stages.q[i], stages.v[i]
            if not fitted:
                fit_curve(stages, v, h, short)
        t, last, a, b = 0.0, min(met, end - max(after, 0.0) / rate), scene.pairs[p, 0], scene.pairs[p, 1]
        while t < last:  # which it is not where a push was not finite
            place_bodies(stages, q, v, h, t, scene.rows, a, b)
            n, gap, clear = find_open(scene, equations, count, scratch, p, stages.q, stages.v)
            if gap < 0.0 or clear == -math.inf:
                index, met = (p, t) if gap < 0.0 else (index, met)
                break
            apart = max(clear / rate, end / _LOOKS)
            if n > 0:
                nx, ny = scratch.measures[0, F.NX], scratch.measures[0, F.NY]
                apart = max(
                    apart, time_apart(scene, a, b, stages.q, stages.v, nx, ny, clear, stages, last_stage)
                )
            t += apart
    if looked and index < 0:
        for i in range(len(q)):
            stages.q[i], stages.v[i] = kept_q[i], kept_v[i]
    return index, met


@always_inlined
def _cross(
    on_curve: bool, kind: int, index: int, scene: RigidScene, equations: Equations, count: int,
    scratch: Equations, stages: Stages, q: Numbers, v: Numbers, h: float, t: float, end: float, slope: float,
    f_low: float, allowance: float, noise: float, tolerance: float,
) -> tuple[float, float, bool, int]:  # fmt: skip
    """Find where a function falls below zero, from ``t`` on and before ``end``, in a segment of ``h`` [s].

    On its curve, or by segments that end there. By the slope where one is given, then by regula falsi with
    the Illinois rule, and by bisection where that is slow. Returns the time, just past it; the slope; whether
    it falls below zero at all; how many trials there were. The state is left in ``stages``.
    """
    low, high, f_high, side, wide = 0.0, end, slope * (end - t), 0, math.inf
    moment = _LOCATED * h
    depth, past, last = noise - slope * moment, -math.inf, _TRIALS - 1
    if kind == APART:
        one, other = scene.pairs[index, 0], scene.pairs[index, 1]
    else:
        one, other = equations.points[index, F.ONE], equations.points[index, F.OTHER]
    # A point that has just bounced begins at nothing and rises: the fall back is looked for after that.
    rising = _HALVINGS if on_curve and kind == APART and f_low <= 0.0 else 0
    for trial in range(_TRIALS):
        near = high - low <= moment or past >= -noise or trial == last
        located = on_curve and trial > 0 and rising == 0 and near
        if on_curve:
            t = high if located else t
            if located or kind <= HOLDS:
                place_on_curve(stages, q, v, h, t)
                constrained_acceleration(scene, equations, count, stages.q, stages.v, stages.acceleration)
            else:
                place_bodies(stages, q, v, h, t, scene.rows, one, other)
                if kind < APART:
                    measure(scene, equations.points, index, stages.q, stages.v, equations.measures)
        else:
            make_segment(scene, equations, count, q, v, t, tolerance, stages)
        f = _value(kind, index, scene, equations, count, scratch, stages.q, stages.v) + allowance
        if f <= 0.0:
            high, f_high, past, rising = t, f, f, max(rising - 1, 0)
            f_low *= 0.5 if side == -1 else 1.0
            side = -1
        else:
            low, f_low, rising = t, f, 0
            f_high *= 0.5 if side == 1 else 1.0
            side = 1
        if not on_curve:
            located = t == end or (f <= 0.0 and (f >= -depth or high - low <= moment))
        elif high - low > _STEEP * h:
            slope = (f_high - f_low) / (high - low)
        if located or trial == last:
            return t, slope, f <= 0.0, trial + 1
        if not on_curve and slope < 0.0 and trial < _BY_SLOPE and high - low > moment:
            t -= (f + 0.5 * depth) / slope
        elif rising > 0 or high - low <= moment:
            t = 0.5 * high if rising > 0 else high
        else:
            t = high - f_high * (high - low) / (f_high - f_low)
        if t != high and (not (low < t < high) or (high - low > 0.5 * wide and rising == 0)):
            t = 0.5 * (low + high)
            t = t if low < t < high else high
        wide = high - low if trial % 2 == 1 and (on_curve or trial >= _BY_SLOPE) else wide
    return t, slope, False, _TRIALS


@always_inlined
def locate_event(
    scene: RigidScene, equations: Equations, count: int, scratch: Equations, start: Vectors, stages: Stages,
    q: Numbers, v: Numbers, h: float, tolerance: float, rest: float, short: bool,
) -> tuple[float, int, int, int]:  # fmt: skip
    """Cut a segment that was made of ``h`` seconds where its first event is, if there is one in it.

    Returns its length, kind and index of the event, -1 if there is none, and how many segments were made. The
    event is found on the curve of the segment. Where the curve is not exact, segments of other lengths then
    locate it to rounding; but a ``short`` one, whose length is then returned as -1, has to be made again.
    """
    kind, index, slope, at, end, f_low, allowance, exact = -1, -1, 0.0, h, h, 0.0, 0.0, False
    for cut in range(_CUTS + 1):
        next_kind, next_index = _first_event(
            scene, equations, count, scratch, start, stages, q, rest, kind, index
        )
        if next_kind < 0:
            next_index, met = _first_meeting(
                scene, equations, count, scratch, start, stages, q, v, h, at, cut > 0, short
            )
            if next_index >= 0:
                next_kind, at = APART, met
        if cut == 0 and (short or next_kind >= 0):
            fit_curve(stages, v, h, short)
            exact = curve_is_exact(scene, equations, count, q, v, h, tolerance, stages)
            if short and not exact:
                return -1.0, kind, index, 0
        on_curve = next_kind >= 0 and cut < _CUTS
        if on_curve:
            kind, index, end, slope = next_kind, next_index, at, 0.0
            allowance = _allowance(kind, index, scene, equations, start[kind, index], rest)
            f_low = max(start[kind, index] + allowance, 0.0)
        elif kind < 0 or (exact and next_kind < 0):
            if kind < 0 and short:
                place_on_curve(stages, q, v, h, h)
            return at, kind, index, 0
        noise = _noise(kind, index, scene, equations, rest)
        at, slope, found, trials = _cross(
            on_curve, kind, index, scene, equations, count, scratch, stages, q, v, h, at, end, slope, f_low,
            allowance, noise, tolerance,
        )  # fmt: skip
        if not on_curve:
            break
    return at, kind if found else -1, index, trials
