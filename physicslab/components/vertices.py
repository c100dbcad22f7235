"""Vertices of polygons: what they must be like, where their centre of mass is, and how they are centred."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from physicslab.ecs.vector import Vector2

_ZERO_LENGTH_SHARE = 1e-9
"""Share of the largest distance of two vertices below which a length is zero, and the sine of a turn is."""


_DIGITS = 12
"""Decimal digits of the size of a polygon that messages have of its vertices: enough to be centred."""
_LEAST = 1e-100
"""The least extent of a polygon or a chain [m]: squares of it are not zero."""


def why_not_convex(vertices: Sequence[Vector2], least: int, most: int) -> str | None:
    """Return in words what the vertices of a convex polygon must be that these [m] are not, or ``None``."""
    count = len(vertices)
    if not least <= count <= most:
        return f"{least} to {most} vertices; these are {count}"
    size = max((one - other).magnitude for one in vertices for other in vertices)
    for k, one in enumerate(vertices):
        for j in range(k):
            if (one - vertices[j]).magnitude <= _ZERO_LENGTH_SHARE * size:
                return f"vertices at different places; number {j + 1} and number {k + 1} are at one"
    if size < _LEAST:
        return f"vertices of which two are at least {_LEAST:g} m apart"
    turns = _turns(vertices)
    straightest = min(turns, key=lambda turn: abs(math.sin(turn)))
    if abs(math.sin(straightest)) <= _ZERO_LENGTH_SHARE:
        k = turns.index(straightest) + 1
        return f"convex, each vertex a corner; number {k} is in line with its neighbours"
    if max(turns) < 0.0:
        return f"counter-clockwise; these are clockwise: take {plain(vertices[::-1])}"
    for k, turn in enumerate(turns, start=1):
        if turn < 0.0:
            return f"convex; at number {k} these turn inwards"
    if sum(turns) > 3.0 * math.pi:
        return "convex; these go around more than once"
    return None


def why_no_chain(vertices: Sequence[Vector2], least: int, most: int) -> str | None:
    """Return in words what the vertices of a chain must be that these [m] are not, or ``None``."""
    count = len(vertices)
    if not least <= count <= most:
        return f"{least} to {most} vertices; these are {count}"
    size = max(vertex.magnitude for vertex in vertices)
    if size < _LEAST:
        return f"vertices of which one is at least {_LEAST:g} m from the centre"
    for k, (one, after) in enumerate(pairwise(vertices), start=1):
        if (after - one).magnitude <= _ZERO_LENGTH_SHARE * size:
            return f"vertices at different places; number {k} and number {k + 1} are at one"
    if count == 3 and vertices[0] == vertices[-1]:
        return "open, or a loop of more than two segments"
    return None


def _turns(vertices: Sequence[Vector2]) -> list[float]:
    """Return by how much the outline turns to the left at each vertex [rad]."""
    edges = [after - one for one, after in pairwise((*vertices, vertices[0]))]
    return [math.atan2(one.cross(after), one.dot(after)) for one, after in pairwise((edges[-1], *edges))]


def why_off_centre(vertices: Sequence[Vector2], radius: float) -> str | None:
    """Return by how much a convex polygon that is rounded by a radius [m] is off its centre, or ``None``."""
    centre = centre_of_mass(vertices, radius)
    if centre.magnitude <= _ZERO_LENGTH_SHARE * max(radius, *(vertex.magnitude for vertex in vertices)):
        return None
    size = max(vertex.magnitude for vertex in vertices)
    at, by = _to_read([centre], size)[0], _to_read([-centre], size)[0]
    return (
        f"about the centre of mass; that of these is at {at} m: shift them by {by} m, "
        f"to {_to_read(centred(vertices, radius), size)}"
    )


def _to_read(points: Sequence[Vector2], size: float) -> list[list[float]]:
    """Return points [m] as people read them: without the rounding of about one ``size`` [m]."""
    places = _DIGITS - math.frexp(size)[1] * 3 // 10  # 2 to the power of 10 has three zeros
    return [[round(part, places) + 0.0 for part in point] for point in points]


def centred(vertices: Sequence[Vector2 | tuple[float, float]], radius: float = 0.0) -> tuple[Vector2, ...]:
    """Return the vertices of a convex polygon [m] from its centre of mass.

    Parameters
    ----------
    vertices : sequence of vectors or pairs of floats
        Counter-clockwise, from anywhere [m].
    radius : float
        Radius that rounds it [m].

    Examples
    --------
    >>> [tuple(vertex) for vertex in centred([(0, 0), (3, 0), (0, 3)])]
    [(-1.0, -1.0), (2.0, -1.0), (-1.0, 2.0)]
    """
    given = [Vector2(*vertex) for vertex in vertices]
    centre = centre_of_mass(given, radius)
    return tuple(vertex - centre for vertex in given)


def centre_of_mass(vertices: Sequence[Vector2], radius: float = 0.0) -> Vector2:
    """Return the centre of mass [m] of a convex polygon of uniform density that is rounded by a radius [m].

    It consists of triangles, a strip along each edge, and a sector at each vertex. Lengths are scaled by a
    power of two first: no bit of the result changes, and third powers of large and small ones are finite.
    """
    first = vertices[0]
    largest = max(radius, *((vertex - first).magnitude for vertex in vertices))
    scale = math.ldexp(1.0, -math.frexp(largest)[1])
    moved, radius = [scale * (vertex - first) for vertex in vertices], scale * radius
    edges = [(one, after - one) for one, after in pairwise((*moved, moved[0]))]
    normals = [Vector2(edge.y, -edge.x) * (1.0 / edge.magnitude) for _, edge in edges]
    area, moment, third = 0.0, Vector2(), radius**3 / 3.0
    before = normals[-1]
    for (one, edge), normal in zip(edges, normals, strict=True):
        triangle, strip = 0.5 * one.cross(edge), radius * edge.magnitude
        sector = 0.5 * radius * radius * math.atan2(before.cross(normal), before.dot(normal))
        area += triangle + strip + sector
        moment += (2.0 * one + edge) * (triangle / 3.0)
        moment += (one + 0.5 * edge + 0.5 * radius * normal) * strip
        moment += one * sector + third * Vector2(normal.y - before.y, before.x - normal.x)
        before = normal
    return first + moment * (1.0 / (area * scale))


def regular(count: int, radius: float) -> tuple[Vector2, ...]:
    """Return the vertices of a regular polygon in a circle of a radius [m]; a side of it is below.

    >>> [round(vertex.y, 3) for vertex in regular(4, 1.0)]
    [-0.707, 0.707, 0.707, -0.707]
    """
    turn = 2.0 * math.pi / count
    return tuple(Vector2.from_angle((k + 0.5) * turn - 0.5 * math.pi, radius) for k in range(count))


def plain(value: Any) -> Any:
    """Return a value as files have it: points as lists of numbers.

    >>> plain((Vector2(1, 2),)), plain(0.5)
    ([[1.0, 2.0]], 0.5)
    """
    return [plain(part) for part in value] if isinstance(value, Vector2 | tuple) else value
