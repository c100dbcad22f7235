"""A rope, which keeps two points from parting."""

from physicslab.components import joint_ends as ends
from physicslab.ecs.component import Component, Derived, Entity, Vector, component


@component
class Rope(Component):
    """Keeps the distance of A's anchor and B's at most as long as it is; it goes taut without bounce."""

    a: Entity = ends.first_end()
    b: Entity = ends.second_end()
    anchor_a: Vector = ends.anchor_of_first()
    anchor_b: Vector = ends.anchor_of_second()
    length: Derived = ends.as_placed("m", "the largest distance of the anchors", above=0.0)
    collide: bool = ends.collides()
    breaks: Derived = ends.breaks_at()
