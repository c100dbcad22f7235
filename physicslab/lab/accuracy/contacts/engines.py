"""The engines of a contact case: rigid and soft contacts, and other engines if installed."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from physicslab.ecs.config import SimulationConfig
from physicslab.lab.peers.mirrors import Box2D3Mirror, Box2DMirror, PymunkMirror
from physicslab.lab.peers.peer import Peer
from physicslab.world import World

type Advance = Callable[[float], None]
"""Advances one world by a time [s]."""


@dataclass(frozen=True, slots=True)
class ContactEngine:
    """One way to compute a contact case.

    Attributes
    ----------
    name, title : str
        For documents, and for people.
    simulation : callable
        Takes the step [s] and returns the configuration with which worlds are built.
    start : callable
        Takes a world and the step; returns what advances it. May raise
        :class:`~physicslab.lab.peers.peer.CannotBuild`, or ``ImportError`` where the engine is not installed.
    own : bool
        Whether it is one of ours.
    """

    name: str
    title: str
    simulation: Callable[[float], SimulationConfig]
    start: Callable[[World, float], Advance]
    own: bool = False


def _simulation(contacts: str, collisions: str, dt: float) -> SimulationConfig:
    return SimulationConfig(dt=dt, contacts=contacts, collisions=collisions, sleeping=False)


def _ours(world: World, dt: float) -> Advance:
    world.synchronise()
    return lambda seconds: world.run(seconds=seconds)


def _theirs(peer: type[Peer], world: World, dt: float) -> Advance:
    mirror = peer(world)

    def advance(seconds: float) -> None:
        steps = round(seconds / dt)
        mirror.run(seconds / steps, steps)
        mirror.bring_back()

    return advance


_SOFT = partial(_simulation, "soft", "step")
OWN = (
    ContactEngine("rigid", "rigid contacts", partial(_simulation, "rigid", "auto"), _ours, own=True),
    ContactEngine("soft", "soft contacts", _SOFT, _ours, own=True),
)
"""Ours."""
ENGINES = (
    *OWN,
    ContactEngine("pymunk", "pymunk", _SOFT, partial(_theirs, PymunkMirror)),
    ContactEngine("box2d", "Box2D 2.3", _SOFT, partial(_theirs, Box2DMirror)),
    ContactEngine("box2d_v3", "Box2D 3", _SOFT, partial(_theirs, Box2D3Mirror)),
)
"""All of them; each takes one of its own steps for one of the scene's."""
