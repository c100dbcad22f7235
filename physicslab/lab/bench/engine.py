"""The engines that are timed, behind one interface: step, run, read the state back."""

import importlib.util
from collections.abc import Callable
from dataclasses import replace
from typing import override

from physicslab.components import Transform
from physicslab.ecs.vector import Vector2
from physicslab.lab.bench.scene import BenchScene
from physicslab.lab.peers.mirrors import Box2D3Mirror, Box2DMirror, PymunkMirror
from physicslab.lab.peers.peer import Peer
from physicslab.world import World

OURS = "PhysicsLab"
PEERS: tuple[type[Peer], ...] = (PymunkMirror, Box2DMirror, Box2D3Mirror)
"""The engines that PhysicsLab is compared with."""


def missing_peers() -> list[str]:
    """Return which peers are not installed."""
    return [peer.title for peer in PEERS if importlib.util.find_spec(peer.module) is None]


class Engine:
    """PhysicsLab with a scene of its own; others override how it is stepped and read.

    Attributes
    ----------
    title : str
        The engine's name.
    world : World
        The simulated world, as it was when :meth:`look` was called last.
    dt : float
        The length of a step [s].
    prepare : callable, optional
        Called before every step, within the timed part, with its number from 0 on.
    """

    title = OURS

    def __init__(self, world: World) -> None:
        self.world = world
        self.dt = world.simulation.dt
        self.prepare: Callable[[int], None] | None = None
        self._prepared = 0

    def advance(self) -> None:
        """Advance by one step, after what is done before it."""
        if self.prepare is not None:
            self.prepare(self._prepared)
            self._prepared += 1
        self.step()

    def set_gravity(self, gravity: Vector2) -> None:
        """Replace uniform gravity [m/s^2]."""
        self.world.physics = replace(self.world.physics, gravity=gravity)

    def step(self) -> None:
        """Advance by one step of ``dt``."""
        self.world.step()

    def run(self, steps: int) -> None:
        """Advance by so many steps, in the way that is fastest."""
        self.world.run(steps=steps)

    def read(self) -> object:
        """Return where every body is, as a program would read it after each step."""
        return self.world.table(Transform)["position"].copy()

    def look(self) -> World:
        """Return the world with the state of now.

        Raises
        ------
        Diverged
            If the state is not finite.
        """
        return self.world

    def pause(self) -> None:
        """Do what a program does between some steps and the next; it is not timed."""


class OtherEngine(Engine):
    """A peer, with a world of its own as its model.

    Parameters
    ----------
    world : World
        The world that is built in it.
    peer : type of Peer
        Which engine.
    finer : int
        How many times as short as usual its steps are.

    Raises
    ------
    CannotBuild
        If the engine has nothing of the kind that the world holds.
    """

    def __init__(self, world: World, peer: type[Peer], finer: int = 1) -> None:
        super().__init__(world)
        self.title = peer.title
        self._peer = peer(self.world, finer)

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
        self._peer.write_back()
        return self.world


def prepared(engine: Engine, scene: BenchScene) -> Engine:
    """Return the engine, which does before every step what the scene has done then, if anything."""
    gravity_at, edit = scene.gravity_at, scene.edit
    if gravity_at is not None:
        engine.prepare = lambda step: engine.set_gravity(gravity_at(step * engine.dt))
    elif edit is not None:
        engine.prepare = lambda step: edit(engine.world, step)
    return engine
