"""What the cursor moves or makes, for its place to snap."""

from __future__ import annotations

from physicslab.components import Held, Shape, Transform
from physicslab.contacts.outlines import Outlines
from physicslab.ecs.vector import Vector2
from physicslab.view.controls.tools import TOOLS
from physicslab.view.window.placing import outlines_of
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["follow_snapping"]

_ORIGIN = Vector2()


def follow_snapping(world: World, window: Window) -> None:
    """Find where the cursor's place snaps to: of a body in the hand, a size, a pin, or what is made next."""
    snapping, cursor = window.snapping, window.place
    snapping.clear()
    if not snapping.active or window.pointer_on_panel:
        return
    held, camera = window.hand.entity, window.camera
    if held is not None:
        if window.pace.paused and world.has(held, Held) and world.has(held, Transform):
            transform = world.component(held, Transform)
            middle = cursor - world.component(held, Held).grip.rotated(transform.angle)
            snapping.follow(world, camera, cursor, middle, _about(world, held), (held,))
    elif window.handles.dragged is not None:
        if window.handles.dragged == "size":
            snapping.follow(world, camera, cursor, cursor, None, window.selection.entities)
    elif window.pins.dragged is not None:
        snapping.follow(world, camera, cursor, cursor, None, ())
    elif (spawn := TOOLS[window.tool].spawn) is not None:
        snapping.follow(world, camera, cursor, cursor, spawn.about(window), ())


def _about(world: World, entity: int) -> Outlines | None:
    """Return the outline of a body, as if its middle were at the origin."""
    if not world.has(entity, Shape):
        return None
    rows = world.batch(Transform, Shape).rows
    own = rows[world.entity_index.entities[rows] == entity]
    return outlines_of(world, own).moved(_ORIGIN - world.component(entity, Transform).position)
