"""A straight slot, along which a body slides, with limits and a motor."""

from physicslab.components import joint_ends as ends
from physicslab.ecs.component import Component, Derived, Entity, InvalidValue, Vector, component, field
from physicslab.ecs.fields import LENGTH_LIMIT

_SHORTEST = 1e-300
"""Length [m] of an axis below which it has not all its digits."""


@component
class Slot(Component):
    """Keeps B's anchor on a straight line through A's anchor, which turns with A.

    Limits and motor are of the way along the axis from A's anchor to B's.
    """

    a: Entity = ends.first_end()
    b: Entity = ends.second_end()
    anchor_a: Vector = ends.anchor_of_first()
    anchor_b: Vector = ends.anchor_of_second()
    axis: Vector = field(default=(1.0, 0.0), limit=LENGTH_LIMIT, meaning="its direction in A's own frame")
    lower: Derived = ends.optional("m", "the least way along the axis; any where absent")
    upper: Derived = ends.optional("m", "the largest way along the axis; any where absent")
    turns: bool = field(default=False, meaning="whether B turns freely")
    angle: Derived = ends.as_placed("rad", "angle of B less that of A, unless B turns")
    motor_speed: Derived = ends.optional(
        "m/s", "how fast its motor moves B along the axis; no motor where absent"
    )
    max_force: Derived = ends.strongest("N")
    collide: bool = ends.collides()
    breaks: Derived = ends.breaks_at()
    breaks_torque: Derived = ends.breaks_at_torque()

    def validate(self) -> None:
        """Check that there is an axis, and that the limits do not cross."""
        if self.axis.magnitude < _SHORTEST:
            allowed = f"a direction: at least {_SHORTEST:g} m long"
            raise InvalidValue("Slot", "axis", tuple(self.axis), allowed)
        ends.check_limits(self)
