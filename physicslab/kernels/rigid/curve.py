"""The curve through both ends of a segment of motion: where it crosses a limit, a segment ends.

It is the polynomial of degree five in time that has the places, speeds and accelerations of both ends
(Hermite). Its error is of order h^6: that of a short segment is rounding, and the state on the curve is the
state. Where it is not, a time found on the curve is the first trial of a location, and often the last: each
trial on the segment itself takes twelve sets of contact forces.
"""

import math

from physicslab.kernels import Numbers, always_inlined, inlined
from physicslab.kernels.ode.dop853_tableau import LAST
from physicslab.kernels.rigid.constraints import constrained_acceleration
from physicslab.kernels.rigid.equations import Equations
from physicslab.kernels.rigid.features import RigidScene
from physicslab.kernels.rigid.smooth_segment import METHODS, SHORT_LAST, Stages, largest_free

_THIRD, _FOURTH, _FIFTH = LAST + 1, LAST + 2, LAST + 3
"""Rows of the rates that hold the coefficients of the curve, in shares of the segment [m]."""
_CHECKED = 0.2
"""Share of a segment at which the accelerations of the curve are checked: errors of places and of speeds at
its end show there, and those of its form."""
_TO_SPEED, _TO_PLACE = 0.8, 0.5
"""Factors of errors of acceleration, with h or h^2, for those of speeds and places."""


@inlined
def fit_curve(stages: Stages, v: Numbers, h: float, short: bool) -> None:
    """Keep the curve of the segment of ``h`` seconds that was just made; segments of other lengths leave it.

    The rest at the end after the first three terms is summed of differences of the stages: for a
    short segment it would be lost in the rounding of places.
    """
    method, last = 1 if short else 0, SHORT_LAST if short else LAST
    for i in range(len(v)):
        place, speed = 0.0, 0.0
        for stage in range(last):
            place += METHODS[method, last, stage] * (stages.rates[stage, i] - v[i])
            speed += METHODS[method, last, stage] * (stages.pushes[stage, i] - stages.pushes[0, i])
        place = h * (place - 0.5 * h * stages.pushes[0, i])
        speed *= h * h
        change = 0.5 * h * h * (stages.pushes[last, i] - stages.pushes[0, i])
        stages.rates[_THIRD, i] = 10.0 * place - 4.0 * speed + change
        stages.rates[_FOURTH, i] = -15.0 * place + 7.0 * speed - 2.0 * change
        stages.rates[_FIFTH, i] = 6.0 * place - 3.0 * speed + change


@inlined
def _place(stages: Stages, q: Numbers, v: Numbers, h: float, s: float, i: int) -> None:
    bend = 0.5 * h * h * stages.pushes[0, i]
    third, fourth, fifth = stages.rates[_THIRD, i], stages.rates[_FOURTH, i], stages.rates[_FIFTH, i]
    stages.q[i] = q[i] + s * (h * v[i] + s * (bend + s * (third + s * (fourth + s * fifth))))
    stages.v[i] = v[i] + s * (2.0 * bend + s * (3.0 * third + s * (4.0 * fourth + s * 5.0 * fifth))) / h


@inlined
def place_on_curve(stages: Stages, q: Numbers, v: Numbers, h: float, t: float) -> None:
    """Leave in ``stages`` the state at time ``t`` on the curve of a segment of ``h`` seconds from (q, v)."""
    for i in range(len(q)):
        _place(stages, q, v, h, t / h, i)


@inlined
def place_bodies(
    stages: Stages, q: Numbers, v: Numbers, h: float, t: float, rows: int, one: int, other: int
) -> None:
    """Leave two bodies where they are at time ``t`` on the curve, and no others."""
    for side in range(2):
        row = one if side == 0 else other
        for k in range(3):
            _place(stages, q, v, h, t / h, 2 * row + k if k < 2 else 2 * rows + row)


@always_inlined
def curve_is_exact(
    scene: RigidScene, equations: Equations, count: int, q: Numbers, v: Numbers, h: float, tolerance: float,
    stages: Stages,
) -> bool:  # fmt: skip
    """Whether the state on the curve is that of the motion, to within the tolerance of a segment."""
    s, n, exact = _CHECKED, 3 * scene.rows, True
    place_on_curve(stages, q, v, h, s * h)
    constrained_acceleration(scene, equations, count, stages.q, stages.v, stages.acceleration)
    q_limit = tolerance * max(largest_free(scene, q), largest_free(scene, stages.q))
    v_limit = tolerance * max(largest_free(scene, v), largest_free(scene, stages.v))
    for i in range(n):
        third, fourth, fifth = stages.rates[_THIRD, i], stages.rates[_FOURTH, i], stages.rates[_FIFTH, i]
        bent = stages.pushes[0, i] + s * (6.0 * third + s * (12.0 * fourth + s * 20.0 * fifth)) / (h * h)
        off = abs(stages.acceleration[i] - bent)
        exact = exact and _TO_SPEED * h * off <= v_limit and _TO_PLACE * h * h * off <= q_limit
    return exact and math.isfinite(q_limit + v_limit)
