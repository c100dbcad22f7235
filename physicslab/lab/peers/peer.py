"""Another engine that holds a world's scene; its state can be copied back into the world's tables."""

from __future__ import annotations

import importlib
import math
import warnings
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Drag, Mass, Material, Shape, Spring, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.state.masses import Diverged
from physicslab.systems.system import Stage
from physicslab.world import World

__all__ = ["CannotBuild", "Peer", "find_contacts"]


class CannotBuild(Exception):
    """An engine has nothing of the kind that a scene holds."""


class Peer(ABC):
    """A world's bodies, as they are when this is made, in another engine.

    Attributes
    ----------
    title, module : str
        The engine's name, and that of its package.
    world : World
        Where the bodies came from, and where :meth:`bring_back` writes their state.
    moving : list of int
        The entities that can move.

    Raises
    ------
    CannotBuild
        If the engine has nothing of the kind that the world holds.
    ImportError
        If the engine is not installed.
    """

    title: ClassVar[str]
    module: ClassVar[str]

    def __init__(self, world: World) -> None:
        with warnings.catch_warnings():
            # Box2D's binding has types without modules, of which Python 3.12 warns; as an error it crashes.
            warnings.simplefilter("ignore", DeprecationWarning)
            self.engine: Any = importlib.import_module(self.module)  # here: most users have no peers
        world.synchronise()
        self.world = world
        if world.physics.gravity_mode == "planet" or world.batch(Drag).entities.size:
            raise CannotBuild("no such force")
        self.gravity = world.physics.gravity if world.physics.gravity_mode == "linear" else Vector2()
        self.make_space()
        for entity in world.batch(Transform).entities.tolist():
            self.add_body(entity)
            if world.has(entity, Shape):
                self.add_shape(entity)
        for entity in world.batch(Spring).entities.tolist():
            self.add_spring(entity, world.component(entity, Spring))
        moving = world.batch(Transform, Velocity)
        self._rows, self.moving = moving.rows.copy(), moving.entities.tolist()

    @abstractmethod
    def make_space(self) -> None:
        """Begin with the bounds of the world and nothing else."""

    @abstractmethod
    def set_gravity(self, gravity: Vector2) -> None:
        """Replace uniform gravity [m/s^2]."""

    @abstractmethod
    def add_body(self, entity: int) -> None:
        """Add a body without its outline."""

    @abstractmethod
    def add_shape(self, entity: int) -> None:
        """Add a body's outline and surface."""

    @abstractmethod
    def add_spring(self, entity: int, spring: Spring) -> None:
        """Add a spring, which an entity carries."""

    @abstractmethod
    def step(self, dt: float) -> None:
        """Advance by one step [s]."""

    def run(self, dt: float, steps: int) -> None:
        """Advance by so many steps [s]."""
        for _ in range(steps):
            self.step(dt)

    @abstractmethod
    def positions(self) -> object:
        """Return where every body is [m], as a user of the engine reads it: in Python in a loop."""

    @abstractmethod
    def state(self, entity: int) -> Sequence[float]:
        """Return a body's place [m], velocity [m/s], angle [rad] and angular velocity [rad/s]."""

    def states(self) -> NDArray[np.float64]:
        """Return the state of every body that can move (n, 6)."""
        return np.array([self.state(entity) for entity in self.moving]).reshape(-1, 6)

    def restitutions(self) -> set[float]:
        """Return the restitutions that there are, of bodies and bounds."""
        physics, rows = self.world.physics, self.world.batch(Material).rows
        found: set[float] = set(self.world.table(Material)["restitution"][rows].tolist())
        return found if physics.bounds is None else {*found, physics.bounds_restitution}

    def walls(self) -> list[tuple[float, float, float, float]]:
        """Return the bounds of the world as lines [m]: x, y of one end, x, y of the other."""
        if self.world.physics.bounds is None:
            return []
        xmin, ymin, xmax, ymax = self.world.physics.bounds
        corners = ((xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax))
        return [(*start, *end) for start, end in zip(corners, corners[1:] + corners[:1], strict=True)]

    def frequency(self, entity: int, spring: Spring) -> tuple[float, float]:
        """Return a spring's frequency [Hz] and share of critical damping, by which Box2D takes springs.

        Raises
        ------
        CannotBuild
            If it is a damper alone.
        """
        if spring.stiffness == 0.0:
            raise CannotBuild("no damper alone")
        ends = (spring.a or entity, spring.b)
        free = [
            self.world.component(end, Mass).mass
            for end in ends
            if end and self.world.has(end, Mass) and self.world.has(end, Velocity)
        ]
        mass = 1.0 / sum(1.0 / weight for weight in free)
        rate = math.sqrt(spring.stiffness / mass)
        return rate / (2.0 * math.pi), spring.damping / (2.0 * mass * rate)

    def bring_back(self) -> None:
        """Write where the bodies are, and how they move, into the world's tables.

        Raises
        ------
        Diverged
            If a number of a body is not finite.
        """
        state = self.states()
        if not np.isfinite(state).all():
            raise Diverged("NaN")
        rows, transform, velocity = self._rows, self.world.table(Transform), self.world.table(Velocity)
        transform["position"][rows], velocity["linear"][rows] = state[:, :2], state[:, 2:4]
        transform["angle"][rows], velocity["angular"][rows] = state[:, 4], state[:, 5]


def find_contacts(world: World) -> None:
    """Find the contacts of a world again, from where its bodies are now."""
    world.synchronise()
    with world.active():
        world.contacts.stale = True
        for stage in (Stage.BROAD_PHASE, Stage.CONTACT):
            world.schedule.run(stage, world, 0.0)
