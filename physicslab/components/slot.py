"""A straight slot, along which a body slides, with limits and a motor."""

from physicslab.components.joint_ends import (
    anchor_of_first,
    anchor_of_second,
    as_placed,
    breaks_at,
    breaks_at_torque,
    check_limits,
    collides,
    first_end,
    optional,
    second_end,
    strongest,
)
from physicslab.ecs.component import Component, Derived, InvalidValue, Vector, component, field
from physicslab.ecs.fields import LENGTH_LIMIT


@component
class Slot(Component):
    """Keeps B's anchor on a straight line through A's anchor, which turns with A.

    Limits and motor are of the way along the axis from A's anchor to B's.
    """

    a: int | None = first_end()
    b: int | None = second_end()
    anchor_a: Vector = anchor_of_first()
    anchor_b: Vector = anchor_of_second()
    axis: Vector = field(default=(1.0, 0.0), limit=LENGTH_LIMIT, meaning="its direction in A's own frame")
    lower: Derived = optional("m", "the least way along the axis; any where absent")
    upper: Derived = optional("m", "the largest way along the axis; any where absent")
    turns: bool = field(default=False, meaning="whether B turns freely")
    angle: Derived = as_placed("rad", "angle of B less that of A, unless B turns")
    motor_speed: Derived = optional("m/s", "how fast its motor moves B along the axis; no motor where absent")
    max_force: Derived = strongest("N")
    collide: bool = collides()
    breaks: Derived = breaks_at()
    breaks_torque: Derived = breaks_at_torque()

    def validate(self) -> None:
        """Check that there is an axis, and that the limits do not cross."""
        if self.axis.magnitude == 0.0:
            raise InvalidValue("Slot", "axis", tuple(self.axis), "a direction: not both 0")
        check_limits(self)
