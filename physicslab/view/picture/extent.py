"""The part of a world in which there is something to see."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Spring, Velocity
from physicslab.contacts.outlines import outlines_of
from physicslab.view.canvas.camera import Extent
from physicslab.view.picture.bodies import body_rows
from physicslab.world import World

type Boxes = NDArray[np.float64]
"""A float64 array (n, 4): xmin, ymin, xmax, ymax [m]."""

_SURROUNDINGS = 4.0
"""How much is shown at least, in sizes of the largest thing that moves."""


def extent_of(world: World) -> Extent | None:
    """Return the extent of all bodies, springs, joints and bounds, or ``None`` where there are none.

    A static body counts only as far as it is near the rest: a floor of a kilometre makes no speck of a ball.
    """
    world.synchronise()
    rows = body_rows(world)
    moves = world.table(Velocity).present
    everything = rows.all
    shapes = _reach(world, everything)
    movable = moves[everything]
    moving = np.concatenate((shapes[movable], _fixed_ends(world), _bounds(world)))
    still = shapes[~movable]
    around = _union(moving)
    if around is None:
        return _union(still)
    low, high = np.array(around[:2]), np.array(around[2:])
    largest = np.nanmax(shapes[movable, 2:] - shapes[movable, :2], initial=0.0)
    lacking = 0.5 * np.maximum(_SURROUNDINGS * largest - (high - low), 0.0)
    low, high = low - lacking, high + lacking
    reach = 0.5 * max(float((high - low).max()), 2.0 * _SURROUNDINGS * largest)
    near = (still[:, :2] < high + reach).all(axis=1) & (still[:, 2:] > low - reach).all(axis=1)
    clipped = (np.maximum(still[near, :2], low - reach), np.minimum(still[near, 2:], high + reach))
    shown = np.concatenate((low, high)).reshape(1, 4)
    return _union(np.concatenate((shown, np.concatenate(clipped, axis=1))))


def boxes_of(world: World) -> Boxes:
    """Return the upright boxes around all bodies."""
    world.synchronise()
    return _reach(world, body_rows(world).all)


def _reach(world: World, rows: NDArray[np.int64]) -> Boxes:
    return np.concatenate(outlines_of(world, rows).boxes, axis=1)


def _fixed_ends(world: World) -> Boxes:
    """Return the points of the world that springs and joints hang from."""
    spring, joints = world.table(Spring), world.joints
    rows = world.batch(Spring).rows
    held = [joints.anchor_a[one.first] for one in joints.joints if not one.a]
    held += [joints.anchor_b[one.first] for one in joints.joints if not one.b]
    anchors = np.array([*spring["anchor_b"][rows[spring["b"][rows] == 0]], *held]).reshape(-1, 2)
    return np.concatenate((anchors, anchors), axis=1)


def _bounds(world: World) -> Boxes:
    bounds = world.physics.bounds
    return np.array([bounds] if bounds is not None else [], np.float64).reshape(-1, 4)


def _union(boxes: Boxes) -> Extent | None:
    boxes = boxes[np.isfinite(boxes).all(axis=1)]
    if not len(boxes):
        return None
    low, high = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])
