"""Polygons that are drawn: by clicks at their corners, or with one stroke, which is simplified."""

from collections.abc import Sequence
from itertools import pairwise

from physicslab.components import Shape
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import body
from physicslab.view.window.edits import Recipe
from physicslab.world import World

MOST = 8
"""How many corners a polygon has at most."""
_HOLLOW = 0.12
"""Share of its area by which a stroke may be hollow where it is taken for a convex shape drawn by hand."""
_ROUND = 0.01
"""Least area within a stroke, as a share of the square of its length; of a circle it is 0.08."""
_SMALL = 0.01
"""Share of the area below which a corner of a stroke is none."""

type Places = Sequence[Vector2]
"""Points one after the other [m]."""


class NotConvex(ValueError):
    """Points are the corners of no convex polygon."""


def area(corners: Places) -> float:
    """Return the area within corners [m^2], positive if they go round counter-clockwise.

    >>> area([Vector2(0, 0), Vector2(2, 0), Vector2(0, 1)])
    1.0
    """
    around = zip(corners, (*corners[1:], corners[0]), strict=True)
    return 0.5 * sum(one.cross(other) for one, other in around)


def is_stroke(places: Places) -> bool:
    """Whether points are those of a stroke around something, and not of a straight one along an edge."""
    length = sum((other - one).magnitude for one, other in pairwise(places))
    return len(places) > MOST and abs(area(places)) > _ROUND * length * length


def hull(places: Places) -> list[Vector2]:
    """Return the corners of the convex hull of points, counter-clockwise (Andrew, IPL 9, 1979)."""
    ordered = sorted(set(places), key=tuple)
    found: list[Vector2] = []
    for way in (ordered, ordered[::-1]):
        begin = len(found)
        for place in way:
            while len(found) > begin + 1 and (found[-1] - found[-2]).cross(place - found[-2]) <= 0.0:
                found.pop()
            found.append(place)
        found.pop()
    return found


def simplified(stroke: Places) -> list[Vector2]:
    """Return the corners of the convex polygon that a closed stroke was meant to be.

    Raises
    ------
    NotConvex
        If it is hollow, or hardly has an area.
    """
    corners = hull(stroke)
    whole = area(corners) if len(corners) > 2 else 0.0
    if whole <= 0.0 or abs(area(stroke)) < (1.0 - _HOLLOW) * whole:
        raise NotConvex("it is hollow: only convex shapes can be made, others of several that are welded")
    while True:
        cuts = [
            (corners[n - 1] - place).cross(corners[(n + 1) % len(corners)] - place)
            for n, place in enumerate(corners)
        ]
        least = min(range(len(cuts)), key=lambda n: abs(cuts[n]))
        if len(corners) <= 3 or (len(corners) <= MOST and 0.5 * abs(cuts[least]) > _SMALL * whole):
            return corners
        del corners[least]


def clicked(places: Places) -> list[Vector2]:
    """Return points that were clicked as the corners of a convex polygon, counter-clockwise.

    Raises
    ------
    NotConvex
        If one of them is within the others, or on a line between two.
    """
    corners = hull(places)
    if len(corners) < 3:
        raise NotConvex("it needs three corners that are not on one line")
    if len(corners) < len(places):
        raise NotConvex("it is hollow: only convex shapes can be made, others of several that are welded")
    return corners


def build_polygon(world: World, places: Places, recipe: Recipe) -> None:
    """Make a body that is a polygon; more points than it may have corners are a stroke."""
    corners = simplified(places) if len(places) > MOST else clicked(places)
    shape = Shape.polygon(corners)
    body(world, shape, corners[0] - shape.vertices[0], **recipe.body(area(corners)))


def build_ramp(world: World, places: Places, recipe: Recipe) -> None:
    """Make a fixed wedge from the foot of its slope to its top."""
    foot, top = places
    corners = clicked([foot, Vector2(top.x, foot.y), top])
    shape = Shape.polygon(corners)
    body(world, shape, corners[0] - shape.vertices[0], static=True, friction=recipe.friction)
