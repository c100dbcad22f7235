"""Springs as coils, which grow slender and thin when they are stretched, and what holds them."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Shape, Spring, Transform
from physicslab.contacts.outlines import outlines_of
from physicslab.ecs.vector import rotated
from physicslab.theme import Theme
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Numbers, Points
from physicslab.view.picture.pen import Pen
from physicslab.world import World

_TURN = 11.0
"""About how long a turn of a coil is at rest [px]."""
_MIN_TURNS, _MAX_TURNS = 4, 16
"""How many turns a coil may have."""
_AROUND = 14
"""Into how many lines a turn is divided."""
_LEAD = 0.1
"""Share of a spring that is straight, at each end; where it lies over a body, up to that body's rim."""
_COILED = 0.2
"""Share of a spring that is a coil at least."""
_RADIUS, _THICKEST = 7.0, 14.0
"""Radius of a coil at rest, and of one that is pressed together at most [px]."""
_DEPTH = 0.3
"""How far a coil is seen from the side: the share of its radius that its back is shifted along it."""
_WIRE = 2.1
"""Width of the wire at rest [px]."""
_MIN_COIL = 26.0
"""Length [px] below which a spring is a plain line."""
_MAX_COILS = 150
"""Number of springs above which each is a plain line."""
_SAG = 0.005
"""Share of its length that the weight of a body stretches a spring by which is drawn as a string."""
_EARTH = 9.81
"""The acceleration of a weight here, for any gravity [m/s^2]."""


def draw_springs(world: World, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw every spring, and a bracket where it is fixed to the world."""
    rows = world.batch(Spring).rows
    if not len(rows):
        return
    pen, spring = Pen(camera, theme), world.table(Spring)
    own, a, b = world.batch(Spring).entities, spring["a"][rows], spring["b"][rows]
    start, end = (camera.project(place) for place in ends_of(world))
    with np.errstate(over="ignore", invalid="ignore"):  # a rest length may be as long as numbers go
        rest = spring["rest_length"][rows] * camera.scale
        seen = (np.abs(start) < 1e9).all(axis=1) & (np.abs(end) < 1e9).all(axis=1)
    rigid = _looks_rigid(world, rows, np.where(a == 0, own, a), b)[seen]
    start, end, rest, fixed = start[seen], end[seen], rest[seen], (b == 0)[seen]
    if not len(start):
        return
    plain = (np.hypot(*(end - start).T) < _MIN_COIL) | rigid
    if len(rows) > _MAX_COILS:
        plain[:] = True
    pen.brackets(end[fixed], 1.0)
    pen.lines(start[plain], end[plain], theme.spring, 1.6)
    if not plain.all():
        held = np.stack((np.where(a == 0, own, a), b), axis=1)[seen][~plain]
        covered = _half_sizes(world, held) * camera.scale
        _draw_coils(pen, start[~plain], end[~plain], rest[~plain], covered)
        pen.discs(np.concatenate((start[~plain], end[~plain & ~fixed])), 2.6, theme.spring)
    pen.screws(end[fixed], np.full(int(fixed.sum()), 0.7))
    pen.draw(canvas)


def _half_sizes(world: World, entities: NDArray[np.int64]) -> Numbers:
    """Return half of the smaller extent of each body [m], 0 for what has no shape."""
    rows = world.entity_index.lookup[entities]
    half = np.zeros(rows.shape)
    shaped = world.table(Shape).present[rows] & (entities != 0)
    half[shaped] = 0.5 * outlines_of(world, rows[shaped]).size
    return half


def _draw_coils(pen: Pen, start: Points, end: Points, rest: Numbers, covered: Numbers) -> None:
    """Add coils: their backs first, then the straight ends and the fronts, which are brighter."""
    path, is_front = coil(start, end, rest, pen.unit, covered)
    length, colour = np.hypot(*(end - start).T), pen.theme.spring
    with np.errstate(over="ignore"):
        wire = _WIRE * np.clip(np.sqrt(np.maximum(rest, _MIN_COIL) / length), 0.6, 1.25)
    for front, shade in ((False, pen.dark(colour)), (True, colour)):
        chosen = is_front == front
        lines = path[:, :-1][:, chosen].reshape(-1, 2), path[:, 1:][:, chosen].reshape(-1, 2)
        pen.lines(*lines, shade, np.repeat(wire, int(chosen.sum())))


def ends_of(world: World) -> tuple[Points, Points]:
    """Return where every spring begins and ends (n, 2) [m]."""
    springs, spring, lookup = world.batch(Spring), world.table(Spring), world.entity_index.lookup
    rows, a = springs.rows, spring["a"][springs.rows]
    start = place_of(world, lookup[np.where(a == 0, springs.entities, a)], spring["anchor_a"][rows])
    return start, place_of(world, lookup[spring["b"][rows]], spring["anchor_b"][rows])


def _looks_rigid(
    world: World, rows: NDArray[np.int64], a: NDArray[np.int64], b: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Whether each spring is so stiff that the weight of what it holds hardly stretches it."""
    spring, mass, lookup = world.table(Spring), world.table(Mass), world.entity_index.lookup
    held = np.maximum(mass["mass"][lookup[a]], mass["mass"][lookup[b]] * (b != 0))
    with np.errstate(over="ignore"):
        weight = _EARTH * held
        rigid: NDArray[np.bool_] = weight < _SAG * spring["stiffness"][rows] * spring["rest_length"][rows]
    return rigid


def coil(
    start: Points, end: Points, rest: Numbers, unit: float = 1.0, covered: Numbers | float = 0.0
) -> tuple[Points, NDArray[np.bool_]]:
    """Return the corners (n, k, 2) of coils between ends (n, 2), and which lines (k - 1,) are in front.

    The springs are of rest lengths (n,) [px], and ``unit`` is the size of a pixel of the usual picture. The
    wire keeps its length: a spring that is stretched grows slender, one that is pressed together wide. It is
    straight as far as bodies lie under it: ``covered`` (n, 2) [px].
    """
    along = end - start
    length = np.maximum(np.hypot(along[:, 0], along[:, 1]), 1e-9)
    ahead = along / length[:, None]
    across = np.stack((-ahead[:, 1], ahead[:, 0]), axis=1)
    natural = np.maximum(rest, _MIN_COIL)
    lead = np.full(2, _LEAD)
    straight = np.maximum(covered, np.outer(length, lead))
    straight *= np.minimum(1.0, (1.0 - _COILED) * length / straight.sum(axis=1))[:, None]
    begin, coiled = straight[:, :1], (length - straight.sum(axis=1))
    with np.errstate(over="ignore"):
        hidden = np.maximum(covered, np.outer(natural, lead)).sum(axis=1)
        natural = np.maximum(natural - hidden, _COILED * natural)
        # All have as many turns, so that they are one array.
        wound = float(np.median(natural)) / (1.0 - 2.0 * _LEAD)
        turns = round(float(np.clip(wound / (_TURN * unit), _MIN_TURNS, _MAX_TURNS)))
        wire = np.hypot(natural / turns, 2.0 * np.pi * np.minimum(_RADIUS * unit, 0.125 * natural))
        radius = np.sqrt(np.maximum(wire * wire - (coiled / turns) ** 2, 0.0)) / (2.0 * np.pi)
    radius = np.clip(radius, 0.8 * unit, _THICKEST * unit)[:, None]
    turn = np.arange(turns * _AROUND + 1) * (2.0 * np.pi / _AROUND)
    share = turn / (2.0 * np.pi * turns)
    depth = _DEPTH * radius * (1.0 - np.cos(turn))
    # The back of each turn lies a little farther along, as of a coil that is seen from above its end.
    nothing = np.zeros((len(start), 1))
    forward = np.concatenate((nothing, begin + share * coiled[:, None] + depth, length[:, None]), axis=1)
    side = np.concatenate((nothing, radius * np.sin(turn), nothing), axis=1)
    path: Points = (
        start[:, None, :] + forward[:, :, None] * ahead[:, None, :] + side[:, :, None] * across[:, None, :]
    )
    middle = 0.5 * (turn[:-1] + turn[1:])
    is_front = np.concatenate(([True], np.cos(middle) > -0.2, [True]))
    return path, is_front


def place_of(world: World, rows: NDArray[np.int64], anchor: Points) -> Points:
    """Return where anchors (n, 2) in the frames of bodies are in the world [m].

    ``rows`` (n,) are those of the bodies; row 0 is the world itself.
    """
    transform = world.table(Transform)
    place: Points = transform["position"][rows] + rotated(anchor, transform["angle"][rows])
    return place
