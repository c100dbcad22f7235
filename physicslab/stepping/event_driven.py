"""Scenes of few bodies that bounce: ballistic motion between impacts, each impact at its own time."""

import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Transform, Velocity
from physicslab.contacts.arguments import bounds_of, materials_of, motion_of, shapes_of
from physicslab.contacts.near_pairs import list_all
from physicslab.kernels.broad import near_pairs
from physicslab.kernels.events import events, path
from physicslab.kernels.wide import slots
from physicslab.state.masses import Diverged, check_finite
from physicslab.state.remainders import Remainders, coordinate_keys
from physicslab.state.samples import NOTHING_SAMPLED, sampled
from physicslab.state.state import State
from physicslab.stepping.ballistic import pairs_that_may_meet, turning_rows, with_links
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.rigid import Rigid, numbers_of_pairs, write_impacts
from physicslab.stepping.stepper import Advance, Stepper, Stretch, divisions
from physicslab.systems.contact import ContactSystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.resolve import ResolveSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import Stage

_ACCELERATION = slice(8, 10)
"""The columns of a path's acceleration."""
_LOW = (1, 3, 5, 7)
"""The columns of what rounding leaves out of a path's place and velocity."""
_MASS = 12
"""The column of the mass that gravity accelerates."""
_run_events: Callable[..., tuple[int, int, int, int, float]] = events.run_events
_BOTH = np.arange(2)
_IMPACT_FIELDS = ("approach_speed", "impact_normal", "impact_tangent")


class EventDriven(Stepper):
    """Advances bodies in closed form from impact to impact.

    Where one comes to rest on another the flight ends, and the next stepper makes the rest of the step, and
    whole steps while it rests; one in which a body meets several others at once is made by the laws of rigid
    contacts.

    Which bodies rest follows from the contacts of the last step, and what rounding leaves out is part of the
    state, so that nothing here needs to be saved. Any number of steps has the bits of single ones.
    """

    name: str = "event_driven"
    title: str = "Impacts at their exact times"
    samples: bool = True
    kernels: tuple[Any, ...] = (events.run_events, near_pairs.carry_over, slots.list_scalar)

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None:
        self._schedule, self._plan = schedule, plan
        self._together: Rigid | None = None
        self.reason = plan.collision_reason
        self._left = self._listed = -1
        rows = len(state.entity_index)
        self._pairs = with_links(state, pairs_that_may_meet(state))
        self._paths = np.zeros((rows, path.FIELDS))
        moving = state.table(Velocity).present & state.table(Transform).present
        free = moving & (state.bodies.inverse_mass > 0.0)
        self._modes = np.where(free, events.BALLISTIC, np.where(moving, events.KINEMATIC, events.FIXED))
        self._mode = self._modes.copy()
        self._ballistic = free
        self._moving = np.flatnonzero(moving)
        self._lows = self._moving[:, None], np.array(_LOW)
        self._kept: Remainders | None = None
        entities = state.entity_index.entities[self._moving]
        self._keys = coordinate_keys(entities, entities[:0])
        self._face = np.zeros(len(self._pairs), np.int64)
        self._apart = np.zeros(len(self._pairs), np.int64)
        self._due = np.zeros((len(self._pairs), 5))
        self._numbers: dict[tuple[int, int, int], int] = {}
        self._bounds = bounds_of(state)
        uniform = [force.uniform_acceleration(state) for force in schedule.forces]
        gravity = np.array([(g.x, g.y) for g in uniform if g is not None] or [(0.0, 0.0)]).sum(axis=0)
        self._paths[:, _ACCELERATION] = free[:, None] * gravity
        internal = (*schedule.forces, schedule.find(ContactSystem), schedule.find(ResolveSystem))
        self._within = [system.name for system in internal if system is not None]

    def forget(self) -> None:
        """Keep nothing of the steps made, as if it were new: what it was made from is the same."""
        self._together, self._kept, self._left, self._listed = None, None, -1, -1
        self._mode[:] = self._modes
        self._paths[:, : _ACCELERATION.start] = self._paths[:, _ACCELERATION.stop :] = 0.0
        self._face[:], self._apart[:], self._due[:] = 0, 0, 0.0

    @classmethod
    def why_not(cls, state: State, schedule: Schedule, plan: StepPlan) -> str | None:
        """Return why collisions are not located in time, or ``None``."""
        return None if plan.collisions == "exact" else plan.collision_reason

    def holds(self, state: State) -> bool:
        """Whether the world may still be stepped so; values that may change at any time can forbid it."""
        return not len(turning_rows(state))

    def ready(self, state: State, h: float) -> bool:
        """Whether the coming step is not one that it has just left to others."""
        return self._left != state.steps

    def goes_on(self, state: State) -> bool:
        """Return True: its forces accelerate all bodies alike."""
        return True

    def advance(self, state: State, h: float, steps: int) -> Advance:
        """Make all of the steps, in one compiled loop; or those before the first that is left to others.

        If that is the first of all, it is begun as far as the bodies fly.
        """
        parts = divisions(state, h)
        made, why, begun = self._fly(state, h / parts, parts, steps)
        if made:
            self._schedule.run_others(ResolveSystem, Stage.IMPACT, state, h)
            check_finite(state, state.time + h * made)
        elif why == events.TOGETHER and self._plan.contacts == "soft":
            self._together = self._together or Rigid(state, self._schedule, self._plan)
            made = self._together.advance(state, h, 1).steps
        self._left = -1 if made else state.steps
        return Advance(made, parts, begun)

    def _fly(self, state: State, span: float, parts: int, steps: int) -> tuple[int, int, float]:
        """Make the steps, of ``parts`` parts of ``span`` s each, before one that is left to others.

        Returns how many they are, why the next one is left, and, of the first, how much is made [s].
        """
        start = [column.copy() for column in motion_of(state)]
        collisions, logged = state.collisions, state.contacts.logged
        booked, why, begun = state.account.sums.copy(), events.CAME_TO_REST, 0.0
        if self._ballistic[_held(state)].any():
            return 0, why, 0.0
        while steps:
            self._recall_remainders(state)
            self._begin(state)
            made, latest, ended, flown = self._run_events(state, span, parts * steps)
            if ended == events.DONE:
                self._write_impacts(state, latest)
                self._keep_remainders(state)
                self._listed = state.steps + steps
                return steps, why, 0.0
            if made < parts and ended != events.TOGETHER:
                why, begun = ended, made * span + flown
                break
            for column, kept in zip(motion_of(state), start, strict=True):
                column[:] = kept
            state.collisions, state.contacts.logged = collisions, logged
            state.account.sums[:] = booked
            self._kept, steps, why = None, made // parts, ended
        self._kept, state.contacts.stale = None, True
        return 0, why, begun

    def _recall_remainders(self, state: State) -> None:
        """Take what rounding left out of places and velocities, which the paths carry on."""
        (q, v), kept = self._moved(state), state.remainders
        if kept is self._kept and (q.tobytes(), v.tobytes()) == (kept.q.tobytes(), kept.v.tobytes()):
            return  # the paths have them
        lows = kept.of(self._keys, q, v)
        self._paths[self._lows] = np.concatenate([low.reshape(-1, 2) for low in lows], axis=1)

    def _keep_remainders(self, state: State) -> None:
        """Leave it to the next step."""
        lows = self._paths[self._lows]
        q, v = self._moved(state)
        state.remainders = self._kept = Remainders(self._keys, q, v, lows[:, :2].ravel(), lows[:, 2:].ravel())

    def _moved(self, state: State) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the coordinates and velocities of what moves, row by row."""
        position, velocity = state.table(Transform)["position"], state.table(Velocity)["linear"]
        return position.take(self._moving, axis=0).ravel(), velocity.take(self._moving, axis=0).ravel()

    def _begin(self, state: State) -> None:
        """List the pairs where others have made the last step, and clear the impacts of that step."""
        contacts = state.contacts
        if contacts.stale or self._listed != state.steps:
            list_all(state, self._pairs, len(self._pairs))
            contacts.manifolds["count"][: contacts.recorded] = 0
            self._listed = state.steps
        near = contacts.manifolds[: contacts.recorded]
        if near["impact_count"].any():
            near["impact_count"] = 0
            for name in _IMPACT_FIELDS:
                contacts.points[name][: 2 * contacts.recorded] = 0.0

    def _write_impacts(self, state: State, impacts: int) -> None:
        """Write the latest impacts into the records of their pairs."""
        if impacts:
            self._numbers = self._numbers or numbers_of_pairs(state.contacts)
            write_impacts(state, impacts, self._numbers)

    def _run_events(self, state: State, span: float, steps: int) -> tuple[int, int, int, float]:
        """Move bodies from impact to impact for ``steps`` times ``span`` s, or until an event.

        Returns how many steps were made, how many impacts were in the last, why there are no more, and how
        far into the next one bodies are [s].
        """
        began = time.perf_counter_ns()
        contacts = state.contacts
        self._take_masses(state)
        made, impacts, latest, why, flown = _run_events(
            *self._arguments(state), contacts.logged, state.time, span, steps,
            sampled(state.samples, state.time, span, steps),
        )  # fmt: skip
        contacts.logged += impacts
        state.collisions += impacts
        spent = time.perf_counter_ns() - began
        self._schedule.note_loop(IntegrateSystem.__name__, made, spent, self._within)
        return made, latest, why, flown

    def _take_masses(self, state: State) -> None:
        """Take the masses that gravity accelerates."""
        self._paths[:, _MASS] = np.where(self._ballistic, state.table(Mass)["mass"], 0.0)

    def _arguments(self, state: State) -> tuple[Any, ...]:
        """Return the arrays that the loop takes, which stay the same while structure and pairs do."""
        contacts, bodies = state.contacts, state.bodies
        return (
            contacts.manifolds, contacts.points, contacts.recorded,
            self._paths, self._mode, self._face, self._apart, self._due,
            motion_of(state), shapes_of(state), materials_of(state),
            (bodies.inverse_mass, bodies.inverse_inertia), self._bounds, state.account.sums, contacts.log,
        )  # fmt: skip

    def repeatable(self, state: State, stretches: Sequence[Stretch]) -> Callable[[], bool]:
        """Return what makes steps from the present places, velocities and masses, as a new stepper does."""
        self.forget()
        self._begin(state)
        contacts = state.contacts
        fixed, collisions, logged = self._arguments(state), state.collisions, contacts.logged

        def make() -> bool:
            self.forget()
            self._take_masses(state)
            count = 0
            for began, h, steps in stretches:
                made, impacts, _, _, _ = _run_events(*fixed, logged + count, began, h, steps, NOTHING_SAMPLED)
                count += impacts
                if made < steps:
                    return False
            state.collisions, contacts.logged = collisions + count, logged + count
            try:
                check_finite(state, state.time)
            except Diverged:
                return False
            return True

        return make


def _held(state: State) -> NDArray[np.int64]:
    """Return the rows (n,) of what another body presses on, or overlaps deeply, after a step made by others.

    Row 0 stands for bodies that are gone.
    """
    contacts, index = state.contacts, state.entity_index
    near = contacts.manifolds[: contacts.recorded]
    points = contacts.points[: 2 * contacts.recorded].reshape(-1, 2)
    in_use = near["count"][:, None] > _BOTH
    deep = points["separation"] < -events.DEEP * near["size"][:, None]
    holding = np.flatnonzero((in_use & ((points["normal_impulse"] > 0.0) | deep)).any(axis=1))
    entities = np.concatenate((near["entity_a"][holding], near["entity_b"][holding]))
    return np.maximum(index.rows_of(entities), 0)
