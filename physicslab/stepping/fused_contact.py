"""Runs of whole steps in one compiled call, for worlds whose bodies touch and which nobody looks at."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Material, Shape, Transform, Velocity
from physicslab.integrators.leapfrog import LEAPFROG
from physicslab.kernels.solver import contact_steps
from physicslab.kernels.solver.contact_steps import (
    BEGIN,
    BLOCKS_FULL,
    DIVERGED,
    FIND,
    IMPACTS,
    PAIRS_STALE,
    SLEEP_PENDING,
    SYSTEMS,
    WAKE_PENDING,
)
from physicslab.systems.schedule import Stage

if TYPE_CHECKING:
    from physicslab.stepping.checkpoint import Checkpoint
    from physicslab.systems.broad_phase import BroadPhaseSystem
    from physicslab.systems.contact import ContactSystem
    from physicslab.systems.resolve import ResolveSystem
    from physicslab.systems.sleep import SleepSystem
    from physicslab.world import World

__all__ = ["COMPILED", "OF_FRAMES", "CompiledSteps", "why_not_compiled"]

COMPILED = {
    "Bodies": "physicslab.state.bodies",
    "GravitySystem": "physicslab.systems.gravity",
    "IntegrateSystem": "physicslab.systems.integrate",
    "BroadPhaseSystem": "physicslab.systems.broad_phase",
    "ContactSystem": "physicslab.systems.contact",
    "SleepSystem": "physicslab.systems.sleep",
    "ResolveSystem": "physicslab.systems.resolve",
}
"""Whose work the loop does, and in which modules those are: a class of that name may be somebody's own."""
_NEEDED = ("Bodies", "IntegrateSystem", "BroadPhaseSystem", "ContactSystem", "ResolveSystem")
OF_FRAMES = {Stage.INPUT, Stage.RENDER, Stage.HUD}
"""The stages that belong to frames, and not to steps."""
_MOST = 4096
"""So many steps, at the most, are one call: whoever wants to stop a run waits for it."""
_PLAN = [stage for stage, _ in LEAPFROG.substep]


def why_not_compiled(world: World) -> str | None:
    """Return why steps of this world cannot be made in a compiled loop, or ``None``."""
    running = {system.name: system for system in world.schedule.running}
    for name in _NEEDED:
        if name not in running:
            return f"{name} is not among the systems"
    if world.method.collisions != "step":
        return "collisions are not found within steps"
    if world.method.stages is not LEAPFROG or world.split_forces is not None:
        return f"bodies are not moved by {LEAPFROG.name} alone"
    if world.physics.gravity_mode == "planet" and "GravitySystem" in running:
        return "planets attract each other"
    for name, system in running.items():
        if type(system).__module__ != COMPILED.get(name) and not set(type(system).marked()) <= OF_FRAMES:
            return f"{name} acts or looks at every step"
    return None


class CompiledSteps:
    """Makes steps of one world in a compiled loop, until its structure changes; the bits are those of steps.

    The loop comes back where Python is needed: to list the near pairs anew, to make the first blocks or room
    for more, to wake who is touched, to let fall asleep who has rested, to report a divergence.

    Parameters
    ----------
    world : World
        One of which :func:`why_not_compiled` says nothing.
    """

    kernels = (contact_steps.advance,)

    def __init__(self, world: World) -> None:
        running = {system.name: system for system in world.schedule.running}
        self._broad_phase = cast("BroadPhaseSystem", running["BroadPhaseSystem"])
        self._contact = cast("ContactSystem", running["ContactSystem"])
        self._resolve = cast("ResolveSystem", running["ResolveSystem"])
        self._sleep = cast("SleepSystem | None", running.get("SleepSystem"))
        self._cost = np.zeros(len(SYSTEMS), np.int64)
        self._calls: list[tuple[int, str, int, int]] = []
        for place, name in enumerate(SYSTEMS):
            if name in running:
                marked = type(running[name]).marked()
                once = len({Stage.PREPARE, Stage.FINISH} & marked.keys())
                self._calls.append((place, name, once, sum(stage in marked for stage in _PLAN)))
        transform, velocity = world.table(Transform), world.table(Velocity)
        shape, material = world.table(Shape), world.table(Material)
        self._columns = (
            (transform["position"], transform["angle"], velocity["linear"], velocity["angular"]),
            (shape["kind"], shape["radius"], shape["width"], shape["height"]),
            (material["restitution"], material["friction"]),
        )

    def ready(self, world: World) -> bool:
        """Whether the coming step can be made so, as things stand."""
        contacts = world.contacts
        heavy = world.bodies.unequal and world.has_forces
        if heavy or contacts.stale:
            return False
        return not (world.sleep.unverified or world.sleep.all_asleep(world))

    def run(self, world: World, steps: int, before: Checkpoint) -> int:
        """Make ``steps`` steps or fewer, at least one, and return how many; the clock goes with them.

        ``before`` keeps the state in which the last of them began.

        Raises
        ------
        Diverged
            If a value is not finite; all steps before that one are made and counted.
        """
        h = world.simulation.dt / world.simulation.substeps
        contacts = world.contacts
        contacts.in_order(len(world.entity_index))
        contacts.refill(world)
        self._contact.begin(world, h)
        made, substep, stage, steps = 0, 0, BEGIN, min(steps, _MOST)
        while made < steps:
            why, done, substep = self._advance(world, before, steps - made, substep, stage, h)
            made += done
            if why == DIVERGED:
                world.bodies.check_finite(world, world.simulation.dt)
            elif why == PAIRS_STALE:
                self._timed("BroadPhaseSystem", self._broad_phase.search, world, h)
                stage = FIND
            elif why == BLOCKS_FULL:
                self._contact.begin(world, h)  # another step than the one before may have begun
                self._timed("ContactSystem", self._contact.add_constraints, world, h)
                self._wake_touched_islands(world, h)
                stage = IMPACTS
            elif why == WAKE_PENDING:
                self._wake_touched_islands(world, h)
                stage = IMPACTS
            elif why == SLEEP_PENDING and self._sleep is not None:
                self._timed("SleepSystem", self._sleep.put_islands_to_sleep, world, world.simulation.dt)
                stage = BEGIN
                if world.sleep.all_asleep(world):
                    break
        world.sleep.keep(world)
        return made

    def _wake_touched_islands(self, world: World, h: float) -> None:
        """Wake whom something touches."""
        if self._sleep is not None:
            self._timed("SleepSystem", self._sleep.wake_touched_islands, world, h)

    def _advance(
        self, world: World, before: Checkpoint, steps: int, substep: int, stage: int, h: float
    ) -> tuple[int, int, int]:
        """Let the loop go as far as it gets; return why it came back, after how many steps, and where."""
        began = time.perf_counter_ns()
        contacts, substeps = world.contacts, world.simulation.substeps
        self._cost[:] = 0
        counts = contacts.counted()
        why, done, substep, struck_before, impact_count, contacts.impulse_dt = contact_steps.advance(
            steps, substeps, substep, stage, h, *self._numbers(world, before, h, counts)
        )
        contacts.recount(counts)
        contacts.changed()
        world.steps += done
        world.time += done * world.simulation.dt
        world.collisions += struck_before
        if done:
            world.force_evaluations += done * substeps * world.has_forces
            before.count(world)
        world.collisions += impact_count - struck_before
        self._note(world, done, time.perf_counter_ns() - began)
        return why, done, substep

    def _numbers(
        self, world: World, before: Checkpoint, h: float, counts: NDArray[np.int64]
    ) -> tuple[Any, ...]:
        """Return what the loop works on."""
        (state, sizes, materials), bodies = self._columns, world.bodies
        contacts, physics, resolve, sleep = world.contacts, world.physics, self._resolve, world.sleep
        return (
            world.simulation.iterations or 1,
            state, before.columns, sizes, materials,
            (bodies.awake_inverse_mass, bodies.awake_inverse_inertia), bodies.sub_integrated,
            (bodies.force, bodies.torque, world.table(Mass)["mass"], world.has_forces, *physics.gravity),
            (
                self._sleep is not None, sleep.count, world.simulation.dt, bodies.inverse_mass,
                sleep.asleep, sleep.rest, sleep.slowest, np.zeros_like(sleep.asleep),
                contacts.inactive, contacts.sleeping,
            ),
            (physics.linear_damping, physics.angular_damping), self._contact.speculative_margin(world, h),
            self._broad_phase.fat,
            (self._broad_phase.bounds, physics.bounds_restitution, physics.bounds_friction),
            (contacts.proximity, contacts.activation_distance, world.entity_index.entities),
            (contacts.manifolds, contacts.points, contacts.scalar, contacts.touching),
            counts, contacts.wide.discs.slots, contacts.wide.boxes.slots, contacts.opened,
            (resolve.hertz, resolve.damping_ratio, resolve.slop, resolve.max_push), contacts.impulse_dt,
            self._cost,
        )  # fmt: skip

    def _note(self, world: World, steps: int, nanoseconds: int) -> None:
        """Note as many calls as stepping would make; the time is shared out by the loop's own clock."""
        costs: list[int] = self._cost.tolist()
        whole = max(1, sum(costs))
        for place, name, once, within in self._calls:
            calls = once + world.simulation.substeps * within
            world.schedule.note(name, steps * calls, nanoseconds * costs[place] // whole)

    def _timed(self, name: str, call: Callable[[World, float], None], world: World, h: float) -> None:
        """Call a system's method, whose call is counted with the step, and note what it cost."""
        began = time.perf_counter_ns()
        call(world, h)
        world.schedule.note(name, 0, time.perf_counter_ns() - began)
