"""A rod, which keeps a distance."""

from physicslab.components.joint_ends import (
    anchor_of_first,
    anchor_of_second,
    as_placed,
    breaks_at,
    collides,
    first_end,
    second_end,
)
from physicslab.ecs.component import Component, Derived, Vector, component


@component
class Rod(Component):
    """Keeps the distance of A's anchor and B's."""

    a: int | None = first_end()
    b: int | None = second_end()
    anchor_a: Vector = anchor_of_first()
    anchor_b: Vector = anchor_of_second()
    length: Derived = as_placed("m", "distance of the anchors", above=0.0)
    collide: bool = collides()
    breaks: Derived = breaks_at()
