"""What springs and drag act on in a world whose bodies can touch: how it moves between contacts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Velocity
from physicslab.integrators import Integrator, StepTooSmall
from physicslab.ode.system import Equations
from physicslab.state.bodies import Diverged
from physicslab.stepping.fastest_body import fastest_body
from physicslab.stepping.split_rows import tethered_rows
from physicslab.systems.schedule import ForceSystem

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["Tethers"]

_GENTLE = 1.0
"""omega h up to which a force hardly changes within a substep, and contacts are told what it will do."""
_TOLERANCE = 1e-12
"""Relative error of a step of methods that choose their steps, at the least."""


class Tethers:
    """Moves what springs and drag act on, under all forces, by a method that follows them.

    A substep is half a flow, the contacts, half a flow. That is the leapfrog of the contact step, in which
    the flow of the forces takes the place of drift and kick: reversible, of second order in what contacts
    do, and as exact between them as the method is. What is not tethered drifts and is kicked.

    Contacts hold up what presses on them only if they see the velocity that it would get by the end of the
    substep. For rows that are pulled gently that is foreseen from the forces, as a kick is, and taken back
    once the contacts are solved; what oscillates within a substep has no such velocity.

    Parameters
    ----------
    world : World
        Whose bodies. Its ``bodies.tethered`` is set.
    method : Integrator
        What moves them.
    steps : int
        Into how many steps of the method half a substep is divided.

    Attributes
    ----------
    gentle : bool array (rows,)
        What is pulled so gently that contacts are shown its velocity ahead.
    """

    def __init__(self, world: World, method: Integrator, steps: int) -> None:
        self._method, self._steps = method, steps
        rows = tethered_rows(world)
        self._equations = Equations(world, rows)
        # Contacts are good to far fewer digits than a free flight: more would only cost time.
        self._equations.tolerance = max(world.simulation.tolerance, _TOLERANCE)
        world.bodies.tethered[:] = rows & world.table(Velocity).present
        h = world.simulation.dt / world.simulation.substeps
        self.gentle: NDArray[np.bool_] = world.bodies.tethered & (world.bodies.inverse_mass > 0.0)
        for system in world.schedule.running:
            rates = system.rates(world) if isinstance(system, ForceSystem) else None
            if rates is not None:
                self.gentle &= rates * h <= _GENTLE
        world.schedule.compile(method.kernels)

    def outdated(self, world: World) -> bool:
        """Whether a number was changed that the layout, or the choice of a method, hangs on."""
        return self._equations.outdated(world)

    def begin(self, world: World) -> None:
        """Take the forces and masses as they are now; they stay for a step."""
        self._equations.gather(world)

    def move(self, world: World, h: float) -> None:
        """Advance what is tethered by a time h."""
        equations = self._equations
        equations.gather_state(world)
        try:
            made = self._method.flow(world, equations, h / self._steps, self._steps)
        except StepTooSmall as error:
            what = f"{world.label(fastest_body(world))}: Velocity changes too fast: {error}"
            raise Diverged(f"{what} (after t = {world.time:.9g} s)") from error
        equations.scatter(world, h)
        world.force_evaluations += made
