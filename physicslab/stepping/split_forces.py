"""Split forces: sub-integration, between contacts, of bodies that springs and drag act on."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity
from physicslab.integrators import Integrator, StepTooSmall
from physicslab.integrators.dop853 import DOP853
from physicslab.integrators.implicit_midpoint import IMPLICIT_MIDPOINT
from physicslab.integrators.spring_splitting import SPRING_SPLITTING
from physicslab.kernels import Plain, motion
from physicslab.kernels.arguments import Springs
from physicslab.kernels.solver import work
from physicslab.ode.system import OdeSystem
from physicslab.state.state import State
from physicslab.stepping.fastest_body import changes_fast
from physicslab.stepping.spring_flow import SpringFlow, put_together, why_no_spring_flow
from physicslab.stepping.spring_groups import SpringGroup, spring_groups
from physicslab.systems.system import ForceSystem

_MAX_PREDICTABLE = 1.0
"""omega h up to which a force hardly changes within a substep, so that contacts get its prediction."""
_TOLERANCE = 1e-12
"""Smallest tolerance of methods that choose their steps."""


def depends_on_velocity_in_python(state: State, force: ForceSystem) -> bool:
    """Return whether a force in Python states that it depends on velocities, which kicks make one of order 1.

    One that states nothing is kicked, as a wind is: bodies that it acts on may then sleep.
    """
    kind = type(force)
    stated = kind.depends_on_velocity is not ForceSystem.depends_on_velocity
    return stated and not kind.packs() and force.depends_on_velocity(state)


def sub_integrated_rows(state: State, forces: Sequence[ForceSystem]) -> NDArray[np.bool_]:
    """Return for each row whether a force acts on it that is not the same for all, or it is an end of one.

    So does a force in Python that states that it depends on velocities.

    Where a force couples any of some bodies with any, all of these are, as soon as one body is.
    """
    rows = np.zeros(len(state.entity_index), np.bool_)
    for force in forces:
        rates, pairs = force.rates(state), force.couples(state)
        if depends_on_velocity_in_python(state, force):
            rows[state.batch(Velocity, *force.needs).rows] = True
        if rates is not None:
            rows |= rates > 0.0
            if pairs is not None:
                rows[pairs.ravel()] = True
    for force in forces:
        if rows.any() and force.couples(state) is None:
            rows[force.coupled_rows(state)] = True
    return rows & state.table(Transform).present


class SplitPart:
    """Bodies that one method moves together between contacts.

    Parameters
    ----------
    state, forces, method, steps
        As of :class:`SplitForces`.
    rows : bool array (rows,)
        The bodies, and what holds them.
    group : SpringGroup, optional
        How fast springs are, where they are moved within the loop of substeps as long as none turns too fast.

    Attributes
    ----------
    springs : SpringFlow, optional
        Their flow within the loop.
    """

    def __init__(
        self, state: State, forces: Sequence[ForceSystem], method: Integrator, steps: int,
        rows: NDArray[np.bool_], group: SpringGroup | None = None,
    ) -> None:  # fmt: skip
        self.method, self.steps = (method, steps) if group is None else (DOP853, 1)
        self._forces = forces
        self.follow(state, rows)
        self.springs = None if group is None else SpringFlow(state, forces, self.ode.layout, group)
        if self.springs is None:
            state.compile((*method.kernels, motion.predict, work.note_flow))

    def follow(self, state: State, rows: NDArray[np.bool_]) -> None:
        """Move these ``rows`` (rows,) from now on."""
        self.ode = OdeSystem(state, self._forces, rows, kicked=self.method.kicks)
        # Contacts are accurate to far fewer digits than free motion: more would only take time.
        rounded = 1e3 * max((force.rounding for force in self._forces), default=0.0)
        self.ode.tolerance = max(state.simulation.tolerance, _TOLERANCE, rounded)

    def begin(self, state: State) -> None:
        """Take the present forces and masses; they are kept for a step."""
        if self.springs is not None:
            self.springs.begin(state)
        else:
            self.ode.gather(state)

    def drift(self, state: State, h: float) -> None:
        """Move the bodies for ``h`` seconds, and book it as their own."""
        if not len(self.ode.layout.moving):
            return
        self._note_flow(state, 1.0, h)
        state.force_evaluations += self._follow(state, h)
        self._note_flow(state, -1.0, 0.0)

    def _note_flow(self, state: State, sign: float, h: float) -> None:
        """Take the flow from the velocities that contacts noted, so that each is booked as its own."""
        bodies, velocity, contacts = state.bodies, state.table(Velocity), state.contacts
        if len(contacts.angular_before) == len(bodies.unkicked):
            work.note_flow(
                contacts.linear_before, contacts.angular_before, velocity["linear"], velocity["angular"],
                bodies.force, bodies.torque, bodies.awake_inverse_mass, bodies.awake_inverse_inertia,
                self.ode.layout.moving, bodies.unkicked, state.uniform_forces, sign, h,
            )  # fmt: skip

    def _follow(self, state: State, h: float) -> int:
        """Advance by the method: that of springs which turn too fast for their flow chooses its steps."""
        ode = self.ode
        if self.springs is None:
            ode.gather_state(state)
        else:
            state.compile(self.method.kernels)
            ode.gather(state)
        try:
            made = self.method.flow(state, ode, h / self.steps, self.steps)
        except StepTooSmall as error:
            raise changes_fast(state, ode.forces, error) from error
        ode.scatter(state, h)
        return made


class SplitForces:
    """Moves the bodies that springs and drag act on, under all forces, by a method that follows these.

    A substep is half a flow, the contacts, half a flow. That is the leapfrog of the contact step, in which
    the flow of the forces takes the place of drift and kick: reversible, of second order in the contact
    impulses, and as exact between them as the method is. All other bodies drift and are kicked.

    Contacts support a load only if the solver has the velocity that it would cause by the end of the substep.
    For rows under slowly changing forces it is predicted from these, as a kick, and removed once the contacts
    are solved; a body that oscillates within a substep has no such velocity.

    Parameters
    ----------
    state : State
        Whose bodies. Its ``bodies.sub_integrated`` and ``unkicked`` are set.
    forces : sequence of ForceSystem
        The forces that act.
    method : Integrator
        The method that moves them; springs that are too fast for ``spring_splitting`` have another.
    steps : int
        Into how many steps of the method half a substep is divided, where that does not go by groups.

    Attributes
    ----------
    parts : list of SplitPart
        Those that are moved together.
    flows : Plain[Springs]
        Springs that the loop of substeps moves by itself; empty where it moves none.
    """

    def __init__(self, state: State, forces: Sequence[ForceSystem], method: Integrator, steps: int) -> None:
        apart = all(force.couples(state) is not None for force in forces)
        local = {force: boxes for force in forces if apart and (boxes := force.regions(state)) is not None}
        self._rows = sub_integrated_rows(state, [force for force in forces if force not in local])
        self._local = [(sub_integrated_rows(state, [force]), boxes) for force, boxes in local.items()]
        rows = self._reached(state, state.simulation.dt)
        state.bodies.sub_integrated[:] = rows & state.table(Velocity).present
        if method is SPRING_SPLITTING and why_no_spring_flow(state, forces) is None:
            self.parts = [
                SplitPart(state, forces, method, group.steps, group.rows, group)
                if group.steps
                else SplitPart(state, forces, IMPLICIT_MIDPOINT, 1, group.rows)
                for group in spring_groups(state, forces, rows)
            ]
        else:
            self.parts = [SplitPart(state, forces, method, steps, rows)]
        flows = [part.springs for part in self.parts if part.springs is not None]
        self.flows: Plain[Springs] = put_together(flows)
        self._judges = len(flows) < len(self.parts) or any(flow.changes_with_speed for flow in flows)
        self._find_predictable(state)

    def outdated(self, state: State) -> bool:
        """Whether a number was changed that the layout, or the choice of a method, depends on."""
        return self.parts[0].ode.outdated(state)

    def _find_predictable(self, state: State) -> None:
        """Find what is pulled gently at its present speed: a file must not need to remember that."""
        h = state.simulation.dt / state.simulation.substeps
        bodies = state.bodies
        predictable = bodies.sub_integrated & (bodies.inverse_mass > 0.0)
        for force in self.parts[0].ode.forces:
            rates = force.rates(state)
            if rates is not None:
                predictable &= rates * h <= _MAX_PREDICTABLE
        bodies.unkicked[:] = bodies.sub_integrated & ~predictable

    def begin(self, state: State, h: float) -> None:
        """Take the present forces and masses, and what forces reach; they are kept for a step of ``h`` s."""
        if self._local:
            rows, moves = self._reached(state, h), state.table(Velocity).present
            if not np.array_equal(rows & moves, state.bodies.sub_integrated):
                state.bodies.sub_integrated[:] = rows & moves
                self.parts[0].follow(state, rows)
        for part in self.parts:
            part.begin(state)
        if self._judges:
            self._find_predictable(state)

    def _reached(self, state: State, h: float) -> NDArray[np.bool_]:
        """Return the rows that forces act on within ``h`` seconds, at up to twice the present speeds.

        Contacts may make bodies faster; what comes farther is kicked in that step.
        """
        if not self._local:
            return self._rows
        place, reach, found = state.table(Transform)["position"], state.bodies.shapes.reach, self._rows.copy()
        pull = state.physics.gravity.magnitude if state.physics.gravity_mode == "linear" else 0.0
        room = reach + 2.0 * h * np.hypot(*state.table(Velocity)["linear"].T) + pull * h * h
        for rows, boxes in self._local:
            for left, bottom, right, top in boxes.tolist():
                within = np.maximum(left - place[:, 0], place[:, 0] - right) <= room
                found |= rows & within & (np.maximum(bottom - place[:, 1], place[:, 1] - top) <= room)
        return found

    def predict(self, state: State, h: float) -> None:
        """Change the velocities of predictable bodies by what forces make of them in ``h`` seconds."""
        bodies, velocity = state.bodies, state.table(Velocity)
        motion.predict(
            velocity["linear"], velocity["angular"], bodies.force, bodies.torque,
            bodies.awake_inverse_mass, bodies.awake_inverse_inertia, bodies.sub_integrated,
            bodies.unkicked, h,
        )  # fmt: skip
