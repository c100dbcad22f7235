"""Who sleeps in a world: bodies that have come to rest, and are not simulated until something wakes them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Material, Shape, Transform, Velocity
from physicslab.kernels.sleep import edits, islands
from physicslab.stepping.fused_contact import COMPILED, OF_FRAMES
from physicslab.systems.schedule import Stage

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["Sleep"]

type _Marks = NDArray[np.bool_]


class Sleep:
    """The sleepers of one world, how long the others have rested, and what must not change for it.

    A sleeper has no velocity, and an infinite mass for what is simulated (``bodies.awake_inverse_mass``);
    its contacts stay in their records. Who sleeps is decided by
    :class:`physicslab.systems.sleep.SleepSystem`, which also wakes what is touched or pushed; what somebody
    edits is found here, before every step.

    Attributes
    ----------
    asleep : bool array (rows,)
        Who sleeps.
    count : int
        How many do.
    rest, slowest : float64 arrays (rows,)
        How long [s] each of the others has been slow, and its lowest speed [m/s] in that time.
    forces : float64 array (rows, 3)
        Forces [N] and torque [N m] on each sleeper; not a number where they are not known yet.
    on : bool
        Whether bodies of this world may sleep.
    unverified : bool
        Whether sleepers came from a file, so that it is still to be seen what holds them.
    has_observers : bool
        Whether somebody acts within a substep beside the contact step.
    has_external_writers : bool
        Whether somebody acts within a step who is not of the engine, and may change anything.
    """

    kernels = (
        islands.join_marked, islands.list_sleeping, edits.note_figures, edits.find_edited,
        edits.find_overlapped,
    )  # fmt: skip

    def __init__(self) -> None:
        self.on = self.unverified = self.has_observers = self.has_external_writers = False
        self.count = 0
        self.asleep: _Marks = np.zeros(1, np.bool_)
        self.rest, self.slowest = np.zeros(1), np.zeros(1)
        self.forces: NDArray[np.float64] = np.zeros((1, 3))
        self._kept: NDArray[np.float64] = np.zeros((1, edits.FIGURES))
        self._known: _Marks = np.zeros(1, np.bool_)
        self._entities: NDArray[np.int64] = np.zeros(1, np.int64)
        self._followed = self._entities
        self._gone: NDArray[np.int64] = np.zeros(0, np.int64)
        self._laws: tuple[Any, Any] | None = None

    def follow(self, world: World) -> None:
        """Let every entity keep what it has where rows are numbered anew."""
        if world.entity_index.entities is self._followed:
            return
        self._followed = world.entity_index.entities
        entities, before = self._followed.copy(), self._entities  # the roster blanks rows where they stand
        row = np.full(max(int(entities.max()), int(before.max())) + 1, -1)
        row[before] = np.arange(len(before))
        row[0] = -1
        old = row[entities]
        self._known = old >= 0
        for name in ("asleep", "rest", "slowest", "forces", "_kept"):
            column = getattr(self, name)
            moved = np.zeros((len(entities), *column.shape[1:]), column.dtype)
            moved[self._known] = column[old[self._known]]
            setattr(self, name, moved)
        self._entities = entities
        self.count = int(np.count_nonzero(self.asleep))
        self._gone = np.union1d(self._gone, np.setdiff1d(before, entities)) if self.count else before[:0]
        world.contacts.stale = True
        self._set_contacts_inactive(world)

    def look_around(self, world: World) -> None:
        """Note who acts on the world beside the contact step."""
        self.has_observers = self.has_external_writers = False
        for system in world.schedule.running:
            if type(system).__module__ != COMPILED.get(system.name):
                stages = type(system).marked().keys() - OF_FRAMES
                self.has_observers |= bool(stages - {Stage.PREPARE, Stage.FINISH})
                self.has_external_writers |= bool(stages) and not type(system).__module__.startswith(
                    "physicslab.systems."
                )

    def check(self, world: World, *, within: bool = False) -> None:
        """Wake whom an edit concerns: whose own numbers have changed, or those of what touches them.

        ``within`` a step, what moves by itself may have moved.
        """
        if not self.count:
            self._gone = self._gone[:0]
            return
        marked = self.asleep & world.bodies.sub_integrated
        if self._laws != (world.physics, world.simulation):
            marked |= self.asleep
        figures, edited = self._figures(world), np.zeros(len(self.asleep), np.bool_)
        velocity = world.table(Velocity)
        found = edits.find_edited(
            figures, self._kept, velocity["linear"], velocity["angular"], self.asleep, self._known,
            within, edited,
        )  # fmt: skip
        fresh = ~self._known & (figures[:, edits.INVERSE_MASS] == 0.0) & (self._entities > 0)
        if found or len(self._gone) or fresh.any():
            causes = np.flatnonzero((edited | fresh) & ~self.asleep)
            edits.find_overlapped(figures, causes, self.asleep, marked)
            self._mark_neighbours(world, np.concatenate((self._gone, self._entities[edited])), marked)
            marked |= edited & self.asleep
        changed = found > 0 or len(self._gone) > 0 or fresh.any() or marked.any()
        self._kept, self._gone = figures, self._gone[:0]
        self._known = self._entities > 0
        if changed:
            self.wake(world, marked)

    def _mark_neighbours(self, world: World, causes: NDArray[np.int64], marked: _Marks) -> None:
        """Mark the sleepers that touched some of the entities ``causes`` when pairs were last listed."""
        a, b, count = _touching(world)
        near = world.contacts.manifolds[: world.contacts.recorded]
        for entity, row in ((near["entity_a"], b), (near["entity_b"], a)):
            met = row[(count > 0) & np.isin(entity, causes) & (row >= 0)]
            marked[met[self.asleep[met]]] = True

    def wake(self, world: World, marked: _Marks) -> _Marks:
        """Wake the islands of the sleepers that are ``marked``, which is added to; return who woke."""
        a, b, count = _touching(world)
        islands.join_marked(a, b, count, self.asleep, marked)
        woken = marked & self.asleep
        self.asleep &= ~woken
        self.rest[woken] = self.slowest[woken] = 0.0
        self.count = int(np.count_nonzero(self.asleep))
        touches = (count > 0) & (a >= 0) & (b >= 0) & (woken[a] | woken[b])
        world.contacts.rescale(touches, self._span(world), world.contacts.impulse_dt)
        self._set_inactive(world)
        return woken

    def fall_asleep(self, world: World, falling: _Marks) -> None:
        """Let bodies fall asleep."""
        velocity = world.table(Velocity)
        velocity["linear"][falling] = velocity["angular"][falling] = 0.0
        self.rest[falling] = self.slowest[falling] = 0.0
        self.forces[falling, :2] = world.bodies.force[falling]
        self.forces[falling, 2] = world.bodies.torque[falling]
        self.asleep |= falling
        self.count = int(np.count_nonzero(self.asleep))
        a, b, count = _touching(world)
        contacts = world.contacts
        contacts.release(self.asleep)
        self._begin(world)
        contacts.rescale((count > 0) & (falling[a] | falling[b]), contacts.impulse_dt, self._span(world))
        self._set_inactive(world)

    def _begin(self, world: World) -> None:
        """Note how everything is from which an edit will be told."""
        self._laws = world.physics, world.simulation
        self._kept, self._known = self._figures(world), self._entities > 0

    def keep(self, world: World) -> None:
        """Note where a step has brought what moves by itself: what is elsewhere later was edited."""
        if self.count:
            transform, moves = world.table(Transform), world.table(Velocity).present
            rows = np.flatnonzero(moves & (world.bodies.inverse_mass == 0.0))
            self._kept[rows, :2], self._kept[rows, 2] = transform["position"][rows], transform["angle"][rows]

    def forget(self, world: World) -> None:
        """Wake everybody, and begin all rests anew."""
        self.asleep[:] = False
        self.rest[:] = self.slowest[:] = 0.0
        self.count, self.unverified = 0, False
        self._set_inactive(world)

    def all_asleep(self, world: World) -> bool:
        """Whether a step would change nothing but the clock: all that can be moved sleeps, and nothing moves.

        Nobody must act within the step but the engine's own contact step.
        """
        if not self.count or self.unverified or self.has_observers or world.contacts.stale:
            return False
        if self.count != np.count_nonzero(world.bodies.inverse_mass):
            return False
        velocity = world.table(Velocity)
        return not (velocity["linear"].any() or velocity["angular"].any())

    def _figures(self, world: World) -> NDArray[np.float64]:
        transform, shape, material = world.table(Transform), world.table(Shape), world.table(Material)
        bodies = world.bodies
        figures = np.zeros((len(self.asleep), edits.FIGURES))
        world.schedule.compile(self.kernels)
        edits.note_figures(
            transform["position"], transform["angle"],
            shape["kind"], shape["radius"], shape["width"], shape["height"],
            material["restitution"], material["friction"], bodies.inverse_mass, bodies.inverse_inertia,
            world.table(Velocity).present, figures,
        )  # fmt: skip
        return figures

    def _set_inactive(self, world: World) -> None:
        """Tell bodies and contacts who sleeps now."""
        world.bodies.set_inactive(self.asleep)
        self._set_contacts_inactive(world)

    def _set_contacts_inactive(self, world: World) -> None:
        if self.count:
            world.contacts.set_inactive(self.asleep | ~world.table(Velocity).present, len(self.asleep))
        else:
            world.contacts.set_inactive(np.zeros(0, np.bool_), len(self.asleep))

    def _span(self, world: World) -> float:
        """Return the time [s] for which impulses of sleepers stand."""
        simulation = self._laws[1] if self._laws is not None else world.simulation
        span: float = simulation.dt / simulation.substeps
        return span

    def export(self, world: World) -> list[list[Any]]:
        """Return lists: an entity that sleeps, or one with how long [s] and how slowly [m/s] it has rested.

        Only what a file will know again: bodies with a Shape that can be moved.
        """
        movable = (world.bodies.inverse_mass > 0.0) & (world.table(Shape)["kind"] != 0)
        rows = np.flatnonzero((self.asleep | (self.rest > 0.0)) & movable)
        columns = (self._entities[rows], self.asleep[rows], self.rest[rows], self.slowest[rows])
        return [
            [entity] if asleep else [entity, rest, slowest]
            for entity, asleep, rest, slowest in zip(*(column.tolist() for column in columns), strict=True)
        ]

    def restore(self, world: World, rows: Sequence[Sequence[Any]]) -> None:
        """Take back what :meth:`export` returned; where bodies may not sleep, all are awake."""
        if not (self.on and rows):
            return
        for entity, *rested in rows:
            row = world.entity_index.row_of[entity]
            if rested:
                self.rest[row], self.slowest[row] = rested
            else:
                self.asleep[row] = True
        self.count = int(np.count_nonzero(self.asleep))
        self.unverified = self.count > 0
        self.forces[:] = np.nan
        self._begin(world)
        self._set_inactive(world)


def _touching(world: World) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return of every near pair the rows as they are now, -1 for what is gone, and how many points it has."""
    near = world.contacts.manifolds[: world.contacts.recorded]
    entity_index = world.entity_index
    a, b = (np.ascontiguousarray(entity_index.rows_of(near[name])) for name in ("entity_a", "entity_b"))
    return a, b, np.ascontiguousarray(near["count"])
