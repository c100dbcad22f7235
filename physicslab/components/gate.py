"""A light gate: a line that notes what crosses it, and when."""

from typing import ClassVar

from physicslab.components.lengths import point
from physicslab.ecs.component import Component, Entity, Vector, component, field


@component
class Gate(Component):
    """A straight line; the moments at which bodies' centres cross it are recorded. It stops nothing."""

    physical: ClassVar[bool] = False
    POINTS: ClassVar[tuple[str, ...]] = ("start", "end")
    start: Vector = point(0.0, 0.0, "one end, in its body's frame")
    end: Vector = point(0.0, 1.0, "the other end, in its body's frame")
    start_body: Entity = field(default=None, meaning="the body that one end is attached to")
    end_body: Entity = field(default=None, meaning="the body that the other end is attached to")
