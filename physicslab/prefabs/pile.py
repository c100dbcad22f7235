"""Discs poured out."""

from typing import Unpack

import numpy as np

from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import BodyOptions, Pair
from physicslab.prefabs.circle import circle
from physicslab.world import World


def pile(
    world: World,
    count: int,
    foot: Pair = (0.0, 0.0),
    *,
    columns: int = 40,
    radius: float = 0.1,
    gap: float = 0.05,
    density: float = 1.0,
    seed: int = 1,
    **options: Unpack[BodyOptions],
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
        Mass of each by its area [kg/m^2], where ``mass`` is not given.
    seed : int
        Of the places.
    **options
        Of each disc, as :class:`BodyOptions` has them.
    """
    corner, pitch = Vector2(*foot), 2.0 * radius + gap
    offsets = np.random.default_rng(seed).uniform(-gap / 2.0, gap / 2.0, (count, 2)).tolist()
    options.setdefault("mass", density * float(np.pi) * radius * radius)
    discs: list[int] = []
    for i, (dx, dy) in enumerate(offsets):
        cell = Vector2((i % columns - (columns - 1) / 2.0) * pitch, (i // columns + 0.5) * pitch)
        discs.append(circle(world, corner + cell + Vector2(dx, dy), radius=radius, **options))
    return discs
