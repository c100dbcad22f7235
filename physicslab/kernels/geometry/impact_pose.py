"""Where two bodies meet at the time of their impact: the normal and the arms of that moment."""

import math

from physicslab.kernels import always_inlined, inlined
from physicslab.kernels.arguments import Motion
from physicslab.kernels.constraint.pair import ContactFrame
from physicslab.kernels.geometry.cores import FACE, FLIPPED, VERTICES
from physicslab.kernels.geometry.manifold import circle_box
from physicslab.kernels.geometry.outline import lying, on_segment
from physicslab.kernels.geometry.segment import end_of
from physicslab.kernels.geometry.shapes import BOX, Shapes, has_own_way, is_chain, vertex
from physicslab.kernels.records import Manifold, Point

_FLIPPED_BOX = 33
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
    outline = lying(box, shapes, math.cos(angle), math.sin(angle))
    dx, dy = _apart(box, circle, motion, t)
    nx, ny, _px, _py, _separation = circle_box(dx, dy, outline, shapes.radius[circle])
    arm_x, arm_y = -shapes.radius[circle] * nx, -shapes.radius[circle] * ny
    return ContactFrame(nx, ny, dx + arm_x, dy + arm_y, arm_x, arm_y)


@inlined
def _circle_on_circle(manifold: Manifold, motion: Motion, shapes: Shapes, t: float) -> ContactFrame[float]:
    """Return where two circles meet."""
    dx, dy = _apart(manifold.a, manifold.b, motion, t)
    distance, nx, ny = math.sqrt(dx * dx + dy * dy), manifold.normal_x, manifold.normal_y
    if distance > 0.0:
        nx, ny = dx / distance, dy / distance
    x, y = shapes.radius[manifold.a] * nx, shapes.radius[manifold.a] * ny
    return ContactFrame(nx, ny, x, y, x - dx, y - dy)


@inlined
def _corner_on_face(
    manifold: Manifold, point: Point, motion: Motion, shapes: Shapes, t: float
) -> ContactFrame[float]:
    """Return where a corner meets a face: it turns with its body, and the normal with the face's."""
    a, b, angular = manifold.a, manifold.b, motion.angular
    # Points are half-way between the surfaces; a swept pair has its own where these meet.
    half = 0.5 * point.found_separation if manifold.swept == 0 and manifold.wall < 0 else 0.0
    dx, dy = _apart(a, b, motion, t)
    boxes = shapes.first[a] == BOX and shapes.first[b] == BOX and point.feature < FACE
    if manifold.wall < 0 and point.feature >= (_FLIPPED_BOX if boxes else FLIPPED):
        nx, ny = _turned(manifold.normal_x, manifold.normal_y, t * angular[b])
        radius = shapes.radius[a]
        back = half + radius
        x, y = point.arm_ax - back * manifold.normal_x, point.arm_ay - back * manifold.normal_y
        x, y = _turned(x, y, t * angular[a])
        x, y = x + radius * nx, y + radius * ny
        return ContactFrame(nx, ny, x, y, x - dx, y - dy)
    nx, ny = _turned(manifold.normal_x, manifold.normal_y, t * angular[a] if manifold.wall < 0 else 0.0)
    radius = shapes.radius[b]
    back = half + radius
    x, y = point.arm_bx + back * manifold.normal_x, point.arm_by + back * manifold.normal_y
    x, y = _turned(x, y, t * angular[b])
    x, y = x - radius * nx, y - radius * ny
    return ContactFrame(nx, ny, dx + x, dy + y, x, y)


@inlined
def _round_at(
    manifold: Manifold, motion: Motion, shapes: Shapes, i: int, k: int, t: float
) -> tuple[float, float, float]:
    """Return where a vertex of row i, or the centre of an end of a chain's segment, is from its centre [m].

    Then what rounds it [m], below zero about a centre outside.
    """
    angle = motion.angle[i] + t * motion.angular[i]
    if is_chain(shapes, i):
        segment = on_segment(lying(i, shapes, math.cos(angle), math.sin(angle)), manifold.wall)
        end = end_of(segment, shapes.pool, k)
        return end.x, end.y, -end.radius if end.hollow else end.radius
    x, y = vertex(shapes, i, k)
    x, y = _turned(x, y, angle)
    return x, y, shapes.radius[i]


@inlined
def _corner_on_corner(
    manifold: Manifold, point: Point, motion: Motion, shapes: Shapes, t: float
) -> ContactFrame[float]:
    """Return where the discs around two vertices meet, each of which turns with its body."""
    a, b, vertices = manifold.a, manifold.b, point.feature - VERTICES
    ax, ay, round_a = _round_at(manifold, motion, shapes, a, vertices % 8, t)
    bx, by, round_b = _round_at(manifold, motion, shapes, b, vertices // 8, t)
    dx, dy = _apart(a, b, motion, t)
    across_x, across_y = dx + bx - ax, dy + by - ay
    distance = math.sqrt(across_x * across_x + across_y * across_y)
    if round_a < 0.0 or round_b < 0.0:
        distance = -distance
    nx, ny = across_x / distance, across_y / distance
    reach = 0.5 * (distance + round_a - round_b)
    x, y = ax + reach * nx, ay + reach * ny
    return ContactFrame(nx, ny, x, y, x - dx, y - dy)


@always_inlined
def is_known(manifold: Manifold, point: Point, motion: Motion, shapes: Shapes) -> bool:
    """Whether normal and arms of a pair are those of the moment at which it meets.

    Those of discs are, and those of a disc and a box that does not turn; of rounded polygons, swept ones',
    and of any shapes those of an inner disc. Those of a pair that was not to meet, before other impacts, are
    not.
    """
    a, b, first, vertices = manifold.a, manifold.b, shapes.first, shapes.vertices
    if manifold.swept == 2:
        return False
    if manifold.wall >= 0:
        return bool(vertices[b] == 1)
    if point.feature >= FACE and manifold.swept == 1:  # what the sweep of any two shapes has found
        return True
    if not (has_own_way(shapes, a) and has_own_way(shapes, b)):
        return False
    if first[b] != BOX:
        return bool(first[a] != BOX or motion.angular[a] == 0.0)
    return bool(first[a] != BOX and motion.angular[b] == 0.0)


@inlined
def meeting_at(
    manifold: Manifold, point: Point, motion: Motion, shapes: Shapes, t: float
) -> ContactFrame[float]:
    """Return where a pair that is not known meets at the time t from now, each body moving as it does now.

    Both arms lead to one point: angular momentum is kept to rounding.
    """
    a, b, first, vertices = manifold.a, manifold.b, shapes.first, shapes.vertices
    if manifold.wall < 0:
        if vertices[a] == 1 and vertices[b] == 1:
            return _circle_on_circle(manifold, motion, shapes, t)
        if first[a] == BOX and vertices[b] == 1:
            return _circle_on_box(b, a, motion, shapes, t)
        if first[b] == BOX and vertices[a] == 1:
            nx, ny, ax, ay, bx, by = _circle_on_box(a, b, motion, shapes, t)
            return ContactFrame(-nx, -ny, bx, by, ax, ay)
        if point.feature >= VERTICES:
            return _corner_on_corner(manifold, point, motion, shapes, t)
    return _corner_on_face(manifold, point, motion, shapes, t)
