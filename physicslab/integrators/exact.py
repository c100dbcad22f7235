"""The solution in closed form, where there is one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from physicslab.integrators.integrator import Integrator
from physicslab.kernels.ode.propagate import propagate
from physicslab.ode.closed_form import closed_form
from physicslab.ode.system import OdeSystem

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["EXACT"]


def _flow(world: World, ode: OdeSystem, h: float, steps: int) -> int:
    position, velocity = closed_form(world).advanced(world, steps * h)
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
    stability_limit=float("inf"),
    symplectic=True,
    source="Landau & Lifshitz, Mechanics, 1976, sections 5, 21, 25",
    flow=_flow,
    kernels=(propagate,),
    chooses_steps=True,
)
