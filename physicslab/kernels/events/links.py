"""When a body in ballistic motion meets one link of a chain, and where it touches it then.

All is seen from the chain, which stays, in its own directions. Vertices of the body meet faces and arcs, its
faces arcs that bend outwards: lines, and circles about a centre, that are met from one side alone.
"""

import math

from physicslab.kernels import inlined
from physicslab.kernels.events import meeting
from physicslab.kernels.events.meeting import Course
from physicslab.kernels.geometry.links import Link, beside_arc, link_of
from physicslab.kernels.geometry.shapes import Shapes, face, vertex
from physicslab.kernels.geometry.vertex_cone import beside_vertex

_FACE = 8
"""Where the features of a body's faces begin; those before are its vertices. A face of the chain is all of
them."""
_DEEP = 0.1
"""Share of the size of a body beyond which it is not on a link that it is behind."""
_Turn = tuple[float, float]
"""Cosine and sine of the angle of the body against the chain."""


@inlined
def _lowest(shapes: Shapes, i: int, nx: float, ny: float, turn: _Turn) -> tuple[float, float, float]:
    """Return how low the core of row i reaches along a normal, and between which lengths across it [m]."""
    least, low, high, seam = math.inf, 0.0, 0.0, meeting.SEAM * shapes.reach[i]
    for j in range(shapes.vertices[i]):
        x, y = _corner(shapes, i, j, turn)
        height, along = nx * x + ny * y, nx * y - ny * x
        if height < least - seam:
            least, low, high = height, along, along
        elif height <= least + seam:
            least, low, high = min(least, height), min(low, along), max(high, along)
    return least, low, high


@inlined
def _corner(shapes: Shapes, i: int, j: int, turn: _Turn) -> tuple[float, float]:
    ux, uy = vertex(shapes, i, j)
    return turn[0] * ux - turn[1] * uy, turn[1] * ux + turn[0] * uy


@inlined
def _is_beside(shapes: Shapes, i: int, link: Link, x: float, y: float, turn: _Turn, seam: float) -> bool:
    """Whether what is lowest of a body at (x, y) is over a face, and not beyond one of its ends."""
    _, low, high = _lowest(shapes, i, link.nx, link.ny, turn)
    along = link.nx * (y - link.y) - link.ny * (x - link.x)
    return along + high >= -seam and along + low <= link.size + seam


@inlined
def _is_on_arc(
    shapes: Shapes, i: int, j: int, link: Link, dx: float, dy: float, turn: _Turn, seam: float
) -> bool:
    """Whether vertex j, (dx, dy) from the centre of an arc, is beside it, and what is nearest of the body."""
    nx, ny = link.bend * dx, link.bend * dy
    ahead, behind = beside_arc(link, nx, ny)
    if min(ahead, behind) < -seam or nx * (link.nx + link.mx) + ny * (link.ny + link.my) <= 0.0:
        return False
    if shapes.vertices[i] == 1:
        return True
    c, s = turn
    one, two = beside_vertex(shapes, i, j, -c * nx - s * ny, s * nx - c * ny)
    return min(one, two) >= -seam


@inlined
def _face_over(shapes: Shapes, i: int, j: int, link: Link, x: float, y: float, turn: _Turn) -> Link:
    """Return face j of a body at (x, y) as a link that the centre of an arc comes to, seen from the chain."""
    fx, fy, _, length = face(shapes, i, j)
    ux, uy = _corner(shapes, i, j, turn)
    nx, ny = turn[0] * fx - turn[1] * fy, turn[1] * fx + turn[0] * fy
    return Link(0.0, length, x + ux, y + uy, nx, ny, nx, ny)


@inlined
def _is_on_face(link: Link, side: Link, seam: float) -> bool:
    """Whether the centre of an arc is beside a face of a body, and this in a direction that the arc has."""
    along = side.nx * (link.y - side.y) - side.ny * (link.x - side.x)
    ahead, behind = beside_arc(link, -side.nx, -side.ny)
    faces = side.nx * (link.nx + link.mx) + side.ny * (link.ny + link.my) < 0.0
    return faces and min(ahead, behind) >= -meeting.ROUNDING and -seam <= along <= side.size + seam


@inlined
def gap_to_link(
    shapes: Shapes, chain: int, k: int, i: int, course: Course, turn: _Turn
) -> tuple[float, float, float, int]:
    """Return the gap of a body from a link that it is beside [m], infinity where it is not, at which feature.

    Between them come its two rates [m/s], [m/s^2]: the pull of an arc about a centre has what it takes to
    go on along it.
    """
    link, (dx, dy, ux, uy, wx, wy) = link_of(shapes, chain, k), course
    best, speed, pull, feature, radius = math.inf, 0.0, 0.0, -1, shapes.radius[i]
    if link.bend == 0.0:
        least, _, _ = _lowest(shapes, i, link.nx, link.ny, turn)
        height = link.nx * (dx - link.x) + link.ny * (dy - link.y)
        if height > 0.0 and _is_beside(shapes, i, link, dx, dy, turn, 0.0):
            best, feature = height + least - radius, 0
            speed, pull = link.nx * ux + link.ny * uy, link.nx * wx + link.ny * wy
        return best, speed, pull, feature
    if link.bend < 0.0 and radius >= link.size:
        return best, speed, pull, feature
    for j in range(shapes.vertices[i] if radius + link.size > 0.0 else 0):
        vx, vy = _corner(shapes, i, j, turn)
        vx, vy = dx + vx - link.x, dy + vy - link.y
        away = math.sqrt(vx * vx + vy * vy)
        gap = link.bend * (away - link.size) - radius
        if away > 0.0 and gap < best and _is_on_arc(shapes, i, j, link, vx, vy, turn, 0.0):
            best, feature = gap, j
            nx, ny = link.bend * vx / away, link.bend * vy / away
            across = nx * uy - ny * ux
            speed, pull = nx * ux + ny * uy, nx * wx + ny * wy + link.bend * across * across / away
    for j in range(shapes.vertices[i] if link.bend > 0.0 and shapes.vertices[i] > 1 else 0):
        side = _face_over(shapes, i, j, link, dx, dy, turn)
        gap = side.nx * (link.x - side.x) + side.ny * (link.y - side.y) - radius - link.size
        if gap < best and gap > -_DEEP * shapes.thin[i] and _is_on_face(link, side, 0.0):
            best, feature = gap, _FACE + j
            speed, pull = -(side.nx * ux + side.ny * uy), -(side.nx * wx + side.ny * wy)
    return best, speed, pull, feature


@inlined
def meet_link(
    shapes: Shapes, chain: int, k: int, i: int, course: Course, turn: _Turn, span: float, min_speed: float
) -> tuple[float, int]:
    """Return in how many seconds the body in row i meets link k, up to ``span``, and at which feature."""
    link, radius = link_of(shapes, chain, k), shapes.radius[i]
    seam = meeting.SEAM * (shapes.reach[chain] + shapes.reach[i])
    dx, dy, ux, uy, wx, wy = course
    min_rate = meeting.ROUNDING * (abs(ux) + abs(uy)) + min_speed
    gap, speed, pull, nearest = gap_to_link(shapes, chain, k, i, course, turn)
    if -2.0 * _DEEP * shapes.thin[i] < gap <= 0.0:
        if speed < -min_rate:
            return 0.0, nearest
        if pull < 0.0 and speed * speed <= -2.0 * pull * -gap:
            return max(speed, 0.0) / -pull, nearest
    best, feature = math.inf, -1
    if link.bend == 0.0:
        least, _, _ = _lowest(shapes, i, link.nx, link.ny, turn)
        gap = link.nx * (dx - link.x) + link.ny * (dy - link.y) + least - radius
        t = meeting.cross_line(gap, link.nx * ux + link.ny * uy, link.nx * wx + link.ny * wy, seam, min_rate)
        if t <= span:
            x, y = meeting.place_at(course, t)
            if _is_beside(shapes, i, link, x, y, turn, seam):
                best, feature = t, 0
        return best, feature
    if link.bend < 0.0 and radius >= link.size:
        return best, feature
    for j in range(shapes.vertices[i] if radius + link.size > 0.0 else 0):
        vx, vy = _corner(shapes, i, j, turn)
        way = Course(dx + vx - link.x, dy + vy - link.y, ux, uy, wx, wy)
        reach = link.size + link.bend * radius
        t = meeting.meet_circle(way, reach, min(best, span), min_speed, link.bend)
        if t < best:
            x, y = meeting.place_at(way, t)
            if _is_on_arc(shapes, i, j, link, x, y, turn, seam):
                best, feature = t, j
    for j in range(shapes.vertices[i] if link.bend > 0.0 and shapes.vertices[i] > 1 else 0):
        side = _face_over(shapes, i, j, link, dx, dy, turn)
        gap = side.nx * (link.x - side.x) + side.ny * (link.y - side.y) - radius - link.size
        speed, pull = -(side.nx * ux + side.ny * uy), -(side.nx * wx + side.ny * wy)
        t = meeting.cross_line(gap, speed, pull, seam, min_rate)
        if t < best and t <= span:
            x, y = meeting.place_at(course, t)
            if _is_on_face(link, _face_over(shapes, i, j, link, x, y, turn), seam):
                best, feature = t, _FACE + j
    return best, feature


@inlined
def curvature_of(shapes: Shapes, chain: int, k: int, i: int, feature: int) -> float:
    """Return by how much a path along a link bends towards the chain [1/m], of a body that meets it there."""
    link = link_of(shapes, chain, k)
    if link.bend == 0.0 or feature >= _FACE or link.size == 0.0:
        return 0.0
    bends: float = link.bend / (link.size + link.bend * shapes.radius[i])
    return bends


@inlined
def touch_link(
    shapes: Shapes, chain: int, k: int, i: int, feature: int, x: float, y: float, turn: _Turn
) -> tuple[float, float, float, float]:
    """Return the normal, and the point from the middle of a body at (x, y) that meets a link [m]."""
    link, radius = link_of(shapes, chain, k), shapes.radius[i]
    if link.bend == 0.0:
        least, low, high = _lowest(shapes, i, link.nx, link.ny, turn)
        along = link.nx * (y - link.y) - link.ny * (x - link.x)
        across = 0.5 * (max(-along, low) + min(link.size - along, high))
        depth = least - radius
        return link.nx, link.ny, depth * link.nx - across * link.ny, depth * link.ny + across * link.nx
    if feature >= _FACE:
        side = _face_over(shapes, i, feature - _FACE, link, x, y, turn)
        nx, ny = -side.nx, -side.ny
        return nx, ny, link.x + link.size * nx - x, link.y + link.size * ny - y
    vx, vy = _corner(shapes, i, feature, turn)
    dx, dy = x + vx - link.x, y + vy - link.y
    away = math.sqrt(dx * dx + dy * dy)
    nx, ny = link.bend * dx / away, link.bend * dy / away
    return nx, ny, vx - radius * nx, vy - radius * ny
