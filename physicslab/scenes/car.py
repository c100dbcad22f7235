"""A car on hills, with motors in its wheels."""

import math

from physicslab.components import Pin
from physicslab.prefabs import circle, ground, polygon
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_RADIUS, _TORQUE, _SPEED = 0.3, 18.0, -12.0
"""Radius of each wheel [m]; the most torque [N m] and the speed [rad/s] of its motor."""
_LEFT, _RIGHT, _STEP = -9.5, 11.5, 0.25
"""The ends of the ground, and how far one vertex is from the next [m]."""


def _height(x: float) -> float:
    """Return the height of the ground [m]: hills from a level start on, then a slope that grows steeper."""
    hills = 0.5 * math.sin(0.9 * (x + 5.5)) * min(1.0, 0.3 * (x + 5.5)) if -5.5 < x < 5.0 else 0.0
    return hills + 0.08 * max(0.0, x - 4.2) ** 2 + 0.3 * max(0.0, -8.2 - x) ** 2


@Scene(
    title="A car on hills",
    description="Motors push with 2 M / r = 120 N: up hills, but no slope above 26 degrees.",
    view=(-9.5, -1.6, 11.5, 5.0),
    moment=3.0,
    teaches=("machines", "forces", "friction"),
    tags=("joints", "solid bodies"),
    also="motor, wheels",
)
def car(world: Contents) -> None:
    along = [_RIGHT - k * _STEP for k in range(round((_RIGHT - _LEFT) / _STEP) + 1)]
    ground(world, [(x, _height(x)) for x in along], friction=1.0, name="hills")
    outline = [(-0.95, -0.12), (0.95, -0.12), (1.0, 0.08), (0.4, 0.42), (-0.4, 0.42), (-0.95, 0.14)]
    car = polygon(world, (-7.0, 0.6), outline, radius=0.03, mass=20.0, colour="#e14f3c", name="car")
    for name, place in (("rear", -0.6), ("front", 0.6)):
        wheel = circle(
            world, (-7.0 + place, _RADIUS), radius=_RADIUS, mass=4.0, friction=1.0, colour="#4c566a",
            name=f"{name} wheel",
        )  # fmt: skip
        axle = Pin(car, wheel, (place, -0.3), motor_speed=_SPEED, max_torque=_TORQUE)
        world.spawn(axle, name=f"{name} motor")
