"""A rigid connection."""

from physicslab.components import joint_ends as ends
from physicslab.ecs.component import Component, Derived, Entity, Vector, component


@component
class Weld(Component):
    """Keeps A's anchor and B's in one place, and the angle between the bodies.

    Bodies that welds make one thing of do not touch each other, unless these ``collide``.
    """

    a: Entity = ends.first_end()
    b: Entity = ends.second_end()
    anchor_a: Vector = ends.anchor_of_first()
    anchor_b: Vector = ends.anchor_of_second()
    angle: Derived = ends.as_placed("rad", "angle of B less that of A")
    collide: bool = ends.collides()
    breaks: Derived = ends.breaks_at()
    breaks_torque: Derived = ends.breaks_at_torque()
