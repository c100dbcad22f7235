"""How far bodies fall in a step, beside how thick what lies below them is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform, Velocity
from physicslab.components.shape import BOX
from physicslab.world import World

__all__ = ["Passage", "passage"]


@dataclass(frozen=True, slots=True)
class Passage:
    """The body that falls furthest in a step, in sizes of what it could fall through.

    Attributes
    ----------
    body, through : int
        Both entities.
    way, sizes : float
        How far it falls from rest in a step [m], and as a multiple of the thickness of both together.
    """

    body: int
    through: int
    way: float
    sizes: float


def passage(world: World, held: NDArray[np.int64] | None = None) -> Passage | None:
    """Return how far a body falls in a step of the world, in sizes; ``None`` where none falls on anything.

    The way is that under gravity from rest: the speed at which a step begins is followed. Bodies in the
    rows ``held`` are left out.
    """
    shapes, moving = world.batch(Transform, Shape), world.batch(Transform, Velocity, Shape)
    if world.physics.gravity_mode != "linear" or len(shapes) < 2 or not len(moving):
        return None
    way = 0.5 * world.physics.gravity.magnitude * world.simulation.dt**2
    falls = world.bodies.inverse_mass[moving.rows] > 0.0
    if held is not None:
        falls &= ~np.isin(moving.rows, held)
    if not falls.any():
        return None
    shape, rows = world.table(Shape), shapes.rows
    box = shape["kind"][rows] == BOX
    thin = np.where(box, np.minimum(shape["width"][rows], shape["height"][rows]), 2.0 * shape["radius"][rows])
    thickness = dict(zip(shapes.entities.tolist(), thin.tolist(), strict=True))
    body = min(moving.entities[falls].tolist(), key=thickness.__getitem__)
    through = min((entity for entity in thickness if entity != body), key=thickness.__getitem__)
    return Passage(body, through, way, way / (thickness[body] + thickness[through]))
