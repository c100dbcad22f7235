"""Scenes of few bodies that bounce: ballistic motion between impacts, each impact at its own time."""

from __future__ import annotations

import time
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Material, Shape, Transform, Velocity
from physicslab.contacts.near_pairs import list_all
from physicslab.kernels.broad import near_pairs
from physicslab.kernels.events import events, path
from physicslab.kernels.wide import slots
from physicslab.state.masses import check_finite
from physicslab.state.state import State
from physicslab.stepping.ballistic import pairs_that_may_meet, turning_boxes
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.stepper import Advance, divisions
from physicslab.systems.contact import ContactSystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.resolve import ResolveSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import Stage

__all__ = ["EventDriven"]

type _State = list[NDArray[np.float64]]
"""Copies of the columns below."""

_COLUMNS = ((Transform, "position"), (Transform, "angle"), (Velocity, "linear"), (Velocity, "angular"))
_WARM = ("feature", "normal_impulse", "tangent_impulse")
"""What a contact starts the next substep from."""
_IMPACT_FIELDS = ("approach_speed", "impact_normal", "impact_tangent")
_ACCELERATION = slice(8, 10)
"""The columns of a path's acceleration."""
_SHORT = 1e-6
"""Share of a step that is too short for resting bodies to move."""
_MAX_PARTS = 1000
"""Largest number of parts of a step; after it all bodies are left to the contact step."""


class EventDriven:
    """Advances bodies in closed form from impact to impact.

    One that comes to rest on another is handed over to the contact step, together with all others that rest,
    and comes back when nothing presses on it or when a ballistic body hits it: the step is then divided at
    the time of the impact.

    Which bodies rest follows from the contacts of the last step, so that nothing here needs to be saved.
    """

    name: ClassVar[str] = "event_driven"
    title: ClassVar[str] = "Impacts at their exact times"
    leaps: ClassVar[bool] = True
    leaves_forces: ClassVar[bool] = False
    kernels: tuple[Any, ...] = (events.run_events, near_pairs.carry_over, slots.list_scalar)

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None:
        self._schedule, self._stages = schedule, plan.stages.substep
        self.reason = plan.collision_reason
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
        self._face = np.zeros(len(self._pairs), np.int64)
        self._due = np.zeros((len(self._pairs), 5))
        self._impact_positions = np.full((len(self._pairs), 2), np.nan)
        self._bounds = np.array(state.physics.bounds or (0.0, 0.0, 0.0, 0.0))
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
        """Be ready for any step."""
        return True

    def advance(self, state: State, h: float, steps: int) -> Advance:
        """Make all of the steps, in one compiled loop while nothing rests."""
        parts = divisions(state, h)
        if parts * steps > 1:
            self._run(state, h / parts, parts * steps)
        else:
            self._step(state, h)
        check_finite(state, state.time + h * steps)
        return Advance(steps, parts)

    def _step(self, state: State, dt: float) -> None:
        """Make one step, and call the systems that observe its impacts."""
        self._begin(state)
        self._begin_contact_step(state)
        self._advance(state, dt, dt, 0.0)
        self._point_to_impacts(state)
        self._schedule.run_others(ResolveSystem, Stage.IMPACT, state, dt)

    def _run(self, state: State, dt: float, steps: int) -> None:
        """Make so many steps."""
        done = 0
        while done < steps:
            self._begin(state)
            gone = 0.0
            if not (self._mode == events.IN_CONTACT).any():
                gone, why = self._run_events(state, dt * (steps - done), dt, done * dt)
                if why == events.DONE:
                    return
                whole = min(int(gone / dt), steps - done - 1)
                done, gone = done + whole, gone - whole * dt
            # Resting bodies are moved by the contact step from here on, which makes whole steps.
            self._begin_contact_step(state)
            self._advance(state, dt - gone, dt, done * dt + gone)
            done += 1

    def _begin_contact_step(self, state: State) -> None:
        contact = self._schedule.find(ContactSystem)
        if contact is not None:
            contact.begin_step(state)

    def _begin(self, state: State) -> None:
        """Find the mode of each row, and clear the impacts of the step before."""
        contacts = state.contacts
        if contacts.stale or not self._listed:
            list_all(state, self._pairs, len(self._pairs))
            self._list_touching(state)
            self._listed = True
        near = contacts.manifolds[: contacts.recorded]
        if near["impact_count"].any():
            near["impact_count"] = 0
            points = contacts.points[: 2 * contacts.recorded]
            for name in _IMPACT_FIELDS:
                points[name] = 0.0
            self._impact_positions[:] = np.nan
        self._mode[:] = self._initial_mode
        if contacts.count:
            self._mode[self._held_by_contacts(state) & (self._initial_mode == events.BALLISTIC)] = (
                events.IN_CONTACT
            )

    def _point_to_impacts(self, state: State) -> None:
        """Make the arms of ballistic impacts lead from the present place of B to that of the impact."""
        pairs = np.flatnonzero(np.isfinite(self._impact_positions[:, 0]) & ~self._left_to_contacts())
        if len(pairs):
            points = state.contacts.points
            moved = self._impact_positions[pairs] - state.table(Transform)["position"][self._pairs[pairs, 1]]
            for k in range(2):
                points["arm_bx"][2 * pairs + k] += moved[:, 0]
                points["arm_by"][2 * pairs + k] += moved[:, 1]

    def _list_touching(self, state: State) -> None:
        contacts = state.contacts
        touching = np.flatnonzero(contacts.manifolds["count"][: contacts.recorded] > 0)
        contacts.active = len(touching)
        contacts.touching[: len(touching)] = touching

    def _held_by_contacts(self, state: State) -> NDArray[np.bool_]:
        """Return which rows have a contact that holds them after the contact step."""
        contacts = state.contacts
        near = contacts.manifolds[: contacts.recorded]
        points = contacts.points[: 2 * contacts.recorded].reshape(-1, 2)
        in_use = np.arange(2) < near["count"][:, None]
        deep = points["separation"] < -events.DEEP * near["size"][:, None]
        held = (in_use & ((points["normal_impulse"] > 0.0) | deep)).any(axis=1)
        pressed = np.zeros(len(self._mode), np.bool_)
        pressed[near["a"][held]] = True
        pressed[near["b"][held]] = True
        return pressed

    # ---- parts of a step -----------------------------------------------------------------------------------

    def _advance(self, state: State, span: float, dt: float, offset: float) -> None:
        """Advance by a step, or by what is left of it."""
        left, parts = span, 0
        while left > 0.0:
            parts += 1
            if parts > _MAX_PARTS:
                self._mode[self._mode == events.BALLISTIC] = events.IN_CONTACT
            if (self._mode == events.IN_CONTACT).any():
                elapsed = self._both(state, left, dt, offset + (span - left))
            else:
                elapsed, why = self._run_events(state, left, dt, offset + (span - left))
                if why == events.TOO_MANY_IMPACTS:
                    self._mode[self._mode == events.BALLISTIC] = events.IN_CONTACT
            left = left - elapsed if elapsed < left else 0.0

    def _both(self, state: State, span: float, dt: float, offset: float) -> float:
        """Advance resting and ballistic bodies together until an event; return the time that passed."""
        in_contact = self._mode == events.IN_CONTACT
        pairs = np.flatnonzero(self._left_to_contacts())
        before, kept = _copied(state), _contacts(state, pairs)
        collisions, logged = state.collisions, state.contacts.logged
        after = self._rest(state, pairs, state.time + offset, span, dt)
        elapsed = span
        if (self._mode == events.BALLISTIC).any():
            # For ballistic bodies, resting ones follow a path from their known start, velocity and end.
            way = after[0] - before[0] - span * before[2]
            self._paths[:, _ACCELERATION] = self._gravity
            self._paths[in_contact, _ACCELERATION] = (
                2.0 * way[in_contact] / (span * span) if span > _SHORT * dt else 0.0
            )
            impact_count = state.collisions - collisions
            _restore(state, before)
            elapsed, _ = self._run_events(state, span, dt, offset)
            advanced = _copied(state)
            if elapsed < span:
                state.collisions -= impact_count
                if state.contacts.read:
                    state.contacts.forget_impacts(logged, impact_count)
                _restore(state, before)
                _restore_contacts(state, pairs, kept)
                after = self._rest(state, pairs, state.time + offset, elapsed, dt)
            for whole, part in zip(advanced, after, strict=True):
                whole[in_contact] = part[in_contact]
            _restore(state, advanced)
        if elapsed > _SHORT * dt:
            self._mode[in_contact & (self._mode == events.IN_CONTACT) & ~self._held_by_contacts(state)] = (
                events.BALLISTIC
            )
        return elapsed

    def _left_to_contacts(self) -> NDArray[np.bool_]:
        """Return which pairs the contact step handles: one body rests, and the other is not ballistic."""
        one, other = self._mode[self._pairs[:, 0]], self._mode[self._pairs[:, 1]]
        in_contact = (one == events.IN_CONTACT) | (other == events.IN_CONTACT)
        left: NDArray[np.bool_] = in_contact & (one != events.BALLISTIC) & (other != events.BALLISTIC)
        return left

    def _rest(self, state: State, pairs: NDArray[np.int64], began: float, span: float, dt: float) -> _State:
        """Advance all by the contact step for ``span`` s, with these contacts alone; return the new state."""
        if span <= _SHORT * dt:
            return _copied(state)
        contacts = state.contacts
        near = contacts.manifolds[: contacts.recorded]
        points = contacts.points[: 2 * contacts.recorded]
        lost = np.repeat(near["count"] <= 0, 2)  # a contact that comes again starts from no old impulse
        for name in _WARM:
            points[name][lost] = 0
        others = np.ones(len(near), np.bool_)
        others[pairs] = False
        near["count"][others] = -1  # the contact step skips them
        impact_count, earlier = near["impact_count"].copy(), [points[name].copy() for name in _IMPACT_FIELDS]
        substeps, run = state.simulation.substeps, self._schedule.run
        # Kernels of the stages are compiled at their first call: most are not called here.
        for substep in range(substeps):
            state.moment = began + (substep + 0.5) * span / substeps
            for stage, share in self._stages:
                if stage is not Stage.BROAD_PHASE:
                    run(stage, state, share * span / substeps)
        near["count"][others] = 0
        # The contact stage has cleared the records of impacts; those of the ballistic part are added again.
        new = impact_count > near["impact_count"]
        near["impact_count"][new] += impact_count[new]
        both = np.repeat(new, 2)
        for name, before in zip(_IMPACT_FIELDS, earlier, strict=True):
            joined = np.maximum if name == "approach_speed" else np.add
            points[name][both] = joined(points[name][both], before[both])
        return _copied(state)

    def _run_events(self, state: State, span: float, dt: float, offset: float) -> tuple[float, int]:
        """Move bodies from impact to impact for ``span`` s, or until an event; return the time and why."""
        began = time.perf_counter_ns()
        contacts, bodies, physics = state.contacts, state.bodies, state.physics
        transform, velocity = state.table(Transform), state.table(Velocity)
        shape, material = state.table(Shape), state.table(Material)
        ballistic = self._mode == events.BALLISTIC
        self._paths[:, _ACCELERATION] = np.where(
            (self._mode == events.IN_CONTACT)[:, None],
            self._paths[:, _ACCELERATION],
            ballistic[:, None] * self._gravity,
        )
        elapsed, impacts, why, pair = events.run_events(
            contacts.manifolds, contacts.points, contacts.recorded,
            self._paths, self._mode, self._face, self._due, self._impact_positions,
            transform["position"], transform["angle"], velocity["linear"], velocity["angular"],
            shape["kind"], shape["radius"], shape["width"], shape["height"],
            material["restitution"], material["friction"], bodies.inverse_mass, bodies.inverse_inertia,
            self._bounds, physics.bounds_restitution, physics.bounds_friction,
            contacts.log, contacts.logged, state.time + offset, span, dt, self._urgent,
        )  # fmt: skip
        # The impact of a woken body is resolved first, or the body would come to rest again at once.
        self._urgent = pair if why == events.WOKEN else -1
        contacts.logged += impacts
        state.collisions += impacts
        self._schedule.note(IntegrateSystem.__name__, 1, time.perf_counter_ns() - began)
        for name in self._within:
            self._schedule.note(name, 1, 0)  # their time is part of the loop's
        return elapsed, why


def _copied(state: State) -> _State:
    """Return a copy of all places and velocities."""
    return [state.table(component)[name].copy() for component, name in _COLUMNS]


def _restore(state: State, kept: _State) -> None:
    for (component, name), column in zip(_COLUMNS, kept, strict=True):
        state.table(component)[name][:] = column


def _contacts(state: State, pairs: NDArray[np.int64]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return a copy of the contacts of some pairs."""
    return state.contacts.manifolds[pairs], state.contacts.points.reshape(-1, 2)[pairs]


def _restore_contacts(
    state: State, pairs: NDArray[np.int64], kept: tuple[NDArray[Any], NDArray[Any]]
) -> None:
    state.contacts.manifolds[pairs] = kept[0]
    state.contacts.points.reshape(-1, 2)[pairs] = kept[1]
