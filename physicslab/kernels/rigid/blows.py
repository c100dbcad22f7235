"""Impacts of rigid bodies: the impulses of all points that approach at one time, with friction.

Points that approach at the same time are resolved together: each leaves with e times its approach
(Newton), and its tangential impulse is what stops the sliding, at most mu times the normal one. Those that
approach because of that come in the next round, so that a row of touching discs passes an impulse on.
Inelastic ones take all inelastic contacts that touch with them. Where Newton's law would make energy, as
it can where a body sticks with one end and pivots, Stronge's law takes over; there is none for several
points at once, and their restitutions are lowered until no energy is made.
"""

import math

from physicslab.kernels import Numbers, Rows, fused, inlined
from physicslab.kernels.energetic import energetic_blow
from physicslab.kernels.records import Impacts
from physicslab.kernels.rigid.complementarity import NOT_FOUND, solve_complementarity
from physicslab.kernels.rigid.constraints import apply, assemble, measure_all
from physicslab.kernels.rigid.equations import FREE, SLIDES_ON, STICKS, UNKNOWN, Equations
from physicslab.kernels.rigid.features import (
    GAP,
    GIVEN,
    MEASURES,
    MU,
    NX,
    NY,
    ONE,
    PAIR,
    POINT_FIELDS,
    PX,
    PY,
    RESTITUTION,
    VN,
    VT,
    Scene,
)

__all__ = ["approaches", "resolve_blows"]

_MAX_ROUNDS, _SHORT_ROUNDS = 500, 3
"""Rounds of impacts at one time, and within a short step; after them all points that touch are inelastic."""
_NOISE = 1e-4
"""Share of the speed that counts as none up to which an approach is rounding."""
_SPEEDS = 100.0
"""Multiple of the speed that counts as none that impulses are measured by: smaller ones go by rounding."""
_TRIALS = 60
"""Trials for the restitution that keeps the energy."""


@inlined
def approaches(speed: float, rest: float) -> bool:
    """Whether a point approaches faster than rounding; ``rest`` is the speed that counts as none [m/s]."""
    return speed < -_NOISE * rest


@inlined
def _take(equations: Equations, i: int, blow: Equations, n: int, restitution: float) -> int:
    for k in range(POINT_FIELDS):
        blow.points[n, k] = equations.points[i, k]
    for k in range(MEASURES):
        blow.measures[n, k] = equations.measures[i, k]
    blow.measures[n, RESTITUTION] = restitution
    blow.points[n, GIVEN] = STICKS if blow.measures[n, MU] > 0.0 else SLIDES_ON
    return n + 1


@inlined
def _closing_speed(equations: Equations, i: int, rate: float) -> float:
    """Return how fast a point moves along its normal beyond what its gap allows in 1 / ``rate`` seconds."""
    speed: float = equations.measures[i, VN] + max(equations.measures[i, GAP], 0.0) * rate
    return speed


@fused
def _gather(
    equations: Equations, count: int, blow: Equations, rest: float, rate: float, last: bool
) -> tuple[int, bool]:
    """Take the points that approach, and inelastic ones that rest.

    Returns how many they are, and whether any approaches.
    """
    n, approaching = 0, False
    for i in range(count):
        e, speed = equations.measures[i, RESTITUTION], equations.measures[i, VN]
        bounces = -e * speed > rest and not last
        # One that bounces in a short step does so before half of the next would take it below the surface.
        closing = _closing_speed(equations, i, rate / (2.0 - e) if bounces else rate)
        if approaches(closing, rest):
            approaching = True
            n = _take(equations, i, blow, n, e if bounces else 0.0)
        elif closing <= rest and (e == 0.0 or last):
            n = _take(equations, i, blow, n, 0.0)
    return n, approaching


@fused
def _solve(blow: Equations, n: int, share: float, rest: float, rate: float) -> bool:
    """Find the impulses at ``share`` of the restitutions; return whether there are any."""
    for i in range(n):
        back = share * blow.measures[i, RESTITUTION] * min(blow.measures[i, VN], 0.0)
        blow.vectors[FREE, 2 * i] = (
            blow.measures[i, VN] + back if back < 0.0 else _closing_speed(blow, i, rate)
        )
        blow.vectors[FREE, 2 * i + 1] = blow.measures[i, VT]
    return solve_complementarity(blow, n, _SPEEDS * rest, rate == 0.0) != NOT_FOUND


@fused
def _energy_gained(blow: Equations, n: int) -> tuple[float, float]:
    """Return the work of the impulses, and the sum of the magnitudes of its parts [J]."""
    work, scale = 0.0, 0.0
    for i in range(n):
        for k in range(2):
            before = blow.measures[i, VN + k]
            after = before
            for j in range(2 * n):
                after += blow.a[2 * i + k, j] * blow.vectors[UNKNOWN, j]
            part = 0.5 * blow.vectors[UNKNOWN, 2 * i + k] * (before + after)
            work += part
            speed = abs(blow.measures[i, VN]) + abs(blow.measures[i, VT])
            scale += abs(blow.vectors[UNKNOWN, 2 * i + k]) * speed
    return work, scale


@fused
def _solve_by_energy(blow: Equations) -> None:
    """Find the impulses of a single point by Stronge's law."""
    a, measures = blow.a, blow.measures
    blow.vectors[UNKNOWN, 0], blow.vectors[UNKNOWN, 1] = energetic_blow(
        a[0, 0], a[1, 1], a[0, 1], measures[0, VN], measures[0, VT], measures[0, RESTITUTION], measures[0, MU]
    )


@fused
def _find_impulses(blow: Equations, n: int, rest: float, rate: float) -> tuple[bool, int, int]:
    """Find the impulses, by Stronge's law or with restitutions lowered where Newton's would make energy.

    Returns whether there are any, how many obey Stronge's law, and how often restitutions were lowered.
    """
    low, high, work_low, work_high, share, side = 0.0, 1.0, 0.0, 0.0, 1.0, 0
    for trial in range(_TRIALS):
        solved = _solve(blow, n, share, rest, rate)
        work, scale = _energy_gained(blow, n)
        if trial == 0 and solved and work <= 1e-13 * scale:
            return True, 0, 0
        if trial == 0 and n == 1 and blow.measures[0, RESTITUTION] > 0.0:
            _solve_by_energy(blow)
            return True, 1, 0
        if trial == 1 or (solved and work <= 0.0):
            low, work_low = share, work
            if not solved or work >= -1e-13 * scale or high - low <= 1e-13 or trial == _TRIALS - 1:
                return solved, 0, 1
            work_high *= 0.5 if side == -1 else 1.0
            side = -1
        else:
            high, work_high = share, work if solved else math.inf
            work_low *= 0.5 if side == 1 else 1.0
            side = 1
        # By regula falsi with the Illinois rule, and by bisection where there is no solution above.
        share = 0.5 * (low + high) if work_high == math.inf else low
        if work_high > 0.0 and work_high < math.inf:
            share = (low * work_high - high * work_low) / (work_high - work_low)
        if trial == 0:
            share = 0.0
        elif high - low <= 1e-13 or trial == _TRIALS - 2:
            share = low
    return False, 0, 1


@fused
def _write(
    scene: Scene, blow: Equations, n: int, rest: float, entities: Rows, log: Impacts, logged: int, time: float
) -> int:
    """Write a round of impacts to the log; return how many pairs they were."""
    written, written_pair = 0, -1
    for i in range(n):
        if blow.vectors[UNKNOWN, 2 * i] <= 0.0 or blow.measures[i, VN] >= -rest:
            continue
        pair = blow.points[i, PAIR]
        same = i > 0 and blow.points[i - 1, PAIR] == pair and written_pair == pair
        if not same:
            written += 1
            written_pair = pair
        if len(log) == 0:
            continue
        record = log[(logged + written - 1) % len(log)]
        a, b = scene.pairs[pair, 0], scene.pairs[pair, 1]
        sign = 1.0 if blow.points[i, ONE] == a else -1.0
        if same:
            record.normal_impulse += blow.vectors[UNKNOWN, 2 * i]
            record.tangent_impulse += blow.vectors[UNKNOWN, 2 * i + 1]
            record.approach_speed = max(record.approach_speed, -blow.measures[i, VN])
            continue
        record.time, record.wall = time, scene.pairs[pair, 2]
        record.entity_a, record.entity_b = entities[a] if scene.pairs[pair, 2] < 0 else 0, entities[b]
        record.normal_x, record.normal_y = sign * blow.measures[i, NX], sign * blow.measures[i, NY]
        record.x, record.y = blow.measures[i, PX], blow.measures[i, PY]
        record.approach_speed = -blow.measures[i, VN]
        record.normal_impulse, record.tangent_impulse = (
            blow.vectors[UNKNOWN, 2 * i],
            blow.vectors[UNKNOWN, 2 * i + 1],
        )
    return written


@fused
def resolve_blows(
    scene: Scene, equations: Equations, count: int, blow: Equations, q: Numbers, v: Numbers, rest: float,
    rate: float, entities: Rows, log: Impacts, logged: int, time: float,
) -> tuple[int, bool, int, int, int, int]:  # fmt: skip
    """Let all points that approach faster than ``rest`` bounce, until none does.

    Those that do not bounce may use up their gap in 1 / ``rate`` seconds. Returns how many impacts there
    were, whether each could be resolved, how many obeyed Stronge's law, how often restitutions were lowered,
    how many points the last impulses act at, and how many rounds there were.
    """
    impacts, energetic, lowered, last = 0, 0, 0, 0
    most = _SHORT_ROUNDS if rate > 0.0 else _MAX_ROUNDS
    for turn in range(most + 2):
        measure_all(scene, equations, count, q, v)
        n, approaching = _gather(equations, count, blow, rest, rate, turn >= most)
        if not approaching:
            return impacts, True, energetic, lowered, last, turn
        assemble(scene, blow, n)
        solved, by_energy, less = _find_impulses(blow, n, rest, rate)
        if not solved:
            return impacts, False, energetic, lowered, last, turn
        energetic, lowered, last = energetic + by_energy, lowered + less, n
        impacts += _write(scene, blow, n, rest, entities, log, logged + impacts, time)
        apply(scene, blow, n, v)
    return impacts, True, energetic, lowered, last, most
