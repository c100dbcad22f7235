"""A spring, which pulls two points together."""

from physicslab.components.lengths import extent, point
from physicslab.ecs.component import Component, Entity, Number, Vector, component, field

OTHER_END = "another entity than a"
"""The allowed ``b``: a pull between two points of one body moves nothing."""


@component
class Spring(Component):
    """A spring and damper between two bodies, or a body and a fixed point.

    The force along the line from A's anchor to B's is F = k (length - rest_length) + c (rate of lengthening),
    pulling the ends together where positive. It lives on an entity of its own or on the body it holds.
    """

    a: Entity = field(
        default=None, fixed=True, meaning="first body; the entity that carries the spring where absent"
    )
    b: Entity = field(
        default=None, fixed=True, meaning="second body; a fixed point of the world where absent"
    )
    anchor_a: Vector = point(0.0, 0.0, "where it holds A, in A's own frame")
    anchor_b: Vector = point(0.0, 0.0, "where it holds B, in B's own frame, or a point of the world")
    rest_length: Number = extent(1.0, "length without force")
    stiffness: Number = field(default=100.0, unit="N/m", minimum=0.0, meaning="force per metre of extension")
    damping: Number = field(default=0.0, unit="N s/m", minimum=0.0, meaning="force per speed of lengthening")
