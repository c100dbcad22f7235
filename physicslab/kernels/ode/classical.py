"""The classical Runge-Kutta method."""

import numpy as np

from physicslab.kernels import Numbers, allocating_kernel
from physicslab.kernels.forces.force_calls import Calls, accelerate
from physicslab.kernels.ode.compensated import add

__all__ = ["rk4"]


@allocating_kernel
def rk4(
    q: Numbers, v: Numbers, inverse_mass: Numbers, damping: Numbers, calls: Calls, h: float, steps: int
) -> int:
    """Advance by ``steps`` steps of ``h`` seconds; return the number of force evaluations."""
    n = len(inverse_mass)
    stage_q, stage_v, acceleration = q.copy(), v.copy(), np.empty(len(q))
    q_sum, v_sum = np.empty(n), np.empty(n)
    q_low, v_low = np.zeros(n), np.zeros(n)
    for _ in range(steps):
        for i in range(n):
            q_sum[i] = v_sum[i] = 0.0
            stage_q[i], stage_v[i] = q[i], v[i]
        for stage in range(4):
            accelerate(stage_q, stage_v, acceleration, inverse_mass, damping, calls)
            weight = h / 6.0 if stage == 0 or stage == 3 else h / 3.0
            reach = h if stage == 2 else 0.5 * h
            for i in range(n):
                q_sum[i] += weight * stage_v[i]
                v_sum[i] += weight * acceleration[i]
                stage_q[i] = q[i] + reach * stage_v[i]
                stage_v[i] = v[i] + reach * acceleration[i]
        for i in range(n):
            q[i], q_low[i] = add(q[i], q_low[i], q_sum[i])
            v[i], v_low[i] = add(v[i], v_low[i], v_sum[i])
    return 4 * steps
