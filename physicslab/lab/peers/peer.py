"""Another engine that has a world's scene, and what is brought back of it into the world's tables."""

from __future__ import annotations

import importlib
import warnings
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np

from physicslab.components import Drag, Shape, Spring, Transform, Velocity
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
        Where the bodies came from, and go with :meth:`bring_back`.

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
            # Box2D's binding has types without modules, which Python 3.12 tells of; as an error it crashes.
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
        self._rows, self._moving = moving.rows.copy(), moving.entities.tolist()

    @abstractmethod
    def make_space(self) -> None:
        """Begin with the bounds of the world and nothing else."""

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
    def positions(self) -> list[tuple[float, float]]:
        """Return where every body is [m], as a user of the engine reads it: in a loop."""

    @abstractmethod
    def state(self, entity: int) -> Sequence[float]:
        """Return a body's place [m], velocity [m/s], angle [rad] and angular velocity [rad/s]."""

    def bring_back(self) -> None:
        """Write where the bodies are, and how they move, into the world's tables.

        Raises
        ------
        Diverged
            If a number of a body is not finite.
        """
        state = np.array([self.state(entity) for entity in self._moving]).reshape(-1, 6)
        if not np.isfinite(state).all():
            raise Diverged("NaN")
        rows, transform, velocity = self._rows, self.world.table(Transform), self.world.table(Velocity)
        transform["position"][rows], velocity["linear"][rows] = state[:, :2], state[:, 2:4]
        transform["angle"][rows], velocity["angular"][rows] = state[:, 4], state[:, 5]


def find_contacts(world: World) -> None:
    """See to it that the world's contacts are those of where its bodies are now."""
    world.synchronise()
    with world.active():
        world.contacts.stale = True
        for stage in (Stage.BROAD_PHASE, Stage.CONTACT):
            world.schedule.run(stage, world, 0.0)
