"""Discs poured out."""

from __future__ import annotations

import numpy as np

from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import Pair
from physicslab.prefabs.circle import circle
from physicslab.world import World

__all__ = ["pile"]


def pile(
    world: World,
    count: int,
    foot: Pair = (0.0, 0.0),
    *,
    columns: int = 40,
    radius: float = 0.1,
    gap: float = 0.05,
    density: float = 1.0,
    restitution: float = 0.0,
    friction: float = 0.5,
    seed: int = 1,
) -> list[int]:
    """Spawn ``count`` discs in spaced rows that will fall into a pile; return their entities, row by row.

    Parameters
    ----------
    foot : vector
        Middle of the lowest row's lower side [m].
    columns : int
        Discs in a row.
    radius : float
        Of each disc [m].
    gap : float
        Mean distance between neighbours [m]; each is off its place by up to half of that, so that they do not
        come to rest on each other's tops.
    density : float
        Mass of each by its area [kg/m^2].
    restitution, friction : float
        The numbers of their surface.
    seed : int
        Of the places.
    """
    corner, pitch = Vector2(*foot), 2.0 * radius + gap
    offsets = np.random.default_rng(seed).uniform(-gap / 2.0, gap / 2.0, (count, 2)).tolist()
    mass = density * float(np.pi) * radius * radius
    discs: list[int] = []
    for i, (dx, dy) in enumerate(offsets):
        cell = Vector2((i % columns - (columns - 1) / 2.0) * pitch, (i // columns + 0.5) * pitch)
        place = corner + cell + Vector2(dx, dy)
        discs.append(
            circle(world, place, radius=radius, mass=mass, restitution=restitution, friction=friction)
        )
    return discs
