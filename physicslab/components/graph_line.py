"""A line of a graph."""

from typing import ClassVar

from physicslab.components.quantities import QUANTITIES, check_quantity
from physicslab.ecs.component import Component, InvalidValue, component, field


@component
class GraphLine(Component):
    """A quantity of a body, or of the world, in a graph. It lives on an entity of its own."""

    physical: ClassVar[bool] = False
    graph: int | None = field(meaning="the entity with the Graph")
    quantity: str = field(choices=tuple(QUANTITIES), meaning="what is plotted")
    body: int | None = field(default=None, meaning="whose quantity it is; the world's where absent")

    def references(self) -> dict[str, str]:
        """Return which component the graph and the body must have."""
        return {"graph": "Graph", "body": "Transform"}

    def validate(self) -> None:
        """Check that there is a graph, and that the body, or the world, has the quantity."""
        if self.graph is None:
            raise InvalidValue("GraphLine", "graph", None, "an entity with a Graph")
        check_quantity("GraphLine", "quantity", self.quantity, self.body)
