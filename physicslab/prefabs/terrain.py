"""Ground to roll, slide and stand on: wedges, ramps, hills and loops."""

import math
from collections.abc import Sequence
from typing import Unpack

from physicslab.components import Shape
from physicslab.components.vertices import regular
from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import BodyOptions, Pair, body, polygon
from physicslab.state.contents import Contents


def wedge(
    world: Contents, position: Pair, *, width: float = 1.0, height: float = 0.5,
    **options: Unpack[BodyOptions],
) -> int:  # fmt: skip
    """Spawn a triangle with a right angle, its left lower corner, at ``position`` [m]; return its entity.

    Examples
    --------
    >>> from physicslab import World
    >>> world = World()
    >>> slope = wedge(world, (0, 0), width=3, height=1.5, static=True)
    >>> world.component(slope, Shape).vertices[0]
    Vector2(x=-1.0, y=-0.5)
    """
    x, y = Vector2(*position)
    corners = [(0.0, 0.0), (width, 0.0), (0.0, height)]
    return polygon(world, (x + width / 3.0, y + height / 3.0), corners, **options)


def regular_polygon(
    world: Contents, position: Pair, *, corners: int = 6, radius: float = 0.25,
    **options: Unpack[BodyOptions],
) -> int:  # fmt: skip
    """Spawn a polygon of 3 to 8 equal sides in a circle of a radius [m]; one side is below."""
    return polygon(world, position, regular(corners, radius), **options)


def ground(
    world: Contents, vertices: Sequence[Pair], position: Pair = (0.0, 0.0), **options: Unpack[BodyOptions]
) -> int:
    """Spawn fixed ground along 2 to 1,000 vertices [m] from ``position``; return its entity.

    It is solid on its left: to have it below, go from right to left.

    Examples
    --------
    >>> from physicslab import World
    >>> world = World()
    >>> hill = ground(world, [(5, 0), (1, 0), (0, 1), (-1, 0), (-5, 0)], friction=0.8)
    """
    options["static"] = True
    return body(world, Shape.chain(vertices), position, **options)


def ramp(
    world: Contents, position: Pair, *, length: float = 4.0, slope: float = 0.5,
    **options: Unpack[BodyOptions],
) -> int:  # fmt: skip
    """Spawn a fixed slope that goes down to the right from ``position`` [m], by ``slope`` [rad].

    Returns
    -------
    entity : int
        Its surface is ``length`` [m] long.
    """
    foot = Vector2.from_angle(-slope, length)
    return ground(world, [foot, (0.0, 0.0)], position, **options)


def loop(
    world: Contents, position: Pair, *, radius: float = 1.0, run: float = 3.0, opening: float = 0.8,
    segments: int = 400, **options: Unpack[BodyOptions],
) -> int:  # fmt: skip
    """Spawn a fixed loop-the-loop with its lowest point at ``position`` [m]; return its entity.

    A level run leads in from the left, below the opening, and what has gone around drops onto it.

    Parameters
    ----------
    radius, run : float
        Radius of the loop, and the length of the run [m].
    opening : float
        Angle [rad] that the loop lacks on the left above the run, through which a body comes in.
    segments : int
        Segments of a whole turn, 24 to 900: from 24 on a chain is round, the circle that touches all of them.
    """
    turn = 2.0 * math.pi / segments
    outer = radius / math.cos(0.5 * turn)
    angles = [(k + 0.5) * turn for k in reversed(range(int((2.0 * math.pi - opening) / turn)))]
    circle = [(outer * math.sin(t), radius - outer * math.cos(t)) for t in angles]
    return ground(world, [*circle, (-run, 0.0)], position, **options)
