"""Points where two bodies can touch: a corner or a centre of one against a face, corner or centre of another.

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

from physicslab.kernels import Numbers, Rows, Vectors, fused, inlined
from physicslab.kernels.constraint.pair import ContactFrame, PairVelocity, along_and_across, point_velocity
from physicslab.kernels.forces.force_calls import Calls
from physicslab.kernels.records import Pairs

__all__ = [
    "BIAS_N", "BIAS_T", "BOX", "CENTRE", "CONTACTS", "CORNER", "DRIVEN", "FEATURE", "GAP", "GIVEN", "HEIGHT",
    "KIND", "MARGIN", "MEASURES", "MU", "NA", "NB", "NX", "NY", "ONE", "OTHER", "OUTLINE_FIELDS", "PAIR",
    "POINT_FIELDS", "PX", "PY", "RADIUS", "REACH", "RESTITUTION", "RUBBING", "STATUS", "TA", "TB", "VERTEX",
    "VN", "VT", "WALL", "WIDTH", "Points", "Scene", "SceneTuple", "face_of", "measure", "named_scene",
    "vertex_of",
]  # fmt: skip

PAIR, ONE, OTHER, FEATURE, VERTEX, GIVEN, STATUS, POINT_FIELDS = range(8)
"""The columns of a point: its pair; bodies and features; what it may do, and what it does."""
CENTRE, CORNER, WALL = 4, 5, 9
"""Features: faces 0 to 3 of a box (its right, top, left and bottom), the centre of a disc, corners 5 to 8 of
a box, walls 9 to 12. Vertices: corners 0 to 3 of a box, counter-clockwise from the upper right; the
centre."""
NX, NY, TA, TB, NA, NB, GAP, VN, VT, BIAS_N, BIAS_T, MARGIN, PX, PY, MU, RESTITUTION, MEASURES = range(17)
"""The columns of measures of a point: normal; arms of ONE and OTHER along the tangent and the normal [m]; gap
[m]; speeds along both [m/s]; their rates at no acceleration [m/s^2]; how far it is from the end of its
feature [m]; where it is [m]; coefficients of friction and restitution."""
KIND, RADIUS, WIDTH, HEIGHT, REACH, OUTLINE_FIELDS = range(6)
"""The columns of outlines (rows, 5): kind of shape, lengths [m], largest distance from the centre [m]."""
BOX = 2.0
"""The kind of a box."""
RUBBING, CONTACTS, DRIVEN = range(3)
"""What ``accounts`` of a scene hold: where those of friction, of contacts and of what is driven begin behind
the clock (:mod:`physicslab.kernels.forces.bookings`); -1 where nothing is driven."""

Points = Annotated[NDArray[np.int64], int64[:, ::1]]
"""An int64 array (n, POINT_FIELDS)."""


class Scene(NamedTuple):
    """What moves, and what may touch.

    The number of rows; inverse masses (3 rows,), damping, forces; outlines, walls of the bounds (4,) [m];
    pairs (n, 3), and of each the friction, restitution and smaller size [m] (n, 3); where accounts are (3,);
    the rows of joints, their numbers and whole numbers (:mod:`physicslab.kernels.constraint.joint_rows`).
    """

    rows: int
    inverse_mass: Numbers
    damping: Numbers
    calls: Calls
    outlines: Vectors
    walls: Numbers
    pairs: Pairs
    coefficients: Vectors
    accounts: Rows
    joint_numbers: Numbers
    joints: Rows


SceneTuple = tuple[int, Numbers, Numbers, Calls, Vectors, Numbers, Pairs, Vectors, Rows, Numbers, Rows]


@fused
def named_scene(plain: SceneTuple) -> Scene:
    """Give names to a tuple."""
    return Scene(
        plain[0], plain[1], plain[2], plain[3], plain[4], plain[5], plain[6], plain[7], plain[8], plain[9],
        plain[10],
    )  # fmt: skip


@inlined
def vertex_of(outlines: Vectors, row: int, vertex: int) -> tuple[float, float, float]:
    """Return a vertex in the body's own directions [m], and the radius around it [m]."""
    if vertex == CENTRE:
        return 0.0, 0.0, outlines[row, RADIUS]
    x, y = 0.5 * outlines[row, WIDTH], 0.5 * outlines[row, HEIGHT]
    return (x if vertex == 0 or vertex == 3 else -x), (y if vertex < 2 else -y), 0.0


@inlined
def face_of(outlines: Vectors, row: int, face: int) -> tuple[float, float, float, float]:
    """Return the outward normal of a face in the body's own directions, its distance, its half length."""
    x, y = 0.5 * outlines[row, WIDTH], 0.5 * outlines[row, HEIGHT]
    if face == 0:
        return 1.0, 0.0, x, y
    if face == 1:
        return 0.0, 1.0, y, x
    if face == 2:
        return -1.0, 0.0, x, y
    return 0.0, -1.0, y, x


@inlined
def measure(scene: Scene, points: Points, i: int, q: Numbers, v: Numbers, out: Vectors) -> None:
    """Measure point number i in a state: where it is, how it moves, and how that changes at no acceleration.

    The rates follow by differentiating the gap twice, and the sliding speed of the material points once; the
    point itself moves over both bodies.
    """
    rows, outlines = scene.rows, scene.outlines
    one, other, feature = points[i, ONE], points[i, OTHER], points[i, FEATURE]
    vx, vy, radius = vertex_of(outlines, other, points[i, VERTEX])
    angle, spin = q[2 * rows + other], v[2 * rows + other]
    c, s = math.cos(angle), math.sin(angle)
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
        out[i, NX], out[i, NY], out[i, TA], out[i, NA] = nx, ny, 0.0, 0.0
        turning, one_spin = 0.0, 0.0
        one_x, one_y, one_vx, one_vy = cx - radius * nx, cy - radius * ny, 0.0, 0.0
        out[i, BIAS_N] = -spin * spin * (nx * rho_x + ny * rho_y)
    else:
        one_x, one_y, one_vx, one_vy = q[2 * one], q[2 * one + 1], v[2 * one], v[2 * one + 1]
        one_spin = v[2 * rows + one]
        co, so = math.cos(q[2 * rows + one]), math.sin(q[2 * rows + one])
        if feature < CENTRE:
            fx, fy, distance, half = face_of(outlines, one, feature)
            nx, ny = co * fx - so * fy, so * fx + co * fy
            dx, dy = cx - one_x, cy - one_y
            out[i, GAP] = nx * dx + ny * dy - distance - radius
            out[i, MARGIN] = half - abs(nx * dy - ny * dx)
            turning = one_spin
            along = nx * (cvy - one_vy) - ny * (cvx - one_vx)
            out[i, BIAS_N] = (
                2.0 * one_spin * along
                - one_spin * one_spin * (nx * dx + ny * dy)
                - spin * spin * (nx * rho_x + ny * rho_y)
            )
        else:
            ux, uy, own = vertex_of(outlines, one, CENTRE if feature == CENTRE else feature - CORNER)
            arm_x, arm_y = co * ux - so * uy, so * ux + co * uy
            dx, dy = cx - one_x - arm_x, cy - one_y - arm_y
            distance = math.sqrt(dx * dx + dy * dy)
            nx, ny = dx / distance, dy / distance
            out[i, GAP] = distance - own - radius
            out[i, MARGIN] = math.inf
            if feature > CENTRE:  # beyond both faces that meet at the corner
                near_x = (co * (cx - one_x) + so * (cy - one_y)) * (1.0 if ux > 0.0 else -1.0) - abs(ux)
                near_y = (co * (cy - one_y) - so * (cx - one_x)) * (1.0 if uy > 0.0 else -1.0) - abs(uy)
                out[i, MARGIN] = min(near_x, near_y)
            dvx = cvx - one_vx + one_spin * arm_y
            dvy = cvy - one_vy - one_spin * arm_x
            across = nx * dvy - ny * dvx
            turning = across / distance
            out[i, BIAS_N] = (
                across * turning
                - spin * spin * (nx * rho_x + ny * rho_y)
                + one_spin * one_spin * (nx * arm_x + ny * arm_y)
            )
        out[i, NX], out[i, NY] = nx, ny
    px, py = cx - radius * nx, cy - radius * ny
    ax, ay, bx, by = px - one_x, py - one_y, px - q[2 * other], py - q[2 * other + 1]
    out[i, TA], out[i, NA] = nx * ay - ny * ax, nx * ax + ny * ay
    out[i, TB], out[i, NB] = nx * by - ny * bx, nx * bx + ny * by
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
