"""Media: buoyancy and drag of what is within them, over packed coordinates.

How much of one outline is within another, area and centroid of both and the part of the outline itself, is
found by Green's theorem. It makes sums along the outline of both from the integrals over their common area:
of the pieces of each outline - a straight line for each face, an arc for each rounded vertex - those parts
count that are within the other. Where outlines coincide, the first one's counts, if both have their insides
on one side.

An outline is :data:`OUTLINE` numbers: how many vertices its core has, its radius, and x, y of 8 vertices.
"""

import math
from typing import Any

from physicslab.kernels import inlined
from physicslab.kernels.accounts import book
from physicslab.kernels.forces.force_calls import force_kernel

OUTLINE = 18
"""How many numbers an outline is."""
CUTS = 64
"""Room for the shares of a piece at which the other outline may cut it."""
AREA, MX, MY, LENGTH, SX, SY, S2, WX, WY, TURN, SUMS = range(11)
"""Sums: the common area and its first moments; length, first and second moments of what part of
the first outline is within the second; and of the second's within the first the integrals of a linear
function psi times the normal, and times the moment of the normal."""
_SAME = 1e-12
"""Share of the size within which outlines coincide."""


@inlined
def place_outline(source: Any, at: int, x: float, y: float, angle: float, placed: Any, to: int) -> None:
    """Write an outline that is turned by an angle, and then moved by (x, y)."""
    c, s = math.cos(angle), math.sin(angle)
    placed[to], placed[to + 1] = source[at], source[at + 1]
    for k in range(int(source[at])):
        u, v = source[at + 2 + 2 * k], source[at + 3 + 2 * k]
        placed[to + 2 + 2 * k], placed[to + 3 + 2 * k] = x + c * u - s * v, y + s * u + c * v


@inlined
def signed_distance(outline: Any, at: int, x: float, y: float) -> tuple[float, float, float]:
    """Return how far a point is outside an outline, negative inside, and the direction away from it."""
    n, r = int(outline[at]), outline[at + 1]
    deepest, nx, ny, nearest, ox, oy = -math.inf, 1.0, 0.0, math.inf, 0.0, 0.0
    for k in range(n):
        p, q = at + 2 + 2 * k, at + 2 + 2 * ((k + 1) % n)
        ex, ey = outline[q] - outline[p], outline[q + 1] - outline[p + 1]
        dx, dy = x - outline[p], y - outline[p + 1]
        square = ex * ex + ey * ey
        share = 0.0
        if square > 0.0:
            length = math.sqrt(square)
            height = (ey * dx - ex * dy) / length
            if height > deepest:
                deepest, nx, ny = height, ey / length, -ex / length
            share = min(max((dx * ex + dy * ey) / square, 0.0), 1.0)
        dx, dy = dx - share * ex, dy - share * ey
        if dx * dx + dy * dy < nearest:
            nearest, ox, oy = dx * dx + dy * dy, dx, dy
    if n > 2 and deepest <= 0.0:
        return deepest - r, nx, ny
    away = math.sqrt(nearest)
    return (away - r, ox / away, oy / away) if away > 0.0 else (-r, nx, ny)


@inlined
def _add_cut(cuts: Any, to: int, count: int, share: float) -> int:
    """Put a share of a piece into its order among the cuts, unless it is beyond the ends."""
    if not 0.0 < share < 1.0:
        return count
    k = count
    while k > 0 and cuts[to + k - 1] > share:
        cuts[to + k] = cuts[to + k - 1]
        k -= 1
    cuts[to + k] = share
    return count + 1


@inlined
def _cut_piece(
    other: Any, b: int, cuts: Any, to: int, x: float, y: float, dx: float, dy: float, r: float, start: float,
    span: float,
) -> int:  # fmt: skip
    """List where the pieces of an outline may cut a line from (x, y) by (dx, dy), or an arc; how many.

    Those are listed, too, at which it may begin to run along one.
    The arc is one about (x, y) with the radius r > 0, from the angle ``start`` on by ``span``.
    """
    n, radius, count = int(other[b]), other[b + 1], 0
    for k in range(n):
        p, q = b + 2 + 2 * k, b + 2 + 2 * ((k + 1) % n)
        px, py = other[p], other[p + 1]
        ex, ey = other[q] - px, other[q + 1] - py
        length = math.sqrt(ex * ex + ey * ey)
        if length > 0.0:
            nx, ny = ey / length, -ex / length
            height = nx * (x - px) + ny * (y - py) - radius
            if r == 0.0:
                along = nx * dx + ny * dy
                if along != 0.0:
                    count = _add_cut(cuts, to, count, -height / along)
            else:
                middle, half = math.atan2(ny, nx), math.acos(min(max(-height / r, -1.0), 1.0))
                for angle in (middle - half, middle, middle + half):
                    count = _add_cut(cuts, to, count, (angle - start) % (2.0 * math.pi) / span)
        if radius > 0.0:
            cx, cy = px - x, py - y
            if r == 0.0:
                square, along = dx * dx + dy * dy, cx * dx + cy * dy
                root = math.sqrt(max(along * along - square * (cx * cx + cy * cy - radius * radius), 0.0))
                for way in (along - root, along, along + root):
                    count = _add_cut(cuts, to, count, way / square)
            else:
                away = math.sqrt(cx * cx + cy * cy)
                share = (r * r + away * away - radius * radius) / (2.0 * r * away) if away > 0.0 else 2.0
                if abs(share) < 1.0:
                    middle, half = math.atan2(cy, cx), math.acos(share)
                    for angle in (middle - half, middle + half):
                        count = _add_cut(cuts, to, count, (angle - start) % (2.0 * math.pi) / span)
    return count


@inlined
def _is_within(other: Any, b: int, x: float, y: float, nx: float, ny: float, same: float, own: bool) -> bool:
    """Whether a point of an outline, where its normal is (nx, ny), is within another, or on it as one."""
    away, ox, oy = signed_distance(other, b, x, y)
    if abs(away) > same:
        return away < 0.0
    return own and nx * ox + ny * oy > 0.0


@inlined
def _add_line(
    sums: Any, to: int, x: float, y: float, dx: float, dy: float, psi: float, gx: float, gy: float, own: bool
) -> None:
    """Add a straight part from (x, y) by (dx, dy)."""
    twice, mx, my = x * dy - y * dx, x + 0.5 * dx, y + 0.5 * dy
    sums[to + AREA] += 0.5 * twice
    sums[to + MX] += twice * mx / 3.0
    sums[to + MY] += twice * my / 3.0
    square = dx * dx + dy * dy
    if own:
        length = math.sqrt(square)
        sums[to + LENGTH] += length
        sums[to + SX] += length * mx
        sums[to + SY] += length * my
        sums[to + S2] += length * (mx * mx + my * my + square / 12.0)
    else:
        mean = psi + gx * mx + gy * my
        sums[to + WX] += mean * dy
        sums[to + WY] -= mean * dx
        sums[to + TURN] -= mean * (mx * dx + my * dy) + (gx * dx + gy * dy) * square / 12.0


@inlined
def _add_arc(
    sums: Any, to: int, x: float, y: float, r: float, start: float, span: float, psi: float, gx: float,
    gy: float, own: bool,
) -> None:  # fmt: skip
    """Add an arc about (x, y) from the angle ``start`` on by ``span``."""
    s0, c0, s1, c1 = math.sin(start), math.cos(start), math.sin(start + span), math.cos(start + span)
    ex, ey = s1 - s0, c0 - c1  # the integral of the normal, and of its products
    xx, xy = 0.5 * (span + s1 * c1 - s0 * c0), 0.5 * (s1 * s1 - s0 * s0)
    yy = span - xx
    along = x * ex + y * ey
    sums[to + AREA] += 0.5 * r * (along + r * span)
    sums[to + MX] += r / 3.0 * (x * (along + r * span) + r * (xx * x + xy * y + r * ex))
    sums[to + MY] += r / 3.0 * (y * (along + r * span) + r * (xy * x + yy * y + r * ey))
    if own:
        sums[to + LENGTH] += r * span
        sums[to + SX] += r * (span * x + r * ex)
        sums[to + SY] += r * (span * y + r * ey)
        sums[to + S2] += r * ((x * x + y * y + r * r) * span + 2.0 * r * along)
    else:
        middle = psi + gx * x + gy * y
        wx = r * (middle * ex + r * (xx * gx + xy * gy))
        wy = r * (middle * ey + r * (xy * gx + yy * gy))
        sums[to + WX] += wx
        sums[to + WY] += wy
        sums[to + TURN] += x * wy - y * wx


@inlined
def _walk(
    one: Any, a: int, other: Any, b: int, cuts: Any, at: int, sums: Any, to: int, psi: float, gx: float,
    gy: float, same: float, own: bool, whole: bool,
) -> None:  # fmt: skip
    """Add those parts of the outline at ``a`` that are within the one at ``b``: all, if it is whole."""
    n, r = int(one[a]), one[a + 1]
    for piece in range(2 * n):
        k = piece // 2
        last, p, q = a + 2 + 2 * ((k + n - 1) % n), a + 2 + 2 * k, a + 2 + 2 * ((k + 1) % n)
        x, y, dx, dy, start, span = one[p], one[p + 1], one[q] - one[p], one[q + 1] - one[p + 1], 0.0, 0.0
        if piece % 2 == 0:  # the arc about vertex k
            if r == 0.0:
                continue
            lx, ly = x - one[last], y - one[last + 1]
            start = math.atan2(-lx, ly)
            span = math.atan2(abs(lx * dy - ly * dx), lx * dx + ly * dy) if n > 1 else 2.0 * math.pi
            if span <= 0.0:
                continue
            count = 0 if whole else _cut_piece(other, b, cuts, at, x, y, 0.0, 0.0, r, start, span)
        else:
            length = math.sqrt(dx * dx + dy * dy)
            if length == 0.0:
                continue
            x, y = x + r * dy / length, y - r * dx / length
            count = 0 if whole else _cut_piece(other, b, cuts, at, x, y, dx, dy, 0.0, 0.0, 1.0)
        low = 0.0
        for cut in range(count + 1):
            high = cuts[at + cut] if cut < count else 1.0
            middle, share = 0.5 * (low + high), high - low
            if piece % 2 == 0:
                angle = start + middle * span
                nx, ny = math.cos(angle), math.sin(angle)
                if whole or (share > 0.0 and _is_within(other, b, x + r * nx, y + r * ny, nx, ny, same, own)):
                    _add_arc(sums, to, x, y, r, start + low * span, share * span, psi, gx, gy, own)
            elif whole or (
                share > 0.0 and _is_within(other, b, x + middle * dx, y + middle * dy, dy, -dx, same, own)
            ):
                _add_line(sums, to, x + low * dx, y + low * dy, share * dx, share * dy, psi, gx, gy, own)
            low = high


@inlined
def immerse(
    outlines: Any, a: int, b: int, cuts: int, to: int, psi: float, gx: float, gy: float, size: float,
    whole: bool,
) -> None:  # fmt: skip
    """Set the :data:`SUMS` at ``to`` for the outline at ``a`` within the one at ``b``, of about one ``size``.

    Where the ``whole`` of it is known to be within, nothing is cut, and the other outline has no part of it.
    ``cuts`` is room for :data:`CUTS` numbers. The linear function is psi + gx x + gy y.
    """
    for k in range(SUMS):
        outlines[to + k] = 0.0
    same = _SAME * size
    _walk(outlines, a, outlines, b, outlines, cuts, outlines, to, psi, gx, gy, same, True, whole)
    if not whole:
        _walk(outlines, b, outlines, a, outlines, cuts, outlines, to, psi, gx, gy, same, False, False)


X, Y, ANGLE, HALF_X, HALF_Y, DENSITY, VISCOSITY, QUADRATIC, FLOW_X, FLOW_Y, LEVEL, NUMBERS = range(12)
"""The numbers of a medium, before its outline: where it is, half of the width and height of what it takes up,
what it is, and g . x at its surface."""
STORED, GX, GY, FIRST = range(4)
"""The parameters of :func:`medium` begin with the energy that it has found, and the gravity."""
ROOM = 2 * OUTLINE + CUTS + SUMS
"""They end with so many numbers of room."""


@force_kernel
def medium(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add to each body the weight of the fluid that it displaces, upwards, and the drag against the flow.

    ``parameters``: STORED, GX, GY; of each medium its numbers and outline; of each body its reach, 1 if it
    can turn or else 0, and its outline; and room. ``indices``: how many bodies and media; two of each body:
    where x and the angle are; then the accounts of fields and of damping, and where drag is kept by itself.

    Buoyancy acts at the centroid of the common area. It is the force of the energy rho times the integral of
    (g . x - level) over that area, and of the pressure of the fluid at those parts of its own outline that
    are below its surface and within the body: what that gives is booked as that of a field.
    """
    bodies, media = indices[0], indices[1]
    fields, damping, kept = (
        indices[2 + 2 * bodies], indices[3 + 2 * bodies], indices[4 + 2 * bodies]
    )  # fmt: skip
    gx, gy, stored = parameters[GX], parameters[GY], 0.0
    first = FIRST + media * (NUMBERS + OUTLINE)
    room = first + bodies * (2 + OUTLINE)
    near, region, cuts, sums = room, room + OUTLINE, room + 2 * OUTLINE, room + 2 * OUTLINE + CUTS
    for p in range(bodies):
        i, turn = indices[2 + 2 * p], indices[3 + 2 * p]
        own = first + p * (2 + OUTLINE)
        reach, x, y, vx, vy, spin = parameters[own], q[i], q[i + 1], v[i], v[i + 1], v[turn]
        turns = parameters[own + 1]
        placed = False
        for m in range(media):
            at = FIRST + m * (NUMBERS + OUTLINE)
            dx, dy = parameters[at + X] - x, parameters[at + Y] - y
            if not (abs(dx) < reach + parameters[at + HALF_X] and abs(dy) < reach + parameters[at + HALF_Y]):
                continue
            place_outline(parameters, at + NUMBERS, dx, dy, parameters[at + ANGLE], parameters, region)
            away, _, _ = signed_distance(parameters, region, 0.0, 0.0)
            if away >= reach:
                continue
            if not placed:
                place_outline(parameters, own + 2, 0.0, 0.0, q[turn], parameters, near)
                placed = True
            psi = gx * x + gy * y - parameters[at + LEVEL]
            immerse(parameters, near, region, cuts, sums, psi, gx, gy, reach, away <= -reach)
            area, mx, my = parameters[sums + AREA], parameters[sums + MX], parameters[sums + MY]
            rho, length = parameters[at + DENSITY], parameters[sums + LENGTH]
            fx, fy = -rho * area * gx, -rho * area * gy
            torque = -turns * rho * (mx * gy - my * gx)
            stored += rho * (psi * area + gx * mx + gy * my)
            force[i] += fx
            force[i + 1] += fy
            force[turn] += torque
            if fields >= 0:
                power = -rho * (parameters[sums + WX] * vx + parameters[sums + WY] * vy)
                power -= rho * parameters[sums + TURN] * spin
                book(force, fields, power, fx, fy, torque + x * fy - y * fx)
            if length == 0.0:
                continue
            sx, sy = parameters[sums + SX] / length, parameters[sums + SY] / length
            flow_x, flow_y = parameters[at + FLOW_X], parameters[at + FLOW_Y]
            ux, uy = vx - spin * sy - flow_x, vy + spin * sx - flow_y
            pull = parameters[at + VISCOSITY] + parameters[at + QUADRATIC] * math.sqrt(ux * ux + uy * uy)
            fx, fy = -pull * length * ux, -pull * length * uy
            slowed = (
                parameters[at + VISCOSITY] * (parameters[sums + S2] - length * (sx * sx + sy * sy)) * spin
            )
            torque = turns * (sx * fy - sy * fx - slowed)
            force[i] += fx
            force[i + 1] += fy
            force[turn] += torque
            if damping >= 0:
                given = fx * flow_x + fy * flow_y
                lost = fx * ux + fy * uy - slowed * spin
                if kept >= 0:
                    force[kept + i] += fx
                    force[kept + i + 1] += fy
                    force[kept + turn] += torque
                    lost = -given
                book(force, damping, lost, fx, fy, torque + x * fy - y * fx)
                force[fields] += given
    parameters[STORED] = stored
