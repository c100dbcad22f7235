"""A splitting of order 4 that is one of order 6 for linear forces, for springs beside contacts.

Its four free shares solve the conditions of order 4 for any forces that depend on positions alone, and those
of order 6 for linear ones (Hairer, Lubich & Wanner, Geometric Numerical Integration, 2006, III.5.1): springs
that hardly turn are nearly linear. The force at its end is that at the beginning of the next.
"""

from physicslab.integrators.integrator import Integrator, Splitting

_FIRST_DRIFT, _SECOND_DRIFT = -0.68591955495621668, 0.99662959095293632
_FIRST_KICK, _SECOND_KICK = 0.15585935917621683, -0.0070254990919573174
_DRIFT, _KICK = 1.0 - 2.0 * (_FIRST_DRIFT + _SECOND_DRIFT), 0.5 - _FIRST_KICK - _SECOND_KICK

_DRIFTS = (_FIRST_DRIFT, _SECOND_DRIFT, _DRIFT, _SECOND_DRIFT, _FIRST_DRIFT)
_KICKS = (_FIRST_KICK, _SECOND_KICK, _KICK, _KICK, _SECOND_KICK, _FIRST_KICK)
_FLOW = Splitting(drifts=_DRIFTS, kicks=_KICKS)
DRIFTS, KICKS = _FLOW.shares
"""Shares of the step (5,) and (6,): kick, drift, kick, ..., drift, kick."""

SPRING_SPLITTING = Integrator(
    name="spring_splitting",
    title="Splitting of order 4, of order 6 for linear forces (5 stages)",
    order=4,
    evaluations=5,
    stability_limit=3.06,
    symplectic=True,
    source="Hairer, Lubich & Wanner, Geometric Numerical Integration, 2006, III.5.1",
    flow=_FLOW,
    positions_only=True,
    phase_share=1.18e-6,
    phase_order=6,
)
