"""The law of an impact: normal and tangential impulses together, so that e asked is e reached with friction.

A point leaves with e times its approach (Newton); its tangential impulse stops the sliding, at most mu times
the normal one (Coulomb). Where that would make energy, as it can where a body sticks with one end and pivots,
Stronge's law takes over; there is none for two points at once, and their restitution is lowered until it
makes no energy.
"""

from typing import NamedTuple

from physicslab.kernels import inlined
from physicslab.kernels.energetic import energetic_blow

__all__ = ["ENERGETIC", "LOWERED", "NEWTON", "Blow", "Lever", "Weights", "one_blow", "two_blows"]

NEWTON, ENERGETIC, LOWERED = range(3)
"""The law of an impact: Newton's; Stronge's, or Newton's with a lower restitution, where it makes energy."""

_MAX_SWEEPS = 200
"""Largest number of sweeps over the two points of a pair."""
_HALVINGS = 48
"""Bisections for the restitution of two points that makes no energy."""
_SINGULAR = 1e-12
"""Share of the responses of both points below which their determinant is none."""
_SEPARATE = 1.0 + 1e-9
"""One, and so much more that two points of a pair are never quite one."""
_ROUNDING = 1e-13
"""Share of the work of the impulses up to which a gain of energy is rounding."""


class Weights(NamedTuple):
    """Inverse masses of both bodies together [1/kg], inverse moments of inertia of A and B [1/(kg m^2)]."""

    both: float
    turn_a: float
    turn_b: float


class Lever(NamedTuple):
    """Lever arms of normal and tangent about A and about B [m]; the approach and sliding of B there [m/s]."""

    normal_a: float
    normal_b: float
    across_a: float
    across_b: float
    v: float
    sliding: float


class Blow(NamedTuple):
    """Normal and tangential impulses of the first and of the second point [N s]."""

    normal1: float
    tangent1: float
    normal2: float
    tangent2: float


@inlined
def _normal_element(weights: Weights, one: Lever, two: Lever) -> float:
    """Return how a normal impulse at a point changes the normal velocity at another [1/kg]."""
    turned = weights.turn_a * one.normal_a * two.normal_a + weights.turn_b * one.normal_b * two.normal_b
    return weights.both + turned


@inlined
def _across_element(weights: Weights, one: Lever, two: Lever) -> float:
    """Return how a tangential impulse at a point changes the sliding of another [1/kg]."""
    turned = weights.turn_a * one.across_a * two.across_a
    return weights.both + turned + weights.turn_b * one.across_b * two.across_b


@inlined
def _coupling(weights: Weights, one: Lever, two: Lever) -> float:
    """Return how a normal impulse at a point changes the sliding of another [1/kg]."""
    turned = weights.turn_a * one.normal_a * two.across_a
    return turned + weights.turn_b * one.normal_b * two.across_b


@inlined
def _newton(
    kn: float, kt: float, between: float, lever: Lever, gained: float, friction: float
) -> tuple[float, float]:
    """Return the impulses that change the approach of a point by ``gained`` [m/s] under friction."""
    frictionless = gained / kn
    if friction == 0.0:
        return frictionless, 0.0
    if between == 0.0:
        limit = friction * frictionless
        return frictionless, min(max(-lever.sliding / kt, -limit), limit)
    determinant = kn * kt - between * between
    if determinant > 1e-12 * kn * kt:
        normal = (kt * gained + between * lever.sliding) / determinant
        tangent = -(kn * lever.sliding + between * gained) / determinant
        if normal >= 0.0 and abs(tangent) <= friction * normal:
            return normal, tangent
    # It slides when it leaves, against its friction.
    for sign in (1.0, -1.0):
        resisted = kn + sign * friction * between
        if resisted > 1e-9 * kn:
            normal = gained / resisted
            left = lever.sliding + (between + kt * sign * friction) * normal
            if sign * left <= 0.0:
                return normal, sign * friction * normal
    return frictionless, 0.0


@inlined
def one_blow(lever: Lever, weights: Weights, restitution: float, friction: float) -> tuple[float, float, int]:
    """Return the normal and tangential impulse of a point that approaches [N s], and which law they obey."""
    kn, kt, between = (
        _normal_element(weights, lever, lever), _across_element(weights, lever, lever),
        _coupling(weights, lever, lever),
    )  # fmt: skip
    normal, tangent = _newton(kn, kt, between, lever, -(1.0 + restitution) * lever.v, friction)
    v = lever.v + 0.5 * (kn * normal + between * tangent)
    sliding = lever.sliding + 0.5 * (between * normal + kt * tangent)
    scale = abs(normal * lever.v) + abs(tangent * lever.sliding)
    if normal * v + tangent * sliding <= _ROUNDING * scale:
        return normal, tangent, NEWTON
    normal, tangent = energetic_blow(kn, kt, between, lever.v, lever.sliding, restitution, friction)
    return normal, tangent, ENERGETIC


@inlined
def _after(one: Lever, two: Lever, weights: Weights, blow: Blow) -> tuple[float, float, float, float]:
    """Return the velocities of two points along the normal and across after a blow [m/s]."""
    normal, tangent = blow.normal1 + blow.normal2, blow.tangent1 + blow.tangent2
    spin_a = weights.turn_a * (
        one.normal_a * blow.normal1 + one.across_a * blow.tangent1
        + two.normal_a * blow.normal2 + two.across_a * blow.tangent2
    )  # fmt: skip
    spin_b = weights.turn_b * (
        one.normal_b * blow.normal1 + one.across_b * blow.tangent1
        + two.normal_b * blow.normal2 + two.across_b * blow.tangent2
    )  # fmt: skip
    return (
        one.v + weights.both * normal + one.normal_a * spin_a + one.normal_b * spin_b,
        one.sliding + weights.both * tangent + one.across_a * spin_a + one.across_b * spin_b,
        two.v + weights.both * normal + two.normal_a * spin_a + two.normal_b * spin_b,
        two.sliding + weights.both * tangent + two.across_a * spin_a + two.across_b * spin_b,
    )


@inlined
def _two_normals(
    x1: float, x2: float, change1: float, change2: float, m1: float, m2: float, between: float
) -> tuple[float, float]:
    """Return the normal impulses of two points that act on each other, neither of which pulls [N s].

    They are ``x1`` and ``x2`` so far; each by itself would change by ``change1`` or ``change2``, and has the
    effective mass m. Where one would pull, the other acts alone.
    """
    to1, to2 = between * m1, between * m2
    scale = 1.0 / (_SEPARATE - to1 * to2)
    both1, both2 = x1 + (change1 - to1 * change2) * scale, x2 + (change2 - to2 * change1) * scale
    if both1 > 0.0 and both2 > 0.0:
        return both1, both2
    alone = max(x1 + change1 + to1 * x2, 0.0)
    if to2 * (alone - x1) > x2 + change2:  # the second point separates
        return alone, 0.0
    return 0.0, max(x2 + change2 + to2 * x1, 0.0)


class _Rubbing(NamedTuple):
    """Friction of two points under normal impulses: t1 = o1 + a1 n1 + b1 n2, t2 = o2 + a2 n1 + b2 n2.

    Where points that stick slide alike, the first has what both hold.
    """

    o1: float
    a1: float
    b1: float
    o2: float
    a2: float
    b2: float
    alike: bool


@inlined
def _rubbing(
    one: Lever, two: Lever, weights: Weights, friction: float, state1: float, state2: float
) -> _Rubbing:
    """Return the friction of two points, of which each sticks (0), or slides under friction of a sign."""
    k1, k2 = _across_element(weights, one, one), _across_element(weights, two, two)
    between = _across_element(weights, one, two)
    c11, c12 = _coupling(weights, one, one), _coupling(weights, one, two)
    c21, c22 = _coupling(weights, two, one), _coupling(weights, two, two)
    m1, m2 = state1 * friction, state2 * friction
    if state1 != 0.0 and state2 != 0.0:
        return _Rubbing(0.0, m1, 0.0, 0.0, 0.0, m2, False)
    if state1 == 0.0 and state2 != 0.0:
        return _Rubbing(-one.sliding / k1, -c11 / k1, -(c21 + between * m2) / k1, 0.0, 0.0, m2, False)
    if state2 == 0.0 and state1 != 0.0:
        return _Rubbing(0.0, m1, 0.0, -two.sliding / k2, -(c12 + between * m1) / k2, -c22 / k2, False)
    determinant = k1 * k2 - between * between
    if determinant <= _SINGULAR * k1 * k2:
        share = -1.0 / (k1 + k2)
        sliding = share * (one.sliding + two.sliding)
        return _Rubbing(sliding, share * (c11 + c12), share * (c21 + c22), 0.0, 0.0, 0.0, True)
    p1, p2, q = -k2 / determinant, -k1 / determinant, between / determinant
    return _Rubbing(
        p1 * one.sliding + q * two.sliding, p1 * c11 + q * c12, p1 * c21 + q * c22,
        p2 * two.sliding + q * one.sliding, p2 * c12 + q * c11, p2 * c22 + q * c21, False,
    )  # fmt: skip


@inlined
def _pressing(
    one: Lever, two: Lever, weights: Weights, restitution: float, pressed: int, rubbing: _Rubbing
) -> tuple[float, float, bool]:
    """Return the normal impulses of two points under their friction, and whether they break no law.

    Both are ``pressed`` (0), or the first (1) or the second alone (2). None pulls, and one that is not
    pressed leaves no slower than it may.
    """
    o1, a1, b1, o2, a2, b2, _alike = rubbing
    k1, k2 = _normal_element(weights, one, one), _normal_element(weights, two, two)
    between = _normal_element(weights, one, two)
    c11, c12 = _coupling(weights, one, one), _coupling(weights, one, two)
    c21, c22 = _coupling(weights, two, one), _coupling(weights, two, two)
    a11, a12 = k1 + c11 * a1 + c12 * a2, between + c11 * b1 + c12 * b2
    a21, a22 = between + c21 * a1 + c22 * a2, k2 + c21 * b1 + c22 * b2
    gained1 = -(1.0 + restitution) * one.v - c11 * o1 - c12 * o2
    gained2 = -(1.0 + restitution) * two.v - c21 * o1 - c22 * o2
    if pressed == 1:
        n1 = gained1 / a11 if abs(a11) > _SINGULAR * k1 else -1.0
        return n1, 0.0, n1 > 0.0 and a21 * n1 >= gained2
    if pressed == 2:
        n2 = gained2 / a22 if abs(a22) > _SINGULAR * k2 else -1.0
        return 0.0, n2, n2 > 0.0 and a12 * n2 >= gained1
    determinant = a11 * a22 - a12 * a21
    if abs(determinant) <= _SINGULAR * k1 * k2:
        return 0.0, 0.0, False
    n1 = (a22 * gained1 - a12 * gained2) / determinant
    n2 = (a11 * gained2 - a21 * gained1) / determinant
    return n1, n2, n1 >= 0.0 and n2 >= 0.0 and n1 + n2 > 0.0


@inlined
def _may_rub(state: float, normal: float, tangent: float, left: float, friction: float) -> bool:
    """Whether friction holds a point that sticks (0), or acts against how one slides that does not."""
    if state == 0.0:
        return abs(tangent) <= friction * normal
    return normal == 0.0 or state * left <= 0.0


@inlined
def _by_cases(
    one: Lever, two: Lever, weights: Weights, restitution: float, friction: float
) -> tuple[Blow, bool]:
    """Return the impulses of two points in closed form, and whether there are any.

    Of all cases - which points are pressed, and whether each sticks or slides which way - it is the first
    that breaks no law.
    """
    for case in range(27):
        pressed, first, second = case // 9, case // 3 % 3, case % 3
        if (pressed == 1 and second != 1) or (pressed == 2 and first != 1):
            continue  # one that is not pressed has no friction
        state1 = 0.0 if first == 0 else 3.0 - 2.0 * first
        state2 = 0.0 if second == 0 else 3.0 - 2.0 * second
        rubbing = _rubbing(one, two, weights, friction, state1, state2)
        n1, n2, keeps = _pressing(one, two, weights, restitution, pressed, rubbing)
        if not keeps:
            continue
        t1 = rubbing.o1 + rubbing.a1 * n1 + rubbing.b1 * n2
        t2 = rubbing.o2 + rubbing.a2 * n1 + rubbing.b2 * n2
        if rubbing.alike:
            share = t1 / (n1 + n2)
            t1, t2 = share * n1, share * n2
        blow = Blow(n1, t1, n2, t2)
        _v1, left1, _v2, left2 = _after(one, two, weights, blow)
        if _may_rub(state1, n1, t1, left1, friction) and _may_rub(state2, n2, t2, left2, friction):
            return blow, True
    return Blow(0.0, 0.0, 0.0, 0.0), False


@inlined
def _both(one: Lever, two: Lever, weights: Weights, restitution: float, friction: float) -> Blow:
    """Return the impulses of two points: normals together, then friction, shared alike, until they stay.

    Where they do not within so many sweeps, as under friction that turns a body much, it goes by cases.
    """
    m1, m2 = 1.0 / _normal_element(weights, one, one), 1.0 / _normal_element(weights, two, two)
    between = _normal_element(weights, one, two)
    kt1, kt2 = _across_element(weights, one, one), _across_element(weights, two, two)
    blow = Blow(0.0, 0.0, 0.0, 0.0)
    for _ in range(_MAX_SWEEPS):
        v1, _s1, v2, _s2 = _after(one, two, weights, blow)
        n1, n2 = _two_normals(
            blow.normal1, blow.normal2, -m1 * (v1 + restitution * one.v), -m2 * (v2 + restitution * two.v),
            m1, m2, between,
        )  # fmt: skip
        t1, t2 = blow.tangent1, blow.tangent2
        changed = abs(n1 - blow.normal1) + abs(n2 - blow.normal2)
        if friction > 0.0:
            _v1, s1, _v2, s2 = _after(one, two, weights, Blow(n1, t1, n2, t2))
            t1 = min(max(t1 - 0.5 * s1 / kt1, -friction * n1), friction * n1)
            t2 = min(max(t2 - 0.5 * s2 / kt2, -friction * n2), friction * n2)
            changed += abs(t1 - blow.tangent1) + abs(t2 - blow.tangent2)
        blow = Blow(n1, t1, n2, t2)
        if changed <= 1e-15 * (n1 + n2):
            return blow
    exact, found = _by_cases(one, two, weights, restitution, friction)
    return exact if found else blow


@inlined
def _work_of_both(one: Lever, two: Lever, weights: Weights, blow: Blow) -> float:
    """Return the work of the impulses at two points, as a share of the sum of the magnitudes of its parts."""
    v1, s1, v2, s2 = _after(one, two, weights, blow)
    work = blow.normal1 * (one.v + v1) + blow.tangent1 * (one.sliding + s1)
    work += blow.normal2 * (two.v + v2) + blow.tangent2 * (two.sliding + s2)
    scale = abs(blow.normal1 * one.v) + abs(blow.tangent1 * one.sliding)
    scale += abs(blow.normal2 * two.v) + abs(blow.tangent2 * two.sliding)
    return work / scale if scale > 0.0 else 0.0


@inlined
def two_blows(
    one: Lever, two: Lever, weights: Weights, restitution: float, friction: float
) -> tuple[Blow, int]:
    """Return the impulses of two points of a pair that approach at once, as a box that lands flat.

    Then which law they obey.
    """
    blow = _both(one, two, weights, restitution, friction)
    if _work_of_both(one, two, weights, blow) <= _ROUNDING:
        return blow, NEWTON
    low, high = 0.0, restitution
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if _work_of_both(one, two, weights, _both(one, two, weights, middle, friction)) <= 0.0:
            low = middle
        else:
            high = middle
    blow = _both(one, two, weights, low, friction)
    if _work_of_both(one, two, weights, blow) > _ROUNDING:
        blow = _both(one, two, weights, low, 0.0)
    return blow, LOWERED
