"""Splitting methods: each is a list of drifts and kicks."""

import math

import numpy as np

from physicslab.kernels import Numbers, Rows, allocating_kernel, inlined
from physicslab.kernels.accounts import book
from physicslab.kernels.clock import step_grid
from physicslab.kernels.forces.budget import CLOCK, END, KEPT, book_kick
from physicslab.kernels.forces.force_calls import Calls, accelerate
from physicslab.kernels.ode.compensated import add


@inlined
def _go_round(
    q: Numbers, v: Numbers, q_low: Numbers, v_low: Numbers, inverse_mass: Numbers, i: int, rate: float,
    span: float, field: int,
) -> None:  # fmt: skip
    """Move the body with coordinates i and i + 1 along an arc for ``span`` seconds, exactly.

    Its velocity turns clockwise at ``rate``; over half the span it has the direction of the chord.
    """
    half = 0.5 * rate * span
    s, c = math.sin(half), math.cos(half)
    x, y, along, across = q[i], q[i + 1], c * v[i] + s * v[i + 1], c * v[i + 1] - s * v[i]
    chord = span if half == 0.0 else 2.0 * s / rate
    spin = x * v[i + 1] - y * v[i]
    q[i], q_low[i] = add(x, q_low[i], chord * along)
    q[i + 1], q_low[i + 1] = add(y, q_low[i + 1], chord * across)
    v[i], v_low[i] = add(v[i], v_low[i], 2.0 * s * across)
    v[i + 1], v_low[i + 1] = add(v[i + 1], v_low[i + 1], -2.0 * s * along)
    if inverse_mass[i] > 0.0:
        gained = q[i] * v[i + 1] - q[i + 1] * v[i] - spin
        mass = 1.0 / inverse_mass[i]
        book(v, field, 0.0, 2.0 * s * across * mass, -2.0 * s * along * mass, gained * mass)


@allocating_kernel
def split(
    q: Numbers, v: Numbers, q_low: Numbers, v_low: Numbers, inverse_mass: Numbers, damping: Numbers,
    calls: Calls, drifts: Numbers, kicks: Numbers, places: Rows, gyration: Numbers, field: int,
    by_velocity: bool, h: float, steps: int,
) -> int:  # fmt: skip
    """Advance by ``steps`` steps of ``h`` seconds; return the number of force evaluations.

    A step is kick, drift, kick, ..., drift, kick, with the shares ``kicks`` (n + 1,) and ``drifts`` (n,) of
    h. A kick with no motion since the last one reuses its forces, unless they go ``by_velocity``, which the
    last one has changed: steps are the same one by one. Damping v' = -c v goes with the kicks and is solved
    exactly: v(h) = v e^(-c h) + a (1 - e^(-c h)) / c. Sums are compensated:
    ``q_low`` and ``v_low`` (n,) are the remainders of what moves, and are carried on. The time goes on with
    the drifts, as the coordinates do. Behind it, v takes what causes give
    (:mod:`physicslab.kernels.forces.budget`), with ``places``: in a kick, by the mean velocity.

    ``gyration`` (bodies,) are the rates [rad/s] at which fields turn velocities, or it is empty: drifts are
    then arcs, which are exact. So the method has the order that it has without the field, as of the forces
    that kick all commutators of the second order still depend on places alone. Work of the fields is booked
    at ``field``.
    """
    n, clock = len(inverse_mass), places[CLOCK]
    (begin, first), kept = step_grid(q[clock], h), len(places) > KEPT
    acceleration = np.empty(len(q))
    undamped = np.empty(0)
    known, evaluations = False, 0
    for step in range(steps):
        moved, known = 0.0, known and not by_velocity
        for stage in range(len(kicks)):
            kick = kicks[stage] * h
            if kick != 0.0:
                if not known:
                    q[clock] = begin + (first + step + moved) * h
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
                for b in range(len(gyration)):
                    _go_round(q, v, q_low, v_low, inverse_mass, 2 * b, gyration[b], drift, field)
                for i in range(2 * len(gyration), n):
                    q[i], q_low[i] = add(q[i], q_low[i], drift * v[i])
                known = False
    q[clock] = begin + (first + steps) * h
    return evaluations
