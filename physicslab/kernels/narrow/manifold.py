"""Where two shapes touch: separations, normals and points, in coordinates relative to A's centre."""

import math

from physicslab.kernels import inlined

__all__ = ["box_box", "circle_box", "circle_circle", "wall_corner"]


@inlined
def circle_circle(
    dx: float, dy: float, radius_a: float, radius_b: float, tie: int
) -> tuple[float, float, float]:
    """Return the normal from A to B and the separation of two circles whose centres are (dx, dy) apart.

    Coincident centres have no direction; ``tie`` gives each pair one of its own.
    """
    distance = math.sqrt(dx * dx + dy * dy)
    if distance > 0.0:
        return dx / distance, dy / distance, distance - radius_a - radius_b
    turn = 2.399963229728653 * tie  # the golden angle spreads many coincident pairs evenly
    return math.cos(turn), math.sin(turn), -radius_a - radius_b


@inlined
def circle_box(
    x: float, y: float, c: float, s: float, half_x: float, half_y: float, radius: float
) -> tuple[float, float, float, float, float]:
    """Return the normal from box to circle, the point of the box's outline nearest, and the separation.

    (x, y) is the circle's centre from the box's, (c, s) the cosine and sine of the box's angle.
    """
    local_x, local_y = c * x + s * y, c * y - s * x
    near_x = min(max(local_x, -half_x), half_x)
    near_y = min(max(local_y, -half_y), half_y)
    out_x, out_y = local_x - near_x, local_y - near_y
    distance = math.sqrt(out_x * out_x + out_y * out_y)
    if distance > 0.0:
        nx, ny = out_x / distance, out_y / distance
    else:  # the centre is inside: out through the nearest face
        nx, ny = 0.0, 0.0
        depth_x, depth_y = half_x - abs(local_x), half_y - abs(local_y)
        if depth_x < depth_y:
            nx = 1.0 if local_x >= 0.0 else -1.0
            near_x = nx * half_x
            distance = -depth_x
        else:
            ny = 1.0 if local_y >= 0.0 else -1.0
            near_y = ny * half_y
            distance = -depth_y
    return (
        c * nx - s * ny, s * nx + c * ny, c * near_x - s * near_y, s * near_x + c * near_y, distance - radius,
    )  # fmt: skip


@inlined
def wall_corner(k: int, c: float, s: float, half_x: float, half_y: float) -> tuple[float, float]:
    """Return corner k of a box, counted counter-clockwise from (+, +), relative to its centre."""
    x = half_x if k == 0 or k == 3 else -half_x
    y = half_y if k == 0 or k == 1 else -half_y
    return c * x - s * y, s * x + c * y


@inlined
def box_box(
    dx: float,
    dy: float,
    ca: float,
    sa: float,
    cb: float,
    sb: float,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    margin: float,
) -> tuple[float, float, float, int, float, float, float, int, float, float, float, int]:
    """Return the contact of two boxes: separating axes, then the incident edge clipped to the reference face.

    (dx, dy) leads from A's centre to B's; (c, s) are cosine and sine of the angles, (ax, ay), (bx, by) half
    extents.

    Returns
    -------
    gap, nx, ny, count, x1, y1, separation1, feature1, x2, y2, separation2, feature2
        ``gap`` is the separation along the best axis, the normal leads from A to B, points are halfway
        between the surfaces and relative to A's centre. No points where the gap exceeds ``margin``. (After
        Catto, box2d-lite.)
    """
    # d in the frames of A and of B; the axes of B seen from A
    dax, day = ca * dx + sa * dy, ca * dy - sa * dx
    dbx, dby = cb * dx + sb * dy, cb * dy - sb * dx
    c, s = abs(ca * cb + sa * sb), abs(ca * sb - sa * cb)
    gap_ax = abs(dax) - ax - (c * bx + s * by)
    gap_ay = abs(day) - ay - (s * bx + c * by)
    gap_bx = abs(dbx) - bx - (c * ax + s * ay)
    gap_by = abs(dby) - by - (s * ax + c * ay)
    # A new axis must be better by a little, so that the reference face does not change to and fro.
    favour = 0.005 * min(min(ax, ay), min(bx, by))
    gap, face = gap_ax, 0
    if gap_ay > gap + favour:
        gap, face = gap_ay, 1
    if gap_bx > gap + favour:
        gap, face = gap_bx, 2
    if gap_by > gap + favour:
        gap, face = gap_by, 3
    nothing = 0.0
    if gap > margin:
        return gap, nothing, nothing, 0, nothing, nothing, nothing, 0, nothing, nothing, nothing, 0

    # The reference box r holds the face; the incident box i is cut off at the face's ends.
    flip = face >= 2
    if flip:
        rc, rs, rx, ry, ic, is_, ix, iy = cb, sb, bx, by, ca, sa, ax, ay
        origin_x, origin_y, incident_x, incident_y = dx, dy, 0.0, 0.0
        toward_x, toward_y = -dbx, -dby
    else:
        rc, rs, rx, ry, ic, is_, ix, iy = ca, sa, ax, ay, cb, sb, bx, by
        origin_x, origin_y, incident_x, incident_y = 0.0, 0.0, dx, dy
        toward_x, toward_y = dax, day
    if face == 0 or face == 2:
        sign = 1.0 if toward_x >= 0.0 else -1.0
        nx, ny, depth, side = sign * rc, sign * rs, rx, ry
        edge = 3 if sign > 0.0 else 1
    else:
        sign = 1.0 if toward_y >= 0.0 else -1.0
        nx, ny, depth, side = -sign * rs, sign * rc, ry, rx
        edge = 0 if sign > 0.0 else 2
    # The incident edge is the one whose outward normal is most opposed to the normal.
    local_nx, local_ny = -(ic * nx + is_ * ny), -(ic * ny - is_ * nx)
    sideways, upright = 3 if local_nx > 0.0 else 1, 0 if local_ny > 0.0 else 2
    incident = sideways if abs(local_nx) > abs(local_ny) else upright
    x1, y1 = wall_corner(incident, ic, is_, ix, iy)
    x2, y2 = wall_corner((incident + 1) % 4, ic, is_, ix, iy)
    x1, y1 = x1 + incident_x - origin_x, y1 + incident_y - origin_y
    x2, y2 = x2 + incident_x - origin_x, y2 + incident_y - origin_y

    # Cut the edge from 1 to 2 at both ends of the face, along its tangent t.
    tx, ty = -ny, nx
    along1, along2 = x1 * tx + y1 * ty, x2 * tx + y2 * ty
    start, end = 0.0, 1.0
    run = along2 - along1
    if abs(run) > 0.0:
        low, high = (-side - along1) / run, (side - along1) / run
        start, end = max(start, min(low, high)), min(end, max(low, high))
    elif abs(along1) > side:
        end = -1.0
    if start > end:
        return gap, nothing, nothing, 0, nothing, nothing, nothing, 0, nothing, nothing, nothing, 0
    px1, py1 = x1 + start * (x2 - x1), y1 + start * (y2 - y1)
    px2, py2 = x1 + end * (x2 - x1), y1 + end * (y2 - y1)
    separation1 = px1 * nx + py1 * ny - depth
    separation2 = px2 * nx + py2 * ny - depth
    px1, py1 = px1 - 0.5 * separation1 * nx + origin_x, py1 - 0.5 * separation1 * ny + origin_y
    px2, py2 = px2 - 0.5 * separation2 * nx + origin_x, py2 - 0.5 * separation2 * ny + origin_y
    feature = 1 + 2 * (incident + 4 * (edge + (4 if flip else 0)))
    if flip:
        nx, ny = -nx, -ny
    if separation1 <= margin and separation2 <= margin:
        return gap, nx, ny, 2, px1, py1, separation1, feature, px2, py2, separation2, feature + 1
    if separation1 <= margin:
        return gap, nx, ny, 1, px1, py1, separation1, feature, nothing, nothing, nothing, 0
    return gap, nx, ny, 1, px2, py2, separation2, feature + 1, nothing, nothing, nothing, 0
