"""Polygons that are drawn: by clicks at their corners, or with one stroke, which is simplified."""

from collections.abc import Sequence
from itertools import pairwise

from physicslab.components import Shape
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import body, outline
from physicslab.view.window.edits import Recipe
from physicslab.world import World

MOST = 100
"""How many corners are clicked at most."""
_CONVEX = 8
"""How many corners one convex body has at most."""
_HOLLOW = 0.06
"""Share of its area by which a stroke may be hollow where it is taken for a convex shape drawn by hand."""
_ROUND = 0.01
"""Least area within a stroke, as a share of the square of its length; of a circle it is 0.08."""
_SMALL, _NOTCH = 0.01, 0.004
"""Shares of the area below which a corner of a stroke is none, of a convex one and of one that is not."""

type Places = Sequence[Vector2]
"""Points one after the other [m]."""


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
    return len(places) > _CONVEX and abs(area(places)) > _ROUND * length * length


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
    """Return the corners of the outline that a closed stroke was meant to be.

    Corners that matter least are left out one after the other, by the triangles that they make with their
    neighbours (Visvalingam & Whyatt, Cartographic J. 30, 1993). A stroke that is hardly hollow is convex.
    """
    corners, whole = hull(stroke), abs(area(stroke))
    is_convex = len(corners) > 2 and whole >= (1.0 - _HOLLOW) * area(corners)
    corners, small, most = (corners, _SMALL, _CONVEX) if is_convex else (list(stroke), _NOTCH, MOST)
    cuts = [_cut(corners, n) for n in range(len(corners))]
    while len(corners) > 3:
        least = min(range(len(cuts)), key=cuts.__getitem__)
        if len(corners) <= most and cuts[least] > small * whole:
            break
        del corners[least], cuts[least]
        for n in (least - 1, least % len(corners)):
            cuts[n] = _cut(corners, n)
    return corners


def _cut(corners: Places, n: int) -> float:
    """Return the area [m^2] of the triangle of a corner and its neighbours."""
    place = corners[n]
    return 0.5 * abs((corners[n - 1] - place).cross(corners[(n + 1) % len(corners)] - place))


def build_polygon(world: World, places: Places, recipe: Recipe) -> None:
    """Make what has some corners: one body, or several that are welded where it is not convex."""
    outline(world, places, **recipe.body(abs(area(places))))


def build_ramp(world: World, places: Places, recipe: Recipe) -> None:
    """Make a fixed wedge from the foot of its slope to its top."""
    foot, top = places
    corners = hull([foot, Vector2(top.x, foot.y), top])
    if len(corners) < 3:
        raise ValueError("it needs a slope that is neither level nor upright")
    shape = Shape.polygon(corners)
    body(world, shape, corners[0] - shape.vertices[0], static=True,
         restitution=recipe.restitution, friction=recipe.friction)  # fmt: skip
