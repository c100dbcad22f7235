"""Points of bodies: in a body's own frame, and in the world."""

import numpy as np

from physicslab.components import Shape, Transform
from physicslab.contacts.outlines import outlines_of
from physicslab.ecs.vector import Vector2
from physicslab.state.attached import local_point as in_frame
from physicslab.world import World


def point_of(world: World, body: int | None, anchor: Vector2) -> Vector2:
    """Return where a point in a body's frame is in the world [m]; without a body it is one of the world."""
    if body is None or not world.has(body, Transform):
        return anchor
    transform = world.component(body, Transform)
    return transform.position + anchor.rotated(transform.angle)


def local_point(world: World, body: int | None, place: Vector2) -> Vector2:
    """Return a point of the world in a body's frame [m]: if it is not on the body, the body's middle."""
    if body is None or not world.has(body, Transform):
        return place
    local = in_frame(world, body, place)
    if not world.has(body, Shape):
        return Vector2()
    row = np.array([world.entity_index.row_of[body]])
    inside = outlines_of(world, row).gaps(place.x, place.y)[0] <= 0.0
    return local if inside else Vector2()
