"""Dormand and Prince's adaptive method of order 8."""

import math

from physicslab.ecs.sentences import sentence
from physicslab.integrators.integrator import Exhausted, Integrator, StepTooSmall
from physicslab.kernels import direct_entry
from physicslab.kernels.ode.dop853 import EXHAUSTED, NOT_FINITE, dop853
from physicslab.ode.system import OdeSystem
from physicslab.state.state import State

_MAX_EVALUATIONS = 1_000_000
"""Force evaluations a step of the world. The most that ``auto`` gives it, 500 rad in a step, takes
120,000 at the finest tolerance; a million take 0.2 s for two bodies."""

MAX_COSTLY = 100_000
"""The same where Python computes a force, or joints are solved: they take a second or two."""


def _floor(state: State, ode: OdeSystem) -> float:
    """Return how far rounding puts off accelerations [m/s^2] of what may come to rest."""
    rests = len(ode.damping) or any(force.depends_on_velocity(state) for force in ode.forces)
    floor = max((force.rounding_floor(state) for force in ode.forces), default=0.0) if rests else 0.0
    return floor if math.isfinite(floor) else 0.0


def _flow(state: State, ode: OdeSystem, h: float, steps: int) -> int:
    q_low, v_low = ode.remainders(state)
    tolerance = ode.tolerance
    made: int = direct_entry(dop853)(
        ode.q, ode.v, q_low, v_low, ode.inverse_mass, ode.damping, ode.damped_calls, ode.places,
        steps * h, tolerance, state.simulation.dt, _most(ode), ode.free_bodies, ode.steepness,
        _floor(state, ode), *ode.wanted,
    )  # fmt: skip
    if made == NOT_FINITE:
        raise StepTooSmall(sentence("forces_not_finite", time=f"{state.time:.9g}"))
    if made == EXHAUSTED:
        raise Exhausted(
            sentence(
                "evaluations_exhausted",
                most=f"{_limit(ode):,}", step=f"{state.simulation.dt:g}", tolerance=f"{tolerance:g}",
            )
        )  # fmt: skip
    if made < 0:
        raise StepTooSmall(sentence("no_step_short_enough", tolerance=f"{tolerance:g}"))
    return made


def _most(ode: OdeSystem) -> int:
    return _limit(ode) if ode.most is None else ode.most


def _limit(ode: OdeSystem) -> int:
    return MAX_COSTLY if ode.interpreted or ode.joined else _MAX_EVALUATIONS


DOP853 = Integrator(
    name="dop853",
    title="Dormand-Prince 8(5,3), adaptive",
    order=8,
    evaluations=12,
    source="Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, 1993, II.5 (DOP853)",
    flow=_flow,
    kernels=(dop853,),
    chooses_steps=True,
    samples=True,
)
