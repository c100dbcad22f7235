"""Areas and moments of inertia of shapes of uniform density, in closed form."""

import math

from physicslab.kernels import always_inlined, inlined
from physicslab.kernels.geometry.shapes import BOX, Shapes, face, is_chain, vertex


@inlined
def area_and_moment(shapes: Shapes, i: int) -> tuple[float, float]:
    """Return the area of row i [m^2], and its second moment about its centre [m^4].

    A rounded polygon is its core, a strip along each face, and a sector at each vertex; the sectors are one
    disc together. The second moment of each is moved to the centre by the parallel axis theorem.
    """
    r, count = shapes.radius[i], shapes.vertices[i]
    if count == 1:
        return math.pi * r * r, 0.5 * math.pi * r * r * r * r
    area, moment = 0.0, 0.0
    before_x, before_y, _, _ = face(shapes, i, count - 1)
    for k in range(count):
        x, y = vertex(shapes, i, k)
        nx, ny, distance, length = face(shapes, i, k)
        # The triangle from the centre to the face, of which the foot of the normal is at the share ``foot``.
        start = x * -ny + y * nx
        end = start + length
        triangle = 0.5 * distance * length
        along = (start * start + start * end + end * end) / 3.0
        area += triangle
        moment += 0.5 * triangle * (distance * distance + along)
        # The strip: its middle is half a radius beyond the face.
        strip, beyond = r * length, distance + 0.5 * r
        area += strip
        moment += strip * (along + beyond * beyond + r * r / 12.0)
        # The sector between the normals of two faces, of which the first moment is (ox, oy).
        angle = math.atan2(abs(before_x * ny - before_y * nx), before_x * nx + before_y * ny)
        sector, third = 0.5 * angle * r * r, r * r * r / 3.0
        ox, oy = third * (ny - before_y), third * (before_x - nx)
        area += sector
        moment += 0.5 * sector * r * r + 2.0 * (x * ox + y * oy) + sector * (x * x + y * y)
        before_x, before_y = nx, ny
    return area, moment


@always_inlined
def inertia_of(shapes: Shapes, i: int, mass: float) -> float:
    """Return the moment of inertia of row i about its centre [kg m^2]; 0 where it has no shape."""
    if shapes.vertices[i] == 0 or is_chain(shapes, i):
        return 0.0
    if shapes.vertices[i] == 1:
        radius: float = shapes.radius[i]
        return 0.5 * mass * radius * radius
    if shapes.first[i] == BOX:
        width: float = 2.0 * shapes.half_x[i]
        height: float = 2.0 * shapes.half_y[i]
        return mass * (width * width + height * height) / 12.0
    if shapes.gyration[i] == 0.0:
        area, moment = area_and_moment(shapes, i)
        shapes.gyration[i] = moment / area
    inertia: float = mass * shapes.gyration[i]
    return inertia
