"""Splitting methods: each is a list of drifts and kicks."""

import math

import numpy as np

from physicslab.kernels import Numbers, Rows, allocating_kernel
from physicslab.kernels.forces.bookings import CLOCK, END, KEPT, book_kick
from physicslab.kernels.forces.force_calls import Calls, accelerate
from physicslab.kernels.ode.compensated import add


@allocating_kernel
def split(
    q: Numbers, v: Numbers, q_low: Numbers, v_low: Numbers, inverse_mass: Numbers, damping: Numbers,
    calls: Calls, drifts: Numbers, kicks: Numbers, places: Rows, h: float, steps: int,
) -> int:  # fmt: skip
    """Advance by ``steps`` steps of ``h`` seconds; return the number of force evaluations.

    A step is kick, drift, kick, ..., drift, kick, with the shares ``kicks`` (n + 1,) and ``drifts`` (n,) of
    h. A kick with no motion since the last one reuses its forces. Damping v' = -c v goes with
    the kicks and is solved exactly: v(h) = v e^(-c h) + a (1 - e^(-c h)) / c. Sums are compensated:
    ``q_low`` and ``v_low`` (n,) are the remainders of what moves, and are carried on. The time goes on with
    the drifts, as the coordinates do. Behind it, v takes what causes give
    (:mod:`physicslab.kernels.forces.bookings`), with ``places``: in a kick, by the mean velocity.
    """
    n, clock = len(inverse_mass), places[CLOCK]
    start, kept = q[clock], len(places) > KEPT
    acceleration = np.empty(len(q))
    undamped = np.empty(0)
    known, evaluations = False, 0
    for step in range(steps):
        moved = 0.0
        for stage in range(len(kicks)):
            kick = kicks[stage] * h
            if kick != 0.0:
                if not known:
                    q[clock] = start + (step + moved) * h
                    accelerate(q, v, acceleration, inverse_mass, undamped, calls)
                    known = True
                    evaluations += 1
                for i in range(clock + 1, places[END]):
                    v[i] += kick * acceleration[i]
                if len(damping) == 0:
                    if kept:
                        for i in range(n):
                            change = kick * acceleration[i]
                            book_kick(q, v, places, i, acceleration, inverse_mass[i], 0.0, kick, change)
                    for i in range(n):
                        v[i], v_low[i] = add(v[i], v_low[i], kick * acceleration[i])
                else:
                    for i in range(n):
                        c = damping[i]
                        if c > 0.0:
                            gain = -math.expm1(-c * kick)
                            change = (acceleration[i] / c - v[i]) * gain
                        else:
                            change = kick * acceleration[i]
                        book_kick(q, v, places, i, acceleration, inverse_mass[i], c, kick, change)
                        v[i], v_low[i] = add(v[i], v_low[i], change)
            if stage < len(drifts):
                drift = drifts[stage] * h
                moved += drifts[stage]
                for i in range(n):
                    q[i], q_low[i] = add(q[i], q_low[i], drift * v[i])
                known = False
    q[clock] = start + steps * h
    return evaluations
