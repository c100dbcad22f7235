"""Steps a world whose bodies fly freely between impacts, each impact at its own time."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Material, Shape, Transform, Velocity
from physicslab.kernels.events import events, flight
from physicslab.stepping.event_driven_limits import pairs_that_may_meet, turning_boxes
from physicslab.systems.schedule import Stage

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["EventDriven"]

type _State = list[NDArray[np.float64]]
"""Copies of the columns below."""

_COLUMNS = ((Transform, "position"), (Transform, "angle"), (Velocity, "linear"), (Velocity, "angular"))
_FELT = ("approach_speed", "impact_normal", "impact_tangent")
_PULL = slice(8, 10)
"""The columns of a flight's acceleration."""
_SHORT = 1e-6
"""Share of a step that is too short for what rests to move."""
_MOST_PARTS = 1000
"""How often flights may be broken off within a step before all bodies are left to the contact step."""


class EventDriven:
    """Flights and impacts of one world, until its structure changes.

    A body flies in closed form from impact to impact. One that comes to rest on another is handed over to the
    contact step, together with all others that rest, and comes back when nothing presses on it or when a
    flying body strikes it: the step is then divided at the time of the blow.

    Who rests follows from the contacts of the last step, so that nothing here needs to be saved.

    Attributes
    ----------
    kernels : tuple of kernels
        What it calls.
    """

    kernels = (events.run_events,)

    def __init__(self, world: World) -> None:
        rows = len(world.entity_index)
        self._pairs = pairs_that_may_meet(world)
        self._listed = False
        self._urgent = -1
        self._paths = np.zeros((rows, flight.FIELDS))
        moving = world.table(Velocity).present & world.table(Transform).present
        free = moving & (world.bodies.inverse_mass > 0.0)
        self._unpressed = np.where(free, events.BALLISTIC, np.where(moving, events.KINEMATIC, events.FIXED))
        self._mode = self._unpressed.copy()
        self._face = np.zeros(len(self._pairs), np.int64)
        self._due = np.zeros((len(self._pairs), 5))
        self._struck_at = np.full((len(self._pairs), 2), np.nan)
        self._bounds = np.array(world.physics.bounds or (0.0, 0.0, 0.0, 0.0))
        gravity = world.physics.gravity
        pulled = any(system.name == "GravitySystem" for system in world.schedule.running)
        self._within = ("GravitySystem",) * pulled + ("ContactSystem", "ResolveSystem")
        self._gravity = np.array((gravity.x, gravity.y) if pulled else (0.0, 0.0))

    def holds(self, world: World) -> bool:
        """Whether the world may still be stepped so; values that anybody may change can forbid it."""
        return not len(turning_boxes(world))

    def step(self, world: World, dt: float) -> None:
        """Advance by one step, and let those look at its impacts who do."""
        self._begin(world)
        self._advance(world, dt, dt, 0.0)
        self._point_to_impacts(world)
        world.schedule.run_beside("ResolveSystem", Stage.IMPACT, world, dt)

    def run(self, world: World, dt: float, steps: int) -> None:
        """Advance by so many steps, in one compiled loop while nothing rests."""
        done = 0
        while done < steps:
            self._begin(world)
            gone = 0.0
            if not (self._mode == events.IN_CONTACT).any():
                gone, why = self._run_events(world, dt * (steps - done), dt, done * dt)
                if why == events.DONE:
                    return
                whole = min(int(gone / dt), steps - done - 1)
                done, gone = done + whole, gone - whole * dt
            # Whoever rests from here on is moved by the contact step, which goes by whole steps.
            world.schedule.run(Stage.PREPARE, world, dt)
            self._advance(world, dt - gone, dt, done * dt + gone)
            done += 1

    def _begin(self, world: World) -> None:
        """Find out what each row does, and forget the impacts of the step before."""
        contacts = world.contacts
        if contacts.stale or not self._listed:
            contacts.relist(world, self._pairs, len(self._pairs))
            self._list_touching(world)
            self._listed = True
        near = contacts.manifolds[: contacts.recorded]
        if near["impact_count"].any():
            near["impact_count"] = 0
            points = contacts.points[: 2 * contacts.recorded]
            for name in _FELT:
                points[name] = 0.0
            self._struck_at[:] = np.nan
        self._mode[:] = self._unpressed
        if contacts.count:
            self._mode[self._held_by_contacts(world) & (self._unpressed == events.BALLISTIC)] = (
                events.IN_CONTACT
            )

    def _point_to_impacts(self, world: World) -> None:
        """Let the arms of what was struck in flight lead from where B is now to where the impact was."""
        pairs = np.flatnonzero(np.isfinite(self._struck_at[:, 0]) & ~self._left_to_contacts())
        if len(pairs):
            points = world.contacts.points
            moved = self._struck_at[pairs] - world.table(Transform)["position"][self._pairs[pairs, 1]]
            for k in range(2):
                points["arm_bx"][2 * pairs + k] += moved[:, 0]
                points["arm_by"][2 * pairs + k] += moved[:, 1]

    def _list_touching(self, world: World) -> None:
        contacts = world.contacts
        touching = np.flatnonzero(contacts.manifolds["count"][: contacts.recorded] > 0)
        contacts.active = len(touching)
        contacts.touching[: len(touching)] = touching

    def _held_by_contacts(self, world: World) -> NDArray[np.bool_]:
        """Return which rows the contact step has left with a contact that holds them."""
        contacts = world.contacts
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

    def _advance(self, world: World, span: float, dt: float, offset: float) -> None:
        """Advance by a step, or by what is left of it."""
        left, parts = span, 0
        while left > 0.0:
            parts += 1
            if parts > _MOST_PARTS:
                self._mode[self._mode == events.BALLISTIC] = events.IN_CONTACT
            if (self._mode == events.IN_CONTACT).any():
                elapsed = self._both(world, left, dt, offset + (span - left))
            else:
                elapsed, why = self._run_events(world, left, dt, offset + (span - left))
                if why == events.TOO_MANY_IMPACTS:
                    self._mode[self._mode == events.BALLISTIC] = events.IN_CONTACT
            left = left - elapsed if elapsed < left else 0.0

    def _both(self, world: World, span: float, dt: float, offset: float) -> float:
        """Let some bodies rest and the others fly until the flights break off; return the time gone by."""
        in_contact = self._mode == events.IN_CONTACT
        pairs = np.flatnonzero(self._left_to_contacts())
        before, kept, collisions = _state(world), _contacts(world, pairs), world.collisions
        after = self._rest(world, pairs, span, dt)
        elapsed = span
        if (self._mode == events.BALLISTIC).any():
            # To those that fly, what rests moves as it will: from where, how fast and to where is known.
            way = after[0] - before[0] - span * before[2]
            self._paths[:, _PULL] = self._gravity
            self._paths[in_contact, _PULL] = (
                2.0 * way[in_contact] / (span * span) if span > _SHORT * dt else 0.0
            )
            impact_count = world.collisions - collisions
            _restore(world, before)
            elapsed, _ = self._run_events(world, span, dt, offset)
            advanced = _state(world)
            if elapsed < span:
                world.collisions -= impact_count
                _restore(world, before)
                _restore_contacts(world, pairs, kept)
                after = self._rest(world, pairs, elapsed, dt)
            for whole, part in zip(advanced, after, strict=True):
                whole[in_contact] = part[in_contact]
            _restore(world, advanced)
        if elapsed > _SHORT * dt:
            self._mode[in_contact & (self._mode == events.IN_CONTACT) & ~self._held_by_contacts(world)] = (
                events.BALLISTIC
            )
        return elapsed

    def _left_to_contacts(self) -> NDArray[np.bool_]:
        """Return of which pairs the contact step takes care: one rests, and the other does not fly."""
        one, other = self._mode[self._pairs[:, 0]], self._mode[self._pairs[:, 1]]
        in_contact = (one == events.IN_CONTACT) | (other == events.IN_CONTACT)
        left: NDArray[np.bool_] = in_contact & (one != events.BALLISTIC) & (other != events.BALLISTIC)
        return left

    def _rest(self, world: World, pairs: NDArray[np.int64], span: float, dt: float) -> _State:
        """Let the contact step move everything for ``span`` s, minding these contacts; return where to."""
        if span <= _SHORT * dt:
            return _state(world)
        contacts = world.contacts
        near = contacts.manifolds[: contacts.recorded]
        points = contacts.points[: 2 * contacts.recorded]
        others = np.ones(len(near), np.bool_)
        others[pairs] = False
        near["count"][others] = -1  # the contact step passes over them
        impact_count, felt = near["impact_count"].copy(), [points[name].copy() for name in _FELT]
        substeps, run = world.simulation.substeps, world.schedule.run
        for _ in range(substeps):
            for stage, share in world.method.stages.substep:
                if stage is not Stage.BROAD_PHASE:
                    run(stage, world, share * span / substeps)
        near["count"][others] = 0
        # The step's first look at contacts has begun a new record; what they felt in flight belongs to it.
        new = impact_count > near["impact_count"]
        near["impact_count"][new] += impact_count[new]
        both = np.repeat(new, 2)
        for name, before in zip(_FELT, felt, strict=True):
            joined = np.maximum if name == "approach_speed" else np.add
            points[name][both] = joined(points[name][both], before[both])
        return _state(world)

    def _run_events(self, world: World, span: float, dt: float, offset: float) -> tuple[float, int]:
        """Let bodies fly for ``span`` s, or until one comes to rest or is woken; return how long, and why."""
        began = time.perf_counter_ns()
        contacts, bodies, physics = world.contacts, world.bodies, world.physics
        transform, velocity = world.table(Transform), world.table(Velocity)
        shape, material = world.table(Shape), world.table(Material)
        ballistic = self._mode == events.BALLISTIC
        self._paths[:, _PULL] = np.where(
            (self._mode == events.IN_CONTACT)[:, None],
            self._paths[:, _PULL],
            ballistic[:, None] * self._gravity,
        )
        elapsed, impacts, why, pair = events.run_events(
            contacts.manifolds, contacts.points, contacts.recorded,
            self._paths, self._mode, self._face, self._due, self._struck_at,
            transform["position"], transform["angle"], velocity["linear"], velocity["angular"],
            shape["kind"], shape["radius"], shape["width"], shape["height"],
            material["restitution"], material["friction"], bodies.inverse_mass, bodies.inverse_inertia,
            self._bounds, physics.bounds_restitution, physics.bounds_friction,
            contacts.log, contacts.logged, world.time + offset, span, dt, self._urgent,
        )  # fmt: skip
        # Who is woken is struck before anything else happens to it, or it would lie down again at once.
        self._urgent = pair if why == events.WOKEN else -1
        contacts.logged += impacts
        world.collisions += impacts
        world.schedule.note("IntegrateSystem", 1, time.perf_counter_ns() - began)
        for name in self._within:
            world.schedule.note(name, 1, 0)  # their time is within the loop's
        return elapsed, why


def _state(world: World) -> _State:
    """Return a copy of all places and velocities."""
    return [world.table(component)[name].copy() for component, name in _COLUMNS]


def _restore(world: World, state: _State) -> None:
    for (component, name), column in zip(_COLUMNS, state, strict=True):
        world.table(component)[name][:] = column


def _contacts(world: World, pairs: NDArray[np.int64]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return a copy of the contacts of some pairs."""
    return world.contacts.manifolds[pairs], world.contacts.points.reshape(-1, 2)[pairs]


def _restore_contacts(
    world: World, pairs: NDArray[np.int64], kept: tuple[NDArray[Any], NDArray[Any]]
) -> None:
    world.contacts.manifolds[pairs] = kept[0]
    world.contacts.points.reshape(-1, 2)[pairs] = kept[1]
