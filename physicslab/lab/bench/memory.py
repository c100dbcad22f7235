"""How much memory a body takes."""

from __future__ import annotations

import gc
import tracemalloc
from dataclasses import dataclass

from physicslab.lab.bench.catalogue import discs
from physicslab.world import World

__all__ = ["Memory", "measure_memory"]

_SIZES = (1_000, 4_000)
_STEPS = 120
"""So long that discs lie on each other: contacts take memory too."""


@dataclass(frozen=True, slots=True)
class Memory:
    """What one more disc of a pile takes, of all that Python and numpy hold.

    Attributes
    ----------
    columns : float
        The numbers of its components [bytes].
    spawned : float
        All of it when it has been spawned: numbers, handles, and what esper knows of it [bytes].
    with_contacts : float
        The same in a pile: near pairs, contacts and what the solver works with [bytes].
    """

    columns: float
    spawned: float
    with_contacts: float


def measure_memory(sizes: tuple[int, int] = _SIZES, steps: int = _STEPS) -> Memory:
    """Return what a body takes: the difference of two piles, so that what every world has does not count."""
    _held(min(sizes[0], 100), 2)  # what is made once is made now
    (few, small), (many, large) = ((size, _held(size, steps)) for size in sizes)
    return Memory(*((high - low) / (many - few) for low, high in zip(small, large, strict=True)))


def _held(count: int, steps: int) -> tuple[int, int, int]:
    """Return the bytes of a pile's columns, of the whole pile at the start, and of the whole later."""
    gc.collect()
    tracemalloc.start()
    try:
        world = discs(count)
        world.synchronise()
        gc.collect()
        spawned, _ = tracemalloc.get_traced_memory()
        world.run(steps=steps)
        gc.collect()
        later, _ = tracemalloc.get_traced_memory()
        return _columns(world), spawned, later
    finally:
        tracemalloc.stop()


def _columns(world: World) -> int:
    """Return the bytes of the rows in use."""
    return sum(
        table[spec.name].nbytes
        for table in world.entity_index.tables.values()
        for spec in table.component.FIELDS
    )
