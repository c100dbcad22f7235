"""The solution in closed form, where there is one.

The contribution of each cause is measured in another way than in other methods: no power is integrated, but
the solution has its own energy, of which dampers and drag take what is lost
(:mod:`physicslab.ode.closed_form_account`).
"""

from physicslab.integrators.integrator import Integrator
from physicslab.kernels.forces.bookings import ACCOUNTS
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
)
