"""The law of impact with friction, at one point of a pair or at two that meet at once.

A point that is pressed leaves with e times its approach (Newton); friction stops its sliding, or is mu times
the normal impulse against the sliding that is left (Coulomb). Where that would make energy, as it can where a
body sticks with one end and pivots, the impulse at one point follows Stronge's energetic law. There is no
such law for several points at once: their restitutions are lowered until no energy is made.
"""

import math
from typing import NamedTuple

from physicslab.kernels import inlined
from physicslab.kernels.constraint.pair import PairInverseMass, PointState, response

NEWTON, ENERGETIC, LOWERED = range(3)
"""The law of an impact: Newton's; Stronge's, or Newton's with a lower restitution, where it makes energy."""
_ENERGY_TOLERANCE = 1e-13
"""Share of the work of the impulses up to which a gain of energy is rounding."""
_MAX_TRIALS = 60
"""Largest number of restitutions that are tried until no energy is made."""
_SINGULAR = 1e-12
"""Share of the product of two responses below which their determinant counts as zero."""
_JAMMED = 1e-9
"""Share of the normal response that must be left where friction drives the point into the surface."""
_STUCK_RESPONSE = 1e-15
"""Share of the normal response that is left to a point that sticks, against rounding."""
_VIOLATION = 1e-12
"""Share of the largest speed or impulse up to which a case of two points breaks no law."""
_CASES = (
    (0, 0.0, 0.0), (0, 1.0, 1.0), (0, -1.0, -1.0), (1, 0.0, 1.0), (1, 1.0, 1.0), (1, -1.0, 1.0),
    (2, 1.0, 0.0), (2, 1.0, 1.0), (2, 1.0, -1.0), (0, 0.0, 1.0), (0, 0.0, -1.0), (0, 1.0, 0.0),
    (0, -1.0, 0.0), (0, 1.0, -1.0), (0, -1.0, 1.0),
)  # fmt: skip
"""Which of two points is pressed, both (0) or one of them; and whether each sticks (0), or slides under
friction of a sign."""


class PointResponse(NamedTuple):
    """Response of a point to unit impulses, and its velocities before.

    A normal impulse changes its velocity ``v`` along the normal [m/s] by ``kn`` and its ``sliding`` [m/s] by
    ``coupling``, a tangential one by ``coupling`` and ``kt`` [1/kg].
    """

    kn: float
    kt: float
    coupling: float
    v: float
    sliding: float


class PairResponse(NamedTuple):
    """Response of two points of a pair to unit impulses, at themselves and at each other [1/kg].

    ``kn_12`` is how a normal impulse at either changes the other's v, ``kt_12`` how a tangential one changes
    its sliding; ``coupling_12`` how a normal impulse at the first changes the sliding of the second, which is
    how a tangential one at the second changes the v of the first.
    """

    first: PointResponse
    second: PointResponse
    kn_12: float
    kt_12: float
    coupling_12: float
    coupling_21: float


class ImpactImpulses(NamedTuple):
    """Normal and tangential impulses at the first and at the second point [N s]."""

    normal1: float
    tangent1: float
    normal2: float
    tangent2: float


@inlined
def point_response(at: PointState[float], mass: PairInverseMass[float]) -> PointResponse:
    """Return what impulses change at a point."""
    both, ia, ib = mass.a + mass.b, mass.inertia_a, mass.inertia_b
    return PointResponse(
        response(both, ia, ib, at.normal_a, at.normal_b, at.normal_a, at.normal_b),
        response(both, ia, ib, at.tangent_a, at.tangent_b, at.tangent_a, at.tangent_b),
        response(0.0, ia, ib, at.normal_a, at.normal_b, at.tangent_a, at.tangent_b),
        at.v, at.sliding,
    )  # fmt: skip


@inlined
def pair_response(
    one: PointState[float], two: PointState[float], mass: PairInverseMass[float]
) -> PairResponse:
    """Return what impulses change at two points."""
    both, ia, ib = mass.a + mass.b, mass.inertia_a, mass.inertia_b
    return PairResponse(
        point_response(one, mass), point_response(two, mass),
        response(both, ia, ib, one.normal_a, one.normal_b, two.normal_a, two.normal_b),
        response(both, ia, ib, one.tangent_a, one.tangent_b, two.tangent_a, two.tangent_b),
        response(0.0, ia, ib, one.normal_a, one.normal_b, two.tangent_a, two.tangent_b),
        response(0.0, ia, ib, two.normal_a, two.normal_b, one.tangent_a, one.tangent_b),
    )  # fmt: skip


# ---- one point ---------------------------------------------------------------------------------------------


@inlined
def newton_impulse(at: PointResponse, restitution: float, friction: float) -> tuple[float, float]:
    """Return the impulses with which a point leaves at e times its approach, under Coulomb's friction."""
    kn, kt, coupling, v, sliding = at
    gained = -(1.0 + restitution) * v
    frictionless = gained / kn
    if friction == 0.0:
        return frictionless, 0.0
    if coupling == 0.0:
        limit = friction * frictionless
        return frictionless, min(max(-sliding / kt, -limit), limit)
    determinant = kn * kt - coupling * coupling
    if determinant > _SINGULAR * kn * kt:
        normal = (kt * gained + coupling * sliding) / determinant
        tangent = -(kn * sliding + coupling * gained) / determinant
        if normal >= 0.0 and abs(tangent) <= friction * normal:
            return normal, tangent
    # It slides when it leaves, against its friction.
    for sign in (1.0, -1.0):
        resisted = kn + sign * friction * coupling
        if resisted > _JAMMED * kn:
            normal = gained / resisted
            left = sliding + (coupling + kt * sign * friction) * normal
            if sign * left <= 0.0:
                return normal, sign * friction * normal
    return frictionless, 0.0


@inlined
def stronge_impulse(at: PointResponse, restitution: float, friction: float) -> tuple[float, float]:
    """Return the impulses of a point that approaches, by Stronge's energetic law.

    The normal impulse grows from zero (Darboux, Keller). While the point slides, the tangential impulse grows
    by mu times as much, against the sliding; once that has stopped, the point sticks, or slides the other way
    where friction cannot hold it. Velocities are linear in the normal impulse in each of these parts. It
    grows until the normal force has given back e^2 times the work that it took until the approach ended
    (Stronge, Proc. R. Soc. A 431 (1990) 169; Wang & Mason, J. Appl. Mech. 59 (1992) 635; Stewart, SIAM Rev.
    42 (2000) 3). Friction acts against the sliding at any moment: energy never grows.
    """
    kn, kt, coupling, v, sliding = at
    # The tangential impulse for each unit of the normal one, before and after the sliding stops.
    before = -friction if sliding > 0.0 else friction
    after = min(max(-coupling / kt, -friction), friction)
    slowed, stopped = coupling + kt * before, 0.0
    rise1, rise2 = kn + coupling * before, max(kn + coupling * after, _STUCK_RESPONSE * kn)
    if slowed < 0.0 < sliding or sliding < 0.0 < slowed:
        stopped = -sliding / slowed
    elif sliding != 0.0 and rise1 > 0.0:
        stopped = math.inf
    if rise1 > 0.0 and v + rise1 * stopped >= 0.0:  # the approach ends while it slides
        left = v + rise1 * stopped
        if left >= -restitution * v:
            normal = -(1.0 + restitution) * v / rise1
            return normal, before * normal
        given = (restitution * restitution * v * v - left * left) / rise1
        normal = given / (left + math.sqrt(left * left + rise2 * given))
        return stopped + normal, before * stopped + after * normal
    left = v + rise1 * stopped
    taken = left * left / rise2 - (v + left) * stopped
    normal = (restitution * math.sqrt(rise2 * taken) - left) / rise2
    return stopped + normal, before * stopped + after * normal


@inlined
def solve_impact(at: PointResponse, restitution: float, friction: float) -> tuple[float, float, int]:
    """Return the normal and tangential impulse of a point that approaches [N s], and which law they obey."""
    normal, tangent = newton_impulse(at, restitution, friction)
    v = at.v + 0.5 * (at.kn * normal + at.coupling * tangent)
    sliding = at.sliding + 0.5 * (at.coupling * normal + at.kt * tangent)
    scale = abs(normal * at.v) + abs(tangent * at.sliding)
    if normal * v + tangent * sliding <= _ENERGY_TOLERANCE * scale:
        return normal, tangent, NEWTON
    normal, tangent = stronge_impulse(at, restitution, friction)
    return normal, tangent, ENERGETIC


# ---- two points --------------------------------------------------------------------------------------------


@inlined
def _after(pair: PairResponse, of: ImpactImpulses) -> tuple[float, float, float, float]:
    """Return the velocities of two points along the normal and the tangent after impulses [m/s]."""
    (n1, t1, n2, t2), one, two = of, pair.first, pair.second
    return (
        one.v + one.kn * n1 + pair.kn_12 * n2 + one.coupling * t1 + pair.coupling_12 * t2,
        one.sliding + one.coupling * n1 + pair.coupling_21 * n2 + one.kt * t1 + pair.kt_12 * t2,
        two.v + pair.kn_12 * n1 + two.kn * n2 + pair.coupling_21 * t1 + two.coupling * t2,
        two.sliding + pair.coupling_12 * n1 + two.coupling * n2 + pair.kt_12 * t1 + two.kt * t2,
    )


type _Friction = tuple[float, float, float, float, float, float, bool]


@inlined
def _friction(pair: PairResponse, friction: float, state1: float, state2: float) -> _Friction:
    """Return the friction of two points, of which each sticks (0), or slides under friction of a sign.

    Its o, a and b for each point: t = o + a n1 + b n2. Where both stick and slide alike, which comes last,
    each holds half, until normal impulses tell how to share it.
    """
    one, two, between = pair.first, pair.second, pair.kt_12
    m1, m2 = state1 * friction, state2 * friction
    if state1 != 0.0 and state2 != 0.0:
        return (0.0, m1, 0.0, 0.0, 0.0, m2, False)
    if state2 != 0.0:
        first, second = -one.coupling / one.kt, -(pair.coupling_21 + between * m2) / one.kt
        return (-one.sliding / one.kt, first, second, 0.0, 0.0, m2, False)
    if state1 != 0.0:
        first, second = -(pair.coupling_12 + between * m1) / two.kt, -two.coupling / two.kt
        return (0.0, m1, 0.0, -two.sliding / two.kt, first, second, False)
    determinant = one.kt * two.kt - between * between
    alike = determinant <= _SINGULAR * one.kt * two.kt
    if alike:
        p1 = p2 = q = -0.5 / (one.kt + two.kt)
    else:
        p1, p2, q = -two.kt / determinant, -one.kt / determinant, between / determinant
    return (
        p1 * one.sliding + q * two.sliding, p1 * one.coupling + q * pair.coupling_12,
        p1 * pair.coupling_21 + q * two.coupling, p2 * two.sliding + q * one.sliding,
        p2 * pair.coupling_12 + q * one.coupling, p2 * two.coupling + q * pair.coupling_21, alike,
    )  # fmt: skip


@inlined
def _impulses_of_case(
    pair: PairResponse, restitution: float, friction: float, pressed: int, state1: float, state2: float
) -> ImpactImpulses:
    """Return the impulses of two points where each does what the case says; not finite if there are none."""
    one, two = pair.first, pair.second
    o1, a1, b1, o2, a2, b2, alike = _friction(pair, friction, state1, state2)
    # How the velocities along the normal answer normal impulses with the friction that these allow.
    a11 = one.kn + one.coupling * a1 + pair.coupling_12 * a2
    a12 = pair.kn_12 + one.coupling * b1 + pair.coupling_12 * b2
    a21 = pair.kn_12 + pair.coupling_21 * a1 + two.coupling * a2
    a22 = two.kn + pair.coupling_21 * b1 + two.coupling * b2
    gained1 = -(1.0 + restitution) * one.v - one.coupling * o1 - pair.coupling_12 * o2
    gained2 = -(1.0 + restitution) * two.v - pair.coupling_21 * o1 - two.coupling * o2
    determinant, n1, n2 = a11 * a22 - a12 * a21, 0.0, 0.0
    if pressed == 1:
        n1 = gained1 / a11
    elif pressed == 2:
        n2 = gained2 / a22
    elif abs(determinant) <= _SINGULAR * one.kn * two.kn:  # they act alike: each has half
        n1 = n2 = (gained1 + gained2) / (a11 + a12 + a21 + a22)
    else:
        n1, n2 = (a22 * gained1 - a12 * gained2) / determinant, (a11 * gained2 - a21 * gained1) / determinant
    t1, t2 = o1 + a1 * n1 + b1 * n2, o2 + a2 * n1 + b2 * n2
    if alike:
        share = (t1 + t2) / (n1 + n2)
        t1, t2 = share * n1, share * n2
    return ImpactImpulses(n1, t1, n2, t2)


@inlined
def _coulomb_violation(
    state: float, normal: float, tangent: float, sliding: float, friction: float
) -> tuple[float, float]:
    """Return by how much a point breaks Coulomb's law: in its sliding [m/s], and in its impulses [N s]."""
    if state == 0.0:
        return abs(sliding), abs(tangent) - friction * normal
    return state * sliding if friction * normal > 0.0 else 0.0, -normal


@inlined
def _violation(
    pair: PairResponse, of: ImpactImpulses, restitution: float, friction: float, pressed: int, state1: float,
    state2: float,
) -> float:  # fmt: skip
    """Return by how much impulses of a case break the laws, as a share of the largest speed or impulse."""
    one, two, (n1, t1, n2, t2) = pair.first, pair.second, of
    impulse = abs(n1) + abs(t1) + abs(n2) + abs(t2)
    if not 0.0 < impulse < math.inf:
        return math.inf
    v1, sliding1, v2, sliding2 = _after(pair, of)
    missing1, missing2 = -restitution * one.v - v1, -restitution * two.v - v2
    slid1, held1 = _coulomb_violation(state1, n1, t1, sliding1, friction)
    slid2, held2 = _coulomb_violation(state2, n2, t2, sliding2, friction)
    speed = max(abs(one.v), abs(two.v), abs(one.sliding), abs(two.sliding))
    missed = max(missing1 if pressed == 2 else abs(missing1), missing2 if pressed == 1 else abs(missing2))
    return max(max(missed, slid1, slid2) / speed, max(-n1, -n2, held1, held2) / impulse)


@inlined
def newton_impulses(pair: PairResponse, restitution: float, friction: float) -> ImpactImpulses:
    """Return the impulses of two points, of which one approaches at least, as a box that lands flat.

    Each that is pressed leaves with e times its approach, the other no slower than that. Cases say which are
    pressed, and whether each sticks or slides which way: it is the first that breaks no law, or the one that
    breaks them least.
    """
    best, least = ImpactImpulses(0.0, 0.0, 0.0, 0.0), math.inf
    for number in range(len(_CASES)):
        pressed, state1, state2 = _CASES[number]
        if friction == 0.0 and not (state1 == 1.0 and state2 == 1.0):
            continue
        found = _impulses_of_case(pair, restitution, friction, pressed, state1, state2)
        violation = _violation(pair, found, restitution, friction, pressed, state1, state2)
        if violation < least:
            best, least = found, violation
        if least <= _VIOLATION:
            break
    return best


@inlined
def _energy_gained(pair: PairResponse, of: ImpactImpulses) -> float:
    """Return the work of impulses at two points, as a share of the sum of the magnitudes of its parts."""
    (n1, t1, n2, t2), one, two = of, pair.first, pair.second
    v1, sliding1, v2, sliding2 = _after(pair, of)
    work = n1 * (one.v + v1) + t1 * (one.sliding + sliding1)
    work += n2 * (two.v + v2) + t2 * (two.sliding + sliding2)
    scale = abs(n1 * one.v) + abs(t1 * one.sliding) + abs(n2 * two.v) + abs(t2 * two.sliding)
    return work / scale if scale > 0.0 else 0.0


class RestitutionSearch(NamedTuple):
    """The search for the largest share of the restitutions that makes no energy.

    ``share`` is to be tried. Impulses at ``low`` have done the work ``low_work``, at most 0, those at
    ``high`` more; it is infinite where there are none. ``side`` is which of them was replaced last.
    """

    share: float
    low: float
    low_work: float
    high: float
    high_work: float
    side: int
    trial: int
    ended: bool


@inlined
def begin_search() -> RestitutionSearch:
    """Return a search that tries the whole restitution first, and 0 after that."""
    return RestitutionSearch(1.0, 0.0, 0.0, 1.0, math.inf, 0, 0, False)


@inlined
def narrow_search(search: RestitutionSearch, work: float) -> RestitutionSearch:
    """Return the search after impulses at its share did ``work``, a share of the magnitudes of its parts.

    It has ``ended`` where they are those that are sought. By regula falsi with the Illinois rule, and by
    bisection where there are no impulses above.
    """
    share, low, low_work, high, high_work, side, trial, _ = search
    if trial == 0:
        ended = work <= _ENERGY_TOLERANCE
        return RestitutionSearch(share if ended else 0.0, 0.0, 0.0, 1.0, work, 0, 1, ended)
    if trial == 1 or work <= 0.0:
        if not work < -_ENERGY_TOLERANCE or high - share <= _ENERGY_TOLERANCE or trial >= _MAX_TRIALS - 1:
            return RestitutionSearch(share, share, work, high, high_work, side, trial, True)
        low, low_work, high_work, side = share, work, high_work * (0.5 if side == -1 else 1.0), -1
    else:
        high, high_work, low_work, side = share, work, low_work * (0.5 if side == 1 else 1.0), 1
    share = (low * high_work - high * low_work) / (high_work - low_work)
    if not high_work < math.inf:
        share = 0.5 * (low + high)
    if high - low <= _ENERGY_TOLERANCE or trial >= _MAX_TRIALS - 2:
        share = low
    return RestitutionSearch(share, low, low_work, high, high_work, side, trial + 1, trial >= _MAX_TRIALS)


@inlined
def solve_impact_of_two(
    pair: PairResponse, restitution: float, friction: float
) -> tuple[ImpactImpulses, float]:
    """Return the impulses of two points of which one approaches at least, and the restitution that they have.

    That is lower than ``restitution`` where more would make energy: the law is ``LOWERED`` then.
    """
    search, found = begin_search(), ImpactImpulses(0.0, 0.0, 0.0, 0.0)
    while not search.ended:
        found = newton_impulses(pair, search.share * restitution, friction)
        search = narrow_search(search, _energy_gained(pair, found))
    return found, search.share * restitution
