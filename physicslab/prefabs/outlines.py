"""Outlines drawn by hand, convex or not: cut into the convex polygons that bodies can have."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Unpack

import numpy as np

from physicslab.components import Shape, Weld
from physicslab.components.shape import KINDS
from physicslab.components.vertices import centre_of_mass
from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import BodyOptions, Pair, body
from physicslab.state.contents import Contents

_MOST_POINTS = 1000
_LEAST, _MOST = KINDS["polygon"].own
_ZERO_LENGTH_SHARE = 2e-9
"""Share of the size of an outline below which a length is zero, and the sine of a turn is."""
_UNCERTAIN = 4e-16
"""Share of two products below which the sign of their difference may be that of rounding."""


def outline(world: Contents, points: Sequence[Pair], **options: Unpack[BodyOptions]) -> list[int]:
    """Spawn what has an outline [m], in its place: its convex parts, welded along their common sides.

    Parameters
    ----------
    points : sequence of vectors or pairs of floats
        As :func:`convex_parts` takes them [m].
    **options
        Options of the whole, as in :class:`BodyOptions`, but for an angle; the mass is shared by area, the
        name is that of the first part.

    Returns
    -------
    entities : list of int
        One for each part.

    Raises
    ------
    ValueError
        If it is no outline, or has an angle.

    Examples
    --------
    >>> from physicslab import World
    >>> len(outline(World(), [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], mass=3))
    3
    """
    if options.get("angle", 0.0):
        raise ValueError(f"angle = {options['angle']!r}: an outline is where its points are")
    corners, cut = _cut(points)
    parts = [tuple(corners[k] for k in _kept(corners, part)) for part in cut]
    areas = [0.5 * sum(one.cross(after) for one, after in _sides(part)) for part in parts]
    centres = [centre_of_mass(part) for part in parts]
    shares = [area / sum(areas) for area in areas]
    middle = sum((centre * share for centre, share in zip(centres, shares, strict=True)), Vector2())
    mass, spin = options.get("mass", 1.0), options.get("angular_velocity", 0.0)
    velocity = Vector2(*options.get("velocity", (0.0, 0.0)))
    made: list[int] = []
    for part, centre, share in zip(parts, centres, shares, strict=True):
        arm = centre - middle
        options["mass"], options["velocity"] = mass * share, velocity + spin * Vector2(-arm.y, arm.x)
        made.append(body(world, Shape.polygon(part), centre, **options))
        options["name"] = None
    if not options.get("static", False):
        beside = {side: j for j, part in enumerate(cut) for side in _sides(part)}
        for (a, b), i in beside.items():
            j = beside.get((b, a), i)
            if i < j:
                at = 0.5 * (corners[a] + corners[b])
                world.spawn(Weld(made[i], made[j], at - centres[i], at - centres[j]))
    return made


def convex_parts(points: Sequence[Pair]) -> list[tuple[Vector2, ...]]:
    """Return an outline [m] as convex polygons of 3 to 8 vertices, which have its area and do not overlap.

    It is cut into triangles, the least sharp ones first, and these are joined where that is convex (Hertel
    and Mehlhorn, 1983: at most four times as many parts as needed, but for the limit of 8 vertices).

    Parameters
    ----------
    points : sequence of vectors or pairs of floats
        3 to 1,000 points [m], either way round; the last one may be the first one again.

    Returns
    -------
    parts : list of tuples of vectors
        Counter-clockwise, in the place of the outline [m]; one if that is convex and has up to 8 corners.

    Raises
    ------
    ValueError
        If the outline crosses or touches itself, has no area, or has too few or too many points.

    Examples
    --------
    >>> [len(part) for part in convex_parts([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)])]
    [3, 3, 3]
    """
    corners, parts = _cut(points)
    return [tuple(corners[k] for k in _kept(corners, part)) for part in parts]


def _cut(points: Sequence[Pair]) -> tuple[list[Vector2], list[list[int]]]:
    """Return the corners of an outline [m], and its parts by the numbers of all corners on their sides."""
    corners = _corners([Vector2(float(x), float(y)) for x, y in points])
    parts = _joined(corners, _triangles(corners))
    return corners, [part for part in parts if len(_kept(corners, part)) >= _LEAST]


def _turn(a: Vector2, b: Vector2, c: Vector2) -> float:
    """Return twice the area of a triangle [m^2]: its sign is exact, and above zero counter-clockwise."""
    left, right = (b.x - a.x) * (c.y - a.y), (b.y - a.y) * (c.x - a.x)
    if abs(left - right) > _UNCERTAIN * (abs(left) + abs(right)):
        return left - right
    ax, ay, bx, by, cx, cy = map(Fraction, (*a, *b, *c))
    return float((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))


def _corners(points: list[Vector2]) -> list[Vector2]:
    """Return the corners of an outline, counter-clockwise, without repeated points and straight lines."""
    count = len(points)
    places = np.array([tuple(point) for point in points])
    if not 3 <= count <= _MOST_POINTS or not np.isfinite(places).all():
        raise ValueError(f"an outline is 3 to {_MOST_POINTS:,} finite points; this one is {count} points")
    none = _ZERO_LENGTH_SHARE * float(np.ptp(places, axis=0).max())
    corners, k, kept = list(points), 0, 0
    while kept < len(corners) and len(corners) >= 3:
        a, b, c = corners[k - 1], corners[k], corners[(k + 1) % len(corners)]
        before, after = (b - a).magnitude, (c - b).magnitude
        if min(before, after) > none and abs(_turn(a, b, c)) > _ZERO_LENGTH_SHARE * before * after:
            k, kept = (k + 1) % len(corners), kept + 1
        else:
            del corners[k]
            k, kept = max(k - 1, 0), max(kept - 2, 0)
    if len(corners) < 3:
        raise ValueError("an outline has an area; the points of this one are on a line")
    _refuse_crossings(corners)
    x, y = np.array([tuple(corner) for corner in corners]).T
    x, y = x - x[0], y - y[0]
    return corners if np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) > 0.0 else corners[::-1]


def _refuse_crossings(corners: list[Vector2]) -> None:
    """Raise an error if two sides of an outline have a point in common, but for corners between them."""
    count = len(corners)
    places = np.array([tuple(corner) for corner in corners])
    ends = np.array([places, np.roll(places, -1, axis=0)])
    low, high = ends.min(axis=0), ends.max(axis=0)
    near = np.all((low[:, None] <= high[None]) & (low[None] <= high[:, None]), axis=2)
    for i, j in np.argwhere(np.triu(near, 2)).tolist():
        a, b, c, d = corners[i], corners[i + 1], corners[j], corners[(j + 1) % count]
        if a == d:
            continue
        astride = min(_turn(a, b, c), _turn(a, b, d)) <= 0.0 <= max(_turn(a, b, c), _turn(a, b, d))
        if astride and min(_turn(c, d, a), _turn(c, d, b)) <= 0.0 <= max(_turn(c, d, a), _turn(c, d, b)):
            sides = f"{list(a)} to {list(b)} and from {list(c)} to {list(d)}"
            raise ValueError(f"an outline does not cross or touch itself; this one does: from {sides} m")


def _triangles(corners: list[Vector2]) -> list[list[int]]:
    """Return the triangles of a simple outline, by the numbers of their corners: one ear after the other."""
    left = list(range(len(corners)))
    places = np.array([tuple(corner) for corner in corners])
    quality = [_ear(corners, places, left, k) for k in range(len(left))]
    made: list[list[int]] = []
    while len(left) >= 3:
        k = max(range(len(left)), key=quality.__getitem__)
        made.append([left[k - 1], left[k], left[(k + 1) % len(left)]])
        del left[k], quality[k]
        for changed in (k - 1, k % len(left)):
            quality[changed] = _ear(corners, places, left, changed)
    return made


def _ear(corners: list[Vector2], places: np.ndarray, left: list[int], k: int) -> float:
    """Return how sharp a triangle would be that is cut off: area over square of a side; -1: cuts the rest."""
    three = [left[k - 1], left[k], left[(k + 1) % len(left)]]
    a, b, c = (corners[i] for i in three)
    area = _turn(a, b, c)
    if area < 0.0:
        return -1.0
    low = min(a.x, b.x, c.x), min(a.y, b.y, c.y)
    high = max(a.x, b.x, c.x), max(a.y, b.y, c.y)
    others = places[left]
    for point in others[np.all((others >= low) & (others <= high), axis=1)].tolist():
        p = Vector2(*point)
        if min(_turn(a, b, p), _turn(b, c, p), _turn(c, a, p)) >= 0.0 and p not in (a, b, c):
            return -1.0
    return area / max((b - a).magnitude, (c - b).magnitude, (a - c).magnitude) ** 2


def _joined(corners: list[Vector2], parts: list[list[int]]) -> list[list[int]]:
    """Return parts joined along their common sides, the longest first, where both ends stay convex."""
    beside = {(a, b): part for part in parts for a, b in _sides(part)}
    common = sorted(
        ((a, b) for a, b in beside if a < b and (b, a) in beside),
        key=lambda side: (-(corners[side[1]] - corners[side[0]]).magnitude, side),
    )
    for a, b in common:
        one, other = beside[a, b], beside[b, a]
        # one goes on from b to a, other from a to b.
        i, j = one.index(b), other.index(a)
        whole = one[i:] + one[:i] + (other[j:] + other[:j])[1:-1]
        bends = _bend(corners, whole, 0), _bend(corners, whole, len(one) - 1)
        if min(bends) >= 0 and len(_kept(corners, whole)) <= _MOST:
            beside.update((side, whole) for side in _sides(whole))
            parts = [part for part in parts if part is not one and part is not other] + [whole]
    return parts


def _sides[T](part: Sequence[T]) -> list[tuple[T, T]]:
    """Return the pairs of neighbours of a closed line."""
    return list(zip(part, (*part[1:], part[0]), strict=True))


def _kept(corners: list[Vector2], part: list[int]) -> list[int]:
    """Return the corners of a part that it turns at: others are those of parts beside it."""
    return [corner for k, corner in enumerate(part) if _bend(corners, part, k) == 1]


def _bend(corners: list[Vector2], part: list[int], k: int) -> int:
    """Return 1 where a part turns to the left at one of its corners, 0 where it goes straight on, else -1."""
    a, b, c = (corners[part[i % len(part)]] for i in (k - 1, k, k + 1))
    turn, none = _turn(a, b, c), _ZERO_LENGTH_SHARE * (b - a).magnitude * (c - b).magnitude
    if abs(turn) > none:
        return 1 if turn > 0.0 else -1
    return 0 if (b - a).dot(c - b) > 0.0 else -1
