"""A rigid connection."""

from physicslab.components.joint_ends import (
    anchor_of_first,
    anchor_of_second,
    as_placed,
    breaks_at,
    breaks_at_torque,
    collides,
    first_end,
    second_end,
)
from physicslab.ecs.component import Component, Derived, Vector, component


@component
class Weld(Component):
    """Keeps A's anchor and B's in one place, and the angle between the bodies."""

    a: int | None = first_end()
    b: int | None = second_end()
    anchor_a: Vector = anchor_of_first()
    anchor_b: Vector = anchor_of_second()
    angle: Derived = as_placed("rad", "angle of B less that of A")
    collide: bool = collides()
    breaks: Derived = breaks_at()
    breaks_torque: Derived = breaks_at_torque()
