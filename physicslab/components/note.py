"""A text at a point of the world.

Instruments have points. Each is two fields: where it is, and the body that it is attached to, ``place`` and
``place_body``; without a body it is a point of the world.
"""

from typing import ClassVar

from physicslab.components.lengths import point
from physicslab.ecs.component import Component, Entity, Vector, component, field


@component
class Note(Component):
    """A text that stands in the world and takes no part in the motion."""

    physical: ClassVar[bool] = False
    POINTS: ClassVar[tuple[str, ...]] = ("place",)
    text: str = field(default="", limit=400, lines=8, meaning="what is written there")
    place: Vector = point(
        0.0, 0.0, "where it is, in the frame of the body that it is attached to, or a point of the world"
    )
    place_body: Entity = field(default=None, meaning="the body that it is attached to; none: it stays")
