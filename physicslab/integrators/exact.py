"""The solution in closed form, where there is one.

The contribution of each cause is measured in another way than in other methods: no power is integrated, but
the solution has its own energy, of which dampers and drag take what is lost
(:mod:`physicslab.kernels.ode.closed_form_account`).
"""

from physicslab.components import Spring
from physicslab.integrators.integrator import Integrator
from physicslab.kernels.forces.budget import ACCOUNTS
from physicslab.kernels.ode.closed_form_account import give_in_closed_form
from physicslab.kernels.ode.compensated import add_all
from physicslab.kernels.ode.kepler import kepler_change
from physicslab.kernels.ode.propagate import propagate
from physicslab.ode.closed_form import ClosedForm, closed_form
from physicslab.ode.kepler import TwoBodies
from physicslab.ode.system import OdeSystem
from physicslab.state.state import State


def _form(state: State, ode: OdeSystem) -> ClosedForm | TwoBodies:
    """Return the closed form; it is kept while the laws are, where it depends on these alone."""
    if ode.form is None or ode.laws is None or ode.form[0] is not ode.laws or len(state.batch(Spring)):
        ode.form = ode.laws, closed_form(state, ode.forces)
    return ode.form[1]


def _flow(state: State, ode: OdeSystem, h: float, steps: int) -> int:
    form = _form(state, ode)
    for cause, given in form.given(state, steps * h).items():
        slot = ode.slots.get(cause)
        if slot is not None:
            ode.v[slot : slot + ACCOUNTS] = given
    n, start = 2 * len(ode.layout.moving), form.motion(state)
    turning = slice(n, ode.layout.moving_count)
    for after, q, v in zip(*ode.wanted, strict=True):
        position, velocity = form.after(start, float(after))
        q[:n], v[:n] = position.ravel(), velocity.ravel()
        q[n:], v[n:] = ode.q[turning] + after * ode.v[turning], ode.v[turning]
    if isinstance(form, TwoBodies):
        moved, gained = form.change(start, steps * h)
        q_low, v_low = ode.remainders(state)
        add_all(ode.q, q_low, moved.ravel())
        add_all(ode.v, v_low, gained.ravel())
    else:
        position, velocity = form.after(start, steps * h)
        ode.q[:n], ode.v[:n] = position.ravel(), velocity.ravel()
    ode.q[turning] += steps * h * ode.v[turning]
    return 0


EXACT = Integrator(
    name="exact",
    title="Closed form",
    order=float("inf"),
    evaluations=0,
    symplectic=True,
    source="Landau & Lifshitz, Mechanics, 1976, sections 5, 15, 21, 25",
    flow=_flow,
    kernels=(propagate, give_in_closed_form, kepler_change, add_all),
    chooses_steps=True,
    samples=True,
)
