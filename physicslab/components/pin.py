"""A pin, about which two bodies turn, with limits and a motor."""

from physicslab.components import joint_ends as ends
from physicslab.ecs.component import Component, Derived, Entity, Vector, component


@component
class Pin(Component):
    """A hinge between two bodies, or a body and a fixed point: it keeps A's anchor and B's in one place.

    It lives on an entity of its own or on one of the bodies. Limits and motor are of the angle of B less that
    of A.
    """

    a: Entity = ends.first_end()
    b: Entity = ends.second_end()
    anchor_a: Vector = ends.anchor_of_first()
    anchor_b: Vector = ends.anchor_of_second()
    lower: Derived = ends.optional("rad", "the smallest angle of B less that of A; any where absent")
    upper: Derived = ends.optional("rad", "the largest angle of B less that of A; any where absent")
    motor_speed: Derived = ends.optional(
        "rad/s", "how fast its motor turns B against A; no motor where absent"
    )
    max_torque: Derived = ends.strongest("N m")
    collide: bool = ends.collides()
    breaks: Derived = ends.breaks_at()
    breaks_torque: Derived = ends.breaks_at_torque()

    def validate(self) -> None:
        """Check that the limits do not cross."""
        ends.check_limits(self)
