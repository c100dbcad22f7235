"""Which bodies sleep, how long the others have rested, and how the sleeping ones were left: arrays."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels.accounts import GRAVITY
from physicslab.kernels.sleep import edits, islands


class Sleep:
    """The sleeping bodies of one world.

    Such a body has no velocity, and an infinite mass in the simulation (``bodies.awake_inverse_mass``); its
    contacts stay in their records. :class:`physicslab.systems.sleep.SleepSystem` puts islands to sleep and
    wakes what is touched or pushed; what an edit affects is found before every step
    (:func:`physicslab.contacts.islands.check_edits`).

    Attributes
    ----------
    asleep : bool array (rows,)
        Which bodies sleep.
    count : int
        How many do.
    rest, slowest : float64 arrays (rows,)
        How long [s] each of the others has been slow, and its lowest speed [m/s] in that time.
    forces : float64 array (rows, 3)
        Forces [N] and torque [N m] on each sleeping body; NaN where they are not known yet.
    other : int
        The cause by which those are booked that are not uniform gravity.
    on : bool
        Whether bodies of this world may sleep.
    unverified : bool
        Whether sleeping bodies came from a file, so that their support must still be checked.
    acted_upon : bool
        Whether a system that is not the engine's acts within a substep.
    has_external_writers : bool
        Whether such a system acts anywhere in a step, and so may change anything.
    kept : float64 array (rows, FIGURES)
        The state when it was last checked; an edit is a difference from it.
    known : bool array (rows,)
        The rows that ``kept`` describes.
    entities : int64 array (rows,)
        The entities of the rows.
    gone : int64 array (n,)
        The entities removed since the last check, while any sleep.
    laws : tuple, optional
        The configuration under which bodies fell asleep.
    """

    kernels = (
        islands.join_marked, islands.list_sleeping, edits.note_figures, edits.find_edited,
        edits.find_overlapped,
    )  # fmt: skip

    def __init__(self) -> None:
        self.on = self.unverified = self.acted_upon = self.has_external_writers = False
        self.count = 0
        self.asleep: NDArray[np.bool_] = np.zeros(1, np.bool_)
        self.rest, self.slowest = np.zeros(1), np.zeros(1)
        self.forces: NDArray[np.float64] = np.zeros((1, 3))
        self.other = GRAVITY
        self.kept: NDArray[np.float64] = np.zeros((1, edits.FIGURES))
        self.known: NDArray[np.bool_] = np.zeros(1, np.bool_)
        self.entities: NDArray[np.int64] = np.zeros(1, np.int64)
        self.gone: NDArray[np.int64] = np.zeros(0, np.int64)
        self.laws: tuple[Any, Any] | None = None
        self._followed = self.entities

    def follow(self, entities: NDArray[np.int64]) -> bool:
        """Move the values of ``entities`` (rows,) where rows have new numbers; return whether they have."""
        if entities is self._followed:
            return False
        self._followed = entities
        entities, before = entities.copy(), self.entities  # the index blanks rows in place
        row = np.full(max(int(entities.max()), int(before.max())) + 1, -1)
        row[before] = np.arange(len(before))
        row[0] = -1
        old = row[entities]
        self.known = old >= 0
        for name in ("asleep", "rest", "slowest", "forces", "kept"):
            column = getattr(self, name)
            moved = np.zeros((len(entities), *column.shape[1:]), column.dtype)
            moved[self.known] = column[old[self.known]]
            setattr(self, name, moved)
        self.entities = entities
        self.count = int(np.count_nonzero(self.asleep))
        self.gone = np.union1d(self.gone, np.setdiff1d(before, entities)) if self.count else before[:0]
        return True
