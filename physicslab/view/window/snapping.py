"""Places that snap: to the edges and middles of other bodies, and else to the grid."""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform
from physicslab.contacts.outlines import Outlines
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.camera import Camera
from physicslab.view.picture.backdrop import grid_spacing
from physicslab.view.window.placing import outlines_of
from physicslab.world import World

_NEAR = 9.0
"""How near the edge of another body must be for a place to snap to it [px]."""
_FINE = 5
"""Into how many parts the distance of grid lines is divided: places snap to these."""

type Numbers = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Mark:
    """A line that shows where a place has snapped: at a coordinate along x (0) or y (1) [m]."""

    axis: int
    at: float


@dataclass(frozen=True, slots=True)
class Snapped:
    """A place that has snapped, with what shows where."""

    place: Vector2
    marks: tuple[Mark, ...] = ()


def extent_about(outlines: Outlines) -> tuple[Numbers, Numbers]:
    """Return the lowest and the highest corner of what shapes take up (2,) [m]; points are at the origin."""
    if not len(outlines.place):
        return np.zeros(2), np.zeros(2)
    reach = outlines.reach
    return (outlines.place - reach).min(axis=0), (outlines.place + reach).max(axis=0)


def snapped(
    world: World, camera: Camera, place: Vector2, low: Numbers, high: Numbers, without: Collection[int] = ()
) -> Snapped:
    """Return the place near to one at which something snaps.

    Along each axis its lower side, its middle and its upper side are tried against those of other bodies;
    where none is near, its middle goes to the lines of the grid, or to what lies a fifth between two of them.

    Parameters
    ----------
    place : Vector2
        Where its middle would be [m].
    low, high : float64 arrays (2,)
        What it takes up, from its middle [m]; both zero for a point.
    without : collection of int
        Entities that it does not snap to: itself.
    """
    rows = world.batch(Transform, Shape).rows
    rows = rows[~np.isin(world.entity_index.entities[rows], list(without))]
    others = outlines_of(world, rows)
    near = _NEAR / camera.scale
    step = grid_spacing(camera.scale) / _FINE
    found, marks = [place.x, place.y], []
    for axis in (0, 1):
        reach = others.reach[:, axis]
        lines = np.concatenate(
            (others.place[:, axis] - reach, others.place[:, axis], others.place[:, axis] + reach)
        )
        own = np.array((low[axis], 0.0, high[axis]))
        gaps = lines[:, None] - (found[axis] + own)[None, :]
        least = int(np.argmin(np.abs(gaps))) if gaps.size else 0
        if gaps.size and abs(gaps.flat[least]) <= near:
            found[axis] += float(gaps.flat[least])
            marks.append(Mark(axis, float(lines[least // len(own)])))
        else:
            found[axis] = round(found[axis] / step) * step
            if abs(found[axis] / (step * _FINE) - round(found[axis] / (step * _FINE))) < 1e-9:
                marks.append(Mark(axis, found[axis]))
    return Snapped(Vector2(*found), tuple(marks))


class Snapping:
    """Whether places snap, and where the cursor's place has snapped to.

    Attributes
    ----------
    on, held : bool
        Whether it was chosen to stay, and whether a key for it is held.
    place : Vector2, optional
        Where what is moved or made goes in place of the cursor [m]; ``None`` where nothing snaps.
    marks : tuple of Mark
        What shows that.
    """

    def __init__(self) -> None:
        self.on = self.held = False
        self.place: Vector2 | None = None
        self.marks: tuple[Mark, ...] = ()

    @property
    def active(self) -> bool:
        """Whether places, sizes and angles snap now."""
        return self.on or self.held

    def clear(self) -> None:
        """Let nothing be snapped."""
        self.place, self.marks = None, ()

    def follow(
        self, world: World, camera: Camera, cursor: Vector2, middle: Vector2, about: Outlines | None,
        without: Collection[int],
    ) -> None:  # fmt: skip
        """Find where what the cursor moves or makes would snap.

        Parameters
        ----------
        cursor, middle : Vector2
            Where the cursor is, and where the middle of what it holds would be [m].
        about : Outlines, optional
            What takes up room, where its middle is at the origin; ``None`` for a point.
        without : collection of int
            Entities that it does not snap to.
        """
        low, high = (np.zeros(2), np.zeros(2)) if about is None else extent_about(about)
        found = snapped(world, camera, middle, low, high, without)
        self.place, self.marks = found.place + (cursor - middle), found.marks
