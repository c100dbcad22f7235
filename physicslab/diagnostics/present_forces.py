"""Forces of joints and contacts in a state that no step has led to, as a scene's before its first step.

Only a step solves for them: one of a copy tells what they are, by the law that tells it after all others.
"""

from contextlib import suppress
from weakref import WeakKeyDictionary

from physicslab.state.masses import Diverged
from physicslab.state.samples import motion_of_rows, moving_rows, put_motion
from physicslab.stepping.keyframe import Keyframe
from physicslab.systems.system import System
from physicslab.world import World

_SHORT = 1e-4
"""Length of the step that finds them, in steps of the scene: nothing has moved by what can be seen. It is not
shorter, as places are known to rounding only: contacts at rest would be apart by more than they close. Where
contacts are soft it is a whole step, as their law has its length in it: they take what is left of a velocity,
and close what is left of a gap, within it. Bodies are then put back to where they were."""

_found: WeakKeyDictionary[World, "_Stepped"] = WeakKeyDictionary()
"""The last result for each world."""


class _Stepped:
    """A copy of a world that has made a step; it is filled again where the world has changed."""

    __slots__ = ("_copy", "_state", "_systems", "world")

    def __init__(self) -> None:
        self._state, self._systems = b"", list[System]()
        self._copy: World | None = None
        self.world: World | None = None

    def follow(self, world: World) -> None:
        """Make the step from the present state, unless that was done; no world is left if it fails."""
        state = _bits(world)
        if state == self._state:
            return
        self._state, self.world = state, None
        systems = [system for system in world.schedule.systems[1:] if system.acts_within_step()]
        with world.active(), suppress(Diverged, TypeError):  # a system's __init__ may need to be told more
            if self._copy is None or systems != self._systems:
                self._systems, self._copy = systems, World(systems=[system.fresh() for system in systems])
            now, self._copy = self._copy, None  # one that fails is not used again
            Keyframe(world).fill(now)
            is_soft = any((plan.collisions, plan.contacts) == ("step", "soft") for plan in world.plans)
            now.step((1.0 if is_soft else _SHORT) * world.simulation.dt)
            rows = moving_rows(world)
            there = now.entity_index.rows_of(world.entity_index.entities[rows])
            put_motion(now, there, motion_of_rows(world, rows))
            now.time = world.time
            self._copy = self.world = now


def with_present_forces(world: World) -> World:
    """Return a world whose joints and contacts have the forces of the present state, for reading only.

    It is the world itself where a step has led to that state. If not, it is a copy that has made a step and
    has the present motion: entities have the same numbers there, and maybe other rows. Systems that do not
    act within a step have no part in it. Where it cannot be made it is the world itself (``forces_known``
    tells), and its next step says why.
    """
    world.synchronise()
    if world.forces_known or not (world.joints.joints or world.plan.collisions != "none"):
        return world
    found = _found.setdefault(world, _Stepped())
    found.follow(world)
    return found.world or world


def _bits(world: World) -> bytes:
    """Return all numbers of a world, its laws and the count of its changes."""
    told = world.physics, world.simulation, world.time, world.entity_index.changes
    return b"".join((repr(told).encode(), *world.entity_index.blocks()))
