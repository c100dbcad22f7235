"""The solution in closed form, where there is one.

The contribution of each cause is measured in another way than in other methods: no power is integrated, but
the solution has its own energy, of which dampers and drag take what is lost
(:mod:`physicslab.kernels.ode.closed_form_account`).
"""

import numpy as np
from numpy.typing import NDArray

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
    if isinstance(form, TwoBodies) and not form.holds(state):
        raise NoClosedForm(sentence("attraction"))
    return form


def _follow(form: TwoBodies, state: State, ode: OdeSystem, spans: NDArray[np.float64]) -> Motion:
    """Move two bodies, and what rounding left out of them; return where they are after each span."""
    motion, moves, n = form.motion(state), form.moves, 2 * len(ode.layout.moving)
    kept = ode.remainders(state)
    for now, low in zip(motion, kept, strict=True):
        now[2:][moves] = low[:n].reshape(-1, 2)
    found = form.follow(motion, spans)
    for now, low in zip(motion, kept, strict=True):
        low[:n] = now[2:][moves].ravel()
    return found


def _flow(state: State, ode: OdeSystem, h: float, steps: int) -> int:
    form = _form(state, ode)
    for cause, given in form.given(state, steps * h).items():
        slot = ode.slots.get(cause)
        if slot is not None:
            ode.v[slot : slot + ACCOUNTS] = given
    n = 2 * len(ode.layout.moving)
    if isinstance(form, TwoBodies):
        position, velocity = _follow(form, state, ode, np.array((steps * h,)))
    else:
        position, velocity = form.after(form.motion(state), steps * h)
    ode.q[:n], ode.v[:n] = position.ravel(), velocity.ravel()
    turning = slice(n, ode.layout.moving_count)
    ode.q[turning] += steps * h * ode.v[turning]
    return 0


def _sample(state: State, ode: OdeSystem, spans: NDArray[np.float64], into: NDArray[np.float64]) -> None:
    form, n, after = _form(state, ode), 2 * len(ode.layout.moving), np.cumsum(spans)
    into[0], into[1] = ode.q, ode.v
    if isinstance(form, TwoBodies):
        for found, motion in zip(into, _follow(form, state, ode, spans), strict=True):
            found[:, :n] = motion.reshape(-1, n)
    else:
        start = form.motion(state)
        for k, t in enumerate(after.tolist()):
            position, velocity = form.after(start, t)
            into[0, k, :n], into[1, k, :n] = position.ravel(), velocity.ravel()
    turning = slice(n, ode.layout.moving_count)
    into[0, :, turning] += after[:, None] * ode.v[turning]


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
    sample=_sample,
)
