"""The solution in closed form, where there is one.

The contribution of each cause is measured in another way than in other methods: no power is integrated, but
the solution has its own energy, of which dampers and drag take what is lost
(:mod:`physicslab.ode.closed_form_account`).
"""

import numpy as np
from numpy.typing import NDArray

from physicslab.integrators.integrator import Integrator
from physicslab.kernels.forces.budget import ACCOUNTS
from physicslab.kernels.ode.propagate import propagate
from physicslab.ode.closed_form import closed_form
from physicslab.ode.closed_form_account import given_in_closed_form
from physicslab.ode.system import OdeSystem
from physicslab.state.state import State


def _flow(state: State, ode: OdeSystem, h: float, steps: int) -> int:
    form = closed_form(state, ode.forces)
    position, velocity = form.motion(state)
    form.advance(position, velocity, steps * h)
    for cause, given in given_in_closed_form(state, form, steps * h).items():
        slot = ode.slots.get(cause)
        if slot is not None:
            ode.v[slot : slot + ACCOUNTS] = given
    n = 2 * len(ode.layout.moving)
    ode.q[:n], ode.v[:n] = position.ravel(), velocity.ravel()
    turning = slice(n, ode.layout.moving_count)
    ode.q[turning] += steps * h * ode.v[turning]
    return 0


def _sample(state: State, ode: OdeSystem, spans: NDArray[np.float64], into: NDArray[np.float64]) -> None:
    form, n = closed_form(state, ode.forces), 2 * len(ode.layout.moving)
    for k, after in enumerate(np.cumsum(spans).tolist()):
        position, velocity = form.motion(state)
        form.advance(position, velocity, after)
        into[0, k], into[1, k] = ode.q, ode.v
        into[0, k, :n], into[1, k, :n] = position.ravel(), velocity.ravel()
        into[0, k, n : ode.layout.moving_count] += after * ode.v[n : ode.layout.moving_count]


EXACT = Integrator(
    name="exact",
    title="Closed form",
    order=float("inf"),
    evaluations=0,
    symplectic=True,
    source="Landau & Lifshitz, Mechanics, 1976, sections 5, 21, 25",
    flow=_flow,
    kernels=(propagate,),
    chooses_steps=True,
    sample=_sample,
)
