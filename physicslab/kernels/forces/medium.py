"""Media: buoyancy and drag of what is within them, over packed coordinates."""

import math

from physicslab.kernels.accounts import book
from physicslab.kernels.forces.force_calls import force_kernel
from physicslab.kernels.forces.immersion import (
    AREA,
    CUTS,
    LENGTH,
    MX,
    MY,
    OUTLINE,
    S2,
    SUMS,
    SX,
    SY,
    TURN,
    WX,
    WY,
    immerse,
    place_outline,
    signed_distance,
)

X, Y, ANGLE, REACH, DENSITY, VISCOSITY, QUADRATIC, FLOW_X, FLOW_Y, LEVEL, NUMBERS = range(11)
"""The numbers of a medium, before its outline: where it is, its size, what it is, g . x at its surface."""
STORED, GX, GY, FIRST = range(4)
"""The parameters of :func:`medium` begin with the energy that it has found, and the gravity."""
ROOM = 2 * OUTLINE + CUTS + SUMS
"""They end with so many numbers of room."""


@force_kernel
def medium(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add to each body the weight of the fluid that it displaces, upwards, and the drag against the flow.

    ``parameters``: STORED, GX, GY; of each medium its numbers and outline; of each body its reach and
    outline; and room. ``indices``: how many bodies and media; two of each body: where x and the angle are;
    then the accounts of fields and of damping, and where drag is kept by itself.

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
    room = first + bodies * (1 + OUTLINE)
    near, region, cuts, sums = room, room + OUTLINE, room + 2 * OUTLINE, room + 2 * OUTLINE + CUTS
    for p in range(bodies):
        i, turn = indices[2 + 2 * p], indices[3 + 2 * p]
        own = first + p * (1 + OUTLINE)
        reach, x, y, vx, vy, spin = parameters[own], q[i], q[i + 1], v[i], v[i + 1], v[turn]
        placed = False
        for m in range(media):
            at = FIRST + m * (NUMBERS + OUTLINE)
            dx, dy, far = parameters[at + X] - x, parameters[at + Y] - y, reach + parameters[at + REACH]
            if not dx * dx + dy * dy < far * far:
                continue
            place_outline(parameters, at + NUMBERS, dx, dy, parameters[at + ANGLE], parameters, region)
            away, _, _ = signed_distance(parameters, region, 0.0, 0.0)
            if away >= reach:
                continue
            if not placed:
                place_outline(parameters, own + 1, 0.0, 0.0, q[turn], parameters, near)
                placed = True
            psi = gx * x + gy * y - parameters[at + LEVEL]
            immerse(parameters, near, region, cuts, sums, psi, gx, gy, reach, away <= -reach)
            area, mx, my = parameters[sums + AREA], parameters[sums + MX], parameters[sums + MY]
            rho, length = parameters[at + DENSITY], parameters[sums + LENGTH]
            fx, fy = -rho * area * gx, -rho * area * gy
            torque = -rho * (mx * gy - my * gx)
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
            torque = sx * fy - sy * fx - slowed
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
