"""A motor, a crank and a piston."""

import math

from physicslab.components import Graph, GraphLine, Pin, Slot
from physicslab.prefabs import box, capsule
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_CRANK, _ROD, _SPEED, _START = 0.5, 1.4, math.pi, math.radians(60.0)
"""The lengths of crank and connecting rod [m], the speed of the motor [rad/s], its angle at first [rad]."""


@Scene(
    title="Crank and piston",
    description="A slider-crank, half a turn a second: the piston's way is no sine, but sharper far out.",
    view=(-1.2, -1.4, 3.2, 1.4),
    teaches=("machines", "circular motion"),
    tags=("joints", "solid bodies"),
    also="engine",
)
def piston(world: Contents) -> None:
    x, y = _CRANK * math.cos(_START), _CRANK * math.sin(_START)
    across, leaning = math.sqrt(_ROD**2 - y**2), -math.asin(y / _ROD)
    crank = capsule(
        world, (0.5 * x, 0.5 * y), length=_CRANK, radius=0.07, mass=2.0, angle=_START, name="crank"
    )
    rod = capsule(
        world, (x + 0.5 * across, 0.5 * y), length=_ROD, radius=0.05, angle=leaning, name="connecting rod"
    )
    piston = box(world, (x + across, 0.0), width=0.4, height=0.5, name="piston")
    world.spawn(Pin(None, crank, anchor_b=(-0.5 * _CRANK, 0.0), motor_speed=_SPEED), name="motor")
    world.spawn(Pin(crank, rod, (0.5 * _CRANK, 0.0), (-0.5 * _ROD, 0.0)), name="crank pin")
    world.spawn(Pin(rod, piston, (0.5 * _ROD, 0.0)), name="piston pin")
    world.spawn(Slot(None, piston), name="cylinder")
    graph = world.spawn(Graph())
    world.spawn(GraphLine(graph, "x", piston))
