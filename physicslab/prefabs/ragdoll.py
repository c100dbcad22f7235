"""A ragdoll: a body, a head and limbs of capsules on pins that bend as a person's joints do."""

import math
from typing import NamedTuple

from physicslab.components import Mass, Material, Pin, Shape, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import Pair
from physicslab.state.contents import Contents


class _Limb(NamedTuple):
    """A limb from a joint on: its carrier, where that holds it, its direction, sizes and limits."""

    parent: int
    anchor: tuple[float, float]
    angle: float
    length: float
    radius: float
    mass: float
    lower: float
    upper: float


_TORSO = 0.3, 0.55, 35.0
"""Width [m], height [m], mass [kg] of a person of 1.75 m and 71 kg."""
_HEAD = 0.12, 5.0
_BENT = 2.3
"""How far elbows and knees bend [rad]."""
_LIMBS = (
    _Limb(0, (0.17, 0.22), 0.0, 0.25, 0.05, 2.0, -1.4, 1.4),
    _Limb(0, (-0.17, 0.22), math.pi, 0.25, 0.05, 2.0, -1.4, 1.4),
    _Limb(2, (0.125, 0.0), 0.0, 0.25, 0.04, 1.5, 0.0, _BENT),
    _Limb(3, (0.125, 0.0), math.pi, 0.25, 0.04, 1.5, -_BENT, 0.0),
    _Limb(0, (0.085, -0.3), -0.5 * math.pi, 0.4, 0.075, 8.0, -0.5, 1.4),
    _Limb(0, (-0.085, -0.3), -0.5 * math.pi, 0.4, 0.075, 8.0, -1.4, 0.5),
    _Limb(6, (0.2, 0.0), -0.5 * math.pi, 0.4, 0.06, 4.0, -_BENT, 0.0),
    _Limb(7, (0.2, 0.0), -0.5 * math.pi, 0.4, 0.06, 4.0, 0.0, _BENT),
)
"""Upper arms and forearms, thighs and shins, right and left; a parent is a place in the list of all parts."""


def ragdoll(world: Contents, position: Pair, *, size: float = 1.0, angle: float = 0.0) -> list[int]:
    """Spawn a ragdoll with its arms held out, the middle of its torso at ``position`` [m].

    Parameters
    ----------
    size : float
        How large it is; 1 is a person of 1.75 m and 71 kg, and masses go by its square.
    angle : float
        How far it has turned [rad].

    Returns
    -------
    entities : list of int
        Torso, head, upper arms, forearms, thighs and shins; joints come between them.

    Examples
    --------
    >>> from physicslab import World
    >>> world = World()
    >>> len(ragdoll(world, (0, 2)))
    10
    """
    middle = Vector2(*position)
    width, height, mass = _TORSO
    radius, skull = _HEAD

    def part(at: Vector2, turned: float, shape: Shape, weight: float) -> int:
        place = Transform(middle + (at * size).rotated(angle), angle + turned)
        return world.spawn(place, Velocity(), Mass(weight * size * size), shape, Material())

    def joint(parent: int, child: int, at: Vector2, tip: Vector2, limits: tuple[float, float]) -> None:
        world.spawn(Pin(parent, child, at * size, tip * size, lower=limits[0], upper=limits[1]))

    neck = Vector2(0.0, 0.5 * height + 0.02)
    above = neck + Vector2(0.0, radius)
    made = [
        part(Vector2(), 0.0, Shape.box(width * size, height * size), mass),
        part(above, 0.0, Shape.circle(radius * size), skull),
    ]
    joint(made[0], made[1], neck, Vector2(0.0, -radius), (-0.5, 0.5))
    places = [(Vector2(), 0.0), (above, 0.0)]
    for limb in _LIMBS:
        start, turned = places[limb.parent]
        anchor = Vector2(*limb.anchor)
        along = Vector2(0.5 * limb.length, 0.0)
        at = start + anchor.rotated(turned) + along.rotated(limb.angle)
        shape = Shape.capsule(limb.length * size, limb.radius * size)
        made.append(part(at, limb.angle, shape, limb.mass))
        places.append((at, limb.angle))
        rest = limb.angle - turned
        joint(made[limb.parent], made[-1], anchor, -along, (rest + limb.lower, rest + limb.upper))
    return made
