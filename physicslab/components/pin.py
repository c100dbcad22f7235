"""A pin, about which two bodies turn, with limits and a motor."""

from physicslab.components.joint_ends import (
    anchor_of_first,
    anchor_of_second,
    breaks_at,
    breaks_at_torque,
    check_limits,
    collides,
    first_end,
    optional,
    second_end,
    strongest,
)
from physicslab.ecs.component import Component, Derived, Vector, component


@component
class Pin(Component):
    """A hinge between two bodies, or a body and a fixed point: it keeps A's anchor and B's in one place.

    It lives on an entity of its own or on one of the bodies. Limits and motor are of the angle of B less that
    of A.
    """

    a: int | None = first_end()
    b: int | None = second_end()
    anchor_a: Vector = anchor_of_first()
    anchor_b: Vector = anchor_of_second()
    lower: Derived = optional("rad", "the smallest angle of B less that of A; any where absent")
    upper: Derived = optional("rad", "the largest angle of B less that of A; any where absent")
    motor_speed: Derived = optional("rad/s", "how fast its motor turns B against A; no motor where absent")
    max_torque: Derived = strongest("N m")
    collide: bool = collides()
    breaks: Derived = breaks_at()
    breaks_torque: Derived = breaks_at_torque()

    def validate(self) -> None:
        """Check that the limits do not cross."""
        check_limits(self)
