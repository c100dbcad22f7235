"""Copies of the selection: beside it, at the cursor, in a row, in a grid, around a circle."""

from collections.abc import Sequence
from itertools import chain
from typing import Any

import numpy as np

from physicslab.components import Held, Shape, Spring, Transform
from physicslab.contacts.outlines import Outlines
from physicslab.ecs.component import Component
from physicslab.ecs.vector import Vector2
from physicslab.history import Command, Spawn
from physicslab.state.joint_rows import KINDS
from physicslab.view.window.copying import Copying
from physicslab.view.window.ends import brought
from physicslab.view.window.placing import outlines_of, refused_place
from physicslab.view.window.window import Window
from physicslab.world import World

type Copied = dict[int, list[Component]]
"""The components of the copies of some bodies, and of what joins them, by the entity that has them."""


def duplicate_selected(world: World, window: Window) -> None:
    """Put a copy of each body that is selected beside it, and select the copies."""
    _spawn(world, window, _selected(world, window), [Vector2(_width(world, window), 0.0)])


def copy_selected(world: World, window: Window) -> None:
    """Keep copies of the selection, to be pasted."""
    window.copied = _selected(world, window)
    count = len(window.selection.bodies(world))
    window.notify(f"Copied: {count}" if count else "Nothing is selected to be copied")


def paste(world: World, window: Window) -> None:
    """Paste the copy at the cursor, and select it."""
    if not window.copied:
        window.notify("Nothing was copied")
        return
    all_parts = chain.from_iterable(window.copied.values())
    places = [part.position for part in all_parts if isinstance(part, Transform)]
    middle = sum(places, Vector2()) / len(places)
    _spawn(world, window, window.copied, [window.place - middle])


def begin_copies(world: World, window: Window) -> None:
    """Open the panel of many copies, which are as far from each other as the selection is wide."""
    if not _selected(world, window):
        window.notify("Select what is to be copied")
        return
    width = float(f"{_width(world, window):.2g}")
    window.copying = Copying(distance=width, upward=width)


def make_copies(world: World, window: Window) -> None:
    """Make the copies that are shown, where there is room for them, as one edit."""
    copying, window.copying = window.copying, None
    if copying is None:
        return
    free = [offset for offset, shown in coming(world, window, copying) if not refused_place(world, shown)]
    _spawn(world, window, _selected(world, window), free)
    left = len(copying.offsets) - len(free)
    if left:
        window.notify(f"{len(free)} copies; for {left} there is no room")


def coming(world: World, window: Window, copying: Copying) -> list[tuple[Vector2, Outlines]]:
    """Return where copies would be, from the selection [m], and their outlines."""
    rows = world.entity_index.rows_of(np.array(window.selection.bodies(world), np.int64))
    shaped = rows[world.table(Shape).present[rows]]
    shown = outlines_of(world, shaped)
    return [(offset, shown.moved(offset)) for offset in copying.offsets]


def _spawn(world: World, window: Window, copied: Copied, offsets: Sequence[Vector2]) -> None:
    """Make copies at offsets [m] from where the originals were as one edit, and select their bodies."""
    made: list[Command] = []
    first = window.edits.history.next_entity
    for offset in offsets:
        number = {entity: first + len(made) + n for n, entity in enumerate(copied)}
        made += [Spawn(brought(parts, number, offset)) for parts in copied.values()]
    new = window.edits.do_all(
        made, f"copied {sum(_is_body(parts) for parts in copied.values()) * len(offsets)}"
    )
    bodies = tuple(entity for entity in new if world.has(entity, Transform))
    window.selection.entities = bodies or window.selection.entities


def _is_body(parts: Sequence[Component]) -> bool:
    return any(isinstance(part, Transform) for part in parts)


def _selected(world: World, window: Window) -> Copied:
    """Return copies of the bodies that are selected, and of what joins them to each other or to the world."""
    copied = {entity: _parts(world, entity) for entity in window.selection.bodies(world)}
    kinds: tuple[type[Any], ...] = (Spring, *KINDS)
    for kind in kinds:
        for entity in world.batch(kind).entities.tolist():
            part = world.component(entity, kind)
            ends = [getattr(part, spec.name) for spec in kind.FIELDS if spec.kind == "entity"]
            joined = [
                end for end in (*ends, entity if world.has(entity, Transform) else None) if end is not None
            ]
            if joined and all(end in copied for end in joined):
                copied.setdefault(entity, []).append(kind(**part.given()))
    return copied


def _parts(world: World, entity: int) -> list[Component]:
    """Return copies of the components of a body but for those that join it to others."""
    return [
        type(part)(**part.given())
        for part in world.components(entity)
        if isinstance(part, Component) and not isinstance(part, (Held, Spring, *KINDS))
    ]


def _width(world: World, window: Window) -> float:
    """Return how far beside the selection its copy is put [m]."""
    sides = [
        world.component(entity, Transform).position.x + side * world.component(entity, Shape).reach
        for entity in window.selection.bodies(world)
        if world.has(entity, Shape)
        for side in (-1.0, 1.0)
    ]
    return 1.1 * (max(sides) - min(sides)) if sides else 0.5
