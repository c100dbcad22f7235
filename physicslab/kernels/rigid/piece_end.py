"""What ends a smooth piece of motion: functions that fall below zero, and when the first of them does."""

import math

from physicslab.kernels import Numbers, Vectors, fused, inlined
from physicslab.kernels.rigid.equations import SLIDES_ON, STICKS, UNKNOWN, Equations
from physicslab.kernels.rigid.features import MARGIN, MU, STATUS, VT, Scene
from physicslab.kernels.rigid.pieces import Stages, make_piece
from physicslab.kernels.rigid.touching import open_gap

__all__ = ["APART", "HOLDS", "PRESSES", "REACHES", "SLIDES", "cut_at_first_event", "note_start"]

PRESSES, HOLDS, SLIDES, REACHES, APART = 0, 1, 2, 3, 4
"""What must stay positive: a normal force, what is
left of the friction cone, a sliding speed, the distance to the end of a feature, a gap."""
_CLOSED = 1e-13
"""Share of a size by which a gap may change by rounding."""
_NO_FORCE = 1e-9
"""Share of the largest force that is rounding."""
_HALVINGS = 40
"""How often a piece is halved to find a time at which a point that has bounced is above the other body."""
_TRIALS = 80
"""Largest number of pieces that are made to locate an event."""
_CUTS = 16
"""Largest number of times that an event is found to come after another one."""


@inlined
def _value(
    kind: int, index: int, scene: Scene, equations: Equations, count: int, scratch: Equations,
    q: Numbers, v: Numbers,
) -> float:  # fmt: skip
    """Return what must stay positive, of a point that is measured in the state or of a pair."""
    pressing, rubbing = equations.vectors[UNKNOWN, 2 * index], equations.vectors[UNKNOWN, 2 * index + 1]
    value: float = equations.measures[index, MARGIN]
    if kind == APART:
        value = open_gap(scene, equations, count, scratch, index, q, v)
    elif kind == PRESSES:
        value = pressing
    elif kind == HOLDS:
        value = equations.measures[index, MU] * pressing - abs(rubbing)
    elif kind == SLIDES:
        sliding = equations.measures[index, VT]
        value = sliding if equations.points[index, STATUS] == SLIDES_ON else -sliding
    return value


@fused
def note_start(
    scene: Scene, equations: Equations, count: int, scratch: Equations, q: Numbers, v: Numbers, start: Vectors
) -> None:
    """Note all functions at the start of a piece: ``start`` (5, points or pairs)."""
    for kind in range(5):
        for i in range(len(scene.pairs) if kind == APART else count):
            start[kind, i] = _value(kind, i, scene, equations, count, scratch, q, v)


@inlined
def _can_end(kind: int, i: int, equations: Equations, start: float) -> bool:
    """Whether a function can end the piece."""
    sticks: bool = equations.points[i, STATUS] == STICKS
    if kind == HOLDS:
        return sticks
    if kind == SLIDES:
        rubs: bool = equations.measures[i, MU] > 0.0
        return rubs and not sticks
    return kind != REACHES or start > 0.0


@inlined
def _allowance(kind: int, i: int, scene: Scene, start: float, rest: float) -> float:
    """Return how far a function may fall that begins at nothing: by as much as counts as none."""
    if kind == SLIDES:
        return rest if start <= rest else 0.0
    if kind == APART and start <= _CLOSED * scene.coefficients[i, 2]:
        allowance: float = _CLOSED * scene.coefficients[i, 2] - min(start, 0.0)
        return allowance
    return 0.0


@inlined
def _first_event(
    scene: Scene, equations: Equations, count: int, scratch: Equations, start: Vectors, stages: Stages,
    rest: float, last_kind: int, last: int,
) -> tuple[int, int]:  # fmt: skip
    """Return which function fell below zero first within the piece: kind and index, -1 if none did.

    One is left out: that at which the piece was cut.
    """
    first_kind, first, earliest, force = -1, -1, math.inf, 0.0
    for i in range(count):
        force = max(force, max(equations.vectors[UNKNOWN, 2 * i], start[PRESSES, i]))
    for kind in range(5):
        for i in range(len(scene.pairs) if kind == APART else count):
            before = start[kind, i]
            if (kind == last_kind and i == last) or not _can_end(kind, i, equations, before):
                continue
            allowance = _allowance(kind, i, scene, before, rest)
            after = _value(kind, i, scene, equations, count, scratch, stages.q, stages.v) + allowance
            if after < (-_NO_FORCE * force if kind <= HOLDS else 0.0):
                before = max(before + allowance, 0.0)
                if before / (before - after) < earliest:
                    first_kind, first, earliest = kind, i, before / (before - after)
    return first_kind, first


@fused
def cut_at_first_event(
    scene: Scene, equations: Equations, count: int, scratch: Equations, start: Vectors, stages: Stages,
    q: Numbers, v: Numbers, h: float, tolerance: float, rest: float,
) -> tuple[float, int, int, int]:  # fmt: skip
    """Cut a piece that was made of ``h`` seconds where its first event is, if there is one in it.

    Returns its length, kind and index of the event, -1 if there is none, and how many pieces were made. The
    time is located to rounding, just past the event, by regula falsi with the Illinois rule, and by
    bisection where that is slow: each trial is a piece of its own.
    """
    kind, index, pieces = -1, -1, 0
    for _ in range(_CUTS):
        next_kind, next_index = _first_event(
            scene, equations, count, scratch, start, stages, rest, kind, index
        )
        if next_kind < 0:
            break
        kind, index = next_kind, next_index
        allowance = _allowance(kind, index, scene, start[kind, index], rest)
        low, high, side = 0.0, h, 0
        f_low = max(start[kind, index] + allowance, 0.0)
        f_high = _value(kind, index, scene, equations, count, scratch, stages.q, stages.v) + allowance
        # A point that has just bounced begins at nothing and rises: the fall back is looked for after that.
        rising = _HALVINGS if kind == APART and allowance > 0.0 else 0
        for trial in range(_TRIALS + rising):
            t = high - f_high * (high - low) / (f_high - f_low)
            if trial < rising:
                t = 0.5 * high
            elif not (low < t < high) or trial % 8 == 7:
                t = 0.5 * (low + high)
            finished = trial >= rising and (high - low <= 2e-16 * h or f_high == 0.0)
            if finished or not (low < t < high) or trial == _TRIALS + rising - 1:
                t = high
                finished = True
            make_piece(scene, equations, count, q, v, t, tolerance, stages)
            pieces += 1
            if finished:
                break
            f = _value(kind, index, scene, equations, count, scratch, stages.q, stages.v) + allowance
            if f <= 0.0:
                high, f_high = t, f
                if side == -1:
                    f_low *= 0.5
                side = -1
            else:
                low, f_low = t, f
                rising = min(rising, trial + 1)
                if side == 1:
                    f_high *= 0.5
                side = 1
        h = high
    return h, kind, index, pieces
