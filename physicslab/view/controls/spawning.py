"""Bodies that can be put into the world at the cursor."""

import copy
import functools
import math
from collections.abc import Callable
from dataclasses import dataclass

from physicslab.components import Spring, Transform
from physicslab.contacts.outlines import Outlines
from physicslab.ecs.component import Component
from physicslab.ecs.vector import Vector2
from physicslab.history import Command, Group, Spawn
from physicslab.prefabs import binary, box, capsule, chain, circle, container, pendulum, pile, pyramid, stack
from physicslab.state.joint_rows import KINDS
from physicslab.view.window.edits import Recipe
from physicslab.view.window.placing import outlines_of, refused_place
from physicslab.view.window.spring_tool import rod_stiffness
from physicslab.view.window.window import Window
from physicslab.world import World

_RADII = (0.22, 0.30, 0.18, 0.26, 0.34)
_SIZES = ((0.5, 0.5), (0.8, 0.4), (0.4, 0.7), (0.6, 0.6), (1.0, 0.3))
"""The sizes of what is spawned, in turn [m]."""
_DENSITY = 5.0
"""Mass of what is spawned per area [kg/m^2]."""
_RESTITUTION = 0.4
_ORIGIN = Vector2(0.0, 0.0)

type Make = Callable[[World, Vector2, int, Recipe], None]
"""Makes something at a place of a world [m]; the number says which of several kinds it is."""


def _circle(world: World, place: Vector2, turn: int, recipe: Recipe) -> None:
    radius = recipe.size or _RADII[turn % len(_RADII)]
    mass = recipe.density * math.pi * radius * radius
    circle(world, place, radius=radius, mass=mass, restitution=recipe.restitution, friction=recipe.friction)


def _box(world: World, place: Vector2, turn: int, recipe: Recipe) -> None:
    width, height = _SIZES[turn % len(_SIZES)]
    if recipe.size:
        width, height = 2.0 * recipe.size, 2.0 * recipe.size
    mass = recipe.density * width * height
    box(
        world, place, width=width, height=height, mass=mass,
        restitution=recipe.restitution, friction=recipe.friction,
    )  # fmt: skip


def _capsule(world: World, place: Vector2, turn: int, recipe: Recipe) -> None:
    length, radius = _SIZES[turn % len(_SIZES)][0], 0.5 * _SIZES[turn % len(_SIZES)][1]
    if recipe.size:
        length, radius = 2.0 * recipe.size, 0.5 * recipe.size
    mass = recipe.density * radius * (2.0 * length + math.pi * radius)
    capsule(
        world, place, length=length, radius=radius, mass=mass,
        restitution=recipe.restitution, friction=recipe.friction,
    )  # fmt: skip


def _plank(world: World, place: Vector2, turn: int, recipe: Recipe) -> None:
    box(world, place, width=2.0, height=0.2, static=True, friction=0.6, restitution=_RESTITUTION)


def _pendulum(world: World, place: Vector2, turn: int, recipe: Recipe) -> None:
    pendulum(world, place, length=1.5, angle=0.7, stiffness=rod_stiffness(1.0, 1.5))


def _chain(world: World, place: Vector2, turn: int, recipe: Recipe) -> None:
    chain(world, 8, place, place + Vector2(1.2, -1.2))


def _stack(world: World, place: Vector2, turn: int, recipe: Recipe) -> None:
    stack(world, 5, place, width=0.5, height=0.4, mass=_DENSITY * 0.2)


def _pyramid(world: World, place: Vector2, turn: int, recipe: Recipe) -> None:
    pyramid(world, 5, place, size=0.4, gap=0.04, mass=_DENSITY * 0.16)


def _heap(world: World, place: Vector2, turn: int, recipe: Recipe) -> None:
    pile(world, 24, place, columns=6, radius=0.12, density=_DENSITY)


def _pit(world: World, place: Vector2, turn: int, recipe: Recipe) -> None:
    container(world, place, width=2.4, height=1.2, thickness=0.15)


def _binary(world: World, place: Vector2, turn: int, recipe: Recipe) -> None:
    for planet in binary(world, (20.0, 10.0), separation=1.6):
        transform = world.component(planet, Transform)
        transform.position = transform.position + place


@dataclass(frozen=True, slots=True)
class Spawnable:
    """Something to put into the world.

    Attributes
    ----------
    name : str
        Its icon.
    title : str
        What it is called.
    place : str
        What the click means, in words that follow "click".
    make : callable
        Makes it at a place.
    remark : str
        What to say where gravity does not act between bodies.
    """

    name: str
    title: str
    place: str
    make: Make
    remark: str = ""

    def outlines(self, window: Window) -> Outlines:
        """Return what would be made at the cursor: the ghost that is shown there."""
        return _outlines(self.make, window.spawned + 1, window.recipe).moved(window.target)

    def about(self, window: Window) -> Outlines:
        """Return the outlines of what would be made, where the cursor is at the origin."""
        return _outlines(self.make, window.spawned + 1, window.recipe)

    def spawn(self, world: World, window: Window) -> None:
        """Make it at the cursor; where it would overlap, say so instead."""
        refused = refused_place(world, self.outlines(window))
        if refused:
            window.notify(f"{self.title}: {refused}")
            return
        window.spawned += 1
        made = _spawn_commands(self.make, window, window.edits.history.next_entity)
        window.edits.do(Group(f"made: {self.title.lower()}", made))
        if self.remark and world.physics.gravity_mode != "planet":
            window.notify(self.remark, 5.0)


def _spawn_commands(make: Make, window: Window, first: int) -> list[Command]:
    """Return the commands that make something at the cursor; ``first`` is the number of its first entity."""
    scratch = World()
    make(scratch, window.target, window.spawned, window.recipe)
    entities = scratch.entities()
    number = {entity: first + n for n, entity in enumerate(entities)}
    commands: list[Command] = []
    for entity in entities:
        parts = [copy.copy(part) for part in scratch.components(entity) if isinstance(part, Component)]
        for part in parts:
            if isinstance(part, (Spring, *KINDS)):
                parts[parts.index(part)] = _renumbered(part, number)
        commands.append(Spawn(parts))
    return commands


def _renumbered[C: Component](part: C, number: dict[int, int]) -> C:
    """Return a spring or a joint between the same bodies under other numbers."""
    given = part.given()
    ends = (spec.name for spec in part.FIELDS if spec.kind == "entity" and given[spec.name] is not None)
    return type(part)(**(given | {end: number[given[end]] for end in ends}))


@functools.lru_cache(maxsize=32)
def _outlines(make: Make, turn: int, recipe: Recipe) -> Outlines:
    """Return the outlines of what would be made at the origin: it is made in a world of its own."""
    scratch = World()
    make(scratch, _ORIGIN, turn, recipe)
    return outlines_of(scratch)


CIRCLE = Spawnable("circle", "Circle", "on empty space for a circle", _circle)
_BOX = Spawnable("box", "Box", "on empty space for a box", _box)
_PENDULUM = Spawnable("pendulum", "Pendulum", "at its upper end", _pendulum)
SPAWNS = (
    CIRCLE,
    _BOX,
    Spawnable("capsule", "Capsule", "on empty space for a capsule", _capsule),
    Spawnable("block", "Plank", "at its middle", _plank),
    _PENDULUM,
    Spawnable("chain", "Chain", "at its upper end", _chain),
    Spawnable("stack", "Stack", "at its foot", _stack),
    Spawnable("pyramid", "Pyramid", "at its foot", _pyramid),
    Spawnable("heap", "Heap of discs", "where it falls", _heap),
    Spawnable("pit", "Open box", "at the middle of its floor", _pit),
    Spawnable("binary", "Planets", "at the centre of their orbit", _binary,
          "These two circle each other in planet mode: O turns it on"),
)  # fmt: skip
"""All there is to spawn, in the order of the chooser."""
spawn_box, spawn_pendulum = _BOX.spawn, _PENDULUM.spawn
