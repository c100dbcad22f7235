"""Gear trains: discs on pins that turn each other."""

from collections.abc import Sequence
from typing import Unpack

from physicslab.components import Gear, Pin
from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import BodyOptions, Pair, circle
from physicslab.state.contents import Contents


def gears(
    world: Contents, position: Pair, teeth: Sequence[int], *, module: float = 0.05, onwards: float = 0.0,
    **options: Unpack[BodyOptions],
) -> list[int]:  # fmt: skip
    """Spawn wheels in a row, each on a pin and coupled to the next one; return their entities.

    A wheel is a disc of its pitch circle; its picture has teeth.

    Parameters
    ----------
    position : vector
        The middle of the first wheel [m].
    teeth : sequence of int
        How many each wheel has: its diameter is as many modules.
    module : float
        The diameter for one tooth [m].
    onwards : float
        The direction in which the row goes on [rad].
    **options
        As in :class:`BodyOptions`; the mass is that of the first wheel, others have theirs by their area,
        and it is the first that an angular velocity is of.

    Raises
    ------
    ValueError
        If a wheel has no tooth.

    Examples
    --------
    >>> from physicslab.components import Mass
    >>> from physicslab import World
    >>> world = World()
    >>> wheels = gears(world, (0, 2), [12, 36], angular_velocity=3.0)
    >>> world.component(wheels[1], Mass).mass
    9.0
    """
    if not teeth or min(teeth) < 1:
        raise ValueError(f"teeth = {list(teeth)!r}: must be whole numbers >= 1, one for each wheel")
    mass, spin = options.get("mass", 1.0), options.get("angular_velocity", 0.0)
    middle, wheels = Vector2(*position), list[int]()
    for n, count in enumerate(teeth):
        if n:
            middle += Vector2.from_angle(onwards, 0.5 * module * (teeth[n - 1] + count))
        share = count / teeth[0]
        options["mass"] = mass * share * share
        options["angular_velocity"] = (-1.0) ** n * spin / share
        wheels.append(circle(world, middle, radius=0.5 * module * count, **options))
        world.add(wheels[n], Pin(anchor_b=middle))
        options["name"] = None
        if n:
            world.spawn(Gear(wheels[n - 1], wheels[n], ratio=-teeth[n - 1] / count))
    return wheels
