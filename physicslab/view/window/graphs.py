"""What is plotted against time: quantities of the world and of bodies, recorded while they are shown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy, measure_momentum
from physicslab.world import World

__all__ = ["BODY_QUANTITIES", "WORLD_QUANTITIES", "Graph", "Quantity", "Series"]

_CAPACITY = 36_000
"""Samples that a line keeps: ten minutes at 60 a second; then every other one is dropped."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """Something that can be plotted.

    Attributes
    ----------
    name, unit : str
        What it is called, and its SI unit.
    read : callable
        Returns its value in a world; of a body, whose entity is given. Of the world, the entity is ignored.
    """

    name: str
    unit: str
    read: Callable[[World, int], float]


WORLD_QUANTITIES = (
    Quantity("kinetic energy", "J", lambda world, _: measure_energy(world).kinetic),
    Quantity("potential energy", "J", lambda world, _: sum(measure_energy(world).potential.values())),
    Quantity("total energy", "J", lambda world, _: measure_energy(world).total),
    Quantity("momentum x", "kg m/s", lambda world, _: measure_momentum(world).linear.x),
    Quantity("momentum y", "kg m/s", lambda world, _: measure_momentum(world).linear.y),
    Quantity("angular momentum", "kg m²/s", lambda world, _: measure_momentum(world).angular),
)
BODY_QUANTITIES = (
    Quantity("x", "m", lambda world, body: world.component(body, Transform).position.x),
    Quantity("y", "m", lambda world, body: world.component(body, Transform).position.y),
    Quantity("angle", "rad", lambda world, body: world.component(body, Transform).angle),
    Quantity("velocity x", "m/s", lambda world, body: world.component(body, Velocity).linear.x),
    Quantity("velocity y", "m/s", lambda world, body: world.component(body, Velocity).linear.y),
    Quantity("speed", "m/s", lambda world, body: world.component(body, Velocity).linear.magnitude),
    Quantity("turning", "rad/s", lambda world, body: world.component(body, Velocity).angular),
    Quantity("kinetic energy", "J", lambda world, body: _kinetic(world, body)),
)


def _kinetic(world: World, body: int) -> float:
    velocity, mass = world.component(body, Velocity), world.component(body, Mass)
    inverse = float(world.bodies.inverse_inertia[world.entity_index.row_of[body]])
    spin = 0.5 * velocity.angular**2 / inverse if inverse > 0.0 else 0.0
    return 0.5 * mass.mass * velocity.linear.magnitude**2 + spin


class Series:
    """A quantity at times that rise; the oldest half is thinned where there are too many samples."""

    def __init__(self) -> None:
        self._samples = np.zeros((2, 256))
        self._count = 0

    @property
    def times(self) -> NDArray[np.float64]:
        """When it was read [s]."""
        return self._samples[0, : self._count]

    @property
    def values(self) -> NDArray[np.float64]:
        """What it was, in the quantity's unit."""
        return self._samples[1, : self._count]

    def add(self, time: float, value: float) -> None:
        """Take in a sample; what came later than ``time`` is forgotten, and what is no number left out."""
        while self._count and self._samples[0, self._count - 1] >= time:
            self._count -= 1
        if not np.isfinite(value):
            return
        if self._count == _CAPACITY:
            kept = np.concatenate(
                (self._samples[:, : _CAPACITY // 2 : 2], self._samples[:, _CAPACITY // 2 :]), axis=1
            )
            self._count = kept.shape[1]
            self._samples[:, : self._count] = kept
        if self._count == self._samples.shape[1]:
            self._samples = np.concatenate((self._samples, np.zeros_like(self._samples)), axis=1)
        self._samples[:, self._count] = time, value
        self._count += 1


@dataclass(slots=True, eq=False)
class Graph:
    """One plot against time: some quantities of the world, or of a body.

    Attributes
    ----------
    number : int
        Tells it from others.
    title : str
        What it shows.
    entity : int, optional
        The body; ``None`` for the world.
    chosen : dict of str to Series
        The lines that are shown, by the name of their quantity.
    before : dict of str to Series
        The same of the run before, drawn faintly.
    follows : bool
        Whether its axes follow what is recorded; not after they were moved by hand.
    """

    number: int
    title: str
    entity: int | None = None
    chosen: dict[str, Series] = field(default_factory=dict)
    before: dict[str, Series] = field(default_factory=dict)
    follows: bool = True
    _last: float = -1.0

    @property
    def quantities(self) -> tuple[Quantity, ...]:
        """All that can be shown in it."""
        return WORLD_QUANTITIES if self.entity is None else BODY_QUANTITIES

    def toggle(self, name: str) -> None:
        """Show a quantity, or no longer."""
        if self.chosen.pop(name, None) is None:
            self.chosen[name] = Series()
            self._last = -1.0

    def sample(self, world: World) -> None:
        """Record what is shown, once for each time; what was recorded of later times is replaced."""
        if world.time == self._last:
            return
        self._last = world.time
        for quantity in self.quantities:
            if quantity.name in self.chosen:
                try:
                    value = quantity.read(world, self.entity or 0)
                except KeyError:  # the body has no such component any more, or is gone
                    continue
                self.chosen[quantity.name].add(world.time, value)

    def restart(self) -> None:
        """Begin another run; this one stays as the run before."""
        self.before = self.chosen
        self.chosen = {name: Series() for name in self.chosen}
        self._last = -1.0

    def csv(self) -> str:
        """Return what is shown as a table: the time, then a column for each quantity."""
        units = {quantity.name: quantity.unit for quantity in self.quantities}
        times = sorted({float(t) for line in self.chosen.values() for t in line.times})
        columns = [
            dict(zip(line.times.tolist(), line.values.tolist(), strict=True)) for line in self.chosen.values()
        ]
        head = ",".join(["time [s]", *(f"{name} [{units[name]}]" for name in self.chosen)])
        rows = [",".join([repr(t), *(repr(c[t]) if t in c else "" for c in columns)]) for t in times]
        return "\n".join([head, *rows]) + "\n"
