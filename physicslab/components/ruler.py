"""A length in the world."""

from typing import ClassVar

from physicslab.components.lengths import point
from physicslab.ecs.component import Component, Entity, Vector, component, field


@component
class Ruler(Component):
    """Measures from one point to another; an end attached to a body follows it."""

    physical: ClassVar[bool] = False
    POINTS: ClassVar[tuple[str, ...]] = ("start", "end")
    start: Vector = point(
        0.0, 0.0, "where it begins, in the frame of the body that this end is attached to, or of the world"
    )
    end: Vector = point(
        1.0, 0.0, "where it ends, in the frame of the body that this end is attached to, or of the world"
    )
    start_body: Entity = field(default=None, meaning="the body that its beginning is attached to")
    end_body: Entity = field(default=None, meaning="the body that its end is attached to")
