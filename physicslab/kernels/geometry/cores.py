"""Where two rounded polygons touch, whatever their numbers of vertices: a box, a capsule, a disc beside one.

Separating axes find the face from which all of the other core is farthest; its nearest edge is clipped to
that face (Ericson, Real-Time Collision Detection, 2005, 5.1.9 and 5.2). For rounded ones whose vertices are
nearest, these are the discs that touch. Coordinates are relative to A's centre.
"""

import math
from typing import NamedTuple

from physicslab.kernels import Vectors, always_inlined, inlined
from physicslab.kernels.geometry.manifold import ALIKE, FAVOUR, LEVEL, Corner, clipped
from physicslab.kernels.geometry.outline import Outline, Way, corner

FACE, FLIPPED, VERTICES = 65, 129, 200
"""From these numbers on features are vertices on faces of A (65 + vertex + 8 face), vertices on faces of B,
and pairs of vertices. Those of two boxes end before."""
_ENDS = 1e-6
"""Share of the radius by which vertices must be farther than faces to be what is nearest."""
_SLACK = 2e-3
"""Share of the radius by which the nearest edge may pass the ends of a face: more than that hides."""
_TIE = 1e-9
"""Share of the smallest width by which it may end before a face begins, as where vertices meet head-on."""
_ALONG = 0.95
"""Least cosine of the angle between a face and the way between two ends at which the other ones may touch."""


class Touch(NamedTuple):
    """The gap of two outlines [m], no more than their distance; the normal from A to B; up to two points."""

    gap: float
    nx: float
    ny: float
    points: int
    one: Corner
    two: Corner


@inlined
def _normal(k: int, outline: Outline, pool: Vectors) -> tuple[float, float, float, float, float]:
    """Return the outward normal of face k of a core, its distance [m], and the vertex at which it begins."""
    x, y = corner(k, outline, pool)
    mx, my = _own_normal(k, outline, pool)
    nx, ny = outline.c * mx - outline.s * my, outline.s * mx + outline.c * my
    return nx, ny, nx * x + ny * y, x, y


@always_inlined
def _own_normal(k: int, outline: Outline, pool: Vectors) -> tuple[float, float]:
    """Return the outward normal of face k of a core, in its own directions."""
    at = outline.first + k
    nx, ny = pool[at, 2], pool[at, 3]
    if nx == 0.0 and ny == 0.0:
        to = outline.first + (k + 1) % outline.vertices
        nx = outline.half_y * (pool[to, 1] - pool[at, 1])
        ny = outline.half_x * (pool[at, 0] - pool[to, 0])
        length = math.sqrt(nx * nx + ny * ny)
        nx, ny = nx / length, ny / length
    return nx, ny


class _Beside(NamedTuple):
    """Where B's centre is, in A's directions [m], and cosine and sine of how far B is turned from A."""

    x: float
    y: float
    c: float
    s: float


@always_inlined
def _beside(x: float, y: float, a: Outline, b: Outline) -> _Beside:
    """Return how B, which is at (x, y), lies beside A."""
    return _Beside(a.c * x + a.s * y, a.c * y - a.s * x, a.c * b.c + a.s * b.s, a.c * b.s - a.s * b.c)


@always_inlined
def lowest(mx: float, my: float, outline: Outline, pool: Vectors) -> float:
    """Return where a core begins along a direction that is given in its own directions [m]."""
    low, mx, my = math.inf, outline.half_x * mx, outline.half_y * my
    for j in range(outline.first, outline.first + outline.vertices):
        low = min(low, mx * pool[j, 0] + my * pool[j, 1])
    return low


@always_inlined
def _clear_of(k: int, lies: _Beside, a: Outline, b: Outline, pool: Vectors) -> float:
    """Return how far all of the core of B, which ``lies`` beside A, is beyond face k of that of A [m]."""
    nx, ny = _own_normal(k, a, pool)
    from_x, from_y = a.half_x * pool[a.first + k, 0], a.half_y * pool[a.first + k, 1]
    nearest = lowest(lies.c * nx + lies.s * ny, lies.c * ny - lies.s * nx, b, pool)
    clear: float = nearest + (nx * (lies.x - from_x) + ny * (lies.y - from_y))
    return clear


@inlined
def _farthest_face(lies: _Beside, a: Outline, b: Outline, pool: Vectors) -> tuple[float, int]:
    """Return the face of A from which all of the core of B is farthest, and before that how far [m]."""
    gap, face = -math.inf, 0
    if a.vertices > 1:
        for k in range(a.vertices):
            clear = _clear_of(k, lies, a, b, pool)
            if clear > gap:
                gap, face = clear, k
    return gap, face


@inlined
def _best_face(
    dx: float, dy: float, a: Outline, b: Outline, pool: Vectors, old: int
) -> tuple[float, int, bool]:
    """Return the largest gap of two cores along a face's normal, that face, and whether it is one of B's.

    The face of an old point stays unless another one is better by a little.
    """
    of_b, of_a = _beside(dx, dy, a, b), _beside(-dx, -dy, b, a)
    gap, face = _farthest_face(of_b, a, b, pool)
    gap_b, face_b = _farthest_face(of_a, b, a, pool)
    smallest, flip = min(a.thin, b.thin), False
    if gap_b > gap + ALIKE * smallest:
        gap, face, flip = gap_b, face_b, True
    if FACE <= old < VERTICES:
        held, held_flip = (old - FACE) // 8 % 8, old >= FLIPPED
        one, other, lies = (b, a, of_a) if held_flip else (a, b, of_b)
        held_gap = _clear_of(held, lies, one, other, pool)
        if gap <= held_gap + FAVOUR * smallest:
            gap, face, flip = held_gap, held, held_flip
    return gap, face, flip


@inlined
def nearest_edge(nx: float, ny: float, outline: Outline, pool: Vectors) -> int:
    """Return the edge of a core whose outward normal is most opposed to a normal."""
    best, least = 0, math.inf
    mx, my = outline.c * nx + outline.s * ny, outline.c * ny - outline.s * nx
    if outline.vertices > 1:
        for k in range(outline.vertices):
            ox, oy = _own_normal(k, outline, pool)
            if ox * mx + oy * my < least:
                best, least = k, ox * mx + oy * my
    return best


@inlined
def _shares(rx: float, ry: float, ux: float, uy: float, wx: float, wy: float) -> tuple[float, float]:
    """Return the shares of two edges u and w at which they are nearest; u begins r from w, maybe a point."""
    a, e, f, c = ux * ux + uy * uy, wx * wx + wy * wy, wx * rx + wy * ry, ux * rx + uy * ry
    if e <= 0.0:
        return min(max(-c / a, 0.0), 1.0), 0.0
    b = ux * wx + uy * wy
    across = a * e - b * b
    s = min(max((b * f - c * e) / across, 0.0), 1.0) if across > 1e-12 * a * e else 0.0
    t = (b * s + f) / e
    if t < 0.0:
        return min(max(-c / a, 0.0), 1.0), 0.0
    if t > 1.0:
        return min(max((b - c) / a, 0.0), 1.0), 1.0
    return s, t


@always_inlined
def _clipped(
    rx: float, ry: float, fx: float, fy: float, wx: float, wy: float, slack: float, tie: float
) -> tuple[float, float]:
    """Return between which shares an edge w is beside a face f, which it begins r from."""
    length = math.sqrt(fx * fx + fy * fy)
    tx, ty = fx / length, fy / length
    along, run, side = rx * tx + ry * ty - 0.5 * length, wx * tx + wy * ty, 0.5 * length + slack
    start, end = clipped(along, along + run, side if abs(run) > 0.0 else side + tie)
    if abs(run) > 0.0 and start > end >= start - tie / abs(run):
        end = start
    return start, end


@inlined
def _slides_over(
    gap: float, radius: float, nx: float, ny: float, ex: float, ey: float, ux: float, uy: float
) -> bool:
    """Whether rounded ends meet a vertex that is hardly higher than the face with normal n beside it.

    The next tile of a floor is no step: they touch it as if that face went on. (ex, ey) leads from the vertex
    to what comes on, by (ux, uy).
    """
    down = ux * nx + uy * ny
    along_x, along_y = ux - down * nx, uy - down * ny
    along = math.sqrt(along_x * along_x + along_y * along_y)
    return gap > (1.0 - LEVEL) * radius and along > abs(down) and along_x * ex + along_y * ey < 0.0


@inlined
def touch_cores(way: Way, a: Outline, b: Outline, pool: Vectors, margin: float, old: int) -> Touch:
    """Return where two rounded polygons touch, of which at most one is a disc.

    ``way`` leads from A's centre to B's; ``old`` is the feature of a point that they have had, or 0. Points
    are half-way between the surfaces, and there are none where the gap exceeds ``margin``.
    """
    dx, dy, ux, uy = way
    none, both = Corner(0.0, 0.0, 0.0, 0), a.radius + b.radius
    gap, face, flip = _best_face(dx, dy, a, b, pool, old)
    # Seen from where the face is: at (0, 0), the other one at (x, y).
    one, other, x, y = (b, a, -dx, -dy) if flip else (a, b, dx, dy)
    sign, from_x, from_y = (-1.0, dx, dy) if flip else (1.0, 0.0, 0.0)
    nx, ny, distance, px, py = _normal(face, one, pool)
    if gap - both > margin:
        return Touch(gap - both, sign * nx, sign * ny, 0, none, none)
    next_face, edge = (face + 1) % one.vertices, nearest_edge(nx, ny, other, pool)
    next_edge = (edge + 1) % other.vertices
    ex, ey = corner(next_face, one, pool)
    qx, qy = corner(edge, other, pool)
    rx, ry = corner(next_edge, other, pool)
    qx, qy, rx, ry = x + qx, y + qy, x + rx, y + ry
    fx, fy, wx, wy = ex - px, ey - py, rx - qx, ry - qy
    slender = one.vertices == 2 and other.vertices < 3
    if both > 0.0 and (gap > 0.0 or slender):
        s, t = _shares(px - qx, py - qy, fx, fy, wx, wy)
        kx, ky = qx + t * wx - px - s * fx, qy + t * wy - py - s * fy
        apart = math.sqrt(kx * kx + ky * ky)
        at_ends = (s == 0.0 or s == 1.0) and (t == 0.0 or t == 1.0)
        if at_ends and apart > max(gap, 0.0) + _ENDS * both:
            separation, mx, my = apart - both, kx / apart, ky / apart
            slides = _slides_over(gap, both, nx, ny, kx, ky, sign * ux, sign * uy)
            if separation > (_ENDS * both if slides else margin):
                return Touch(separation, sign * mx, sign * my, 0, none, none)
            if slides:
                separation, mx, my = gap - both, nx, ny
            vertex, tip = (next_face if s > 0.0 else face), (next_edge if t > 0.0 else edge)
            feature = VERTICES + (tip + 8 * vertex if flip else vertex + 8 * tip)
            reach = one.radius + 0.5 * separation
            first = Corner(
                from_x + px + s * fx + reach * mx, from_y + py + s * fy + reach * my, separation, feature
            )
            points, second = 1, none
            if gap > _ALONG * apart:
                start, end = _clipped(qx - px, qy - py, fx, fy, wx, wy, _SLACK * both, 0.0)
                far = end if t == 0.0 else start
                second = on_face(far, qx, qy, wx, wy, nx, ny, distance, one.radius, other.radius)
                second = Corner(
                    second.x + from_x, second.y + from_y, second.separation,
                    (FLIPPED if flip else FACE) + 8 * face + (next_edge if t == 0.0 else edge),
                )  # fmt: skip
                points = 2 if start < end and second.separation <= margin else 1
            return Touch(separation, sign * mx, sign * my, points, first, second)
    start, end = _clipped(
        qx - px, qy - py, fx, fy, wx, wy, _SLACK * both, _TIE * min(a.thin, b.thin)
    )  # fmt: skip
    if start > end:
        return Touch(gap - both, sign * nx, sign * ny, 0, none, none)
    feature = (FLIPPED if flip else FACE) + 8 * face
    first = on_face(start, qx, qy, wx, wy, nx, ny, distance, one.radius, other.radius)
    second = on_face(end, qx, qy, wx, wy, nx, ny, distance, one.radius, other.radius)
    first = Corner(first.x + from_x, first.y + from_y, first.separation, feature + edge)
    second = Corner(second.x + from_x, second.y + from_y, second.separation, feature + next_edge)
    if other.vertices == 1 or second.separation > margin:
        return Touch(gap - both, sign * nx, sign * ny, 1 if first.separation <= margin else 0, first, none)
    if first.separation > margin:
        return Touch(gap - both, sign * nx, sign * ny, 1, second, none)
    return Touch(gap - both, sign * nx, sign * ny, 2, first, second)


@inlined
def on_face(
    share: float, qx: float, qy: float, wx: float, wy: float, nx: float, ny: float, distance: float,
    radius: float, rounding: float,
) -> Corner:  # fmt: skip
    """Return the point of an edge at a share of it, half-way to the surface of a face with a radius."""
    x, y = qx + share * wx, qy + share * wy
    clear = nx * x + ny * y - distance
    back = 0.5 * (clear - radius + rounding)
    return Corner(x - back * nx, y - back * ny, clear - radius - rounding, 0)
