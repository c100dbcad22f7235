"""A graph in the window."""

from typing import ClassVar

from physicslab.components.quantities import QUANTITIES, why_not_of
from physicslab.ecs.component import Component, InvalidValue, component, field

TIME = "time"
"""The quantity on the horizontal axis of most graphs."""


@component
class Graph(Component):
    """A plot of quantities against time, or against a quantity. Each line is an entity with a GraphLine."""

    physical: ClassVar[bool] = False
    across: str = field(
        default=TIME, choices=(TIME, *QUANTITIES), meaning="what stands on the horizontal axis"
    )
    body: int | None = field(default=None, meaning="body of what stands there; the world where absent")
    side: str = field(default="right", choices=("left", "right"), meaning="where in the window it is")

    def references(self) -> dict[str, str]:
        """Return which component the body must have."""
        return {"body": "Transform"}

    def validate(self) -> None:
        """Check that the body, or the world, has the quantity."""
        allowed = None if self.across == TIME else why_not_of(self.across, self.body)
        if allowed is not None:
            raise InvalidValue("Graph", "across", self.across, f'"{TIME}", or {allowed}')
