"""Stronge's law of impact: closed forms, its laws on random points, and the same by integration."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numba
import numpy as np
import pytest
from compiled import compiled
from hypothesis import given, settings
from hypothesis import strategies as st

from physicslab.kernels.constraint import impact_law
from physicslab.kernels.constraint.impact_law import PointResponse
from physicslab.kernels.constraint.pair import PairInverseMass, PointState

MANY = 10 * settings().max_examples
"""Random impacts: a thousandth of a second each."""

_stronge: Any = compiled(impact_law.stronge_impulse)
solve_impact: Any = compiled(impact_law.solve_impact)
solve_impact_of_two: Any = compiled(impact_law.solve_impact_of_two)
pair_response: Any = compiled(impact_law.pair_response)


def stronge_impulse(
    kn: float, kt: float, between: float, v: float, sliding: float, e: float, mu: float
) -> Any:
    return _stronge(PointResponse(kn, kt, between, v, sliding), e, mu)


class Impact(NamedTuple):
    """An impact at a point: what impulses cause [1/kg], its speeds [m/s], e and mu."""

    kn: float
    kt: float
    between: float
    v: float
    sliding: float
    e: float
    mu: float


# ---- closed forms, worked out by hand ----------------------------------------------------------------------


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
def test_a_point_that_slides_all_the_time_obeys_newton(e: float, side: float) -> None:
    # The approach changes by 2 - 0.5 a unit, the sliding of 9 by 1 - 1.
    found = stronge_impulse(2.0, 2.0, side, -3.0, side * 9.0, e, 0.5)
    pressed = (1.0 + e) * 3.0 / 1.5
    assert found == pytest.approx((pressed, -side * 0.5 * pressed), rel=1e-15)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
def test_sliding_that_stops_in_the_approach_is_held(e: float, side: float) -> None:
    # After 1/2 the sliding has stopped, and the approach is 1/2; the work so far is 3/8, and 1/12 to its end.
    found = stronge_impulse(2.0, 2.0, side, -1.0, side * 0.5, e, 1.0)
    later = (0.5 + math.sqrt(3.0 * e * e * (3 / 8 + 1 / 12))) / 1.5
    assert found == pytest.approx((0.5 + later, -side * (0.5 + 0.5 * later)), rel=1e-15)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
def test_sliding_that_friction_cannot_hold_turns_round(e: float, side: float) -> None:
    # After 1/3 the approach is 1/4; friction of 1/4 does not hold what 1/2 would: it acts the other way now.
    found = stronge_impulse(2.0, 2.0, side, -1.0, -side * 0.5, e, 0.25)
    taken = 0.5 * 1.25 / 3.0 + 0.5 * 0.25**2 / 1.75
    later = (0.25 + e * math.sqrt(2.0 * 1.75 * taken)) / 1.75
    assert found == pytest.approx((1 / 3 + later, side * 0.25 * (1 / 3 - later)), rel=1e-15)


@pytest.mark.parametrize("e", [0.5, 1.0])
def test_sliding_that_stops_in_restitution(e: float) -> None:
    # The approach of 1 ends after 1; the sliding of 1.25 stops after 1.25, and it leaves with 1/4 by then.
    found = stronge_impulse(2.0, 2.0, 1.0, -1.0, 1.25, e, 1.0)
    given_later = 0.5 * e * e - 0.5 * 0.25**2
    later = (math.sqrt(0.25**2 + 2.0 * 1.5 * given_later) - 0.25) / 1.5
    assert found == pytest.approx((1.25 + later, -1.25 - 0.5 * later), rel=1e-14)


@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
def test_a_rod_that_jams_approaches_faster_until_its_end_sticks(e: float) -> None:
    # Self-locking: while it slides, friction presses more than the impulse resists. From 1 to 1.125 in 1/4.
    found = stronge_impulse(2.0, 2.0, 1.0, -1.0, 1.0, e, 2.5)
    taken = 0.25 * 0.5 * (1.0 + 1.125) + 0.5 * 1.125**2 / 1.5
    later = (1.125 + e * math.sqrt(2.0 * 1.5 * taken)) / 1.5
    assert found == pytest.approx((0.25 + later, -2.5 * 0.25 - 0.5 * later), rel=1e-15)


def test_a_point_that_no_impulse_moves_apart_gives_numbers() -> None:
    """Of a singular response, which is what rounding leaves of a body of next to no inertia."""
    for sliding in (1.0, -1.0, 0.0):
        assert np.isfinite(stronge_impulse(1.0, 1.0, 1.0, -1.0, sliding, 0.5, 2.0)).all()
        assert np.isfinite(stronge_impulse(1.0, 1.0, 1.0, -1.0, sliding, 0.5, 1.0)).all()


# ---- any point: the laws, and the equations of Darboux and Keller ------------------------------------------


@st.composite
def points(draw: st.DrawFn) -> Impact:
    """Return any point of two rigid bodies that approach."""
    masses, arms = st.floats(0.05, 5.0), st.floats(-2.0, 2.0)
    ma, mb, ia, ib = (draw(masses) for _ in range(4))
    na, nb, ta, tb = (draw(arms) for _ in range(4))
    return Impact(
        ma + mb + ia * na * na + ib * nb * nb, ma + mb + ia * ta * ta + ib * tb * tb,
        ia * na * ta + ib * nb * tb, -draw(st.floats(1e-3, 10.0)),
        draw(st.one_of(st.just(0.0), st.floats(-10.0, 10.0))), draw(st.floats(0.0, 1.0)),
        draw(st.one_of(st.just(0.0), st.floats(0.0, 3.0))),
    )  # fmt: skip


def normal_work(impact: Impact, normal: float) -> tuple[float, float]:
    """Return the work that the normal force takes and gives back up to a normal impulse [J].

    By parts: the sliding is linear between the impulses at which it starts and stops.
    """
    kn, kt, between, v, sliding, _e, mu = impact
    taken, given_back, done = 0.0, 0.0, 0.0
    while done < normal:
        if sliding != 0.0:
            share = -math.copysign(mu, sliding)
            slowed = between + kt * share
            end = done - sliding / slowed if slowed * sliding < 0.0 else math.inf
        else:
            share = max(-mu, min(mu, -between / kt))
            end = math.inf
        part, rise = min(end, normal) - done, kn + between * share
        until_still = -v / rise if rise > 0.0 and v < 0.0 else (0.0 if v >= 0.0 else math.inf)
        first = min(part, until_still)
        taken -= first * (v + 0.5 * rise * first)
        given_back += (part - first) * (v + rise * first + 0.5 * rise * (part - first))
        v += rise * part
        sliding = 0.0 if end <= normal else sliding
        done = min(end, normal)
    return taken, given_back


@settings(max_examples=MANY, deadline=None)
@given(points())
def test_every_impact_keeps_the_laws(impact: Impact) -> None:
    kn, kt, between, v, sliding, e, mu = impact
    normal, tangent = stronge_impulse(*impact)
    assert normal > 0.0
    assert abs(tangent) <= mu * normal * (1.0 + 1e-14)
    taken, given_back = normal_work(impact, normal)
    assert given_back == pytest.approx(e * e * taken, rel=1e-9, abs=1e-9 * taken)
    leaving = v + kn * normal + between * tangent
    left = sliding + between * normal + kt * tangent
    scale = normal * abs(v) + abs(tangent * sliding)
    assert leaving >= -1e-13 * (kn * normal + abs(v))
    assert normal * (v + leaving) + tangent * (sliding + left) <= 1e-13 * scale


@settings(max_examples=MANY // 2, deadline=None)
@given(points(), st.sampled_from([1e-3, 0.1, 1e3]))
def test_an_impact_scales_and_is_mirrored(impact: Impact, factor: float) -> None:
    kn, kt, between, v, sliding, e, mu = impact
    normal, tangent = stronge_impulse(*impact)
    assert stronge_impulse(kn, kt, -between, v, -sliding, e, mu) == (normal, -tangent)
    faster = stronge_impulse(kn, kt, between, factor * v, factor * sliding, e, mu)
    assert faster == pytest.approx((factor * normal, factor * tangent), rel=1e-9, abs=1e-12 * factor * normal)


def by_parts(
    kn: float, kt: float, between: float, v: float, sliding: float, e: float, mu: float, parts: int
) -> tuple[float, float]:
    """Return the impulses by small parts of the normal one: dv/dp = kn + between f, ds/dp = between + kt f.

    The friction f in [-mu, mu] of each part is what brings the sliding nearest to rest: no cases are told
    apart (implicit Euler, of order one).
    """
    part, normal, tangent, balance = -v / (kn * parts), 0.0, 0.0, 0.0
    taken = -1.0
    while True:
        f = min(max(-(sliding / part + between) / kt, -mu), mu)
        after = v + part * (kn + between * f)
        work = 0.5 * part * (v + after)
        if taken < 0.0 and after >= 0.0:
            taken = -balance
            balance = 0.0
            if e == 0.0:
                return normal, tangent
        if taken >= 0.0 and balance + work >= e * e * taken:
            return normal, tangent
        v, sliding = after, sliding + part * (between + kt * f)
        normal, tangent, balance = normal + part, tangent + f * part, balance + work


integrated: Any = numba.njit(by_parts)


@settings(max_examples=MANY // 2, deadline=None)
@given(points())
def test_impulses_are_those_of_the_equations_of_darboux_and_keller(impact: Impact) -> None:
    found = stronge_impulse(*impact)
    reach = max(impact.mu, 1.0)
    coarse, fine = (integrated(*impact, parts) for parts in (2_000, 20_000))
    for k in range(2):
        scale = reach * found[0]
        assert fine[k] == pytest.approx(found[k], abs=4e-3 * scale)
        assert coarse[k] == pytest.approx(found[k], abs=4e-2 * scale)


# ---- when it takes over ------------------------------------------------------------------------------------


@settings(max_examples=MANY, deadline=None)
@given(
    st.tuples(*(st.floats(0.05, 5.0) for _ in range(3))),
    st.tuples(*(st.floats(-2.0, 2.0) for _ in range(4))),
    st.floats(1e-3, 10.0), st.floats(-10.0, 10.0), st.floats(0.0, 1.0), st.floats(0.0, 2.0),
)  # fmt: skip
def test_it_takes_over_where_newton_makes_energy_and_nowhere_else(
    weights: Any, arms: Any, approach: float, sliding: float, e: float, mu: float
) -> None:
    both, turn_a, turn_b = weights
    na, nb, ta, tb = arms
    kn, kt = both + turn_a * na * na + turn_b * nb * nb, both + turn_a * ta * ta + turn_b * tb * tb
    between = turn_a * na * ta + turn_b * nb * tb
    normal, tangent, law = solve_impact(PointResponse(kn, kt, between, -approach, sliding), e, mu)
    v = -approach + kn * normal + between * tangent
    left = sliding + between * normal + kt * tangent
    work = normal * (v - approach) + tangent * (left + sliding)
    scale = abs(normal * approach) + abs(tangent * sliding)
    assert work <= 1e-11 * scale
    if law == impact_law.NEWTON:
        assert v == pytest.approx(e * approach, abs=1e-9 * (kn * normal))
    else:
        assert law == impact_law.ENERGETIC
        found = stronge_impulse(kn, kt, between, -approach, sliding, e, mu)
        assert (normal, tangent) == pytest.approx(found, rel=1e-9, abs=1e-12 * normal)
        # Newton's law: sticking, or sliding at the edge against the sliding that is left.
        gained = (1.0 + e) * approach
        stuck = np.linalg.solve([[kn, between], [between, kt]], [gained, -sliding])
        if abs(stuck[1]) <= mu * stuck[0]:
            asked = stuck
        else:
            edges = [
                edge
                for edge in (-mu, mu)
                if kn + edge * between > 0.0
                and edge * (sliding + gained * (between + kt * edge) / (kn + edge * between)) <= 0.0
            ]
            asked = gained / (kn + edges[0] * between) * np.array((1.0, edges[0]))
        assert asked @ (e * approach - approach, 2.0 * sliding + between * asked[0] + kt * asked[1]) > 0.0


def test_two_points_at_once_have_their_restitution_lowered_instead() -> None:
    """No accepted law has the order in which they end their approach."""
    random, lowered = np.random.default_rng(3), 0
    for _ in range(3000):
        both, turn_a, turn_b = random.uniform(0.05, 5.0, 3)
        na, nb, ta, tb = random.uniform(-2.0, 2.0, 4)
        apart, v, turning = random.uniform(0.1, 2.0), -random.uniform(0.1, 3.0), random.uniform(-1.0, 1.0)
        sliding, e, mu = random.normal(0.0, 3.0), random.random(), random.uniform(0.0, 1.5)
        one = PointState(na, nb, ta, tb, v, sliding)
        two = PointState(na + apart, nb + apart, ta, tb, v + turning * apart, sliding)
        if two.v >= 0.0:
            continue
        response = pair_response(one, two, PairInverseMass(0.5 * both, turn_a, 0.5 * both, turn_b))
        found, used = solve_impact_of_two(response, e, mu)
        normal, tangent = found.normal1 + found.normal2, found.tangent1 + found.tangent2
        moments = []
        for levers, turn in (((na, na + apart, ta), turn_a), ((nb, nb + apart, tb), turn_b)):
            arm_1, arm_2, across = levers
            moments.append((turn, arm_1 * found.normal1 + arm_2 * found.normal2 + across * tangent))
        work = normal * v + found.normal2 * turning * apart + tangent * sliding
        work += 0.5 * (both * (normal**2 + tangent**2) + sum(turn * moment**2 for turn, moment in moments))
        scale = abs(found.normal1 * one.v) + abs(found.normal2 * two.v) + abs(tangent * sliding)
        assert work <= 1e-11 * scale
        assert abs(found.tangent1) <= mu * found.normal1 * (1.0 + 1e-12)
        assert abs(found.tangent2) <= mu * found.normal2 * (1.0 + 1e-12)
        lowered += used < e
    assert lowered > 20
