"""A body held by the hand."""

from physicslab.components.lengths import point
from physicslab.ecs.component import Component, Vector, component


@component
class Held(Component):
    """Marks a body that is held: infinitely heavy for contacts and forces until it is let go."""

    grip: Vector = point(0.0, 0.0, "where it is held, in the body's own frame")
