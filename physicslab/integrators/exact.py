"""The solution in closed form, where there is one.

The contribution of each cause is measured in another way than in other methods: no power is integrated, but
the solution has its own energy, of which dampers and drag take what is lost
(:mod:`physicslab.kernels.ode.closed_form_account`).
"""

import numpy as np

from physicslab.components import Spring
from physicslab.ecs.sentences import sentence
from physicslab.integrators.integrator import Integrator
from physicslab.kernels.forces.budget import ACCOUNTS
from physicslab.kernels.ode.closed_form_account import give_in_closed_form
from physicslab.kernels.ode.kepler import move_two
from physicslab.kernels.ode.propagate import propagate
from physicslab.ode.closed_form import ClosedForm, NoClosedForm, closed_form
from physicslab.ode.kepler import Motion, TwoBodies
from physicslab.ode.system import OdeSystem
from physicslab.state.state import State


def _form(state: State, ode: OdeSystem) -> ClosedForm | TwoBodies:
    """Return the closed form; it is kept while the laws are, where it depends on these alone."""
    if ode.form is None or ode.laws is None or ode.form[0] is not ode.laws or len(state.batch(Spring)):
        ode.form = ode.laws, closed_form(state, ode.forces)
    form: ClosedForm | TwoBodies = ode.form[1]
    return form


def _start(form: TwoBodies, state: State, ode: OdeSystem) -> Motion:
    """Return how two bodies move, with what rounding left out of that."""
    motion, n = form.motion(state), 2 * len(ode.layout.moving)
    if not form.holds(motion):
        raise NoClosedForm(sentence("attraction"))
    for now, low in zip(motion, ode.remainders(state), strict=True):
        now[2:][form.moves] = low[:n].reshape(-1, 2)
    return motion


def _flow(state: State, ode: OdeSystem, h: float, steps: int) -> int:
    form = _form(state, ode)
    start = form.motion(state)
    for cause, given in form.given(start, steps * h).items():
        slot = ode.slots.get(cause)
        if slot is not None:
            ode.v[slot : slot + ACCOUNTS] = given
    n, (after, q, v) = 2 * len(ode.layout.moving), ode.wanted
    turning = slice(n, ode.layout.moving_count)
    if isinstance(form, TwoBodies):
        if len(after):
            places, rates = form.follow(_start(form, state, ode), np.diff(after, prepend=0.0))
            q[:, :n], v[:, :n] = places.reshape(-1, n), rates.reshape(-1, n)
        motion = _start(form, state, ode)
        position, velocity = form.follow(motion, np.array((steps * h,)))
        for now, low in zip(motion, ode.remainders(state), strict=True):
            low[:n] = now[2:][form.moves].ravel()
    else:
        for k, t in enumerate(after.tolist()):
            position, velocity = form.after(start, t)
            q[k, :n], v[k, :n] = position.ravel(), velocity.ravel()
        position, velocity = form.after(start, steps * h)
    if len(after):
        q[:, n:] = ode.q[turning] + after[:, None] * ode.v[turning]
        v[:, n:] = ode.v[turning]
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
    kernels=(propagate, give_in_closed_form, move_two),
    chooses_steps=True,
    samples=True,
)
