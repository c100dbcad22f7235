"""A bridge of planks on pins, which hangs between two points."""

import math
from itertools import pairwise
from typing import Unpack

from physicslab.components import Pin
from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import BodyOptions, Pair, box
from physicslab.world import World


def bridge(
    world: World, start: Pair, end: Pair, *, count: int = 30, slack: float = 1.05, thickness: float = 0.1,
    **options: Unpack[BodyOptions],
) -> list[int]:  # fmt: skip
    """Spawn planks on pins from one fixed point to another [m], on an arc that hangs down between them.

    Parameters
    ----------
    count : int
        How many planks.
    slack : float
        How long all planks are, as a share of the distance of the points; more than 1.
    thickness : float
        How thick a plank is [m].
    **options
        Of each plank, as of :func:`~physicslab.prefabs.body.box`; its angle is given by the arc.

    Returns
    -------
    entities : list of int
        The planks from the start on; the pins come after them.

    Examples
    --------
    >>> world = World()
    >>> planks = bridge(world, (0, 0), (6, 0), count=12)
    >>> len(planks)
    12
    """
    first, last = Vector2(*start), Vector2(*end)
    span = last - first
    half = _half_angle(count, slack)
    length = slack * span.magnitude / count
    level = math.atan2(span.y, span.x)
    turns = [level + half * (2.0 * (n + 0.5) / count - 1.0) for n in range(count)]
    planks: list[int] = []
    at = first
    for turn in turns:
        along = Vector2(length, 0.0).rotated(turn)
        laid: BodyOptions = {**options, "angle": turn}
        planks.append(box(world, at + 0.5 * along, width=length, height=thickness, **laid))
        at += along
    arm = (0.5 * length, 0.0)
    world.spawn(Pin(a=planks[0], anchor_a=-Vector2(*arm), anchor_b=first))
    for one, other in pairwise(planks):
        world.spawn(Pin(a=one, b=other, anchor_a=arm, anchor_b=-Vector2(*arm)))
    world.spawn(Pin(a=planks[-1], anchor_a=arm, anchor_b=last))
    return planks


def _half_angle(count: int, slack: float) -> float:
    """Return by how much the first plank is inclined [rad]: the planks then reach from end to end."""

    def reach(half: float) -> float:
        return sum(math.cos(half * (2.0 * (n + 0.5) / count - 1.0)) for n in range(count)) / count

    low, high = 0.0, 0.5 * math.pi
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if reach(middle) > 1.0 / slack else (low, middle)
    return low
