"""What a person can put into the world at the cursor."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass

from physicslab.components import Transform
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import binary, box, chain, circle, container, pendulum, pile, pyramid, stack
from physicslab.view.window.edits import announce_edit
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["CIRCLE", "SPAWNS", "Spawn", "spawn_box", "spawn_circle", "spawn_pendulum"]

_RADII = (0.22, 0.30, 0.18, 0.26, 0.34)
_SIZES = ((0.5, 0.5), (0.8, 0.4), (0.4, 0.7), (0.6, 0.6), (1.0, 0.3))
"""The sizes of what is spawned, in turn [m]."""
_DENSITY = 5.0
"""Mass of what is spawned per area [kg/m^2]."""
_RESTITUTION = 0.4


def _next_size[T](window: Window, sizes: tuple[T, ...]) -> T:
    window.spawned += 1
    return sizes[window.spawned % len(sizes)]


def _announced(spawn: Callable[[World, Window], None]) -> Callable[[World, Window], None]:
    """Let a way to spawn something announce that the world was edited."""

    @functools.wraps(spawn)
    def announcing(world: World, window: Window) -> None:
        spawn(world, window)
        announce_edit(world)

    return announcing


@_announced
def spawn_circle(world: World, window: Window) -> None:
    """Make a circle at the cursor."""
    radius = _next_size(window, _RADII)
    mass = _DENSITY * math.pi * radius * radius
    circle(world, window.place, radius=radius, mass=mass, restitution=_RESTITUTION)


@_announced
def spawn_box(world: World, window: Window) -> None:
    """Make a rectangle at the cursor."""
    width, height = _next_size(window, _SIZES)
    mass = _DENSITY * width * height
    box(world, window.place, width=width, height=height, mass=mass, restitution=_RESTITUTION)


@_announced
def spawn_block(world: World, window: Window) -> None:
    """Make a rectangle at the cursor that stays where it is."""
    box(world, window.place, width=2.0, height=0.2, static=True, friction=0.6, restitution=_RESTITUTION)


@_announced
def spawn_pendulum(world: World, window: Window) -> None:
    """Hang a pendulum from the cursor."""
    window.spawned += 1
    pendulum(world, window.place, length=1.5, angle=0.7)


@_announced
def spawn_chain(world: World, window: Window) -> None:
    """Hang a chain from the cursor."""
    chain(world, 8, window.place, window.place + Vector2(1.2, -1.2))


@_announced
def spawn_stack(world: World, window: Window) -> None:
    """Put a stack of boxes on the cursor."""
    stack(world, 5, window.place, width=0.5, height=0.4, mass=_DENSITY * 0.2)


@_announced
def spawn_pyramid(world: World, window: Window) -> None:
    """Put a pyramid of boxes on the cursor."""
    pyramid(world, 5, window.place, size=0.4, gap=0.04, mass=_DENSITY * 0.16)


@_announced
def spawn_heap(world: World, window: Window) -> None:
    """Pour discs out above the cursor."""
    pile(world, 24, window.place, columns=6, radius=0.12, density=_DENSITY)


@_announced
def spawn_pit(world: World, window: Window) -> None:
    """Build a floor and two walls around the cursor."""
    container(world, window.place, width=2.4, height=1.2, thickness=0.15)


@_announced
def spawn_binary(world: World, window: Window) -> None:
    """Let two planets circle each other about the cursor."""
    for planet in binary(world, (20.0, 10.0), separation=1.6):
        transform = world.component(planet, Transform)
        transform.position = transform.position + window.place
    if world.physics.gravity_mode != "planet":
        window.notify("These two circle each other in planet mode: O turns it on", 5.0)


@dataclass(frozen=True, slots=True)
class Spawn:
    """Something to put into the world.

    Attributes
    ----------
    name : str
        Its icon.
    title : str
        What it is called.
    place : str
        What the click means, in words that follow "click".
    spawn : callable
        Makes it at the cursor.
    """

    name: str
    title: str
    place: str
    spawn: Callable[[World, Window], None]


CIRCLE = Spawn("circle", "Circle", "on empty space for a circle", spawn_circle)
SPAWNS = (
    CIRCLE,
    Spawn("box", "Box", "on empty space for a box", spawn_box),
    Spawn("block", "Plank", "where its middle shall be", spawn_block),
    Spawn("pendulum", "Pendulum", "where it shall hang from", spawn_pendulum),
    Spawn("chain", "Chain", "where it shall hang from", spawn_chain),
    Spawn("stack", "Stack", "where its foot shall be", spawn_stack),
    Spawn("pyramid", "Pyramid", "where its foot shall be", spawn_pyramid),
    Spawn("heap", "Heap of discs", "where it shall fall", spawn_heap),
    Spawn("pit", "Open box", "where the middle of its floor shall be", spawn_pit),
    Spawn("binary", "Two planets", "where they shall circle each other", spawn_binary),
)
"""All there is to spawn, in the order of the chooser."""
