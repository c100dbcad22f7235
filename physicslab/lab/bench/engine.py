"""The engines that are timed, behind one interface: step, run, read the state back."""

from __future__ import annotations

import importlib.util
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import replace
from typing import override

from physicslab.components import Transform
from physicslab.ecs.vector import Vector2
from physicslab.lab.bench.scene import BenchScene
from physicslab.lab.peers.box2d3_mirror import Box2D3Mirror
from physicslab.lab.peers.box2d_mirror import Box2DMirror
from physicslab.lab.peers.peer import Peer
from physicslab.lab.peers.pymunk_mirror import PymunkMirror
from physicslab.world import World

__all__ = ["OURS", "PEERS", "Engine", "OtherEngine", "OurEngine", "missing_peers", "prepared"]

OURS = "PhysicsLab"
PEERS: tuple[type[Peer], ...] = (PymunkMirror, Box2DMirror, Box2D3Mirror)
"""The engines that PhysicsLab is compared with."""


def missing_peers() -> list[str]:
    """Return which peers are not installed."""
    return [peer.title for peer in PEERS if importlib.util.find_spec(peer.module) is None]


class Engine(ABC):
    """An engine that holds a scene of its own.

    Attributes
    ----------
    title : str
        The engine's name.
    world : World
        What is simulated, as it was when :meth:`look` was called last.
    dt : float
        The length of a step [s].
    """

    title: str

    def __init__(self, world: World) -> None:
        self.world = world
        self.dt = world.simulation.dt

    @abstractmethod
    def set_gravity(self, gravity: Vector2) -> None:
        """Replace uniform gravity [m/s^2]."""

    @abstractmethod
    def step(self) -> None:
        """Advance by one step of ``dt``."""

    @abstractmethod
    def run(self, steps: int) -> None:
        """Advance by so many steps, in the way that is fastest."""

    @abstractmethod
    def read(self) -> object:
        """Return where every body is, as a program would read it after each step."""

    def look(self) -> World:
        """Return the world with the state of now.

        Raises
        ------
        Diverged
            If the state is not finite.
        """
        return self.world

    def pause(self) -> None:  # noqa: B027 (most engines have nothing to do)
        """Do what a program does between some steps and the next; it is not timed."""


class OurEngine(Engine):
    """PhysicsLab."""

    title = OURS

    @override
    def set_gravity(self, gravity: Vector2) -> None:
        self.world.physics = replace(self.world.physics, gravity=gravity)

    @override
    def step(self) -> None:
        self.world.step()

    @override
    def run(self, steps: int) -> None:
        self.world.run(steps=steps)

    @override
    def read(self) -> object:
        return self.world.table(Transform)["position"].copy()


class OtherEngine(Engine):
    """A peer, with a world of its own as its model.

    Parameters
    ----------
    scene : BenchScene
        The scene that is built in it.
    peer : type of Peer
        Which engine.

    Raises
    ------
    CannotBuild
        If the engine has nothing of the kind that the scene holds.
    """

    def __init__(self, scene: BenchScene, peer: type[Peer]) -> None:
        super().__init__(scene.build())
        self.title = peer.title
        self._peer = peer(self.world)

    @override
    def set_gravity(self, gravity: Vector2) -> None:
        self._peer.set_gravity(gravity)

    @override
    def step(self) -> None:
        self._peer.step(self.dt)

    @override
    def run(self, steps: int) -> None:
        self._peer.run(self.dt, steps)

    @override
    def read(self) -> object:
        return self._peer.positions()

    @override
    def look(self) -> World:
        self._peer.bring_back()
        return self.world


class Prepared(Engine):
    """An engine with something done before every step, as part of what is timed.

    Parameters
    ----------
    engine : Engine
        What steps.
    prepare : callable
        Takes the engine and the number of the coming step, from 0 on.
    """

    def __init__(self, engine: Engine, prepare: Callable[[Engine, int], None]) -> None:
        super().__init__(engine.world)
        self.title, self._engine, self._prepare, self._steps = engine.title, engine, prepare, 0

    @override
    def set_gravity(self, gravity: Vector2) -> None:
        self._engine.set_gravity(gravity)

    @override
    def step(self) -> None:
        self._prepare(self._engine, self._steps)
        self._engine.step()
        self._steps += 1

    @override
    def run(self, steps: int) -> None:
        for _ in range(steps):
            self.step()

    @override
    def read(self) -> object:
        return self._engine.read()

    @override
    def look(self) -> World:
        return self._engine.look()

    @override
    def pause(self) -> None:
        self._engine.pause()


def prepared(engine: Engine, scene: BenchScene) -> Engine:
    """Return the engine with what the scene has done before every step, if anything."""
    gravity_at, edit = scene.gravity_at, scene.edit
    if gravity_at is not None:
        return Prepared(engine, lambda engine, step: engine.set_gravity(gravity_at(step * engine.dt)))
    if edit is not None:
        return Prepared(engine, lambda engine, step: edit(engine.world, step))
    return engine
