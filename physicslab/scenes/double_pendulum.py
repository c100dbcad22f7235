"""Two double pendulums that begin almost alike."""

import math

from physicslab.components import Pin, Trail
from physicslab.prefabs import capsule
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_LENGTH, _START, _APART = 1.0, math.radians(120.0), 1e-3
"""The length of a bar [m], the angle at first [rad], and how much farther the second lower bar is."""


@Scene(
    title="Double pendulum",
    description="Two that begin a thousandth of a radian apart: alike for seconds, and then nothing alike.",
    view=(-4.5, -2.4, 4.5, 2.2),
    moment=2.2,
    teaches=("chaos", "energy"),
    tags=("joints", "solid bodies"),
)
def double_pendulum(world: Contents) -> None:
    for name, middle, further in (("left", -2.2, 0.0), ("right", 2.2, _APART)):
        x, y, above = middle, 0.0, 0
        for part, angle in (("upper", _START), ("lower", _START + further)):
            dx, dy, half = math.sin(angle) * _LENGTH, -math.cos(angle) * _LENGTH, 0.5 * _LENGTH
            place, turned = (x + 0.5 * dx, y + 0.5 * dy), angle - 0.5 * math.pi
            bar = capsule(world, place, length=_LENGTH, radius=0.05, angle=turned, name=f"{name} {part}")
            held = (half, 0.0) if above else (middle, 0.0)
            world.spawn(Pin(above or None, bar, held, (-half, 0.0)))
            x, y, above = x + dx, y + dy, bar
        world.add(above, Trail(2.0))
