"""Which points of a body touch a chain, or would next: those of each link near it, by themselves.

Vertices of the body on faces and on arcs, and its faces on arcs that bend outwards. Where a link goes over
into the next one without a notch, a point is on one of them: the one that it comes on to.
"""

import math

from physicslab.kernels import Numbers, inlined
from physicslab.kernels.geometry import links
from physicslab.kernels.geometry.links import Link
from physicslab.kernels.geometry.shapes import Shapes, face, is_chain, vertex
from physicslab.kernels.geometry.vertex_cone import beside_vertex
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid.features import Points, RigidScene

_Lie = tuple[float, float, float, float, float, float, float]
"""Where a body is, seen from the chain [m]; cosine and sine of its angle against that; its velocity in the
chain's directions [m/s], and its spin [rad/s]."""


@inlined
def _seen(q: Numbers, v: Numbers, rows: int, chain: int, body: int) -> _Lie:
    """Return how a body lies and moves, seen from a chain, which stays."""
    c, s = math.cos(q[2 * rows + chain]), math.sin(q[2 * rows + chain])
    turned = q[2 * rows + body] - q[2 * rows + chain]
    dx, dy = q[2 * body] - q[2 * chain], q[2 * body + 1] - q[2 * chain + 1]
    vx, vy = v[2 * body], v[2 * body + 1]
    return (
        c * dx + s * dy, c * dy - s * dx, math.cos(turned), math.sin(turned),
        c * vx + s * vy, c * vy - s * vx, v[2 * rows + body],
    )  # fmt: skip


@inlined
def _corner(lie: _Lie, shapes: Shapes, body: int, j: int) -> tuple[float, float]:
    """Return where a vertex of the body is, seen from the chain [m]."""
    ux, uy = vertex(shapes, body, j)
    return lie[0] + lie[2] * ux - lie[3] * uy, lie[1] + lie[3] * ux + lie[2] * uy


@inlined
def _speed(lie: _Lie, x: float, y: float) -> tuple[float, float]:
    """Return how fast the place (x, y) of the body moves, seen from the chain [m/s]."""
    return lie[4] - lie[6] * (y - lie[1]), lie[5] + lie[6] * (x - lie[0])


@inlined
def _is_on(distance: float, rate: float, tie: float, sharp: bool) -> bool:
    """Whether a place is on a feature, by how far it is from its end and how fast that distance grows.

    Where the feature goes over into the next, only one may have it: within a ``tie``, that which it comes to.
    """
    if sharp or abs(distance) > tie:
        return distance >= -tie
    return rate >= 0.0


@inlined
def _is_sharp(shapes: Shapes, chain: int, k: int, step: int, radius: float) -> bool:
    """Whether a face ends in a notch or a corner there, for a body of no radius."""
    count = links.count_links(shapes, chain)
    beside = (k + step + count) % count
    link = links.link_of(shapes, chain, beside)
    return radius == 0.0 and (link.bend == 0.0 or link.size == 0.0)


@inlined
def _write(points: Points, n: int, pair: int, one: int, feature: int, other: int, corner: int) -> int:
    if n < len(points):
        points[n, F.PAIR], points[n, F.ONE], points[n, F.OTHER] = pair, one, other
        points[n, F.FEATURE], points[n, F.VERTEX] = feature, corner
        n += 1
    return n


@inlined
def _to_face(
    shapes: Shapes, points: Points, n: int, p: int, chain: int, k: int, link: Link, body: int, lie: _Lie,
    near: float, tie: float,
) -> int:  # fmt: skip
    """Find the vertices of a body that face a face, at most two."""
    nx, ny, radius, count = link.nx, link.ny, shapes.radius[body], shapes.vertices[body]
    if nx * (lie[0] - link.x) + ny * (lie[1] - link.y) <= 0.0:
        return n  # behind it
    lowest, least, second = 0, math.inf, -1
    for j in range(count):
        x, y = _corner(lie, shapes, body, j)
        height = nx * (x - link.x) + ny * (y - link.y)
        if height < least:
            lowest, least = j, height
    if least - radius > near:
        return n
    if count > 1:
        after, before = (lowest + 1) % count, (lowest + count - 1) % count
        ax, ay = _corner(lie, shapes, body, after)
        bx, by = _corner(lie, shapes, body, before)
        second = after if nx * (ax - bx) + ny * (ay - by) < 0.0 else before
    for turn in range(2):
        j = min(lowest, second) if turn == 0 and second >= 0 else max(lowest, second)
        if turn == 1 and second < 0:
            continue
        x, y = _corner(lie, shapes, body, j)
        along = nx * (y - link.y) - ny * (x - link.x)
        rate_x, rate_y = _speed(lie, x, y)
        rate = nx * rate_y - ny * rate_x
        starts = _is_on(along, rate, tie, _is_sharp(shapes, chain, k, -1, radius))
        if starts and _is_on(link.size - along, -rate, tie, _is_sharp(shapes, chain, k, 1, radius)):
            n = _write(points, n, p, chain, F.LINK - k, body, j)
    return n


@inlined
def _to_arc(
    shapes: Shapes, points: Points, n: int, p: int, chain: int, k: int, link: Link, body: int, lie: _Lie,
    near: float, tie: float,
) -> int:  # fmt: skip
    """Find the vertices of a body on an arc, or a corner, which a sharp vertex does not meet."""
    radius, count, bend = shapes.radius[body], shapes.vertices[body], link.bend
    if (radius == 0.0 and link.size == 0.0) or (bend < 0.0 and radius >= link.size):
        return n
    for j in range(count):
        x, y = _corner(lie, shapes, body, j)
        dx, dy = x - link.x, y - link.y
        distance = math.sqrt(dx * dx + dy * dy)
        gap = bend * (distance - link.size) - radius
        if distance == 0.0 or abs(gap) > near:
            continue
        nx, ny = bend * dx / distance, bend * dy / distance
        vx, vy = _speed(lie, x, y)
        ahead, behind = links.beside_arc(link, nx, ny)
        if nx * (link.nx + link.mx) + ny * (link.ny + link.my) <= 0.0:
            continue
        turning = nx * vy - ny * vx  # along the chain, be it against the turn of the normal
        if not _is_on(distance * ahead, turning, tie, False):
            continue
        if not _is_on(distance * behind, -turning, tie, False):
            continue
        if count > 1:
            c, s = lie[2], lie[3]
            wx, wy = -bend * dx, -bend * dy
            one, two = beside_vertex(shapes, body, j, c * wx + s * wy, c * wy - s * wx)
            wx, wy = lie[6] * wy - bend * vx, -lie[6] * wx - bend * vy
            one_rate, two_rate = beside_vertex(shapes, body, j, c * wx + s * wy, c * wy - s * wx)
            if not (_is_on(one, one_rate, tie, False) and _is_on(two, two_rate, tie, False)):
                continue
        n = _write(points, n, p, chain, F.LINK - k, body, j)
    return n


@inlined
def _faces_on_arc(
    shapes: Shapes, points: Points, n: int, p: int, chain: int, k: int, link: Link, body: int, lie: _Lie,
    near: float, tie: float,
) -> int:  # fmt: skip
    """Find the faces of a body that an arc or a corner touches, which bends outwards."""
    c, s = lie[2], lie[3]
    dx, dy = link.x - lie[0], link.y - lie[1]
    x, y = c * dx + s * dy, c * dy - s * dx  # the centre, seen from the body
    radius, rounded = shapes.radius[body], shapes.radius[body] + link.size > 0.0
    for j in range(shapes.vertices[body]):
        fx, fy, distance, length = face(shapes, body, j)
        gap = fx * x + fy * y - distance - radius - link.size
        if abs(gap) > near:
            continue
        nx, ny = -(c * fx - s * fy), -(s * fx + c * fy)
        ahead, behind = links.beside_arc(link, nx, ny)
        spin = lie[6] * shapes.reach[body]
        inside = nx * (link.nx + link.mx) + ny * (link.ny + link.my) > 0.0
        if link.size > 0.0:
            on = inside and _is_on(ahead * shapes.reach[body], spin, tie, False)
            on = on and _is_on(behind * shapes.reach[body], -spin, tie, False)
        else:  # what lies flat beside a corner rests on it
            on = inside and min(ahead, behind) * shapes.reach[body] >= -tie
        if not on:
            continue
        ux, uy = vertex(shapes, body, j)
        along = fx * (y - uy) - fy * (x - ux)
        vx, vy = _speed(lie, link.x, link.y)
        rate = -(fx * (c * vy - s * vx) - fy * (c * vx + s * vy))
        if rounded:
            if not (_is_on(along, rate, tie, False) and _is_on(length - along, -rate, tie, False)):
                continue
        elif not (along > tie and length - along > tie):
            continue
        n = _write(points, n, p, body, j, chain, k)
    return n


@inlined
def find_chain_points(
    scene: RigidScene, p: int, q: Numbers, v: Numbers, points: Points, tie: float
) -> tuple[int, float]:
    """Write the points where pair ``p``, of which one is a chain, touches or would; return how many.

    And infinity, as :func:`physicslab.kernels.rigid.detect.find_points` does.
    """
    shapes, near, n = scene.shapes, scene.coefficients[p, 2], 0
    chain, body = scene.pairs[p, 0], scene.pairs[p, 1]
    if not is_chain(shapes, chain):
        chain, body = body, chain
    lie = _seen(q, v, scene.rows, chain, body)
    count, room = links.count_links(shapes, chain), shapes.reach[body] + near
    k = links.next_near(shapes, chain, 0, lie[0], lie[1], room)
    while k < count:
        link = links.link_of(shapes, chain, k)
        if link.bend == 0.0:
            n = _to_face(shapes, points, n, p, chain, k, link, body, lie, near, tie)
        else:
            n = _to_arc(shapes, points, n, p, chain, k, link, body, lie, near, tie)
            if link.bend > 0.0 and shapes.vertices[body] > 1:
                n = _faces_on_arc(shapes, points, n, p, chain, k, link, body, lie, near, tie)
        k = links.next_near(shapes, chain, k + 1, lie[0], lie[1], room)
    return n, math.inf


@inlined
def distance_to_chain(scene: RigidScene, chain: int, body: int, q: Numbers, enough: float) -> float:
    """Return how far a body is at least from a chain [m]; one above ``enough`` is not the best."""
    rows, reach = scene.rows, scene.shapes.reach[body]
    c, s = math.cos(q[2 * rows + chain]), math.sin(q[2 * rows + chain])
    dx, dy = q[2 * body] - q[2 * chain], q[2 * body + 1] - q[2 * chain + 1]
    away = links.distance_to_links(scene.shapes, chain, c * dx + s * dy, c * dy - s * dx, enough + reach)
    apart: float = away - reach
    return apart


@inlined
def _goes_on(shapes: Shapes, points: Points, i: int, others: Points, k: int) -> bool:
    """Whether point i, of a chain, goes over into point k of the same pair as it moves along."""
    for side in range(2):
        if points[i, F.ONE] != others[k, F.ONE]:
            return False
        chain = points[i, F.ONE] if side == 0 else points[i, F.OTHER]
        if not is_chain(shapes, chain):
            continue
        if side == 0:
            same = points[i, F.VERTEX] == others[k, F.VERTEX]
            one, other = F.LINK - points[i, F.FEATURE], F.LINK - others[k, F.FEATURE]
        else:
            same = points[i, F.FEATURE] == others[k, F.FEATURE]
            one, other = points[i, F.VERTEX], others[k, F.VERTEX]
        return same and links.are_joined(shapes, chain, one, other)
    return False


@inlined
def is_closed_on_chain(shapes: Shapes, points: Points, count: int, others: Points, k: int) -> bool:
    """Whether point k of ``others``, of a pair with a chain, is among ``count`` closed points.

    Or goes over into one of them; but a vertex touches each link by itself.
    """
    for i in range(count):
        if points[i, F.PAIR] != others[k, F.PAIR]:
            continue
        same = True
        for column in range(F.GIVEN):
            same = same and points[i, column] == others[k, column]
        if same or _goes_on(shapes, points, i, others, k):
            return True
    return False
