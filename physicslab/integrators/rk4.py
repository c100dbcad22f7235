"""The classical Runge-Kutta method."""

from physicslab.integrators.integrator import Integrator
from physicslab.kernels.ode.classical import rk4
from physicslab.ode.system import OdeSystem
from physicslab.state.state import State


def _flow(state: State, ode: OdeSystem, h: float, steps: int) -> int:
    eq = ode
    q_low, v_low = eq.remainders(state)
    return rk4(eq.q, eq.v, q_low, v_low, eq.inverse_mass, eq.damping, eq.damped_calls, eq.places, h, steps)


RK4 = Integrator(
    name="rk4",
    title="Runge-Kutta 4 (classical)",
    order=4,
    evaluations=4,
    stability_limit=8.0**0.5,
    source="Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, 1993, II.1",
    flow=_flow,
    kernels=(rk4,),
    phase_share=1.0 / 120.0,
    phase_order=4,
)
