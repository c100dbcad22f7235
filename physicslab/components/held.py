"""A body held by the hand."""

from physicslab.ecs.component import Component, Vector, component, field
from physicslab.ecs.fields import LENGTH_LIMIT


@component
class Held(Component):
    """Marks a body that is held: infinitely heavy for contacts and forces until it is let go."""

    grip: Vector = field(
        default=(0.0, 0.0),
        unit="m",
        limit=LENGTH_LIMIT,
        meaning="where it is held, in the body's own frame",
    )
