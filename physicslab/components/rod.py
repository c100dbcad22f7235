"""A rod, which keeps a distance."""

from physicslab.components import joint_ends as ends
from physicslab.ecs.component import Component, Derived, Entity, Vector, component


@component
class Rod(Component):
    """Keeps the distance of A's anchor and B's."""

    a: Entity = ends.first_end()
    b: Entity = ends.second_end()
    anchor_a: Vector = ends.anchor_of_first()
    anchor_b: Vector = ends.anchor_of_second()
    length: Derived = ends.as_placed("m", "distance of the anchors", above=0.0)
    collide: bool = ends.collides()
    breaks: Derived = ends.breaks_at()
