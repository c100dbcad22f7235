"""Which worlds are so small that kernels can be interpreted for them, until they are compiled."""

import weakref
from collections.abc import Callable
from itertools import islice

import esper

from physicslab.state.state import State

_ENTITY_LIMIT = 40
"""So many entities a small world has at most: forty boxes in a heap take 30 ms a step, ten bodies on ten
springs 16, alone on a core. Where bodies attract each other each counts twice: twenty take 26 ms, forty
300."""


def smallness_of(state: State) -> Callable[[], bool]:
    """Return what tells that of a world by the time it is called, and does not keep the world."""
    kept = weakref.ref(state)
    return lambda: (there := kept()) is None or is_small(there)


def is_small(state: State) -> bool:
    """Whether a step of a world takes tens of milliseconds at most where kernels are interpreted."""
    most = _ENTITY_LIMIT // (2 if state.physics.gravity_mode == "planet" else 1)
    with state.active():  # each run counts, so no further than it needs
        return len([*islice(esper.get_entities(), most + 1)]) <= most
