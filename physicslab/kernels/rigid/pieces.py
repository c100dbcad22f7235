"""A smooth piece of motion: one Runge-Kutta step of bodies whose points go on with what they do."""

import math
from typing import NamedTuple

from physicslab.kernels import Numbers, Vectors, fused, inlined
from physicslab.kernels.ode.dop853 import largest, step_error
from physicslab.kernels.ode.dop853_tableau import LAST, WEIGHTS
from physicslab.kernels.rigid.constraints import constrained_acceleration
from physicslab.kernels.rigid.equations import Equations
from physicslab.kernels.rigid.features import Scene

__all__ = ["Stages", "StagesTuple", "begin_piece", "make_piece", "named_stages"]

_LEADS = 1e-4
"""Share of the largest coordinate that must be covered in a step for speeds to be measured by themselves."""


class Stages(NamedTuple):
    """Rates of places and of speeds at each stage (3 rows, 16), and room for a state and its acceleration."""

    rates: Vectors
    pushes: Vectors
    q: Numbers
    v: Numbers
    acceleration: Numbers


StagesTuple = tuple[Vectors, Vectors, Numbers, Numbers, Numbers]


@fused
def named_stages(plain: StagesTuple) -> Stages:
    """Give names to a tuple."""
    return Stages(plain[0], plain[1], plain[2], plain[3], plain[4])


@fused
def begin_piece(
    scene: Scene, equations: Equations, count: int, q: Numbers, v: Numbers, stages: Stages
) -> None:
    """Compute the first stage, from which pieces of any length can begin."""
    constrained_acceleration(scene, equations, count, q, v, stages.acceleration)
    for i in range(len(v)):
        stages.rates[i, 0], stages.pushes[i, 0] = v[i], stages.acceleration[i]


@inlined
def make_piece(
    scene: Scene, equations: Equations, count: int, q: Numbers, v: Numbers, h: float, tolerance: float,
    stages: Stages,
) -> float:  # fmt: skip
    """Make a step of ``h`` seconds from (q, v), which stay; the end is left in ``stages``.

    Returns the estimated error, 1 where it is just tolerated. Points are measured at the end, with the forces
    there.
    """
    n = len(v)
    for stage in range(1, LAST + 1):
        for i in range(n):
            moved, pushed = 0.0, 0.0
            for other in range(stage):
                moved += WEIGHTS[stage, other] * stages.rates[i, other]
                pushed += WEIGHTS[stage, other] * stages.pushes[i, other]
            stages.q[i] = q[i] + h * moved
            stages.v[i] = v[i] + h * pushed
        constrained_acceleration(scene, equations, count, stages.q, stages.v, stages.acceleration)
        for i in range(n):
            stages.rates[i, stage], stages.pushes[i, stage] = stages.v[i], stages.acceleration[i]
    n, free = 3 * scene.rows, 0  # without the clock
    for i in range(n):  # rows of what is fixed, or gone, are no reason for another step
        free += 1 if scene.inverse_mass[i] > 0.0 else 0
    q_scale = max(largest(q, n), largest(stages.q, n))
    v_scale = max(largest(v, n), largest(stages.v, n))
    v_scale = max(v_scale, _LEADS * q_scale / h)
    error = step_error(stages.rates, stages.pushes, max(free, 1), h, q_scale, v_scale, tolerance)
    return error if math.isfinite(error) else math.inf
