"""A rope over two wheels."""

from physicslab.components import joint_ends as ends
from physicslab.components.lengths import point
from physicslab.ecs.component import Component, Derived, Entity, Number, Vector, component, field


@component
class Pulley(Component):
    """A rope from A's anchor over two wheels, fixed points of the world, to B's anchor.

    l_a + ratio l_b is at most its length, with the distances of the anchors from the wheels.
    """

    a: Entity = ends.first_end()
    b: Entity = ends.second_end()
    anchor_a: Vector = ends.anchor_of_first()
    anchor_b: Vector = ends.anchor_of_second()
    wheel_a: Vector = point(0.0, 0.0, "the point of the world over which A hangs")
    wheel_b: Vector = point(0.0, 0.0, "the point of the world over which B hangs")
    ratio: Number = field(default=1.0, above=0.0, meaning="how often the rope goes to B")
    length: Derived = ends.as_placed("m", "the largest l_a + ratio l_b", above=0.0)
    collide: bool = ends.collides()
    breaks: Derived = ends.breaks_at()
