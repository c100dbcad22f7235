"""Scenes of few bodies that bounce: ballistic motion between impacts, each impact at its own time."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Transform, Velocity
from physicslab.contacts.arguments import bounds_of, materials_of, motion_of, shapes_of
from physicslab.contacts.near_pairs import list_all
from physicslab.kernels.accounts import GRAVITY, PX
from physicslab.kernels.broad import near_pairs
from physicslab.kernels.events import events, path
from physicslab.kernels.wide import slots
from physicslab.state.masses import check_finite
from physicslab.state.remainders import Remainders, coordinate_keys
from physicslab.state.state import State
from physicslab.stepping.ballistic import pairs_that_may_meet, turning_boxes
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.resting_bodies import (
    Moment,
    Motion,
    RestingBodies,
    clear_impacts,
    copy_motion,
    list_touching,
    set_motion,
)
from physicslab.stepping.rigid import Rigid
from physicslab.stepping.stepper import Advance, divisions
from physicslab.systems.contact import ContactSystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.resolve import ResolveSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import Stage

__all__ = ["EventDriven"]

_ACCELERATION = slice(8, 10)
"""The columns of a path's acceleration."""
_LOW = (1, 3, 5, 7)
"""The columns of what rounding leaves out of a path's place and velocity."""
_MASS = 12
"""The column of the mass that gravity accelerates."""
_SHORT = 1e-6
"""Share of a step that is too short for resting bodies to move."""
_MAX_PARTS = 1000
"""Largest number of parts of a step; after it all bodies are left to the contact step."""


class EventDriven:
    """Advances bodies in closed form from impact to impact.

    Where contacts are rigid, a step in which one comes to rest on another, or rests, is left to them. Else
    that body is handed over to the contact step, together with all others that rest, and comes back when
    nothing presses on it or when a ballistic body hits it: the step is then divided at the time of the
    impact.

    Which bodies rest follows from the contacts of the last step, and what rounding leaves out is part of the
    state, so that nothing here needs to be saved. Any number of steps has the bits of single ones.
    """

    name: str = "event_driven"
    title: str = "Impacts at their exact times"
    keeps_balance: bool = False
    leaves_forces: bool = False
    kernels: tuple[Any, ...] = (events.run_events, near_pairs.carry_over, slots.list_scalar)

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None:
        self._schedule, self._resting = schedule, RestingBodies(state, schedule, plan)
        self._plan: StepPlan = plan
        self._together: Rigid | None = None
        self.reason = plan.collision_reason
        self._leaves_rest = plan.contacts == "rigid"
        self._left = -1
        self.leaps = not self._leaves_rest
        rows = len(state.entity_index)
        self._pairs = pairs_that_may_meet(state)
        self._listed = False
        self._urgent = -1
        self._paths = np.zeros((rows, path.FIELDS))
        moving = state.table(Velocity).present & state.table(Transform).present
        free = moving & (state.bodies.inverse_mass > 0.0)
        self._initial_mode = np.where(
            free, events.BALLISTIC, np.where(moving, events.KINEMATIC, events.FIXED)
        )
        self._mode = self._initial_mode.copy()
        self._moving = np.flatnonzero(moving)
        self._lows = self._moving[:, None], np.array(_LOW)
        self._kept: Remainders | None = None
        entities = state.entity_index.entities[self._moving]
        self._keys = coordinate_keys(entities, entities[:0])
        self._face = np.zeros(len(self._pairs), np.int64)
        self._apart = np.zeros(len(self._pairs), np.int64)
        self._due = np.zeros((len(self._pairs), 5))
        self._impact_positions = np.full((len(self._pairs), 2), np.nan)
        self._bounds = bounds_of(state)
        uniform = [force.uniform_acceleration(state) for force in schedule.forces]
        self._gravity = np.array([(g.x, g.y) for g in uniform if g is not None] or [(0.0, 0.0)]).sum(axis=0)
        internal = (*schedule.forces, schedule.find(ContactSystem), schedule.find(ResolveSystem))
        self._within = [system.name for system in internal if system is not None]

    @classmethod
    def why_not(cls, state: State, schedule: Schedule, plan: StepPlan) -> str | None:
        """Return why collisions are not located in time, or ``None``."""
        return None if plan.collisions == "exact" else plan.collision_reason

    def holds(self, state: State) -> bool:
        """Whether the world may still be stepped so; values that may change at any time can forbid it."""
        return not len(turning_boxes(state))

    def ready(self, state: State, h: float) -> bool:
        """Whether the coming step is not one that it has just left to others."""
        return self._left != state.steps

    def advance(self, state: State, h: float, steps: int) -> Advance:
        """Make all of the steps, in one compiled loop while nothing rests; or those before anything rests."""
        parts = divisions(state, h)
        if self._leaves_rest:
            steps = self._run_until_rest(state, h, parts, steps)
        else:
            self._run(state, h / parts, parts * steps)
        if steps:
            self._point_to_impacts(state)
            self._schedule.run_others(ResolveSystem, Stage.IMPACT, state, h)
        check_finite(state, state.time + h * steps)
        return Advance(steps, parts)

    def _run_until_rest(self, state: State, h: float, parts: int, steps: int) -> int:
        """Make the steps in which nothing rests, of ``parts`` parts each; return how many they are."""
        start, collisions, logged = copy_motion(state), state.collisions, state.contacts.logged
        booked = state.account.sums.copy()
        while steps:
            self._recall_remainders(state)
            self._begin(state)
            made, why = 0, events.CAME_TO_REST
            if not (self._mode == events.IN_CONTACT).any():
                made, _, why = self._run_events(state, h / parts, parts * steps, h / parts, 0.0)
            if why == events.DONE:
                self._keep_remainders(state)
                return steps
            set_motion(state, start)
            state.collisions, state.contacts.logged = collisions, logged
            state.account.sums[:] = booked
            self._urgent, self._kept, steps = -1, None, made // parts
        self._left = state.steps
        return 0

    def _run(self, state: State, dt: float, steps: int) -> None:
        """Make so many steps."""
        done = 0
        self._recall_remainders(state)
        while done < steps:
            self._begin(state)
            gone = 0.0
            if not (self._mode == events.IN_CONTACT).any():
                made, gone, why = self._run_events(state, dt, steps - done, dt, done * dt)
                done += made
                if why == events.DONE:
                    break
                self._give_up(why)
            # Resting bodies are moved by the contact step from here on, which makes whole steps.
            self._resting.begin_step(state)
            self._advance(state, dt - gone, dt, done * dt + gone)
            done += 1
        self._keep_remainders(state)

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

    def _give_up(self, why: int) -> None:
        """Leave all bodies to the contact step where impacts have no end."""
        if why == events.TOO_MANY_IMPACTS:
            self._mode[self._mode == events.BALLISTIC] = events.IN_CONTACT

    def _begin(self, state: State) -> None:
        """Find the mode of each row, and clear the impacts of the step before."""
        if state.contacts.stale or not self._listed:
            list_all(state, self._pairs, len(self._pairs))
            list_touching(state)
            self._listed = True
        if clear_impacts(state):
            self._impact_positions[:] = np.nan
        self._mode[:] = self._initial_mode
        if state.contacts.count:
            resting = self._resting.held(state) & (self._initial_mode == events.BALLISTIC)
            self._mode[resting] = events.IN_CONTACT

    def _point_to_impacts(self, state: State) -> None:
        """Make the arms of ballistic impacts lead from the present place of B to that of the impact."""
        pairs = np.flatnonzero(np.isfinite(self._impact_positions[:, 0]) & ~self._left_to_contacts())
        if len(pairs):
            points = state.contacts.points
            moved = self._impact_positions[pairs] - state.table(Transform)["position"][self._pairs[pairs, 1]]
            for k in range(2):
                points["arm_bx"][2 * pairs + k] += moved[:, 0]
                points["arm_by"][2 * pairs + k] += moved[:, 1]

    # ---- parts of a step -----------------------------------------------------------------------------------

    def _advance(self, state: State, span: float, dt: float, offset: float) -> None:
        """Advance by a step, or by what is left of it."""
        left, parts, ordered = span, 0, False
        while left > 0.0:
            parts += 1
            if parts > _MAX_PARTS:
                self._mode[self._mode == events.BALLISTIC] = events.IN_CONTACT
            if (self._mode == events.IN_CONTACT).any():
                elapsed = self._advance_both(state, left, dt, offset + (span - left))
            else:
                made, elapsed, why = self._run_events(state, left, 1, dt, offset + (span - left), ordered)
                elapsed, ordered = left if made else elapsed, False
                if why == events.TOGETHER:
                    ordered = not self._collide(state, offset + (span - left) + elapsed)
                self._give_up(why)
            left = left - elapsed if elapsed < left else 0.0

    def _advance_both(self, state: State, span: float, dt: float, offset: float) -> float:
        """Advance resting and ballistic bodies together until an event; return the time that passed.

        For ballistic bodies, resting ones follow a path from their known start, velocity and end. Where an
        event comes before that end, resting bodies go back and advance to the event.
        """
        in_contact, ballistic = self._mode == events.IN_CONTACT, self._mode == events.BALLISTIC
        start = Moment.of(state, np.flatnonzero(self._left_to_contacts()))
        end = self._advance_resting(state, start, offset, span, dt, ballistic)
        impacts, elapsed = state.collisions - start.collisions, span
        if ballistic.any():
            self._lead_resting(in_contact, start.motion, end, span, dt)
            set_motion(state, start.motion)
            resting = state.account.sums.copy()
            made, elapsed, _ = self._run_events(state, span, 1, dt, offset, ordered=True)
            elapsed = span if made else elapsed
            motion = copy_motion(state)
            if elapsed < span:
                flown = state.account.sums - resting
                start.restore(state, impacts)
                end = self._advance_resting(state, start, offset, elapsed, dt, ballistic)
                state.account.sums += flown
            for whole, part in zip(motion, end, strict=True):
                whole[in_contact] = part[in_contact]
            set_motion(state, motion)
        self._paths[np.ix_(in_contact, _LOW)] = 0.0
        if elapsed > _SHORT * dt:
            released = in_contact & (self._mode == events.IN_CONTACT) & ~self._resting.held(state)
            self._mode[released] = events.BALLISTIC
        return elapsed

    def _advance_resting(
        self, state: State, start: Moment, offset: float, span: float, dt: float, ballistic: NDArray[np.bool_]
    ) -> Motion:
        """Advance resting bodies by ``span`` s, if they can move within it; return the motion of all.

        The contact step moves ``ballistic`` ones as well, which is not booked.
        """
        if span <= _SHORT * dt:
            return copy_motion(state)
        end = self._resting.advance(state, start.pairs, state.time + offset, span)
        mass, (gx, gy) = state.table(Mass)["mass"][ballistic], span * self._gravity
        position, velocity = start.motion[0][ballistic], start.motion[2][ballistic]
        x, y = mass @ (position + 0.5 * span * velocity)
        state.account.sums[GRAVITY, PX:] -= (mass.sum() * gx, mass.sum() * gy, x * gy - y * gx)
        return end

    def _lead_resting(
        self, in_contact: NDArray[np.bool_], start: Motion, end: Motion, span: float, dt: float
    ) -> None:
        """Give resting bodies the acceleration that leads them from ``start`` to ``end`` in ``span`` s."""
        way = end[0] - start[0] - span * start[2]
        self._paths[:, _ACCELERATION] = self._gravity
        self._paths[in_contact, _ACCELERATION] = (
            2.0 * way[in_contact] / (span * span) if span > _SHORT * dt else 0.0
        )

    def _left_to_contacts(self) -> NDArray[np.bool_]:
        """Return which pairs the contact step handles: one body rests, and the other is not ballistic."""
        one, other = self._mode[self._pairs[:, 0]], self._mode[self._pairs[:, 1]]
        in_contact = (one == events.IN_CONTACT) | (other == events.IN_CONTACT)
        left: NDArray[np.bool_] = in_contact & (one != events.BALLISTIC) & (other != events.BALLISTIC)
        return left

    def _collide(self, state: State, offset: float) -> bool:
        """Resolve impacts that a body has with several others by the laws of rigid contacts, all at once.

        Returns whether there were any: what is not resolved so is resolved in order.
        """
        self._together = self._together or Rigid(state, self._schedule, self._plan)
        impacts = self._together.collide(state, state.time + offset)
        state.collisions += impacts
        self._paths[self._lows] = 0.0
        return impacts > 0

    def _run_events(
        self, state: State, span: float, steps: int, dt: float, offset: float, ordered: bool = False
    ) -> tuple[int, float, int]:
        """Move bodies from impact to impact for ``steps`` times ``span`` s, or until an event.

        Returns how many steps were made, the time of the one that was not, and why.
        """
        began = time.perf_counter_ns()
        contacts, bodies = state.contacts, state.bodies
        ballistic = self._mode == events.BALLISTIC
        self._paths[:, _ACCELERATION] = np.where(
            (self._mode == events.IN_CONTACT)[:, None],
            self._paths[:, _ACCELERATION],
            ballistic[:, None] * self._gravity,
        )
        self._paths[:, _MASS] = np.where(ballistic, state.table(Mass)["mass"], 0.0)
        made, elapsed, impacts, why, pair = events.run_events(
            contacts.manifolds, contacts.points, contacts.recorded,
            self._paths, self._mode, self._face, self._apart, self._due,
            self._impact_positions, motion_of(state), shapes_of(state), materials_of(state),
            (bodies.inverse_mass, bodies.inverse_inertia), self._bounds,
            state.account.sums, contacts.log, contacts.logged, state.time + offset, span, steps, dt,
            self._urgent, ordered,
        )  # fmt: skip
        # The impact of a woken body is resolved first, or the body would come to rest again at once.
        self._urgent = pair if why == events.WOKEN else -1
        contacts.logged += impacts
        state.collisions += impacts
        calls = max(made, 1)
        self._schedule.note(IntegrateSystem.__name__, calls, time.perf_counter_ns() - began)
        for name in self._within:
            self._schedule.note(name, calls, 0)  # their time is part of the loop's
        return made, elapsed, why
