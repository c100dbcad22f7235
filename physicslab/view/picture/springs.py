"""Springs as coils, and the pins that hold them."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Spring, Transform
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Look, Points
from physicslab.view.canvas.theme import Theme
from physicslab.world import World

_TURN = 13.0
"""About how long a turn of a coil is at rest [px]."""
_MIN_TURNS, _MAX_TURNS = 4, 12
"""How many turns a coil may have."""
_LEAD = 0.12
"""Share of a spring that is straight, at each end."""
_WIDTH = 7.0
"""Half width of a coil at rest [px]."""
_MIN_COIL = 26.0
"""Length [px] below which a spring is a plain line."""
_MAX_COILS = 500
"""Number of springs above which each is a plain line."""
_SAG = 0.005
"""Share of its length that the weight of a body stretches a spring by which is drawn as a string."""
_EARTH = 9.81
"""The acceleration of a weight here, for any gravity [m/s^2]."""
_PIN = 4.0
"""Radius of a pin [px]."""


def draw_springs(world: World, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw every spring, and a pin where it is fixed to the world."""
    rows = world.batch(Spring).rows
    if not len(rows):
        return
    spring = world.table(Spring)
    own, a, b = world.batch(Spring).entities, spring["a"][rows], spring["b"][rows]
    start, end = (camera.project(place) for place in ends_of(world))
    with np.errstate(over="ignore"):  # a rest length may be as long as numbers go
        rest = spring["rest_length"][rows] * camera.scale
    seen = _on_screen(start, end, camera.size)
    start, end, rest, fixed = start[seen], end[seen], rest[seen], (b == 0)[seen]
    length = np.hypot(*(end - start).T)
    plain = (length < _MIN_COIL) | _looks_rigid(world, rows, np.where(a == 0, own, a), b)[seen]
    if len(rows) > _MAX_COILS:
        plain[:] = True
    if plain.any():
        canvas.lines(start[plain], end[plain], theme.spring, 1.6)
    if not plain.all():
        path = coil(start[~plain], end[~plain], rest[~plain])
        canvas.lines(path[:, :-1].reshape(-1, 2), path[:, 1:].reshape(-1, 2), theme.spring, 1.6)
    if fixed.any():
        pins = end[fixed]
        count = len(pins)
        look = Look.plain(theme.pin, theme.pin, count)
        canvas.discs(pins, np.full(count, _PIN), np.zeros(count), look)


def ends_of(world: World) -> tuple[Points, Points]:
    """Return where every spring begins and ends (n, 2) [m]."""
    springs, spring, lookup = world.batch(Spring), world.table(Spring), world.entity_index.lookup
    rows, a = springs.rows, spring["a"][springs.rows]
    start = _end(world, lookup[np.where(a == 0, springs.entities, a)], spring["anchor_a"][rows])
    return start, _end(world, lookup[spring["b"][rows]], spring["anchor_b"][rows])


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


def coil(start: Points, end: Points, rest: NDArray[np.float64]) -> Points:
    """Return the corners (n, k, 2) of zigzags between ends (n, 2), for springs of rest lengths (n,) [px].

    The wire keeps its length: a spring that is stretched grows slender, one that is compressed wide.
    """
    along = end - start
    length = np.maximum(np.hypot(along[:, 0], along[:, 1]), 1e-9)
    across = np.stack((-along[:, 1], along[:, 0]), axis=1) / length[:, None]
    # All have as many turns, so that they are one array.
    turns = round(float(np.clip(np.median(rest) / _TURN, _MIN_TURNS, _MAX_TURNS)))
    part = (1.0 - 2.0 * _LEAD) / (2 * turns)
    natural = np.maximum(rest, _MIN_COIL)
    with np.errstate(over="ignore"):
        wire = np.hypot(part * natural, 2.0 * np.minimum(_WIDTH, 0.1 * natural))
        swing = 0.5 * np.sqrt(np.maximum(wire * wire - (part * length) ** 2, 0.0))
    swing = np.clip(swing, 1.0, 2.0 * _WIDTH)
    share = np.concatenate(([0.0, _LEAD], _LEAD + part * (np.arange(2 * turns) + 0.5), [1.0 - _LEAD, 1.0]))
    side = np.concatenate(([0.0, 0.0], np.resize([1.0, -1.0], 2 * turns), [0.0, 0.0]))
    straight = start[:, None, :] + share[None, :, None] * along[:, None, :]
    path: Points = straight + (swing[:, None] * side)[:, :, None] * across[:, None, :]
    return path


def _end(world: World, rows: NDArray[np.int64], anchor: Points) -> Points:
    """Return where anchors in the bodies' own frames are in the world [m]; row 0 is the world itself."""
    transform = world.table(Transform)
    angle = transform["angle"][rows]
    c, s = np.cos(angle), np.sin(angle)
    x, y = anchor[:, 0], anchor[:, 1]
    place: Points = transform["position"][rows] + np.stack((c * x - s * y, s * x + c * y), axis=1)
    return place


def _on_screen(start: Points, end: Points, size: tuple[int, int]) -> NDArray[np.bool_]:
    """Whether each spring can be seen; what is not finite cannot."""
    margin = 2.0 * _WIDTH
    with np.errstate(invalid="ignore"):
        low, high = np.minimum(start, end), np.maximum(start, end)
        inside: NDArray[np.bool_] = ((high > -margin) & (low < np.array(size) + margin)).all(axis=1)
    # A line of more than a billion pixels is that of a body that is lost.
    return inside & (np.abs(low) < 1e9).all(axis=1) & (np.abs(high) < 1e9).all(axis=1)
