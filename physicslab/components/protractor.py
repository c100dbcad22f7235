"""An angle in the world."""

from typing import ClassVar

from physicslab.components.lengths import point
from physicslab.ecs.component import Component, Entity, Vector, component, field


@component
class Protractor(Component):
    """Measures the angle between two arms from one vertex; a point attached to a body follows it."""

    physical: ClassVar[bool] = False
    POINTS: ClassVar[tuple[str, ...]] = ("vertex", "first", "second")
    vertex: Vector = point(0.0, 0.0, "where the arms meet, in its body's frame")
    first: Vector = point(1.0, 0.0, "end of the first arm, in its body's frame")
    second: Vector = point(0.0, 1.0, "end of the second arm, in its body's frame")
    vertex_body: Entity = field(default=None, meaning="the body that the vertex is attached to")
    first_body: Entity = field(default=None, meaning="the body that the first arm's end is attached to")
    second_body: Entity = field(default=None, meaning="the body that the second arm's end is attached to")
