"""A pin, about which two bodies turn."""

from physicslab.components.joint_ends import (
    anchor_of_first,
    anchor_of_second,
    collides,
    first_end,
    second_end,
)
from physicslab.ecs.component import Component, Vector, component


@component
class Pin(Component):
    """A hinge between two bodies, or a body and a fixed point: it keeps A's anchor and B's in one place.

    It lives on an entity of its own or on one of the bodies.
    """

    a: int | None = first_end()
    b: int | None = second_end()
    anchor_a: Vector = anchor_of_first()
    anchor_b: Vector = anchor_of_second()
    collide: bool = collides()
