"""Points of instruments, which may go with bodies: where they are in the world."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Gate, Note, Protractor, Ruler, Transform, Velocity
from physicslab.ecs.vector import Vector2, rotated
from physicslab.state.state import State

INSTRUMENTS: tuple[type[Any], ...] = (Note, Ruler, Protractor, Gate)
"""The components whose ``POINTS`` may go with bodies."""

type _Points = NDArray[np.float64]


def carriers(state: State, kind: type[Any], name: str, rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the rows (k,) of the bodies that a point of the instruments in some ``rows`` goes with."""
    # Without a body, or where it is gone, a point goes with row 0: the world, at rest in its origin.
    return np.maximum(state.entity_index.rows_of(state.table(kind)[f"{name}_body"][rows]), 0)


def carried(motion: _Points, points: _Points) -> tuple[_Points, _Points]:
    """Return where points in the frames of bodies (k, 2) are [m], and how fast they move (..., k, 2) [m/s].

    ``motion`` (..., k, 6) has x, y, the angle and their rates of the bodies.
    """
    arm = rotated(points, motion[..., 2])
    turning = motion[..., 5, None] * np.stack((-arm[..., 1], arm[..., 0]), axis=-1)
    return motion[..., :2] + arm, motion[..., 3:5] + turning


def place_of(state: State, entity: int, kind: type[Any], name: str) -> Vector2:
    """Return where a point of an instrument is in the world [m].

    Raises
    ------
    KeyError
        If there is no such instrument.
    """
    part = state.component(entity, kind)
    return point_of(state, getattr(part, f"{name}_body"), getattr(part, name))


def point_of(state: State, body: int | None, point: Vector2) -> Vector2:
    """Return where a point in the frame of a body is in the world [m]; without a body it is one of that."""
    return motion_of_point(state, body, point)[0]


def motion_of_point(state: State, body: int | None, point: Vector2) -> tuple[Vector2, Vector2]:
    """Return where a point in the frame of a body is [m] and how it moves [m/s]; without a body it stays."""
    if body is None or not state.has(body, Transform):
        return point, Vector2()
    transform = state.component(body, Transform)
    arm, speed = point.rotated(transform.angle), Vector2()
    if state.has(body, Velocity):
        velocity = state.component(body, Velocity)
        speed = velocity.linear + velocity.angular * arm.perpendicular
    return transform.position + arm, speed


def local_point(state: State, body: int | None, place: Vector2) -> Vector2:
    """Return a point of the world [m] in the frame of a body; in that of the world where there is none."""
    if body is None:
        return place
    transform = state.component(body, Transform)
    return (place - transform.position).rotated(-transform.angle)


def attached_to(state: State, bodies: set[int]) -> list[tuple[int, type[Any], str]]:
    """Return the points that go with any of these bodies: the instrument, its kind and the point's name."""
    found: list[tuple[int, type[Any], str]] = []
    for kind in INSTRUMENTS:
        for entity in state.batch(kind).entities.tolist():
            part = state.component(entity, kind)
            found += [(entity, kind, name) for name in kind.POINTS if getattr(part, f"{name}_body") in bodies]
    return found


def let_go_of_removed(state: State) -> None:
    """Let points stay in the world whose body was removed, or has no place any more."""
    placed = state.table(Transform).present
    for kind in INSTRUMENTS:
        rows, table = state.batch(kind).rows, state.table(kind)
        for name in kind.POINTS if len(rows) else ():
            column = table[f"{name}_body"]
            body = state.entity_index.rows_of(column[rows])
            column[rows[(body < 0) | ~placed[body]]] = 0
