"""Impacts of rigid bodies: the impulses of all points that approach at one time, with friction.

Points that approach at the same time are resolved together: each leaves with e times its approach
(Newton), and its tangential impulse is what stops the sliding, at most mu times the normal one. Those that
approach because of that come in the next round, so that a row of touching discs passes an impulse on.
Inelastic ones take all inelastic contacts that touch with them. Where Newton's law would make energy, as
it can where a body sticks with one end and pivots, Stronge's law takes over; there is none for several
points at once, and their restitutions are lowered until no energy is made.
"""

import math

from physicslab.kernels import Numbers, Rows, Vectors, fused, inlined
from physicslab.kernels.accounts import CONTACT, ENERGY, FRICTION, IMPACTS
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
    OTHER,
    PAIR,
    POINT_FIELDS,
    PX,
    PY,
    RESTITUTION,
    VN,
    VT,
    Scene,
)
from physicslab.kernels.solver.blow import ENERGETIC, LOWERED, NEWTON, Blow
from physicslab.kernels.solver.impact_log import (
    Masses,
    Pair,
    Pose,
    Speeds,
    Struck,
    book_impact,
    in_order,
    shares_of,
    write_impact,
)
from physicslab.kernels.solver.impact_pose import Meeting

__all__ = ["approaches", "resolve_blows"]

_MAX_ROUNDS, _SHORT_ROUNDS = 500, 3
"""Rounds of impacts at one time, and within a short step; after them all points that touch are inelastic."""
_NOISE = 1e-4
"""Share of the speed that counts as none up to which an approach is rounding."""
_SPEEDS = 100.0
"""Multiple of the speed that counts as none that impulses are measured by: smaller ones go by rounding."""
_ROUNDING = 1e-15
"""Share of sums that may be rounding."""
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


@inlined
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


@inlined
def _energy_gained(blow: Equations, n: int) -> tuple[float, float]:
    """Return the work of the impulses at most, and the sum of the magnitudes of its parts [J].

    What is light and pressed from two sides by what is heavy takes large impulses that nearly cancel; the
    rounding of that could make energy.
    """
    work, scale, cancelled = 0.0, 0.0, 0.0
    for i in range(n):
        for k in range(2):
            before = blow.measures[i, VN + k]
            after, parts = before, abs(before)
            for j in range(2 * n):
                gained = blow.a[2 * i + k, j] * blow.vectors[UNKNOWN, j]
                after, parts = after + gained, parts + abs(gained)
            cancelled += abs(blow.vectors[UNKNOWN, 2 * i + k]) * parts
            part = 0.5 * blow.vectors[UNKNOWN, 2 * i + k] * (before + after)
            work += part
            speed = abs(blow.measures[i, VN]) + abs(blow.measures[i, VT])
            scale += abs(blow.vectors[UNKNOWN, 2 * i + k]) * speed
    return work + _ROUNDING * cancelled, scale


@inlined
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


@inlined
def _speeds(scene: Scene, v: Numbers, late: float, acceleration: Numbers, a: int, b: int) -> Speeds:
    """Return how a pair moves at the moment of its impact, ``late`` seconds ago by the forces."""
    wa, wb = 2 * scene.rows + a, 2 * scene.rows + b
    return Speeds(
        v[2 * a] - late * acceleration[2 * a], v[2 * a + 1] - late * acceleration[2 * a + 1],
        v[wa] - late * acceleration[wa],
        v[2 * b] - late * acceleration[2 * b], v[2 * b + 1] - late * acceleration[2 * b + 1],
        v[wb] - late * acceleration[wb],
    )  # fmt: skip


@inlined
def _meeting(scene: Scene, blow: Equations, i: int, q: Numbers) -> Meeting:
    """Return the normal from A to B of a point's pair, and its arms."""
    pair = blow.points[i, PAIR]
    a, b = scene.pairs[pair, 0], scene.pairs[pair, 1]
    sign = 1.0 if blow.points[i, ONE] == a else -1.0
    x, y = blow.measures[i, PX], blow.measures[i, PY]
    return Meeting(
        sign * blow.measures[i, NX], sign * blow.measures[i, NY],
        x - q[2 * a], y - q[2 * a + 1], x - q[2 * b], y - q[2 * b + 1],
    )  # fmt: skip


@inlined
def _two_points(scene: Scene, blow: Equations, i: int, end: int, q: Numbers) -> Struck:
    """Return the points ``i`` to ``end`` of a pair as two, at the ends of the line on which they are.

    Where there are more, the impulses of those between are shared out to the ends by the law of the lever.
    """
    first = _meeting(scene, blow, i, q)
    low, high, at_low, at_high = 0.0, 0.0, i, i
    for k in range(i + 1, end):
        to = _meeting(scene, blow, k, q)
        along = (to.arm_by - first.arm_by) * first.nx - (to.arm_bx - first.arm_bx) * first.ny
        if blow.vectors[UNKNOWN, 2 * k] > 0.0 and along < low:
            low, at_low = along, k
        if blow.vectors[UNKNOWN, 2 * k] > 0.0 and along > high:
            high, at_high = along, k
    one, two = _meeting(scene, blow, at_low, q), _meeting(scene, blow, at_high, q)
    normal1, tangent1, normal2, tangent2 = 0.0, 0.0, 0.0, 0.0
    for k in range(i, end):
        at = _meeting(scene, blow, k, q)
        along = (at.arm_by - one.arm_by) * one.nx - (at.arm_bx - one.arm_bx) * one.ny
        share = along / (high - low) if at_high != at_low else 0.0
        # Along the directions of the first point: where faces meet, those of all are the same.
        cosine, sine = at.nx * one.nx + at.ny * one.ny, one.nx * at.ny - one.ny * at.nx
        n, t = blow.vectors[UNKNOWN, 2 * k], blow.vectors[UNKNOWN, 2 * k + 1]
        n, t = n * cosine - t * sine, n * sine + t * cosine
        normal1, tangent1 = normal1 + (1.0 - share) * n, tangent1 + (1.0 - share) * t
        normal2, tangent2 = normal2 + share * n, tangent2 + share * t
    return in_order(Struck(one, two, Blow(normal1, tangent1, normal2, tangent2)))


@inlined
def _alone(scene: Scene, blow: Equations, n: int, i: int, end: int) -> bool:
    """Whether no other pair's impulse acts on what the points ``i`` to ``end`` move."""
    pair, alone = blow.points[i, PAIR], True
    for body in (scene.pairs[pair, 0], scene.pairs[pair, 1]):
        if scene.inverse_mass[2 * body] == 0.0:
            continue
        for k in range(n):
            other = (k < i or k >= end) and (blow.points[k, ONE] == body or blow.points[k, OTHER] == body)
            acts = blow.vectors[UNKNOWN, 2 * k] != 0.0 or blow.vectors[UNKNOWN, 2 * k + 1] != 0.0
            alone = alone and not (other and acts)
    return alone


@inlined
def _book(
    scene: Scene, blow: Equations, i: int, end: int, q: Numbers, pose: Pose, before: Speeds, after: Speeds,
    masses: Masses, cause: int, account: Vectors,
) -> None:  # fmt: skip
    """Book the impulses of the points ``i`` to ``end`` of a pair, two by two."""
    for k in range(i, end, 2):
        one, two, n2, t2 = _meeting(scene, blow, k, q), _meeting(scene, blow, k, q), 0.0, 0.0
        if k + 1 < end:
            two = _meeting(scene, blow, k + 1, q)
            n2, t2 = blow.vectors[UNKNOWN, 2 * k + 2], blow.vectors[UNKNOWN, 2 * k + 3]
        struck = Struck(
            one, two, Blow(blow.vectors[UNKNOWN, 2 * k], blow.vectors[UNKNOWN, 2 * k + 1], n2, t2)
        )
        book_impact(account, struck, pose, before, after, masses, cause)


@inlined
def _note_round(
    scene: Scene, blow: Equations, n: int, q: Numbers, old: Numbers, v: Numbers, rest: float, rate: float,
    acceleration: Numbers, law: int, entities: Rows, log: Impacts, logged: int, time: float, account: Vectors,
) -> int:  # fmt: skip
    """Book a round of impulses that has changed the speeds ``old`` to ``v``, and log its impacts.

    In a short step all forces have acted already, and those of its second half are not part of the moment;
    what does not approach there is the load of a resting contact. Returns how many pairs met.
    """
    written, i = 0, 0
    bounced, rubbed = account[IMPACTS, ENERGY], account[FRICTION, ENERGY]
    late = 1.0 / rate if rate > 0.0 else 0.0
    while i < n:
        pair, end, approach, restitution = blow.points[i, PAIR], i, 0.0, 0.0
        while end < n and blow.points[end, PAIR] == pair:
            speed = -blow.measures[end, VN]
            if blow.vectors[UNKNOWN, 2 * end] > 0.0 and speed > max(rest, approach):
                approach, restitution = speed, blow.measures[end, RESTITUTION]
            end += 1
        a, b, wall = scene.pairs[pair, 0], scene.pairs[pair, 1], scene.pairs[pair, 2]
        ra, rb, mass = 2 * scene.rows + a, 2 * scene.rows + b, scene.inverse_mass
        masses = Masses(mass[2 * a], mass[ra], mass[2 * b], mass[rb])
        pose = Pose(q[2 * a], q[2 * a + 1], q[ra], q[2 * b], q[2 * b + 1], q[rb])
        before = _speeds(scene, old, late, acceleration, a, b)
        after = _speeds(scene, v, late, acceleration, a, b)
        cause = CONTACT if rate > 0.0 and approach == 0.0 else IMPACTS
        _book(scene, blow, i, end, q, pose, before, after, masses, cause, account)
        if approach > 0.0:
            if len(log) > 0:
                ids = Pair(
                    entities[a] if wall < 0 else 0, entities[b], wall, restitution, blow.measures[i, MU]
                )
                write_impact(
                    log, logged + written, ids, time, approach, _two_points(scene, blow, i, end, q), pose,
                    _speeds(scene, old, 0.0, acceleration, a, b), _speeds(scene, v, 0.0, acceleration, a, b),
                    masses, law, _alone(scene, blow, n, i, end),
                )  # fmt: skip
            written += 1
        i = end
    # Where several pairs meet at once, one can give what another takes: all together take, or give nothing.
    along, across = account[IMPACTS, ENERGY] - bounced, account[FRICTION, ENERGY] - rubbed
    if along > 0.0 or across > 0.0:
        along, across = shares_of(along, across)
        account[IMPACTS, ENERGY], account[FRICTION, ENERGY] = bounced + along, rubbed + across
    return written


@fused
def resolve_blows(
    scene: Scene, equations: Equations, count: int, blow: Equations, q: Numbers, v: Numbers, old: Numbers,
    acceleration: Numbers, rest: float, rate: float, entities: Rows, log: Impacts, logged: int, time: float,
    account: Vectors,
) -> tuple[int, bool, int, int, int, int]:  # fmt: skip
    """Let all points that approach faster than ``rest`` bounce, until none does.

    Those that do not bounce may use up their gap in 1 / ``rate`` seconds. ``old`` is room for speeds. What
    the impulses give is added to ``account``. Returns how many impacts there were, whether each could be
    resolved, how many obeyed Stronge's law, how often restitutions were lowered, how many points the last
    impulses act at, and how many rounds there were.
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
        for i in range(len(v)):
            old[i] = v[i]
        apply(scene, blow, n, v)
        law = ENERGETIC if by_energy > 0 else (LOWERED if less > 0 else NEWTON)
        impacts += _note_round(
            scene, blow, n, q, old, v, rest, rate, acceleration, law, entities, log, logged + impacts, time,
            account,
        )  # fmt: skip
    return impacts, True, energetic, lowered, last, most
