"""Bodies at rest fall asleep, and wake when they are touched or pushed."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Charge, Mass, Shape, Transform, Velocity
from physicslab.contacts.arguments import do_stage, near_in
from physicslab.contacts.islands import (
    book_sleep,
    check_edits,
    fall_asleep,
    keep_places,
    pull_of,
    wake,
    wake_all,
)
from physicslab.ecs.sentences import sentence
from physicslab.kernels import Plain, motion, near_counts
from physicslab.kernels.arguments import Inverse
from physicslab.kernels.sleep import edits, islands
from physicslab.kernels.solver import soft, work
from physicslab.state.sleep import Sleep
from physicslab.state.state import State
from physicslab.systems.broad_phase import nothing_to_touch
from physicslab.systems.system import Stage, System, at

_AWAKE_LIMIT = 64
"""Number of bodies up to which none falls asleep unless a scene has ``"sleeping": true``.

A step of so many at rest takes 25 us more awake than asleep, 0.15 % of a frame.
"""


class SleepSystem(System):
    """Puts islands of bodies that have rested to sleep, and wakes those that are touched or pushed.

    An island, bodies that touch each other, sleeps when all of them have been slower than 0.05 m/s for half
    a second without getting faster, friction holds each of them or stops it within 1e-5 of its size, and a
    fixed body supports it. A body stays awake that rolls freely, touches a kinematic one, or on which a
    spring or drag acts.
    """

    engine = True
    kernels = (
        *Sleep.kernels, islands.count_rest, islands.find_held, islands.find_touched, edits.find_pushed,
        motion.kick, work.book_kick, work.book_damping, work.book_held,
    )  # fmt: skip

    def why_left_out(self, state: State) -> str | None:
        """Needed where bodies may come to rest on each other."""
        reason = self._why_awake(state)
        if reason is not None and state.sleep.on:
            wake_all(state)
        state.sleep.on = reason is None
        return reason

    def _why_awake(self, state: State) -> str | None:
        reason = nothing_to_touch(state)
        if reason is not None:
            return reason
        wish = state.simulation.sleeping
        if not wish:
            return sentence("sleeping_off")
        if state.physics.gravity_mode == "planet":
            return sentence("planets")
        if state.physics.coulomb_constant and len(state.batch(Charge)) > 1:
            return sentence("charges")
        if wish == "auto" and len(state.batch(Shape, Transform, Velocity, Mass)) <= _AWAKE_LIMIT:
            return sentence("few_awake", limit=_AWAKE_LIMIT)
        if state.event_driven or state.rigid_contacts:
            return sentence("impacts_located")
        return None

    @at(Stage.CONTACT)
    def wake_touched_islands(self, state: State, h: float) -> None:
        """Wake bodies that touch a moving or awake one, and those on which other forces act than before.

        This is done before the impacts, in which a sleeping body would otherwise count as fixed.
        """
        sleep, contacts, bodies = state.sleep, state.contacts, state.bodies
        if sleep.unverified:
            self._take_part(state, self._verify(state), h)
        while sleep.count:
            velocity, marked = state.table(Velocity), np.zeros(len(sleep.asleep), np.bool_)
            contacts.active, found = islands.find_touched(
                contacts.manifolds, contacts.points, contacts.touching, contacts.active,
                bodies.awake_inverse_mass, velocity["linear"], velocity["angular"], sleep.asleep, marked,
            )  # fmt: skip
            if state.has_forces:
                found += edits.find_pushed(bodies.force, bodies.torque, sleep.forces, sleep.asleep, marked)
            if not found:
                return
            self._take_part(state, wake(state, marked), h)

    def _take_part(self, state: State, woken: NDArray[np.bool_], h: float) -> None:
        """Include the bodies that have just woken in the substep at hand."""
        if not woken.any():
            return
        contacts, bodies, velocity = state.contacts, state.bodies, state.table(Velocity)
        if state.has_forces:
            inverse, before = np.where(woken, bodies.inverse_mass, 0.0), state.kick_before_contacts * h
            position, sums, gravity = state.table(Transform)["position"], state.account.sums, pull_of(state)
            moved = velocity["linear"], velocity["angular"], bodies.force, bodies.torque
            yields = inverse, bodies.inverse_inertia, bodies.sub_integrated
            damping = state.physics.linear_damping, state.physics.angular_damping
            work.book_kick(
                position, bodies.force, bodies.torque, state.table(Mass)["mass"], *yields, gravity.x,
                gravity.y, state.sleep.other, before, sums,
            )  # fmt: skip
            book_sleep(state, woken, -before)  # that it was held in this kick
            if any(damping):
                work.book_damping(position, *moved, *yields, *damping, before, 0.5 * (h - before), sums)
            motion.kick(*moved, *yields, *damping, before)
        scalar = contacts.scalar[: contacts.scalar_count]
        near = contacts.manifolds[scalar]
        theirs = np.ascontiguousarray(scalar[woken[near["a"]] | woken[near["b"]]])
        # Their masses have changed; they had no impact in this step.
        awake = (bodies.awake_inverse_mass, bodies.awake_inverse_inertia)
        _find_among(state, theirs, contacts.touching, awake, h, first=True)
        contacts.active = _find_among(state, scalar, contacts.touching, awake, h, first=False)

    def count_rest(self, state: State, h: float) -> None:
        """Count at the end of a step how long bodies have rested; put islands to sleep where it is enough."""
        sleep, velocity = state.sleep, state.table(Velocity)
        if sleep.has_external_writers:
            check_edits(state, within=True)
        if islands.count_rest(
            velocity["linear"], velocity["angular"],
            state.bodies.shapes.reach, state.bodies.inverse_mass, state.bodies.sub_integrated,
            sleep.asleep, sleep.rest, sleep.slowest,
            min(h, state.simulation.dt),  # of a divided step only the end is observed
        ):  # fmt: skip
            self.put_islands_to_sleep(state, h)
        keep_places(state)

    def put_islands_to_sleep(self, state: State, h: float) -> None:
        """Put the islands to sleep that have rested long enough."""
        sleep = state.sleep
        state.contacts.sync()
        ready = (sleep.rest >= islands.READY) & ~sleep.asleep
        held = self._held(state, ready)
        if held.any():
            fall_asleep(state, held)
            self._verify(state)

    def _held(self, state: State, ready: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return which of the rows that are ready to sleep belong to an island that may."""
        contacts, velocity, held = state.contacts, state.table(Velocity), np.zeros(len(ready), np.bool_)
        impulse_dt = contacts.impulse_dt or state.simulation.dt / state.simulation.substeps
        islands.find_held(
            contacts.manifolds, contacts.points, contacts.recorded, impulse_dt, state.bodies.shapes.vertices,
            state.bodies.inverse_mass, state.bodies.force, velocity["linear"], velocity["angular"],
            state.joints.edges.ravel(), ready, held,
        )  # fmt: skip
        return held

    def _verify(self, state: State) -> NDArray[np.bool_]:
        """Find where sleeping bodies touch; wake those without support, and return which woke.

        In a file that was edited, a body may sleep in the air.
        """
        sleep, contacts, bodies = state.sleep, state.contacts, state.bodies
        sleep.unverified = False
        inactive = sleep.asleep | ~state.table(Velocity).present
        pairs = np.empty(contacts.recorded, np.int64)
        count = islands.list_sleeping(contacts.manifolds, contacts.recorded, inactive, pairs)
        h = state.simulation.dt / state.simulation.substeps
        own = (bodies.inverse_mass, bodies.inverse_inertia)
        contacts.sleeping_count = _find_among(state, pairs[:count], contacts.sleeping, own, h, first=True)
        unsupported = sleep.asleep & ~self._held(state, sleep.asleep)
        return wake(state, unsupported) if unsupported.any() else unsupported


def _find_among(
    state: State, pairs: NDArray[np.int64], touching: NDArray[np.int64], inverse: Plain[Inverse], h: float, *,
    first: bool,
) -> int:  # fmt: skip
    """Find or refresh the points of some of the pairs; return how many of them touch."""
    counts = np.zeros_like(state.contacts.counts)  # neither proximity pairs nor wide contacts
    counts[near_counts.SCALAR] = len(pairs)
    near = near_in(state)
    among = (counts, *near[1:3], pairs, touching, *near[5:])
    do_stage(state, soft.FIND, h, first=first, near=among, inverse=inverse)
    return int(counts[near_counts.ACTIVE])
