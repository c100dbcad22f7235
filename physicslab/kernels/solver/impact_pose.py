"""Where two bodies meet at the time of their impact: the normal and the arms of that moment."""

import math

from physicslab.kernels import fused, inlined
from physicslab.kernels.arguments import Motion
from physicslab.kernels.constraint.pair import ContactFrame
from physicslab.kernels.geometry.shapes import BOX, Shapes
from physicslab.kernels.narrow.manifold import circle_box
from physicslab.kernels.narrow.outline import Outline
from physicslab.kernels.records import Manifold, Point

_FLIPPED = 33
"""From this number on the features of two boxes are corners of A on a face of B."""


@inlined
def _turned(x: float, y: float, angle: float) -> tuple[float, float]:
    """Return a vector turned by an angle."""
    if angle == 0.0:
        return x, y
    c, s = math.cos(angle), math.sin(angle)
    return c * x - s * y, s * x + c * y


@inlined
def _apart(a: int, b: int, motion: Motion, t: float) -> tuple[float, float]:
    """Return the way from A's centre to B's at the time t from now [m]."""
    position, linear = motion.position, motion.linear
    return (
        position[b, 0] - position[a, 0] + t * (linear[b, 0] - linear[a, 0]),
        position[b, 1] - position[a, 1] + t * (linear[b, 1] - linear[a, 1]),
    )


@inlined
def _circle_on_box(circle: int, box: int, motion: Motion, shapes: Shapes, t: float) -> ContactFrame[float]:
    """Return where a circle, as B, meets a box, as A, that turns."""
    angle = motion.angle[box] + t * motion.angular[box]
    outline = Outline(True, math.cos(angle), math.sin(angle), shapes.half_x[box], shapes.half_y[box], 0.0)
    dx, dy = _apart(box, circle, motion, t)
    nx, ny, _px, _py, _separation = circle_box(dx, dy, outline, shapes.radius[circle])
    arm_x, arm_y = -shapes.radius[circle] * nx, -shapes.radius[circle] * ny
    return ContactFrame(nx, ny, dx + arm_x, dy + arm_y, arm_x, arm_y)


@inlined
def _corner_on_face(manifold: Manifold, point: Point, motion: Motion, t: float) -> ContactFrame[float]:
    """Return where a corner of a box meets a face: it turns with its body, and the normal with the face's."""
    a, b, angular = manifold.a, manifold.b, motion.angular
    # Points are half-way between the surfaces; a swept pair has its own where these meet.
    half = 0.5 * point.found_separation if manifold.swept == 0 else 0.0
    dx, dy = _apart(a, b, motion, t)
    if manifold.wall < 0 and point.feature >= _FLIPPED:
        nx, ny = _turned(manifold.normal_x, manifold.normal_y, t * angular[b])
        x, y = point.arm_ax - half * manifold.normal_x, point.arm_ay - half * manifold.normal_y
        x, y = _turned(x, y, t * angular[a])
        return ContactFrame(nx, ny, x, y, x - dx, y - dy)
    nx, ny = _turned(manifold.normal_x, manifold.normal_y, t * angular[a] if manifold.wall < 0 else 0.0)
    half = half if manifold.wall < 0 else 0.0
    x, y = point.arm_bx + half * manifold.normal_x, point.arm_by + half * manifold.normal_y
    x, y = _turned(x, y, t * angular[b])
    return ContactFrame(nx, ny, dx + x, dy + y, x, y)


@fused
def is_known(manifold: Manifold, motion: Motion, shapes: Shapes) -> bool:
    """Whether normal and arms of a pair are those of the moment at which it meets: of discs they are.

    A box must not turn for that.
    """
    a, b = manifold.a, manifold.b
    if shapes.first[b] != BOX:
        return bool(manifold.wall >= 0 or shapes.first[a] != BOX or motion.angular[a] == 0.0)
    return bool(manifold.wall < 0 and shapes.first[a] != BOX and motion.angular[b] == 0.0)


@inlined
def meeting_at(
    manifold: Manifold, point: Point, motion: Motion, shapes: Shapes, t: float
) -> ContactFrame[float]:
    """Return where a pair that is not known meets at the time t from now, each body moving as it does now.

    Both arms lead to one point: angular momentum is kept to rounding.
    """
    a, b, walled = manifold.a, manifold.b, manifold.wall >= 0
    if shapes.first[b] != BOX:
        return _circle_on_box(b, a, motion, shapes, t)
    if not walled and shapes.first[a] != BOX:
        nx, ny, ax, ay, bx, by = _circle_on_box(a, b, motion, shapes, t)
        return ContactFrame(-nx, -ny, bx, by, ax, ay)
    return _corner_on_face(manifold, point, motion, t)
