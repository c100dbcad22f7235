"""Impacts, read from a world's log once a frame."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.state.state import State


class ImpactReader:
    """Reads each impact of a world once.

    The log of a world (``Contacts.log``) holds the last impacts, and ``Contacts.logged`` is how many there
    were: what has a higher number than at the last call is new, however many steps were made meanwhile.
    """

    def __init__(self) -> None:
        self._state: State | None = None
        self._read = 0

    def follow(self, state: State) -> None:
        """Begin with the next impact of ``state``, unless it is the world that is read already."""
        if state is not self._state:
            self._state, self._read = state, state.contacts.logged
            state.contacts.read = True

    def new(self, state: State) -> NDArray[Any]:
        """Return the impacts since the last call, oldest first: an array of IMPACT (n,).

        Of more than the log holds, the oldest are missing.
        """
        self.follow(state)
        contacts = state.contacts
        first = max(min(self._read, contacts.logged), contacts.logged - len(contacts.log))
        self._read = contacts.logged
        new: NDArray[Any] = contacts.log[np.arange(first, contacts.logged) % len(contacts.log)]
        return new
