"""The four measures of joints: value, gradient and Jdot v against 30 digits, compiled and as Python."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest
from compiled import compiled

from physicslab.kernels.interpreter import fallback_of
from physicslab.kernels.joints.terms import ALONG, ALONG_A, ANGLE, DISTANCE, TermEnd, measure_term

MEASURES = pytest.mark.parametrize("measure", [ALONG, ALONG_A, DISTANCE, ANGLE])
TIERS: list[Any] = [compiled(measure_term), fallback_of(measure_term)]


def by_digits(measure: int, a: TermEnd, b: TermEnd, axis: tuple[float, float]) -> list[mpmath.mpf]:
    """Return value, gradient and Jdot v by differences of 30 digits."""

    def turned(x: float, y: float, angle: mpmath.mpf) -> mpmath.matrix:
        c, s = mpmath.cos(angle), mpmath.sin(angle)
        return mpmath.matrix([c * x - s * y, s * x + c * y])

    def value(*q: mpmath.mpf) -> mpmath.mpf:
        at_a = mpmath.matrix(q[0:2]) + turned(a.anchor_x, a.anchor_y, q[2])
        apart = mpmath.matrix(q[3:5]) + turned(b.anchor_x, b.anchor_y, q[5]) - at_a
        n = turned(*axis, q[2]) if measure == ALONG_A else mpmath.matrix(axis)
        along = n[0] * apart[0] + n[1] * apart[1]
        return {DISTANCE: mpmath.norm(apart), ANGLE: q[5] - q[2]}.get(measure, along)

    q = [mpmath.mpf(x) for x in (a.x, a.y, a.angle, b.x, b.y, b.angle)]
    v = (a.vx, a.vy, a.spin, b.vx, b.vy, b.spin)
    gradient = [mpmath.diff(value, tuple(q), tuple(int(i == k) for i in range(6))) for k in range(6)]
    rate = mpmath.diff(lambda t: value(*(x + t * dx for x, dx in zip(q, v, strict=True))), 0, 2)
    return [value(*q), *gradient, rate]


@MEASURES
@pytest.mark.parametrize("far", [0.0, 1e8])
def test_gradient_and_jdot_v_are_those_of_30_digits(measure: int, far: float) -> None:
    random = np.random.default_rng(measure)
    for _ in range(3):
        one, other = (random.uniform(-2.0, 2.0, 8).tolist() for _ in range(2))
        one[0], other[0] = one[0] + far, other[0] + far
        a, b, angle = TermEnd(*one), TermEnd(*other), float(random.uniform(0.0, 6.0))
        axis = float(np.cos(angle)), float(np.sin(angle))
        with mpmath.workdps(40):
            expected = [float(x) for x in by_digits(measure, a, b, axis)]
        for tier in TIERS:
            assert tuple(tier(measure, a, b, *axis)) == pytest.approx(expected, rel=1e-13, abs=2e-14)


@MEASURES
def test_both_tiers_have_the_same_bits(measure: int) -> None:
    random = np.random.default_rng(7)
    for _ in range(20):
        a, b = (TermEnd(*random.normal(size=8).tolist()) for _ in range(2))
        assert len({tuple(tier(measure, a, b, 0.6, 0.8)) for tier in TIERS}) == 1


def test_a_distance_of_zero_has_no_direction() -> None:
    a = TermEnd(1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0)
    b = TermEnd(2.0, 2.0, 0.0, 3.0, 1.0, 2.0, -0.5, 0.0)
    for tier in TIERS:
        assert not any(tier(DISTANCE, a, b, 1.0, 0.0))


def test_a_circle_is_run_through_with_the_acceleration_of_its_speed() -> None:
    a, b = TermEnd(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), TermEnd(3.0, 4.0, 0.0, -8.0, 6.0, 0.0, 0.0, 0.0)
    for tier in TIERS:
        one = tier(DISTANCE, a, b, 1.0, 0.0)
        assert (one.value, one.bx, one.by, one.rate) == pytest.approx(
            (5.0, 0.6, 0.8, 10.0**2 / 5.0), abs=1e-15
        )
