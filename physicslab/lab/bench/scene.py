"""The record of a scene of the benchmark, and figures of quality: speed without them does not count."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity
from physicslab.diagnostics.energy import measure_energy
from physicslab.ecs.vector import Vector2
from physicslab.lab.case import Case
from physicslab.lab.peers.peer import find_contacts
from physicslab.state.joint_figures import figures_of
from physicslab.world import World

type When = Literal["settled", "throughout", "end"]
"""Before the steps that are timed; the largest of all looks, from the start on; after those steps."""
type Places = NDArray[np.float64]
"""Positions of bodies (n, 2) [m]."""
type Inside = Callable[[Places], NDArray[np.bool_]]
"""Returns which positions are where bodies may be (n,)."""


@dataclass(slots=True)
class Moment:
    """A world as it was, and its energy in the looks since then.

    Attributes
    ----------
    positions : float64 array (rows, 2)
        Where its bodies were [m].
    energy : float
        Their energy [J].
    least, gained, kinetic : float
        The least energy since then, the most that any later one was above it, and the largest kinetic
        energy [J].
    """

    positions: Places
    energy: float
    least: float
    gained: float = 0.0
    kinetic: float = 0.0

    @classmethod
    def of(cls, world: World) -> Moment:
        """Note how a world is now."""
        world.synchronise()
        energy = measure_energy(world).total
        return cls(world.table(Transform)["position"].copy(), energy, energy)

    def follow(self, world: World) -> None:
        """Take the energy of the world into account as it is now."""
        now = measure_energy(world)
        self.least, self.kinetic = min(self.least, now.total), max(self.kinetic, now.kinetic)
        self.gained = max(self.gained, now.total - self.least)


@dataclass(frozen=True, slots=True)
class Quality:
    """A figure of how well a scene was simulated; less is better.

    Attributes
    ----------
    name, unit : str
        Its name, and its SI unit; no unit for a share or a number.
    limit : float
        The largest that counts as right.
    measure : callable
        Takes the world as it is now, and as it was: at the end since the steps that are timed began, else
        since the start.
    when : str
        When it is measured.
    """

    name: str
    unit: str
    limit: float
    measure: Callable[[World, Moment], float]
    when: When = "settled"


def _moved(world: World, before: Moment) -> Places:
    moved: Places = world.table(Transform)["position"] - before.positions
    return moved


def _sideways(world: World, before: Moment) -> float:
    return float(np.abs(_moved(world, before)[:, 0]).max())


def _sink(world: World, before: Moment) -> float:
    return float(max(0.0, -_moved(world, before)[:, 1].min()))


def _overlap(world: World, before: Moment) -> float:
    find_contacts(world)  # the same measure for every engine
    return max(0.0, world.contacts.max_penetration)


def _stretch(world: World, before: Moment) -> float:
    world.synchronise()
    return float(figures_of(world).stretch.max()) if world.joints.joints else 0.0


def _energy(world: World, before: Moment) -> float:
    return abs(measure_energy(world).total / before.energy - 1.0)


def _energy_gained(world: World, before: Moment) -> float:
    # A scene that rests by the first look has moved before, and lost that.
    most = max(before.kinetic, before.energy - before.least)
    return before.gained / most if before.gained > 0.0 else 0.0


def _kinetic_energy(world: World, before: Moment) -> float:
    return measure_energy(world).kinetic


def _creep(world: World, before: Moment) -> float:
    moving = world.batch(Transform, Velocity).rows
    return float(np.sqrt((_moved(world, before)[moving] ** 2).sum(axis=1).mean()))


sideways = partial(Quality, "sideways drift", "m", measure=_sideways)
"""Returns the largest displacement of a body sideways as a quality, with its limit [m]."""
sink = partial(Quality, "sink", "m", measure=_sink)
"""Returns the largest displacement of a body downwards as a quality, with its limit [m]."""
overlap = partial(Quality, "deepest overlap", "m", measure=_overlap)
"""Returns the deepest overlap of two bodies as a quality, with its limit [m]."""
largest_overlap = partial(Quality, "largest overlap", "m", measure=_overlap, when="throughout")
"""Returns the deepest overlap that was seen while bodies moved as a quality, with its limit [m]."""
stretched = partial(Quality, "joint off", "m", measure=_stretch, when="throughout")
"""Returns the largest error of a joint that was seen as a quality, with its limit [m]."""
energy_change = partial(Quality, "energy change", "", measure=_energy)
"""Returns the change of the energy since the start as a quality, with its limit, as a share of it."""

energy_gained = partial(Quality, "energy gained", "", measure=_energy_gained, when="end")
"""Returns by how much the energy rose where it can only fall as a quality, with its limit, as a share of the
largest kinetic energy or of what was lost, if that is more."""


def at_rest(energy: float, drift: float) -> tuple[Quality, Quality]:
    """Return what still moves in a scene that should be at rest, as qualities.

    They are the kinetic energy [J] at the end, and how far bodies went while they were timed [m, rms].
    """
    return (
        Quality("kinetic energy at rest", "J", energy, _kinetic_energy, "end"),
        Quality("drift at rest", "m", drift, _creep, "end"),
    )


def within(half: float, *, floor: float = 0.0, top: float = math.inf) -> Inside:
    """Return which places are less than ``half`` from the middle, above a floor and below a top [m]."""

    def inside(places: Places) -> NDArray[np.bool_]:
        found: NDArray[np.bool_] = (
            (np.abs(places[:, 0]) < half) & (places[:, 1] > floor) & (places[:, 1] < top)
        )
        return found

    return inside


def lost(inside: Inside) -> Quality:
    """Return how many bodies are where they can only be by having passed through others, as a quality.

    Parameters
    ----------
    inside : callable
        Takes positions of bodies, and returns which of them are where they may be.
    """

    def count(world: World, before: Moment) -> float:
        places = world.table(Transform)["position"][world.batch(Transform, Velocity).rows]
        return float(np.count_nonzero(~inside(places)))

    return Quality("lost bodies", "", 0.0, count, "end")


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchScene(Case):
    """A scene that is timed.

    Attributes
    ----------
    size : int
        How many bodies move.
    build : callable
        Returns its world, at the start.
    seconds : float
        How long it runs before the timing [s]; quality is measured then.
    steps : int
        How many steps are timed after that.
    quality : tuple of Quality
        Measures beside the times.
    compiled_runs : bool
        Whether many steps are taken in one call, as headless runs do, and not one by one.
    in_window : bool
        Whether it is stepped with the systems of a window installed.
    gravity_at : callable, optional
        Returns gravity [m/s^2] at a time [s]; it is set before every step.
    edit : callable, optional
        Takes the world and the number of the step; it is called before every step, as part of what is timed.
        Other engines do not run such a scene.
    by_default : bool
        Whether the scene is run where none is named.
    """

    size: int
    build: Callable[[], World]
    seconds: float = 10.0
    steps: int = 300
    quality: tuple[Quality, ...] = ()
    compiled_runs: bool = False
    in_window: bool = False
    gravity_at: Callable[[float], Vector2] | None = None
    edit: Callable[[World, int], None] | None = None
    by_default: bool = True
