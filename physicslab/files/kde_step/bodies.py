"""Bodies of Step: particles, discs, boxes and polygons. Its collisions are elastic and without friction."""

import math
import random
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Any

from physicslab.components.shape import KINDS
from physicslab.components.vertices import centre_of_mass, centred, why_not_convex
from physicslab.ecs.vector import Vector2
from physicslab.files.kde_step.draft import Body, Draft, turned
from physicslab.files.kde_step.item import Item, Pair

_SURFACE = {"restitution": 1.0, "friction": 0.0}
"""Step's collisions: nothing is lost, nothing rubs."""
_ROUNDED = 1e-4
"""How far off the origin the middle of a polygon is by rounding, as a share of its extent: six digits."""
_POINT_SHARE = 0.005
"""Radius of a particle that can touch something, as a share of the extent of the world."""


def take_particle(item: Item, draft: Draft) -> None:
    """Take a particle: a body without a shape."""
    _take(item, draft, {}, is_point=True)
    if item.kind == "ChargedParticle":
        draft.bodies[item.number].entity["Charge"] = {"charge": item.number_of("charge", 0.0)}


def take_disc(item: Item, draft: Draft) -> None:
    """Take a disc."""
    _take(item, draft, {"kind": "circle", "radius": item.number_of("radius", 0.5)})


def take_box(item: Item, draft: Draft) -> None:
    """Take a box."""
    width, height = item.pair("size") if item.has("size") else (1.0, 1.0)
    _take(item, draft, {"kind": "box", "width": width, "height": height})


def take_polygon(item: Item, draft: Draft) -> None:
    """Take a convex polygon; a rectangle along its axes is a box."""
    vertices = item.pairs("vertexes")
    rectangle = _rectangle(vertices)
    if rectangle is not None:
        (x0, y0), (x1, y1) = rectangle
        shape: dict[str, Any] = {"kind": "box", "width": x1 - x0, "height": y1 - y0}
        _take(item, draft, shape, centre=(0.5 * (x0 + x1), 0.5 * (y0 + y1)))
        return
    corners = [Vector2(x, y) for x, y in vertices]
    if len(corners) > 2 and sum(one.cross(other) for one, other in pairwise((*corners, corners[0]))) < 0.0:
        corners.reverse()  # Step takes them either way round
    refused = why_not_convex(corners, *KINDS["polygon"].own)
    if refused is not None:
        draft.lose(item, f"its vertices must be {refused}")
        return
    middle = centre_of_mass(corners)
    if middle.magnitude <= _ROUNDED * max(corner.magnitude for corner in corners):
        middle = Vector2()
    outline = [[vertex.x, vertex.y] for vertex in centred(corners)]
    _take(item, draft, {"kind": "polygon", "vertices": outline}, centre=(middle.x, middle.y))


BODIES: Mapping[str, Callable[[Item, Draft], None]] = {
    "Particle": take_particle,
    "ChargedParticle": take_particle,
    "GasParticle": take_particle,
    "SoftBodyParticle": take_particle,
    "Disk": take_disc,
    "Box": take_box,
    "Polygon": take_polygon,
}
"""The classes of bodies."""


def _rectangle(vertices: Sequence[Pair]) -> tuple[Pair, Pair] | None:
    """Return the lower left and the upper right corner, if this is a rectangle along the axes."""
    xs, ys = sorted({x for x, _ in vertices}), sorted({y for _, y in vertices})
    if len(vertices) != 4 or len(set(vertices)) != 4 or len(xs) != 2 or len(ys) != 2:
        return None
    beside = all(
        (x == next_x) != (y == next_y)
        for (x, y), (next_x, next_y) in zip(vertices, [*vertices[1:], vertices[0]], strict=True)
    )
    return ((xs[0], ys[0]), (xs[1], ys[1])) if beside else None


def _take(
    item: Item, draft: Draft, shape: Mapping[str, Any], *, is_point: bool = False, centre: Pair = (0.0, 0.0)
) -> None:
    """Add a body with its motion and its mass. An infinite mass is one that nothing moves."""
    place, velocity = item.pair("position"), item.pair("velocity")
    angle, spin = (item.number_of(name, 0.0) for name in ("angle", "angularVelocity"))
    mass = item.number_of("mass", 1.0, infinite=True)
    inertia = item.number_of("inertia", 1.0, infinite=True)
    body = Body({}, is_point, place, angle, centre)
    x, y = turned(centre, angle)
    moving: dict[str, Any] = {"linear": [velocity[0] - spin * y, velocity[1] + spin * x]}
    if spin != 0.0:
        moving["angular"] = spin
    parts: dict[str, Any] = {"Transform": {"position": list(body.in_world(centre))}}
    if angle != 0.0:
        parts["Transform"]["angle"] = angle
    if shape:
        parts |= {"Shape": dict(shape), "Material": dict(_SURFACE)}
    if mass == math.inf > inertia and not is_point and velocity == (0.0, 0.0):
        mass = 1.0  # on an axle the mass does not matter
        parts["Pin"] = {"anchor_a": body.anchor((0.0, 0.0)), "anchor_b": list(place)}
    if mass < math.inf:
        weight: dict[str, Any] = {"mass": mass}
        if inertia == math.inf:
            weight["fixed_rotation"] = True
        elif not is_point:
            weight["inertia"] = inertia
        parts |= {"Velocity": moving, "Mass": weight}
    elif velocity != (0.0, 0.0) or spin != 0.0:
        parts["Velocity"] = moving
    if mass < math.inf and inertia == math.inf and moving.pop("angular", 0.0):
        draft.lose(item, f"it turns at {spin:g} rad/s with an infinite inertia; here it does not turn")
    if centre != (0.0, 0.0) and "Mass" in parts:
        draft.lose(
            item,
            f"its centre of mass is ({-centre[0]:g}, {-centre[1]:g}) m off that of its area; here it is not",
        )
    if item.colour():
        parts["Colour"] = {"colour": item.colour()}
    body.entity = draft.place(item, parts)
    draft.bodies[item.number] = body


def give_points_extent(draft: Draft) -> None:
    """Make particles small discs where there is something that they can hit: a point touches nothing here."""
    points = [body for body in draft.bodies.values() if body.is_point]
    solid = [body for body in draft.bodies.values() if not body.is_point]
    if not points or not solid:
        return
    xs, ys = ([body.place[axis] for body in draft.bodies.values()] for axis in (0, 1))
    extent = math.hypot(max(xs) - min(xs), max(ys) - min(ys)) or 1.0
    # Two that are nearest to each other are a tenth of their distance apart.
    radius = 0.45 * _least_distance([body.place for body in points], _POINT_SHARE * extent / 0.45)
    for body in points:
        body.entity["Shape"] = {"kind": "circle", "radius": radius}
        body.entity["Material"] = dict(_SURFACE)
        if "Mass" in body.entity:
            body.entity["Mass"]["fixed_rotation"] = True
    one = points[0].id if len(points) == 1 else f"{len(points)} particles"
    words = f"have no size; here they touch as discs of {radius:.3g} m"
    if len(points) == 1:
        words = f"has no size; here it touches as a disc of {radius:.3g} m"
    draft.losses.append(f"{one}: {words}{', each other too' if len(points) > 1 else ''}")


def _least_distance(places: Sequence[Pair], most: float) -> float:
    """Return the least distance of two places that differ, or ``most`` if none is less [m].

    Each is compared with those in the cells around it; in random order cells rarely have to be made smaller
    (Khuller and Matias, Information and Computation 118 (1995) 34).
    """
    ordered = sorted(set(places))
    random.Random(0).shuffle(ordered)
    least = most
    cells: dict[tuple[int, int], list[Pair]] = {}
    for n, place in enumerate(ordered):
        column, row = _cell(place, least)
        around = (cells.get((column + i, row + j), ()) for i in (-1, 0, 1) for j in (-1, 0, 1))
        nearest = min((math.dist(place, other) for cell in around for other in cell), default=least)
        if nearest < least:
            least, cells = nearest, {}
            for other in ordered[:n]:
                cells.setdefault(_cell(other, least), []).append(other)
        cells.setdefault(_cell(place, least), []).append(place)
    return least


def _cell(place: Pair, size: float) -> tuple[int, int]:
    return math.floor(place[0] / size), math.floor(place[1] / size)
