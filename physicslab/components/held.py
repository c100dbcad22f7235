"""A body held by the hand."""

from physicslab.components.lengths import point
from physicslab.ecs.component import Component, Vector, component, field


@component
class Held(Component):
    """Marks a body that is held: infinitely heavy for contacts and forces until it is let go.

    One that joints hold, too, would tear them: it ``yields``, and keeps its mass.
    """

    grip: Vector = point(0.0, 0.0, "where it is held, in the body's own frame")
    yields: bool = field(default=False, meaning="whether it keeps its mass, and the hand pulls at it")
    pull: Vector = field(default=(0.0, 0.0), unit="N", meaning="force of the hand, where it yields")
