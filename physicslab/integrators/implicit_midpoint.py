"""The implicit midpoint rule, with the springs' force over the step: bounded however stiff they are.

The midpoint rule itself conserves quadratic energies, as of a spring without rest length; a spring with one
that rotates and oscillates many times a step gains energy. Springs therefore return a discrete gradient of
their energy (:func:`physicslab.kernels.forces.springs.mean_spring_pull`), by which the energy is kept to the
rounding of the search, and so no spring becomes longer than the energy allows. The price: areas in phase
space are kept only where the force is linear. All other forces are taken at the middle of the step.
"""

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.sentences import sentence
from physicslab.integrators.integrator import Integrator, StepTooSmall
from physicslab.kernels.ode.implicit import implicit_midpoint
from physicslab.ode.system import OdeSystem
from physicslab.state.ordering import cuthill_mckee
from physicslab.state.state import State


def _flow(state: State, ode: OdeSystem, h: float, steps: int) -> int:
    q_low, v_low = ode.remainders(state)
    if ode.near is None:
        ode.near = _banded(state, ode)
    order, band = ode.near
    if len(ode.damping) or len(ode.resistances):
        # Each coordinate of the mean velocity is next to the same one of the end velocity less the mean.
        order, band = np.stack((order, order + len(order)), axis=1).ravel(), 2 * band + 1
    made = implicit_midpoint(
        ode.q, ode.v, q_low, v_low, ode.inverse_mass, ode.damping, ode.damped_calls, ode.resistances,
        ode.places, order, band, h, steps,
    )  # fmt: skip
    if made < 0:
        raise StepTooSmall(sentence("implicit_unsolved", step=f"{h:.3g}"))
    return made


def _banded(state: State, ode: OdeSystem) -> tuple[NDArray[np.int64], int]:
    """Return an order of the coordinates in which coupled ones are near each other, and the bandwidth."""
    layout = ode.layout
    pairs = [force.couples(state) for force in ode.forces]
    bodies = layout.moving.tolist()
    if any(found is None for found in pairs):
        return np.arange(layout.moving_count), max(layout.moving_count - 1, 0)
    neighbours: dict[int, set[int]] = {row: set() for row in bodies}
    for found in pairs:
        for a, b in [] if found is None else found.tolist():
            if a in neighbours and b in neighbours:
                neighbours[a].add(b)
                neighbours[b].add(a)
    chain = cuthill_mckee(neighbours)
    parts = [[layout.place[row], layout.place[row] + 1, layout.turn[row]] for row in chain]
    order = [int(part) for body in parts for part in body if part >= 0]
    number = {row: n for n, row in enumerate(chain)}
    reach = max((abs(number[a] - number[b]) for a in chain for b in neighbours[a]), default=0)
    width = 3 if len(layout.turning) else 2
    return np.array(order, np.int64), min((reach + 1) * width - 1, max(len(order) - 1, 0))


IMPLICIT_MIDPOINT = Integrator(
    name="implicit_midpoint",
    title="Implicit midpoint, spring energy kept, L-stable beside dampers (Newton)",
    order=2,
    evaluations=3,
    source="Hairer, Lubich & Wanner, Geometric Numerical Integration, 2006, II.1.1 and VIII.6; "
    "LaBudde & Greenspan, J. Comput. Phys. 15 (1974) 134; "
    "Hairer & Wanner, Solving Ordinary Differential Equations II, 1996, IV.3",
    flow=_flow,
    kernels=(implicit_midpoint,),
    phase_share=1.0 / 12.0,
)
