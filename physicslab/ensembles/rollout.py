"""Many starts of one scene by one stepper: between two runs nothing is chosen, booked or gone back to.

Most of the time of a short run is choosing systems, keeping accounts and going back in the world. A stepper
that makes a whole run in one call (:class:`physicslab.stepping.stepper.Repeatable`) is given here the places,
velocities, materials and masses of one row after the other, and where bodies are at the end is read.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity
from physicslab.contacts.arguments import motion_of
from physicslab.diagnostics.impact_table import first_and_last
from physicslab.ensembles.space import Values
from physicslab.files.places import Place
from physicslab.kernels.records import IMPACT
from physicslab.state.masses import derive_masses, quiet
from physicslab.stepping.event_driven import EventDriven
from physicslab.stepping.flow import Flow
from physicslab.stepping.run import RunLength
from physicslab.stepping.stepper import Repeatable, Stretch
from physicslab.systems.system import AROUND
from physicslab.world import World

MOTION: Mapping[str, tuple[type[Any], str, str]] = {
    "x": (Transform, "position", "x"), "y": (Transform, "position", "y"), "angle": (Transform, "angle", ""),
    "vx": (Velocity, "linear", "x"), "vy": (Velocity, "linear", "y"), "omega": (Velocity, "angular", ""),
}  # fmt: skip
"""Quantities that can be read at the end of a run: the column, and the part of a vector."""
_ANY_TIME = {(kind.__name__, field) for kind, field, _ in MOTION.values()}
"""Fields of which a stepper keeps nothing."""
_BETWEEN_IMPACTS = _ANY_TIME | {("Material", "restitution"), ("Material", "friction"), ("Mass", "mass")}
"""Those of which one that goes from impact to impact keeps nothing."""


class Rollout:
    """Makes runs with the bits of single ones, where the world's best stepper makes each in one call.

    Parameters
    ----------
    world : World
        The world that rows have in common; it is one island at all times.
    places : mapping of str to Place
        In what they differ, by column.
    read : sequence of tuple of int and str
        Readings at the end: an entity that moves, and a name of ``MOTION``; or the number of collisions.
    chooses_the_same : callable
        Tells whether the world, as it is then, is stepped by the systems and the method that it has.
    of_impacts : bool
        Whether the first and the last impact are read too.
    """

    def __init__(
        self, world: World, places: Mapping[str, Place], read: Sequence[tuple[int, str]],
        chooses_the_same: Callable[[], bool], of_impacts: bool,
    ) -> None:  # fmt: skip
        self._world, self._places, self._read, self._of_impacts = world, places, read, of_impacts
        self._chooses_the_same = chooses_the_same
        self._fields = {(place.kind.__name__, place.spec.name) for place in places.values()}

    @quiet
    def run(
        self, columns: Mapping[str, Values], length: RunLength
    ) -> tuple[NDArray[np.float64], NDArray[Any], NDArray[np.bool_]]:
        """Make those of the runs that can be made so, from where :meth:`World.reset` leads.

        Parameters
        ----------
        columns : mapping of str to array (n,)
            The values of the fields in each row [SI].
        length : RunLength
            How long each run is.

        Returns
        -------
        ends : float64 array (n, quantities)
            The readings at the end of each [SI].
        impacts : array of IMPACT (n, 2)
            The first and the last impact of each, where they are read.
        made : bool array (n,)
            Which runs were made.
        """
        given = np.array([columns[name] for name in self._places], np.float64)
        ends, made = np.full((given.shape[1], len(self._read)), np.nan), self._allowed(given)
        impacts, world = np.zeros((len(made), 2), IMPACT), self._world
        world.reset()
        world.synchronise()
        stepper = world.stepper_for(length.dt)
        if not made.any() or not isinstance(stepper, Repeatable) or not self._repeats(stepper, length):
            made[:] = False
            return ends, impacts, made
        world.compile(stepper.kernels)
        world.steppers.use(stepper)
        start, collisions, logged = world.time, world.collisions, world.contacts.logged
        with world.active():
            self._run_each(stepper, _stretches(stepper, length, start), given.T.tolist(), ends, impacts, made)
        world.time, world.collisions, world.contacts.logged = start, collisions, logged
        return ends, impacts, made

    def _repeats(self, stepper: Repeatable, length: RunLength) -> bool:
        """Whether runs of a length are calls of this stepper, from the moment at which the world is."""
        schedule = self._world.schedule
        fields = _BETWEEN_IMPACTS if isinstance(stepper, EventDriven) else _ANY_TIME
        watched = any(not system.sampled for stage in AROUND for system in schedule.at(stage))
        watched |= self._world.joints.breakable
        return bool(
            length.steps and self._fields <= fields and not watched and not len(self._world.remainders.keys)
        )

    def _allowed(self, given: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return which rows have values (fields, rows) that their fields can have."""
        allowed = np.ones(given.shape[1], np.bool_)
        for place, values in zip(self._places.values(), given, strict=True):
            highest = place.spec.highest
            lowest = -highest if place.part else place.spec.lowest
            allowed &= (values >= lowest) & (values <= highest)
        return allowed

    def _run_each(
        self, stepper: Repeatable, stretches: Sequence[Stretch], given: list[list[float]],
        ends: NDArray[np.float64], impacts: NDArray[Any], made: NDArray[np.bool_],
    ) -> None:  # fmt: skip
        """Make the runs of rows that are allowed, and note which could not be made."""
        world, run = self._world, stepper.repeatable(self._world, stretches)
        motion = motion_of(world)
        start = [column.copy() for column in motion]
        row_of = world.entity_index.row_of
        written = [
            (world.table(place.kind)[place.spec.name], _index(row_of[place.entity], place.part))
            for place in self._places.values()
        ]
        read: list[tuple[NDArray[Any], Any]] = []
        counted, logged = np.zeros(1), world.contacts.logged
        for entity, name in self._read:
            if name not in MOTION:
                read.append((counted, 0))
                continue
            kind, field, part = MOTION[name]
            read.append((world.table(kind)[field], _index(row_of[entity], part)))
        weighs = ("Mass", "mass") in self._fields
        for row in np.flatnonzero(made).tolist():
            for column, then in zip(motion, start, strict=True):
                column[:] = then
            for (column, index), value in zip(written, given[row], strict=True):
                column[index] = value
            world.generation += 1
            if weighs:
                derive_masses(world)
            made[row] = self._chooses_the_same() and stepper.holds(world) and run()
            if made[row]:
                counted[0] = world.collisions
                if self._of_impacts:
                    impacts[row] = first_and_last(world, logged)
                ends[row] = [column[index] for column, index in read]


def _index(row: int, part: str) -> int | tuple[int, int]:
    return (row, "xy".index(part)) if part else row


def _stretches(stepper: Repeatable, length: RunLength, start: float) -> list[Stretch]:
    """Return the calls of a stepper that make a run, which begins at a time [s]."""
    if isinstance(stepper, Flow) and stepper.whole:
        return [(start, length.seconds, 1)]
    rest = [(start + length.elapsed(length.whole), length.rest, 1)] if length.rest else []
    whole = [(start, length.dt, length.whole)] if length.whole else []
    return whole + rest
