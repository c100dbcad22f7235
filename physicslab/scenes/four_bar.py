"""A linkage of four bars, whose pen draws a line that is nearly straight."""

import math

from physicslab.components import Layer, Pin, Trail
from physicslab.prefabs import BodyOptions, capsule, circle
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_UNIT, _SPEED, _START = 0.4, -0.5 * math.pi, math.radians(240.0)
"""The length of the crank [m], the speed of the motor [rad/s], the angle of the crank at first [rad].

The ground is 2 cranks long, rocker and half of the coupler 2.5: K. Hoeken's proportions of 1926, in which the
pen is also nearly even in its speed.
"""


@Scene(
    title="A four-bar linkage",
    description="Bars that only turn draw a line: for half of each turn the pen is off by 4 mm in 1.7 m.",
    view=(-1.3, -0.7, 3.0, 2.3),
    moment=3.4,
    teaches=("machines",),
    tags=("joints", "solid bodies"),
)
def four_bar(world: Contents) -> None:
    tip = _UNIT * math.cos(_START), _UNIT * math.sin(_START)
    foot = (2.0 * _UNIT, 0.0)
    between = foot[0] - tip[0], foot[1] - tip[1]
    half = 0.5 * math.hypot(*between)
    rise = math.sqrt((2.5 * _UNIT) ** 2 - half**2) / (2.0 * half)
    elbow = 0.5 * (tip[0] + foot[0]) - rise * between[1], 0.5 * (tip[1] + foot[1]) + rise * between[0]
    pen = 2.0 * elbow[0] - tip[0], 2.0 * elbow[1] - tip[1]
    bars = []
    for name, start, end, colour in (
        ("crank", (0.0, 0.0), tip, "#e69f00"),
        ("coupler", tip, pen, "#56b4e9"),
        ("rocker", foot, elbow, "#00be8c"),
    ):
        length, angle = math.dist(start, end), math.atan2(end[1] - start[1], end[0] - start[0])
        middle = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
        looks: BodyOptions = {"mass": 2.0 * length, "angle": angle, "colour": colour, "name": name}
        bars.append(capsule(world, middle, length=length, radius=0.04, **looks))
    crank, coupler, rocker = bars
    point = circle(world, pen, radius=0.06, mass=0.1, colour="#e14f3c", name="pen")
    world.add(point, Trail(8.0))
    for body in (*bars, point):
        world.add(body, Layer(touches="none"))
    world.spawn(Pin(None, crank, (0.0, 0.0), (-0.5 * _UNIT, 0.0), motor_speed=_SPEED), name="motor")
    world.spawn(Pin(crank, coupler, (0.5 * _UNIT, 0.0), (-2.5 * _UNIT, 0.0)))
    world.spawn(Pin(None, rocker, foot, (-1.25 * _UNIT, 0.0)))
    world.spawn(Pin(rocker, coupler, (1.25 * _UNIT, 0.0), (0.0, 0.0)))
    world.spawn(Pin(coupler, point, (2.5 * _UNIT, 0.0), (0.0, 0.0)))
