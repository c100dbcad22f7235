"""Points of wide contacts that are met later within the step: they are found once in it."""

from physicslab.kernels import inlined
from physicslab.kernels.arguments import Motion
from physicslab.kernels.constraint.pair import frame_of, point_state, velocity_of
from physicslab.kernels.records import Manifold, Point


@inlined
def put_on_surfaces(manifold: Manifold, one: Point, two: Point) -> None:
    """Move points that lie in gaps onto the surface of each body: where these close, both are one point."""
    for j in range(manifold.count):
        point = one if j == 0 else two
        half = 0.5 * max(point.separation, 0.0)
        point.arm_ax -= half * manifold.normal_x
        point.arm_ay -= half * manifold.normal_y
        point.arm_bx += half * manifold.normal_x
        point.arm_by += half * manifold.normal_y


@inlined
def bounces_within(manifold: Manifold, one: Point, two: Point, motion: Motion, span: float) -> bool:
    """Whether a second point, not met yet, comes within ``span`` seconds where it may bounce."""
    if manifold.count < 2 or manifold.restitution == 0.0:
        return False
    v = velocity_of(motion.linear, motion.angular, manifold.a, manifold.b)
    for j in range(2):
        point = one if j == 0 else two
        opens = point_state(frame_of(manifold, point), v).v
        if point.normal_impulse == 0.0 and 0.0 < point.separation < -span * opens:
            return True
    return False
