"""A graph in the window, and its lines."""

from typing import ClassVar

from physicslab.components.quantities import QUANTITIES, carrier_of, check_quantity, why_not_of
from physicslab.ecs.component import Component, Entity, InvalidValue, component, field

TIME = "time"
"""The quantity on the horizontal axis of most graphs."""


@component
class Graph(Component):
    """A plot of quantities against time, or against a quantity. Each line is an entity with a GraphLine."""

    physical: ClassVar[bool] = False
    across: str = field(
        default=TIME, choices=(TIME, *QUANTITIES), meaning="what stands on the horizontal axis"
    )
    body: Entity = field(
        default=None, meaning="body, joint or spring of what stands there; the world where absent"
    )
    side: str = field(default="right", choices=("left", "right"), meaning="where in the window it is")

    def references(self) -> dict[str, str]:
        """Return which component the body must have."""
        return {"body": carrier_of(self.across)}

    def validate(self) -> None:
        """Check that the body, or the world, has the quantity."""
        allowed = None if self.across == TIME else why_not_of(self.across, self.body)
        if allowed is not None:
            raise InvalidValue("Graph", "across", self.across, f'"{TIME}", or {allowed}')


@component
class GraphLine(Component):
    """A quantity of a body, a joint, a spring or the world in a graph, on an entity of its own."""

    physical: ClassVar[bool] = False
    graph: Entity = field(meaning="the entity with the Graph")
    quantity: str = field(choices=tuple(QUANTITIES), meaning="what is plotted")
    body: Entity = field(default=None, meaning="whose quantity it is; the world's where absent")

    def references(self) -> dict[str, str]:
        """Return which component the graph and the body must have."""
        return {"graph": "Graph", "body": carrier_of(self.quantity)}

    def validate(self) -> None:
        """Check that there is a graph, and that the body, or the world, has the quantity."""
        if self.graph is None:
            raise InvalidValue("GraphLine", "graph", None, "an entity with a Graph")
        check_quantity("GraphLine", self.quantity, self.body)
