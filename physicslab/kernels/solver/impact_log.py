"""The log of impacts: one record each, whichever way the impact was found."""

from physicslab.kernels import inlined
from physicslab.kernels.records import Impacts, Manifold, Point

__all__ = ["write_impact"]


@inlined
def write_impact(
    log: Impacts, k: int, manifold: Manifold, one: Point, two: Point, where: Point, time: float,
    x: float, y: float, speed: float, normal: float, tangent: float,
) -> None:  # fmt: skip
    """Write an impact at the point ``where`` of B, whose centre is at (x, y) [m], into the log.

    The two points of the pair had received the impulses ``normal`` and ``tangent`` [N s] in this step before.
    """
    record = log[k % len(log)]
    record.time, record.entity_a, record.entity_b = time, manifold.entity_a, manifold.entity_b
    record.wall, record.normal_x, record.normal_y = manifold.wall, manifold.normal_x, manifold.normal_y
    record.x, record.y, record.approach_speed = x + where.arm_bx, y + where.arm_by, speed
    record.normal_impulse = one.impact_normal + two.impact_normal - normal
    record.tangent_impulse = one.impact_tangent + two.impact_tangent - tangent
