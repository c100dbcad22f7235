"""Figures of quality, measured beside the times: an engine that is fast and wrong does not count."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.diagnostics.energy import measure_energy
from physicslab.lab.peers.peer import find_contacts
from physicslab.world import World

__all__ = ["Quality", "Start", "energy_change", "overlap", "sideways", "sink"]


@dataclass(frozen=True, slots=True)
class Start:
    """A world as it was at the start.

    Attributes
    ----------
    positions : float64 array (rows, 2)
        Where its bodies were [m].
    energy : float
        Their energy [J].
    """

    positions: NDArray[np.float64]
    energy: float

    @classmethod
    def of(cls, world: World) -> Start:
        """Note how a world is now."""
        world.synchronise()
        return cls(world.table(Transform)["position"].copy(), measure_energy(world).total)


@dataclass(frozen=True, slots=True)
class Quality:
    """A figure of how well a scene was simulated; less is better.

    Attributes
    ----------
    name, unit : str
        What it is, and its SI unit; no unit for a share.
    limit : float
        The largest that counts as right.
    measure : callable
        Takes the world as it is now, and as it was at the start.
    """

    name: str
    unit: str
    limit: float
    measure: Callable[[World, Start], float]


def _moved(world: World, start: Start) -> NDArray[np.float64]:
    moved: NDArray[np.float64] = world.table(Transform)["position"] - start.positions
    return moved


def _sideways(world: World, start: Start) -> float:
    return float(np.abs(_moved(world, start)[:, 0]).max())


def _sink(world: World, start: Start) -> float:
    return float(max(0.0, -_moved(world, start)[:, 1].min()))


def _overlap(world: World, start: Start) -> float:
    find_contacts(world)  # the same measure for every engine
    return max(0.0, world.contacts.max_penetration)


def _energy(world: World, start: Start) -> float:
    return abs(measure_energy(world).total / start.energy - 1.0)


def sideways(limit: float) -> Quality:
    """Return the largest displacement of a body sideways [m], as a quality."""
    return Quality("sideways drift", "m", limit, _sideways)


def sink(limit: float) -> Quality:
    """Return the largest displacement of a body downwards [m], as a quality."""
    return Quality("sink", "m", limit, _sink)


def overlap(limit: float) -> Quality:
    """Return the deepest overlap of two bodies [m], as a quality."""
    return Quality("deepest overlap", "m", limit, _overlap)


def energy_change(limit: float) -> Quality:
    """Return the change of the energy since the start, as a share of it, as a quality."""
    return Quality("energy change", "", limit, _energy)
