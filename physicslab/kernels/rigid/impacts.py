"""Impacts of rigid bodies: the impulses of all points that approach at one time, with friction.

Points that approach at the same time are resolved together: each leaves with e times its approach
(Newton), and its tangential impulse is what stops the sliding, at most mu times the normal one. Those that
approach because of that come in the next round, so that a row of touching discs passes an impulse on.
Inelastic ones take all inelastic contacts that touch with them. The law is that of
:mod:`physicslab.kernels.constraint.impact_law`: one point goes by it, several by a complementarity problem
and, where Newton's law would make energy, by the same search for a lower restitution.
"""

import math

from physicslab.kernels import Numbers, Rows, Vectors, always_inlined, inlined
from physicslab.kernels.accounts import CONTACT, ENERGY, FRICTION, HAND, IMPACTS, JOINTS
from physicslab.kernels.constraint import impact_law
from physicslab.kernels.constraint.impact_law import ImpactImpulses, PointResponse
from physicslab.kernels.constraint.pair import ContactFrame, PairInverseMass, PairVelocity
from physicslab.kernels.geometry.links import segment_at
from physicslab.kernels.geometry.shapes import is_chain, wall_of
from physicslab.kernels.joints.layout import ROWS
from physicslab.kernels.records import Impacts
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid.budget import book_row
from physicslab.kernels.rigid.complementarity import NOT_FOUND, solve_complementarity
from physicslab.kernels.rigid.constraints import apply, assemble, measure_all
from physicslab.kernels.rigid.equations import FREE, SLIDES_ON, STICKS, UNKNOWN, Equations
from physicslab.kernels.rigid.features import RigidScene, rate_along
from physicslab.kernels.rigid.joined import book_impulses
from physicslab.kernels.solver import impact_log
from physicslab.kernels.solver.impact_log import ImpactPoints, Pair, Pose

_MAX_ROUNDS, _SHORT_ROUNDS = 500, 3
"""Rounds of impacts at one time, and within a short step; after them all points that touch are inelastic."""
_NOISE = 1e-4
"""Share of the tolerance of speeds up to which an approach is rounding."""
_SPEEDS = 100.0
"""Multiple of the tolerance of speeds that impulses are measured by: smaller ones go by rounding."""
_SUM_ROUNDING = 1e-15
"""Share of sums that may be rounding."""


@inlined
def approaches(speed: float, rest: float) -> bool:
    """Whether a point approaches faster than rounding; ``rest`` is the tolerance of speeds [m/s]."""
    return speed < -_NOISE * rest


@inlined
def _take(equations: Equations, i: int, impact: Equations, n: int, restitution: float) -> int:
    for k in range(F.POINT_FIELDS):
        impact.points[n, k] = equations.points[i, k]
    for k in range(F.MEASURES):
        impact.measures[n, k] = equations.measures[i, k]
    impact.measures[n, F.RESTITUTION] = restitution
    impact.points[n, F.GIVEN] = STICKS if impact.measures[n, F.MU] > 0.0 else SLIDES_ON
    return n + 1


@inlined
def _closing_speed(equations: Equations, i: int, rate: float) -> float:
    """Return how fast a point moves along its normal beyond what its gap allows in 1 / ``rate`` seconds."""
    speed: float = equations.measures[i, F.VN] + max(equations.measures[i, F.GAP], 0.0) * rate
    return speed


@inlined
def _gather(
    equations: Equations, count: int, impact: Equations, rest: float, rate: float, last: bool
) -> tuple[int, bool]:
    """Take the points that approach, and inelastic ones that rest; a motor with a cap has no impulse.

    Returns how many they are, and whether any approaches.
    """
    n, approaching = 0, False
    for i in range(count):
        e, speed = equations.measures[i, F.RESTITUTION], equations.measures[i, F.VN]
        if equations.points[i, F.FEATURE] == F.MOTOR:
            continue
        bounces = -e * speed > rest and not last
        # One that bounces in a short step does so before half of the next would take it below the surface.
        closing = _closing_speed(equations, i, rate / (2.0 - e) if bounces else rate)
        if approaches(closing, rest):
            approaching = True
            n = _take(equations, i, impact, n, e if bounces else 0.0)
        elif closing <= rest and (e == 0.0 or last):
            n = _take(equations, i, impact, n, 0.0)
    return n, approaching


@always_inlined
def _solve(impact: Equations, n: int, share: float, rest: float, rate: float) -> bool:
    """Find the impulses at ``share`` of the restitutions; return whether there are any."""
    for i in range(n):
        back = share * impact.measures[i, F.RESTITUTION] * min(impact.measures[i, F.VN], 0.0)
        impact.vectors[FREE, 2 * i] = (
            impact.measures[i, F.VN] + back if back < 0.0 else _closing_speed(impact, i, rate)
        )
        impact.vectors[FREE, 2 * i + 1] = impact.measures[i, F.VT]
    return solve_complementarity(impact, n, _SPEEDS * rest, rate == 0.0) != NOT_FOUND


@inlined
def _energy_gained(impact: Equations, n: int) -> float:
    """Return the work of the impulses at most, as a share of the sum of the magnitudes of its parts.

    A light body pressed from two sides by heavy ones takes large impulses that nearly cancel; the
    rounding of that could make energy.
    """
    work, scale, cancelled = 0.0, 0.0, 0.0
    for i in range(n):
        for k in range(2):
            before = impact.measures[i, F.VN + k]
            after, parts = before, abs(before)
            for j in range(2 * n):
                gained = impact.a[2 * i + k, j] * impact.vectors[UNKNOWN, j]
                after, parts = after + gained, parts + abs(gained)
            impulse = impact.vectors[UNKNOWN, 2 * i + k]
            cancelled += abs(impulse) * parts
            work += 0.5 * impulse * (before + after)
            scale += abs(impulse) * (abs(impact.measures[i, F.VN]) + abs(impact.measures[i, F.VT]))
    return (work + _SUM_ROUNDING * cancelled) / scale if scale > 0.0 else 0.0


@always_inlined
def _find_impulses(impact: Equations, n: int, rest: float, rate: float) -> tuple[bool, int]:
    """Find the impulses of points that meet at once; return whether there are any, and their law."""
    a, measures, vectors = impact.a, impact.measures, impact.vectors
    if n == 1 and measures[0, F.RESTITUTION] > 0.0:
        response = PointResponse(a[0, 0], a[1, 1], a[0, 1], measures[0, F.VN], measures[0, F.VT])
        e, mu = measures[0, F.RESTITUTION], measures[0, F.MU]
        normal, tangent, law = impact_law.solve_impact(response, e, mu)
        vectors[UNKNOWN, 0], vectors[UNKNOWN, 1] = normal, tangent
        return True, law
    search, solved = impact_law.begin_search(), False
    while not search.ended:
        solved = _solve(impact, n, search.share, rest, rate)
        search = impact_law.narrow_search(search, _energy_gained(impact, n) if solved else math.inf)
    return solved, impact_law.NEWTON if search.share == 1.0 else impact_law.LOWERED


@inlined
def _pair_velocity(
    scene: RigidScene, v: Numbers, late: float, acceleration: Numbers, a: int, b: int
) -> PairVelocity[float]:
    """Return how a pair moves at the moment of its impact, ``late`` seconds ago by the forces."""
    wa, wb = 2 * scene.rows + a, 2 * scene.rows + b
    return PairVelocity(
        v[2 * a] - late * acceleration[2 * a], v[2 * a + 1] - late * acceleration[2 * a + 1],
        v[wa] - late * acceleration[wa],
        v[2 * b] - late * acceleration[2 * b], v[2 * b + 1] - late * acceleration[2 * b + 1],
        v[wb] - late * acceleration[wb],
    )  # fmt: skip


@inlined
def _frame(scene: RigidScene, impact: Equations, i: int, q: Numbers) -> ContactFrame[float]:
    """Return the normal from A to B of a point's pair, and its arms."""
    pair = impact.points[i, F.PAIR]
    a, b = scene.pairs[pair, 0], scene.pairs[pair, 1]
    sign = 1.0 if impact.points[i, F.ONE] == a else -1.0
    x, y = impact.measures[i, F.PX], impact.measures[i, F.PY]
    return ContactFrame(
        sign * impact.measures[i, F.NX], sign * impact.measures[i, F.NY],
        x - q[2 * a], y - q[2 * a + 1], x - q[2 * b], y - q[2 * b + 1],
    )  # fmt: skip


@inlined
def _name_of_wall(scene: RigidScene, impact: Equations, i: int, wall: int) -> int:
    """Return the ``wall`` of a pair; of one with a chain it names the segment where point i is."""
    one, other = impact.points[i, F.ONE], impact.points[i, F.OTHER]
    if impact.points[i, F.FEATURE] < 0:
        return wall_of(segment_at(scene.shapes, one, F.LINK - impact.points[i, F.FEATURE]))
    if wall < 0 and is_chain(scene.shapes, other):
        return wall_of(segment_at(scene.shapes, other, impact.points[i, F.VERTEX]))
    return wall


@inlined
def _two_points(scene: RigidScene, impact: Equations, i: int, end: int, q: Numbers) -> ImpactPoints:
    """Return the points ``i`` to ``end`` of a pair as two, at the ends of the line on which they are.

    Where there are more, the impulses of those between are shared out to the ends by the law of the lever.
    """
    first = _frame(scene, impact, i, q)
    low, high, at_low, at_high = 0.0, 0.0, i, i
    for k in range(i + 1, end):
        to = _frame(scene, impact, k, q)
        along = (to.arm_by - first.arm_by) * first.nx - (to.arm_bx - first.arm_bx) * first.ny
        if impact.vectors[UNKNOWN, 2 * k] > 0.0 and along < low:
            low, at_low = along, k
        if impact.vectors[UNKNOWN, 2 * k] > 0.0 and along > high:
            high, at_high = along, k
    one, two = _frame(scene, impact, at_low, q), _frame(scene, impact, at_high, q)
    normal1, tangent1, normal2, tangent2 = 0.0, 0.0, 0.0, 0.0
    for k in range(i, end):
        at = _frame(scene, impact, k, q)
        along = (at.arm_by - one.arm_by) * one.nx - (at.arm_bx - one.arm_bx) * one.ny
        share = along / (high - low) if at_high != at_low else 0.0
        # Along the directions of the first point: where faces meet, those of all are the same.
        cosine, sine = at.nx * one.nx + at.ny * one.ny, one.nx * at.ny - one.ny * at.nx
        n, t = impact.vectors[UNKNOWN, 2 * k], impact.vectors[UNKNOWN, 2 * k + 1]
        n, t = n * cosine - t * sine, n * sine + t * cosine
        normal1, tangent1 = normal1 + (1.0 - share) * n, tangent1 + (1.0 - share) * t
        normal2, tangent2 = normal2 + share * n, tangent2 + share * t
    return ImpactPoints(one, two, ImpactImpulses(normal1, tangent1, normal2, tangent2))


@inlined
def _alone(scene: RigidScene, impact: Equations, n: int, i: int, end: int) -> bool:
    """Whether no other pair's impulse acts on what the points ``i`` to ``end`` move."""
    pair, alone = impact.points[i, F.PAIR], True
    for body in (scene.pairs[pair, 0], scene.pairs[pair, 1]):
        if scene.inverse_mass[2 * body] == 0.0:
            continue
        for k in range(n):
            takes_part = impact.points[k, F.ONE] == body or impact.points[k, F.OTHER] == body
            acts = impact.vectors[UNKNOWN, 2 * k] != 0.0 or impact.vectors[UNKNOWN, 2 * k + 1] != 0.0
            alone = alone and not ((k < i or k >= end) and takes_part and acts)
    return alone


@inlined
def _book(
    scene: RigidScene, impact: Equations, i: int, end: int, q: Numbers, pose: Pose,
    before: PairVelocity[float], after: PairVelocity[float], mass: PairInverseMass[float], cause: int,
    account: Vectors,
) -> None:  # fmt: skip
    """Book the impulses of the points ``i`` to ``end`` of a pair, two by two."""
    for k in range(i, end, 2):
        one, two, n2, t2 = _frame(scene, impact, k, q), _frame(scene, impact, k, q), 0.0, 0.0
        if k + 1 < end:
            two = _frame(scene, impact, k + 1, q)
            n2, t2 = impact.vectors[UNKNOWN, 2 * k + 2], impact.vectors[UNKNOWN, 2 * k + 3]
        n1, t1 = impact.vectors[UNKNOWN, 2 * k], impact.vectors[UNKNOWN, 2 * k + 1]
        points = ImpactPoints(one, two, ImpactImpulses(n1, t1, n2, t2))
        impact_log.book_impact(account, points, pose, before, after, mass, cause)


@inlined
def _note_round(
    scene: RigidScene, impact: Equations, n: int, q: Numbers, old: Numbers, v: Numbers, rest: float,
    rate: float, acceleration: Numbers, law: int, entities: Rows, log: Impacts, logged: int, time: float,
    account: Vectors,
) -> int:  # fmt: skip
    """Book a round of impulses that has changed the speeds ``old`` to ``v``, and log its impacts.

    In a short step all forces have acted already, and those of its second half are not part of the moment;
    what does not approach there is the load of a resting contact. Elsewhere a resting pair takes part in the
    impact of others, and is one of those that met. Returns how many pairs did.
    """
    written, i = 0, 0
    bounced, friction_work = account[IMPACTS, ENERGY], account[FRICTION, ENERGY]
    late = 1.0 / rate if rate > 0.0 else 0.0
    while i < n:
        pair, end, approach, restitution, met = impact.points[i, F.PAIR], i, 0.0, 0.0, False
        while end < n and impact.points[end, F.PAIR] == pair:
            speed = -impact.measures[end, F.VN]
            change = impact.a[2 * end, 2 * end] * impact.vectors[UNKNOWN, 2 * end]
            if change > 0.0:
                met = met or speed > rest or (rate == 0.0 and change > rest)
                if speed > approach:
                    approach, restitution = speed, impact.measures[end, F.RESTITUTION]
            end += 1
        a, b, wall = scene.pairs[pair, 0], scene.pairs[pair, 1], scene.pairs[pair, 2]
        if wall >= F.FIRST_ROW:
            book_row(scene, impact, i, q, old, v, late, acceleration, account[JOINTS], account[HAND])
            i = end
            continue
        wall = _name_of_wall(scene, impact, i, wall)
        ra, rb, inverse = 2 * scene.rows + a, 2 * scene.rows + b, scene.inverse_mass
        mass = PairInverseMass(inverse[2 * a], inverse[ra], inverse[2 * b], inverse[rb])
        pose = Pose(q[2 * a], q[2 * a + 1], q[ra], q[2 * b], q[2 * b + 1], q[rb])
        before = _pair_velocity(scene, old, late, acceleration, a, b)
        after = _pair_velocity(scene, v, late, acceleration, a, b)
        cause = IMPACTS if met else CONTACT
        _book(scene, impact, i, end, q, pose, before, after, mass, cause, account)
        if met:
            if len(log) > 0:
                ids = Pair(
                    entities[a] if wall < 0 else 0, entities[b], wall, restitution, impact.measures[i, F.MU]
                )
                impact_log.write_impact(
                    log, logged + written, ids, time, approach, _two_points(scene, impact, i, end, q), pose,
                    _pair_velocity(scene, old, 0.0, acceleration, a, b),
                    _pair_velocity(scene, v, 0.0, acceleration, a, b), mass, law,
                    _alone(scene, impact, n, i, end),
                )  # fmt: skip
            written += 1
        i = end
    # Where several pairs meet at once, one can give what another takes: all together take, or give nothing.
    along, across = account[IMPACTS, ENERGY] - bounced, account[FRICTION, ENERGY] - friction_work
    if along > 0.0 or across > 0.0:
        along, across = impact_log.shares_of(along, across)
        account[IMPACTS, ENERGY], account[FRICTION, ENERGY] = bounced + along, friction_work + across
    return written


@inlined
def _is_driven_on(
    scene: RigidScene, impact: Equations, n: int, old: Numbers, v: Numbers, rest: float, rate: float
) -> bool:
    """Whether a point still approaches half as fast as before, as a motor of any strength drives it."""
    for i in range(n):
        room = max(impact.measures[i, F.GAP], 0.0) * rate
        before = rate_along(scene.rows, impact.points, impact.measures, i, F.NORMAL, old) + room
        after = rate_along(scene.rows, impact.points, impact.measures, i, F.NORMAL, v) + room
        if before < -rest and after < 0.5 * before:
            return True
    return False


@always_inlined
def resolve_simultaneous_impacts(
    scene: RigidScene, equations: Equations, count: int, impact: Equations, q: Numbers, v: Numbers,
    old: Numbers, acceleration: Numbers, rest: float, rate: float, entities: Rows, log: Impacts, logged: int,
    time: float,
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
        n, approaching = _gather(equations, count, impact, rest, rate, turn >= most)
        if not approaching:
            return impacts, True, energetic, lowered, last, turn
        assemble(scene, impact, n)
        solved, law = _find_impulses(impact, n, rest, rate)
        if not solved:
            return impacts, False, energetic, lowered, last, turn
        energetic += int(law == impact_law.ENERGETIC)
        lowered, last = lowered + int(law == impact_law.LOWERED), n
        for i in range(len(v)):
            old[i] = v[i]
        apply(scene, impact, n, v)
        if scene.joints[ROWS] > 0:
            if _is_driven_on(scene, impact, n, old, v, rest, rate):
                for i in range(len(v)):
                    v[i] = old[i]
                return impacts, False, energetic, lowered, last, turn
            book_impulses(scene, impact, n, q, v, account)
        impacts += _note_round(
            scene, impact, n, q, old, v, rest, rate, acceleration, law, entities, log, logged + impacts, time,
            account,
        )  # fmt: skip
    return impacts, True, energetic, lowered, last, most
