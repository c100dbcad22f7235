"""Heaps: discs poured out, boxes in a pyramid and in a stack."""

from typing import Unpack

import numpy as np

from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import BodyOptions, Pair, box, circle
from physicslab.state.contents import Contents


def pile(
    world: Contents, count: int, foot: Pair = (0.0, 0.0), *, columns: int = 40, radius: float = 0.1,
    gap: float = 0.05, density: float = 1.0, seed: int = 1, **options: Unpack[BodyOptions],
) -> list[int]:  # fmt: skip
    """Spawn ``count`` discs in spaced rows that will fall into a pile; return their entities, row by row.

    Parameters
    ----------
    foot : vector
        Middle of the lowest row's lower side [m].
    columns : int
        Discs in a row.
    radius : float
        Radius of each disc [m].
    gap : float
        Mean distance between neighbours [m]; each is off its place by up to half of that, so that they do not
        come to rest on each other's tops.
    density : float
        Mass of each by its area [kg/m^2], where ``mass`` is not given.
    seed : int
        Seed of the places.
    **options
        Options of each disc, as in :class:`BodyOptions`.
    """
    corner, pitch = Vector2(*foot), 2.0 * radius + gap
    offsets = np.random.default_rng(seed).uniform(-gap / 2.0, gap / 2.0, (count, 2)).tolist()
    options.setdefault("mass", density * float(np.pi) * radius * radius)
    discs: list[int] = []
    for i, (dx, dy) in enumerate(offsets):
        cell = Vector2((i % columns - (columns - 1) / 2.0) * pitch, (i // columns + 0.5) * pitch)
        discs.append(circle(world, corner + cell + Vector2(dx, dy), radius=radius, **options))
    return discs


def pyramid(
    world: Contents, base: int, foot: Pair = (0.0, 0.0), *, size: float = 1.0, gap: float = 0.1,
    **options: Unpack[BodyOptions],
) -> list[int]:  # fmt: skip
    """Spawn rows of ``base``, ``base - 1``, ..., 1 square boxes; return their entities, row by row.

    Parameters
    ----------
    base : int
        Boxes in the lowest row.
    foot : vector
        Middle of the lowest row's lower side [m].
    size : float
        Side of a box [m].
    gap : float
        Between neighbours of a row [m]; the rows rest on each other.
    **options
        Options of each box, as in :class:`BodyOptions`, with a friction of 0.6.
    """
    options.setdefault("friction", 0.6)
    middle, pitch = Vector2(*foot), size + gap
    places = (
        middle + Vector2((i - (base - row - 1) / 2.0) * pitch, (row + 0.5) * size)
        for row in range(base)
        for i in range(base - row)
    )
    return [box(world, place, width=size, height=size, **options) for place in places]


def stack(
    world: Contents, count: int, base: Pair = (0.0, 0.0), *, width: float = 1.0, height: float = 1.0,
    gap: float = 0.0, **options: Unpack[BodyOptions],
) -> list[int]:  # fmt: skip
    """Spawn ``count`` boxes on top of each other; return their entities from the lowest up.

    Parameters
    ----------
    base : vector
        Middle of the lowest side [m].
    width, height : float
        Size of each box [m].
    gap : float
        Left between each and the next at the start [m].
    **options
        Options of each box, as in :class:`BodyOptions`, with a friction of 0.6.
    """
    options.setdefault("friction", 0.6)
    foot = Vector2(*base)
    places = (foot + Vector2(0.0, height / 2.0 + i * (height + gap)) for i in range(count))
    return [box(world, place, width=width, height=height, **options) for place in places]
