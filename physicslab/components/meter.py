"""A number in large figures."""

from typing import ClassVar

from physicslab.components.quantities import QUANTITIES, carrier_of, check_quantity
from physicslab.ecs.component import Component, Entity, component, field

CORNERS = ("bottom left", "top left", "bottom right", "top right")
"""The corners of the window for a small panel."""


@component
class Meter(Component):
    """Shows a quantity of a body, a joint, a spring or the world in a small panel of the window."""

    physical: ClassVar[bool] = False
    quantity: str = field(choices=tuple(QUANTITIES), meaning="what is shown")
    body: Entity = field(default=None, meaning="whose quantity it is; the world's where absent")
    corner: str = field(default=CORNERS[0], choices=CORNERS, meaning="where in the window it is")

    def references(self) -> dict[str, str]:
        """Return which component the body must have."""
        return {"body": carrier_of(self.quantity)}

    def validate(self) -> None:
        """Check that the body, or the world, has the quantity."""
        check_quantity("Meter", self.quantity, self.body)
