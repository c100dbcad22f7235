"""The classical Runge-Kutta method."""

import numpy as np

from physicslab.kernels import Numbers, Rows, allocating_kernel
from physicslab.kernels.clock import step_grid
from physicslab.kernels.forces.budget import CLOCK, END
from physicslab.kernels.forces.force_calls import Calls, accelerate
from physicslab.kernels.ode.compensated import add


@allocating_kernel
def rk4(
    q: Numbers, v: Numbers, q_low: Numbers, v_low: Numbers, inverse_mass: Numbers, damping: Numbers,
    calls: Calls, places: Rows, h: float, steps: int,
) -> int:  # fmt: skip
    """Advance by ``steps`` steps of ``h`` seconds; return the number of force evaluations.

    ``q_low`` and ``v_low`` (n,) are the remainders of what moves, and are carried on. Behind the clock, v
    takes what causes give (:mod:`physicslab.kernels.forces.budget`).
    """
    n, clock = len(inverse_mass), places[CLOCK]
    begin, first = step_grid(q[clock], h)
    stage_q, stage_v, acceleration = q.copy(), v.copy(), np.empty(len(q))
    q_sum, v_sum = np.empty(n), np.empty(n)
    for step in range(steps):
        node = 0.0
        for i in range(n):
            q_sum[i] = v_sum[i] = 0.0
            stage_q[i], stage_v[i] = q[i], v[i]
        for stage in range(4):
            stage_q[clock] = begin + (first + step + node) * h
            accelerate(stage_q, stage_v, acceleration, inverse_mass, damping, calls)
            weight = h / 6.0 if stage == 0 or stage == 3 else h / 3.0
            node = 1.0 if stage == 2 else 0.5
            reach = node * h
            for i in range(n):
                q_sum[i] += weight * stage_v[i]
                v_sum[i] += weight * acceleration[i]
                stage_q[i] = q[i] + reach * stage_v[i]
                stage_v[i] = v[i] + reach * acceleration[i]
            for i in range(clock + 1, places[END]):
                v[i] += weight * acceleration[i]
        for i in range(n):
            q[i], q_low[i] = add(q[i], q_low[i], q_sum[i])
            v[i], v_low[i] = add(v[i], v_low[i], v_sum[i])
    q[clock] = begin + (first + steps) * h
    return 4 * steps
