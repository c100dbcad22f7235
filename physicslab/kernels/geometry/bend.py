"""Round bends of chains: how fast the normal turns away from what slides along one.

A contact keeps its normal within a substep, and what slides along a bend comes to the next one with a
velocity that points into it. To remove that velocity would take energy each time; it is turned round
instead, as an arc of many short elastic impacts turns it, so that the speed stays.
"""

from physicslab.kernels import Vectors, inlined
from physicslab.kernels.geometry.cores import VERTICES
from physicslab.kernels.geometry.outline import Outline, Way, corner
from physicslab.kernels.geometry.segment import end_of
from physicslab.kernels.records import Manifold, Point


@inlined
def _bend(
    which: int, k: int, nx: float, ny: float, way: Way, turn: float, room: float, segment: Outline,
    body: Outline, pool: Vectors,
) -> float:  # fmt: skip
    """Return how far vertex k of a body is to leave the end of a segment in a substep, along a normal [m].

    That is half of the angle by which the normal turns in it, times the way along the bend; at most as far
    as the vertex comes towards the bend, which forces may have changed by ``room`` [m].
    """
    end = end_of(segment, pool, which)
    radius = end.radius - body.radius if end.hollow else -end.radius - body.radius
    if end.radius == 0.0 or radius == 0.0:
        return 0.0
    vx, vy = corner(k, body, pool)
    ux, uy = way.ux - turn * vy, way.uy + turn * vx
    along = abs(nx * uy - ny * ux)
    away = 0.5 * along * min(along / abs(radius), 1.0)
    return min(away, max(room - (ux * nx + uy * ny), 0.0)) if radius > 0.0 else -away


@inlined
def note_bends(
    manifold: Manifold, one: Point, two: Point, way: Way, turn: float, h: float, room: float,
    chain_is_a: bool, segment: Outline, body: Outline, pool: Vectors,
) -> None:  # fmt: skip
    """Note how fast the points of a pair of a chain's segment and a body leave it after ``h`` [m/s].

    The body turns by ``turn`` [rad] in that time. ``way`` is that of B against A.
    """
    sign = 1.0 if chain_is_a else -1.0
    moved = Way(way.dx, way.dy, sign * way.ux, sign * way.uy)
    nx, ny = sign * manifold.normal_x, sign * manifold.normal_y
    for j in range(manifold.count):
        point = one if j == 0 else two
        vertices = point.feature - VERTICES
        if 0 <= vertices < 64:
            low, high = vertices % 8, vertices // 8
            which, k = (low, high) if chain_is_a else (high, low)
            point.bend = _bend(which, k, nx, ny, moved, turn, room, segment, body, pool) / h
