"""What springs and drag act on in a world whose bodies can touch: how it moves between contacts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity
from physicslab.integrators import Integrator, StepTooSmall
from physicslab.kernels import motion
from physicslab.ode.system import OdeSystem
from physicslab.state.masses import Diverged
from physicslab.state.state import State
from physicslab.stepping.fastest_body import fastest_body
from physicslab.systems.system import ForceSystem, Stage

__all__ = ["SplitForces", "sub_integrated_rows"]

_GENTLE = 1.0
"""omega h up to which a force hardly changes within a substep, and contacts are told what it will do."""
_TOLERANCE = 1e-12
"""Smallest relative error of a step that methods are given that choose their steps."""


def sub_integrated_rows(state: State, forces: Sequence[ForceSystem]) -> NDArray[np.bool_]:
    """Return for each row whether a force acts on it that tells bodies apart, or it is an end of one.

    Where another force couples any body with any, all are.
    """
    rows = np.zeros(len(state.entity_index), np.bool_)
    for force in forces:
        rates, pairs = force.rates(state), force.couples(state)
        if rates is not None:
            rows |= rates > 0.0
            if pairs is not None:
                rows[pairs.ravel()] = True
    if rows.any() and any(force.couples(state) is None for force in forces):
        rows[:] = True
    return rows & state.table(Transform).present


class SplitForces:
    """Moves what springs and drag act on, under all forces, by a method that follows them.

    A substep is half a flow, the contacts, half a flow. That is the leapfrog of the contact step, in which
    the flow of the forces takes the place of drift and kick: reversible, of second order in what contacts
    do, and as exact between them as the method is. What is not sub-integrated drifts and is kicked.

    Contacts hold up what presses on them only if they see the velocity that it would get by the end of the
    substep. For rows that are pulled gently that is predicted from the forces, as a kick is, and taken back
    once the contacts are solved; what oscillates within a substep has no such velocity.

    Parameters
    ----------
    state : State
        Whose bodies. Its ``bodies.sub_integrated`` is set.
    forces : sequence of ForceSystem
        What acts.
    method : Integrator
        What moves them.
    steps : int
        Into how many steps of the method half a substep is divided.

    Attributes
    ----------
    gentle : bool array (rows,)
        What is pulled so gently that contacts are shown its velocity ahead.
    """

    def __init__(self, state: State, forces: Sequence[ForceSystem], method: Integrator, steps: int) -> None:
        self._forces, self._method, self._steps = forces, method, steps
        rows = sub_integrated_rows(state, forces)
        self._ode = OdeSystem(state, forces, rows)
        # Contacts are good to far fewer digits than a free flight: more would only cost time.
        self._ode.tolerance = max(state.simulation.tolerance, _TOLERANCE)
        state.bodies.sub_integrated[:] = rows & state.table(Velocity).present
        h = state.simulation.dt / state.simulation.substeps
        self.gentle: NDArray[np.bool_] = state.bodies.sub_integrated & (state.bodies.inverse_mass > 0.0)
        for force in forces:
            rates = force.rates(state)
            if rates is not None:
                self.gentle &= rates * h <= _GENTLE
        state.compile((*method.kernels, motion.predict))

    def outdated(self, state: State) -> bool:
        """Whether a number was changed that the layout, or the choice of a method, depends on."""
        return self._ode.outdated(state)

    def begin(self, state: State) -> None:
        """Take the forces and masses as they are now; they stay for a step."""
        self._ode.gather(state)

    def take_part(self, stage: Stage, state: State, h: float) -> None:
        """Do what a stage of a substep wants, if anything."""
        if stage is Stage.DRIFT:
            self._move(state, h)
        elif stage is Stage.PREDICT:
            bodies, velocity = state.bodies, state.table(Velocity)
            motion.predict(
                velocity["linear"], velocity["angular"], bodies.force, bodies.torque,
                bodies.awake_inverse_mass, bodies.awake_inverse_inertia, self.gentle, h,
            )  # fmt: skip

    def _move(self, state: State, h: float) -> None:
        """Advance what is sub-integrated by a time h."""
        ode = self._ode
        ode.gather_state(state)
        try:
            made = self._method.flow(state, ode, h / self._steps, self._steps)
        except StepTooSmall as error:
            what = f"{fastest_body(state, self._forces)}: Velocity changes too fast: {error}"
            raise Diverged(f"{what} (after t = {state.time:.9g} s)") from error
        ode.scatter(state, h)
        state.force_evaluations += made
