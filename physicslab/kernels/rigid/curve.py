"""The curve through both ends of a piece of motion: where it crosses a limit, a piece ends.

Of polynomials of degree five in time the one that has the places, speeds and accelerations of both ends
(Hermite). Its error is of order h^6, so that a time found on it is the first trial of a location, and often
the last: each trial on the piece itself takes twelve sets of contact forces.
"""

from physicslab.kernels import Numbers, inlined
from physicslab.kernels.ode.dop853_tableau import LAST
from physicslab.kernels.rigid.pieces import Stages

__all__ = ["keep_ends", "place_on_curve"]

_SPEEDS, _PLACES = LAST + 1, LAST + 2
"""Columns of the rates that hold the speeds and places of the end; its accelerations are beside the
speeds."""


@inlined
def keep_ends(stages: Stages) -> None:
    """Keep the end of the piece that was just made; trials of other lengths overwrite it."""
    for i in range(len(stages.q)):
        stages.rates[i, _SPEEDS], stages.rates[i, _PLACES] = stages.v[i], stages.q[i]
        stages.pushes[i, _SPEEDS] = stages.pushes[i, LAST]


@inlined
def place_on_curve(stages: Stages, q: Numbers, v: Numbers, h: float, t: float) -> None:
    """Leave in ``stages`` the state at time ``t`` on the curve of a piece of ``h`` seconds from (q, v)."""
    s = t / h
    for i in range(len(q)):
        start, end = h * v[i], h * stages.rates[i, _SPEEDS]
        bend, last_bend = 0.5 * h * h * stages.pushes[i, 0], 0.5 * h * h * stages.pushes[i, _SPEEDS]
        # What is missing at the end after the first three terms, of place, speed and acceleration.
        place = stages.rates[i, _PLACES] - q[i] - start - bend
        speed = end - start - 2.0 * bend
        change = last_bend - bend
        third = 10.0 * place - 4.0 * speed + change
        fourth = -15.0 * place + 7.0 * speed - 2.0 * change
        fifth = 6.0 * place - 3.0 * speed + change
        stages.q[i] = q[i] + s * (start + s * (bend + s * (third + s * (fourth + s * fifth))))
        slope = start + s * (2.0 * bend + s * (3.0 * third + s * (4.0 * fourth + s * 5.0 * fifth)))
        stages.v[i] = slope / h
