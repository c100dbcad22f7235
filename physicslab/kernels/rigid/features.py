"""Points where two bodies can touch: a vertex of one against a face or a vertex of another.

A body is its core of 1 to 8 vertices, rounded by a radius (:mod:`physicslab.kernels.geometry.shapes`).
Coordinates are packed as :meth:`physicslab.state.packed.StateLayout.of_rows` has them: x and y of every row,
then all angles, then the clock; behind it v has accounts, which go on as speeds do, and q has nothing. A
point is a row of whole numbers: its pair, the body ``ONE`` with its feature, the body ``OTHER`` with its
vertex, and what the point does. The normal leads from ONE to OTHER, the tangent is the normal turned counter-
clockwise.
"""

import math
from typing import Annotated, NamedTuple

import numpy as np
from numba import int64
from numpy.typing import NDArray

from physicslab.kernels import Numbers, Rows, Vectors, inlined, inlined_by_numba
from physicslab.kernels.constraint.pair import ContactFrame, PairVelocity, along_and_across, point_velocity
from physicslab.kernels.forces.force_calls import Calls
from physicslab.kernels.geometry.links import beside_arc, link_of
from physicslab.kernels.geometry.shapes import (
    MOST_VERTICES,
    Shapes,
    ShapesTuple,
    face,
    is_chain,
    named_shapes,
    vertex,
)
from physicslab.kernels.geometry.vertex_cone import beside_vertex
from physicslab.kernels.records import Pairs

PAIR, ONE, OTHER, FEATURE, VERTEX, GIVEN, STATUS, POINT_FIELDS = range(8)
"""The columns of a point: its pair; bodies and features; what it may do, and what it does."""
CORNER, WALL, JOINT, MOTOR = MOST_VERTICES, 2 * MOST_VERTICES, 2 * MOST_VERTICES + 4, 2 * MOST_VERTICES + 5
"""Where features of vertices and walls begin; those before are faces, from the vertex of that number on. Then
what limits of joints are, and motors."""
LINK = -1
"""The feature of the first link of a chain; that of the next is less by 1. As a VERTEX it is its number."""
FIRST_ROW = JOINT - WALL
"""From which number on the third column of a pair says that it is a row of a joint, and no wall."""
NORMAL, TANGENT, NX, NY = 0, 6, 3, 4
"""The columns of measures of a point that hold the gradients of its gap and of its way along the surface, by
x, y and angle of ONE, then of OTHER. By OTHER's x and y that of the gap is the normal."""
GAP, VN, VT, BIAS_N, BIAS_T, MARGIN, PX, PY, MU, RESTITUTION, MEASURES = range(12, 23)
"""The columns behind them: gap [m]; speeds along normal and tangent [m/s]; their rates at no acceleration
[m/s^2]; how far it is from the end of its feature [m]; where it is [m]; coefficients of friction and
restitution."""
FRICTION, CONTACTS, DRIVEN, JOINED, MOTORS = range(5)
"""What ``accounts`` of a scene hold: where those of friction, of contacts, of what is driven, of joints and
of motors begin behind the clock (:mod:`physicslab.kernels.forces.budget`); -1 where there is none."""

Points = Annotated[NDArray[np.int64], int64[:, ::1]]
"""An int64 array (n, POINT_FIELDS)."""


class RigidScene(NamedTuple):
    """Bodies that move, and bodies that may touch.

    The number of rows; inverse masses (3 rows,), damping, forces; shapes, walls of the bounds (4,) [m];
    pairs (n, 3), and of each the friction, restitution and smaller size [m] (n, 3); where accounts are (3,);
    the rows that joints keep in any case, their numbers and whole numbers
    (:mod:`physicslab.kernels.joints.rows`). Pairs that are rows have more coefficients
    (:mod:`physicslab.kernels.rigid.joint_points`).
    """

    rows: int
    inverse_mass: Numbers
    damping: Numbers
    calls: Calls
    shapes: Shapes
    walls: Numbers
    pairs: Pairs
    coefficients: Vectors
    accounts: Rows
    joint_numbers: Numbers
    joints: Rows


SceneTuple = tuple[int, Numbers, Numbers, Calls, ShapesTuple, Numbers, Pairs, Vectors, Rows, Numbers, Rows]


@inlined_by_numba
def named_scene(plain: SceneTuple) -> RigidScene:
    """Give names to a tuple."""
    return RigidScene(
        plain[0], plain[1], plain[2], plain[3], named_shapes(plain[4]), plain[5], plain[6], plain[7],
        plain[8], plain[9], plain[10],
    )  # fmt: skip


@inlined
def turned_by(scene: RigidScene, row: int, q: Numbers) -> tuple[float, float]:
    """Return cosine and sine of the angle of a body; those of 0 where a core of one vertex turns nothing."""
    if scene.shapes.vertices[row] == 1:
        return 1.0, 0.0
    return math.cos(q[2 * scene.rows + row]), math.sin(q[2 * scene.rows + row])


@inlined
def rate_along(rows: int, points: Points, measures: Vectors, i: int, gradient: int, values: Numbers) -> float:
    """Return how fast point number i opens or slides at given velocities, by a ``gradient`` of its measures.

    Or how these rates change at given accelerations, but for those at no acceleration.
    """
    one, other, at, end = points[i, ONE], points[i, OTHER], gradient, gradient + 3
    dx, dy = values[2 * other] - values[2 * one], values[2 * other + 1] - values[2 * one + 1]
    rate: float = measures[i, end] * dx + measures[i, end + 1] * dy
    rate += values[2 * rows + other] * measures[i, end + 2]
    rate += values[2 * rows + one] * measures[i, at + 2]
    if points[i, FEATURE] >= JOINT:  # a row of two terms pulls at its bodies in directions of their own
        rate += (measures[i, at] + measures[i, end]) * values[2 * one]
        rate += (measures[i, at + 1] + measures[i, end + 1]) * values[2 * one + 1]
    return rate


@inlined
def _round_link(shapes: Shapes, chain: int, k: int) -> tuple[float, float, float]:
    """Return the centre of an arc of a chain, or a corner, and its radius [m]."""
    link = link_of(shapes, chain, k)
    return link.x, link.y, link.size


@inlined
def _flat_link(shapes: Shapes, chain: int, k: int) -> tuple[float, float, float, float, float, float]:
    """Return normal, distance from the origin, length and beginning of a face of a chain [m]."""
    link = link_of(shapes, chain, k)
    return link.nx, link.ny, link.nx * link.x + link.ny * link.y, link.size, link.x, link.y


@inlined
def _within_arc(shapes: Shapes, chain: int, k: int, nx: float, ny: float, scale: float) -> float:
    """Return how far a normal, in a chain's own directions, is within the nearer end of an arc."""
    ahead, behind = beside_arc(link_of(shapes, chain, k), nx, ny)
    return scale * min(ahead, behind)


@inlined
def measure_contact(scene: RigidScene, points: Points, i: int, q: Numbers, v: Numbers, out: Vectors) -> None:
    """Measure point number i, which is of a contact: where it is, how it moves, and how that changes.

    By itself, at no acceleration. The rates follow by differentiating the gap twice, and the sliding speed
    of the material points once; the point itself moves over both bodies.
    """
    rows, shapes = scene.rows, scene.shapes
    one, other, feature = points[i, ONE], points[i, OTHER], points[i, FEATURE]
    chained = is_chain(shapes, other)
    if chained:
        vx, vy, radius = _round_link(shapes, other, points[i, VERTEX])
    else:
        (vx, vy), radius = vertex(shapes, other, points[i, VERTEX]), shapes.radius[other]
    spin, (c, s) = v[2 * rows + other], turned_by(scene, other, q)
    rho_x, rho_y = c * vx - s * vy, s * vx + c * vy
    cx, cy = q[2 * other] + rho_x, q[2 * other + 1] + rho_y
    cvx, cvy = v[2 * other] - spin * rho_y, v[2 * other + 1] + spin * rho_x
    if feature >= WALL:
        wall = feature - WALL
        nx = 1.0 if wall == 0 else (-1.0 if wall == 2 else 0.0)
        ny = 1.0 if wall == 1 else (-1.0 if wall == 3 else 0.0)
        edge = scene.walls[wall]
        out[i, GAP] = nx * (cx - edge) + ny * (cy - edge) - radius
        out[i, MARGIN] = math.inf
        turning, one_spin = 0.0, 0.0
        one_x, one_y, one_vx, one_vy = cx - radius * nx, cy - radius * ny, 0.0, 0.0
        out[i, BIAS_N] = -spin * spin * (nx * rho_x + ny * rho_y)
    else:
        one_x, one_y, one_vx, one_vy = q[2 * one], q[2 * one + 1], v[2 * one], v[2 * one + 1]
        one_spin = v[2 * rows + one]
        co, so = turned_by(scene, one, q)
        own, bend = shapes.radius[one], 0.0 if feature < CORNER else 1.0
        if feature < 0:
            bend = link_of(shapes, one, LINK - feature).bend
        if bend == 0.0:
            if feature < 0:
                fx, fy, distance, length, ux, uy = _flat_link(shapes, one, LINK - feature)
            else:
                fx, fy, distance, length = face(shapes, one, feature)
                ux, uy = vertex(shapes, one, feature)
            nx, ny = co * fx - so * fy, so * fx + co * fy
            dx, dy = cx - one_x, cy - one_y
            out[i, GAP] = nx * dx + ny * dy - distance - radius - own
            passed, start = nx * dy - ny * dx, fx * uy - fy * ux
            out[i, MARGIN] = min(passed - start, start + length - passed)
            if chained:
                within = _within_arc(
                    shapes, other, points[i, VERTEX], -c * nx - s * ny, s * nx - c * ny, shapes.reach[one]
                )
                out[i, MARGIN] = min(out[i, MARGIN], within)
            turning = one_spin
            along = nx * (cvy - one_vy) - ny * (cvx - one_vx)
            out[i, BIAS_N] = (
                2.0 * one_spin * along
                - one_spin * one_spin * (nx * dx + ny * dy)
                - spin * spin * (nx * rho_x + ny * rho_y)
            )
        else:
            if feature < 0:
                ux, uy, own = _round_link(shapes, one, LINK - feature)
            else:
                ux, uy = vertex(shapes, one, feature - CORNER)
            arm_x, arm_y = co * ux - so * uy, so * ux + co * uy
            dx, dy = cx - one_x - arm_x, cy - one_y - arm_y
            distance = math.sqrt(dx * dx + dy * dy)
            nx, ny = bend * dx / distance, bend * dy / distance
            out[i, GAP] = bend * (distance - own) - radius
            out[i, MARGIN] = math.inf
            if feature < 0:
                ahead_x, ahead_y = co * nx + so * ny, co * ny - so * nx
                out[i, MARGIN] = _within_arc(shapes, one, LINK - feature, ahead_x, ahead_y, distance)
            elif shapes.vertices[one] > 1:
                near, far = beside_vertex(shapes, one, feature - CORNER, co * dx + so * dy, co * dy - so * dx)
                out[i, MARGIN] = min(near, far)
            if shapes.vertices[other] > 1:
                back_x, back_y = -bend * dx, -bend * dy
                near, far = beside_vertex(
                    shapes, other, points[i, VERTEX], c * back_x + s * back_y, c * back_y - s * back_x
                )
                out[i, MARGIN] = min(out[i, MARGIN], min(near, far))
            dvx = cvx - one_vx + one_spin * arm_y
            dvy = cvy - one_vy - one_spin * arm_x
            across = nx * dvy - ny * dvx
            turning = bend * across / distance
            out[i, BIAS_N] = (
                across * turning
                - spin * spin * (nx * rho_x + ny * rho_y)
                + one_spin * one_spin * (nx * arm_x + ny * arm_y)
            )
    px, py = cx - radius * nx, cy - radius * ny
    ax, ay, bx, by = px - one_x, py - one_y, px - q[2 * other], py - q[2 * other + 1]
    # The moment arm of a unit force along the normal is -t . r, along the tangent n . r.
    out[i, NORMAL], out[i, NORMAL + 1], out[i, NORMAL + 2] = -nx, -ny, nx * ay - ny * ax
    out[i, NX], out[i, NY], out[i, NORMAL + 5] = nx, ny, -(nx * by - ny * bx)
    out[i, TANGENT], out[i, TANGENT + 1], out[i, TANGENT + 2] = ny, -nx, -(nx * ax + ny * ay)
    out[i, TANGENT + 3], out[i, TANGENT + 4], out[i, TANGENT + 5] = -ny, nx, nx * bx + ny * by
    moving = PairVelocity(one_vx, one_vy, one_spin, v[2 * other], v[2 * other + 1], spin)
    rx, ry = point_velocity(ContactFrame(nx, ny, ax, ay, bx, by), moving)
    out[i, VN], out[i, VT] = along_and_across(nx, ny, rx, ry)
    # The point moves with the vertex, and around it as the normal turns.
    pvx, pvy = cvx + radius * turning * ny, cvy - radius * turning * nx
    out[i, BIAS_T] = (
        spin * (nx * (pvx - v[2 * other]) + ny * (pvy - v[2 * other + 1]))
        - one_spin * (nx * (pvx - one_vx) + ny * (pvy - one_vy))
        - turning * out[i, VN]
    )
    out[i, PX], out[i, PY] = px, py
