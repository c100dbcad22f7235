"""Impacts of rigid bodies: the impulses of all points that approach at one time, with friction.

Points that approach at the same time are resolved together: each leaves with e times its approach
(Newton), and its tangential impulse is what stops the sliding, at most mu times the normal one. Those that
approach because of that come in the next round, so that a row of touching discs passes an impulse on.
Inelastic ones take all inelastic contacts that touch with them. Where Newton's law would make energy, as
it can where a body sticks with one end and pivots, restitutions are lowered until it makes none.
"""

from physicslab.kernels import Numbers, Rows, fused, inlined
from physicslab.kernels.records import Impacts
from physicslab.kernels.rigid.complementarity import solve_complementarity
from physicslab.kernels.rigid.constraints import apply, assemble, measure_all
from physicslab.kernels.rigid.equations import FREE, SLIDES_ON, STICKS, UNKNOWN, Equations
from physicslab.kernels.rigid.features import (
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

_MAX_ROUNDS = 500
"""Rounds of impacts at one time; after them all points that touch are inelastic."""
_NOISE = 1e-4
"""Share of the speed that counts as none up to which an approach is rounding."""
_SPEEDS = 100.0
"""Multiple of the speed that counts as none that impulses are measured by: smaller ones go by rounding."""
_HALVINGS = 46
"""Bisections for the restitution that keeps the energy."""


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


@fused
def _gather(equations: Equations, count: int, blow: Equations, rest: float, last: bool) -> tuple[int, bool]:
    """Take the points that approach, and inelastic ones that rest.

    Returns how many they are, and whether any approaches.
    """
    n, approaching = 0, False
    for i in range(count):
        speed = equations.measures[i, VN]
        e = (
            0.0
            if last or -equations.measures[i, RESTITUTION] * speed <= rest
            else equations.measures[i, RESTITUTION]
        )
        if approaches(speed, rest):
            approaching = True
            n = _take(equations, i, blow, n, e)
        elif speed <= rest and (equations.measures[i, RESTITUTION] == 0.0 or last):
            n = _take(equations, i, blow, n, 0.0)
    return n, approaching


@fused
def _solve(blow: Equations, n: int, share: float, rest: float) -> bool:
    """Find the impulses at ``share`` of the restitutions; return whether there are any."""
    for i in range(n):
        speed = blow.measures[i, VN]
        blow.vectors[FREE, 2 * i] = (
            (1.0 + share * blow.measures[i, RESTITUTION]) * speed if speed < 0.0 else speed
        )
        blow.vectors[FREE, 2 * i + 1] = blow.measures[i, VT]
    return solve_complementarity(blow, n, _SPEEDS * rest)


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
def _find_impulses(blow: Equations, n: int, rest: float) -> tuple[bool, bool]:
    """Find the impulses, with restitutions lowered where they would make energy.

    Returns whether there are any, and whether restitutions were lowered.
    """
    low, high, share = 0.0, 1.0, 1.0
    for trial in range(_HALVINGS):
        solved = _solve(blow, n, share, rest)
        work, scale = _energy_gained(blow, n)
        if trial == _HALVINGS - 1 or (solved and work <= (1e-12 * scale if trial == 0 else 0.0)):
            if trial == 0 or trial == _HALVINGS - 1:
                return solved, trial > 0
            low = share
        else:
            high = share
        share = 0.5 * (low + high) if trial < _HALVINGS - 2 else low
    return False, True


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
    entities: Rows, log: Impacts, logged: int, time: float,
) -> tuple[int, bool, bool]:  # fmt: skip
    """Let all points that approach faster than ``rest`` bounce, until none does.

    Returns how many impacts there were, whether each could be resolved, and whether energy had to be kept.
    """
    impacts, lowered = 0, False
    for turn in range(_MAX_ROUNDS + 2):
        measure_all(scene, equations, count, q, v)
        n, approaching = _gather(equations, count, blow, rest, turn >= _MAX_ROUNDS)
        if not approaching:
            return impacts, True, lowered
        assemble(scene, blow, n)
        solved, kept = _find_impulses(blow, n, rest)
        if not solved:
            return impacts, False, lowered
        lowered = lowered or kept
        impacts += _write(scene, blow, n, rest, entities, log, logged + impacts, time)
        apply(scene, blow, n, v)
    return impacts, True, lowered
