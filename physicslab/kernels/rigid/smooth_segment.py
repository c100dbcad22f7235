"""A smooth segment of motion: one Runge-Kutta step of bodies whose points go on with what they do."""

import math
from typing import NamedTuple

import numpy as np

from physicslab.kernels import Numbers, Vectors, always_inlined, inlined
from physicslab.kernels.ode.dop853_tableau import ESTIMATE_3, ESTIMATE_5, LAST, WEIGHTS
from physicslab.kernels.rigid.constraints import constrained_acceleration
from physicslab.kernels.rigid.equations import Equations
from physicslab.kernels.rigid.features import RigidScene

SHORT_LAST = 6
"""The stage that is the end of a short step."""
METHODS = np.zeros((2, LAST + 1, LAST + 1))
"""The weights of the stages of both methods; those of order 5 are of Dormand & Prince, J. Comp. Appl. Math. 6
(1980) 19."""
METHODS[0] = WEIGHTS[: LAST + 1, : LAST + 1]
for _stage, _weights in enumerate(
    (
        (1 / 5,),
        (3 / 40, 9 / 40),
        (44 / 45, -56 / 15, 32 / 9),
        (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
        (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656),
        (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84),
    )
):
    METHODS[1, _stage + 1, : len(_weights)] = _weights
_LEADS = 1e-4
"""Share of the largest coordinate that must be covered in a step for speeds to be measured by themselves."""


class Stages(NamedTuple):
    """Rates of places and of speeds at each stage (16, n), room for a state and its acceleration.

    A stage is a row, so that sums over stages are made for many coordinates at a time.
    """

    rates: Vectors
    pushes: Vectors
    q: Numbers
    v: Numbers
    acceleration: Numbers


@always_inlined
def begin_segment(
    scene: RigidScene, equations: Equations, count: int, q: Numbers, v: Numbers, stages: Stages
) -> None:
    """Compute the first stage, from which segments of any length can begin."""
    constrained_acceleration(scene, equations, count, q, v, stages.acceleration)
    for i in range(len(v)):
        stages.rates[0, i], stages.pushes[0, i] = v[i], stages.acceleration[i]


@inlined
def largest_free(scene: RigidScene, values: Numbers) -> float:
    """Return the largest magnitude of ``values`` (3 rows,) of what can move.

    A fixed body far away is no measure of errors.
    """
    found = 0.0
    for i in range(3 * scene.rows):
        if scene.inverse_mass[i] > 0.0:
            found = max(found, abs(values[i]))
    return found


@inlined
def _error(
    stages: Stages, n: int, free: int, h: float, q_scale: float, v_scale: float, tolerance: float
) -> float:
    """Return a segment's estimated error (Hairer's), a mean over ``free`` coordinates; 1 is tolerated."""
    fifth, third = 0.0, 0.0
    for i in range(n):
        moved, pushed, moved_low, pushed_low = 0.0, 0.0, 0.0, 0.0
        for stage in range(LAST):
            rate, push = stages.rates[stage, i], stages.pushes[stage, i]
            moved += ESTIMATE_5[stage] * rate
            pushed += ESTIMATE_5[stage] * push
            moved_low += ESTIMATE_3[stage] * rate
            pushed_low += ESTIMATE_3[stage] * push
        if q_scale > 0.0:
            moved, moved_low = moved / q_scale, moved_low / q_scale
            fifth += moved * moved
            third += moved_low * moved_low
        if v_scale > 0.0:
            pushed, pushed_low = pushed / v_scale, pushed_low / v_scale
            fifth += pushed * pushed
            third += pushed_low * pushed_low
    if fifth == 0.0:
        return 0.0
    return h * fifth / math.sqrt((fifth + 0.01 * third) * 2 * free) / tolerance


@always_inlined
def make_stages(
    scene: RigidScene, equations: Equations, count: int, q: Numbers, v: Numbers, h: float, short: bool,
    stages: Stages,
) -> None:  # fmt: skip
    """Make a step of ``h`` seconds from (q, v), which stay; the end is left in ``stages``.

    By Dormand and Prince's method of order 8, or by theirs of order 5 where it is ``short``. Points are
    measured at the end, with the forces there.
    """
    n, method = len(v), 1 if short else 0
    for stage in range(1, (SHORT_LAST if short else LAST) + 1):
        for i in range(n):
            stages.q[i] = stages.v[i] = 0.0
        for other in range(stage):
            weight = METHODS[method, stage, other]
            if weight != 0.0:
                for i in range(n):
                    stages.q[i] += weight * stages.rates[other, i]
                    stages.v[i] += weight * stages.pushes[other, i]
        for i in range(n):
            stages.q[i] = q[i] + h * stages.q[i]
            stages.v[i] = v[i] + h * stages.v[i]
        constrained_acceleration(scene, equations, count, stages.q, stages.v, stages.acceleration)
        for i in range(n):
            stages.rates[stage, i], stages.pushes[stage, i] = stages.v[i], stages.acceleration[i]


@inlined
def make_segment(
    scene: RigidScene, equations: Equations, count: int, q: Numbers, v: Numbers, h: float, tolerance: float,
    stages: Stages,
) -> float:  # fmt: skip
    """Make a step of order 8; return the estimated error, 1 where it is just tolerated."""
    make_stages(scene, equations, count, q, v, h, False, stages)
    n, free = 3 * scene.rows, 0  # without the clock
    for i in range(n):  # rows of what is fixed, or gone, are no reason for another step
        free += 1 if scene.inverse_mass[i] > 0.0 else 0
    # The scale is that of the start: in a step beyond the limit of stability the end grows with the error.
    q_start, v_start = largest_free(scene, q), largest_free(scene, v)
    push = 0.0
    for i in range(n):
        push = max(push, abs(stages.pushes[0, i]))
    v_scale = min(max(v_start, largest_free(scene, stages.v)), v_start + h * push)
    q_scale = min(max(q_start, largest_free(scene, stages.q)), q_start + h * v_scale)
    error = _error(stages, n, max(free, 1), h, q_scale, max(v_scale, _LEADS * q_scale / h), tolerance)
    return error if math.isfinite(error) else math.inf
