"""What has come to rest falls asleep, and wakes when it is touched or pushed."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Velocity
from physicslab.kernels import motion
from physicslab.kernels.sleep import edits, islands
from physicslab.state.sleep import Sleep
from physicslab.systems.broad_phase import nothing_to_touch
from physicslab.systems.contact import ContactSystem
from physicslab.systems.schedule import Stage, System, at

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["SleepSystem"]


class SleepSystem(System):
    """Lets islands of bodies that have rested fall asleep, and wakes those that something touches or pushes.

    An island, bodies that touch each other, sleeps when all of it has been slower than 0.05 m/s for half a
    second and not been getting faster, and something holds it that nothing moves. Nobody sleeps who touches
    what moves by itself, or on whom a spring or drag acts.
    """

    kernels = (
        *Sleep.kernels, islands.count_rest, islands.find_held, islands.find_touched, edits.find_pushed,
        motion.kick,
    )  # fmt: skip
    observes = False  # where bodies may sleep, a world goes step by step anyway

    def __init__(self) -> None:
        self._contact: ContactSystem | None = None

    def attach(self, world: World) -> None:
        """Note who finds contacts."""
        found = (system for system in world.schedule.systems if isinstance(system, ContactSystem))
        self._contact = next(found, None)

    def why_left_out(self, world: World) -> str | None:
        """Needed where bodies may come to rest on each other."""
        reason = self._why_awake(world)
        if reason is not None and world.sleep.on:
            world.sleep.forget(world)
        world.sleep.on = reason is None
        return reason

    def _why_awake(self, world: World) -> str | None:
        reason = nothing_to_touch(world)
        if reason is not None:
            return reason
        if not world.simulation.sleeping:
            return "sleeping is false"
        if world.physics.gravity_mode == "planet":
            return "planets attract each other"
        if world.method.collisions == "exact":
            return "impacts are located exactly"
        if self._contact is None:
            return "ContactSystem is not among the systems"
        return None

    @at(Stage.CONTACT)
    def wake_touched_islands(self, world: World, h: float) -> None:
        """Wake whom something touches that moves or is awake, and on whom the forces have changed.

        That is done before the impacts: nobody is struck as if nothing could move him.
        """
        sleep, contacts, bodies = world.sleep, world.contacts, world.bodies
        if sleep.unverified:
            self._take_part(world, self._see(world), h)
        while sleep.count:
            velocity, marked = world.table(Velocity), np.zeros(len(sleep.asleep), np.bool_)
            contacts.active, found = islands.find_touched(
                contacts.manifolds, contacts.points, contacts.touching, contacts.active,
                bodies.awake_inverse_mass, velocity["linear"], velocity["angular"], sleep.asleep, marked,
            )  # fmt: skip
            if world.has_forces:
                found += edits.find_pushed(bodies.force, bodies.torque, sleep.forces, sleep.asleep, marked)
            if not found:
                return
            self._take_part(world, sleep.wake(world, marked), h)

    def _take_part(self, world: World, woken: NDArray[np.bool_], h: float) -> None:
        """Let those who have just woken take part in the substep that has begun without them."""
        if not woken.any():
            return
        contacts, bodies, velocity = world.contacts, world.bodies, world.table(Velocity)
        if world.has_forces:
            motion.kick(
                velocity["linear"], velocity["angular"], bodies.force, bodies.torque,
                np.where(woken, bodies.inverse_mass, 0.0), bodies.inverse_inertia, bodies.sub_integrated,
                world.physics.linear_damping, world.physics.angular_damping, _missed(world) * h,
            )  # fmt: skip
        scalar = contacts.scalar[: contacts.scalar_count]
        near = contacts.manifolds[scalar]
        theirs = np.ascontiguousarray(scalar[woken[near["a"]] | woken[near["b"]]])
        # Of these the masses are others now; no impact of this step can have been theirs.
        self._find(world, theirs, len(theirs), contacts.touching, h, first=True)
        contacts.active = self._find(world, contacts.scalar, len(scalar), contacts.touching, h)

    def _find(
        self, world: World, pairs: NDArray[np.int64], count: int, touching: NDArray[np.int64], h: float,
        first: bool = False,
    ) -> int:  # fmt: skip
        bodies, finder = world.bodies, cast("ContactSystem", self._contact)
        return finder.find_among(
            world, pairs, count, touching, bodies.awake_inverse_mass, bodies.awake_inverse_inertia, first, h
        )

    @at(Stage.FINISH)
    def add_constraints(self, world: World, h: float) -> None:
        """Count how long bodies have rested; let the islands that have rested long enough fall asleep."""
        sleep, velocity, shape = world.sleep, world.table(Velocity), world.table(Shape)
        if sleep.has_external_writers:
            sleep.check(world, within=True)
        if islands.count_rest(
            velocity["linear"], velocity["angular"],
            shape["kind"], shape["radius"], shape["width"], shape["height"],
            world.bodies.inverse_mass, world.bodies.sub_integrated, sleep.asleep, sleep.rest, sleep.slowest,
            min(h, world.simulation.dt),  # of a step that was divided no more than the end is seen
        ):  # fmt: skip
            self.put_islands_to_sleep(world, h)
        sleep.keep(world)

    def put_islands_to_sleep(self, world: World, h: float) -> None:
        """Let the islands fall asleep that have rested long enough."""
        sleep, contacts = world.sleep, world.contacts
        contacts.sync()
        ready = (sleep.rest >= islands.READY) & ~sleep.asleep
        held = self._held(world, ready)
        if held.any():
            sleep.fall_asleep(world, held)
            self._see(world)

    def _held(self, world: World, ready: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return which of those who are ready to sleep belong to an island that may."""
        contacts, velocity, held = world.contacts, world.table(Velocity), np.zeros(len(ready), np.bool_)
        islands.find_held(
            contacts.manifolds, contacts.points, contacts.recorded, world.bodies.inverse_mass,
            velocity["linear"], velocity["angular"], ready, held,
        )  # fmt: skip
        return held

    def _see(self, world: World) -> NDArray[np.bool_]:
        """Find where sleepers touch as they lie now; wake those whom nothing holds, and return who woke.

        A file may have it that somebody sleeps in the air.
        """
        sleep, contacts, bodies = world.sleep, world.contacts, world.bodies
        sleep.unverified = False
        inactive = sleep.asleep | ~world.table(Velocity).present
        pairs = np.empty(contacts.recorded, np.int64)
        count = islands.list_sleeping(contacts.manifolds, contacts.recorded, inactive, pairs)
        h = world.simulation.dt / world.simulation.substeps
        contacts.sleeping_count = cast("ContactSystem", self._contact).find_among(
            world, pairs, count, contacts.sleeping, bodies.inverse_mass, bodies.inverse_inertia, True, h
        )
        scalar = sleep.asleep & ~self._held(world, sleep.asleep)
        return sleep.wake(world, scalar) if scalar.any() else scalar


def _missed(world: World) -> float:
    """Return which share of a substep's kick comes before contacts are found."""
    plan = world.method.stages.substep
    before = plan[: [stage for stage, _ in plan].index(Stage.CONTACT)]
    return sum(share for stage, share in before if stage is Stage.KICK)
