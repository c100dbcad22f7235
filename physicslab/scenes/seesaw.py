"""Three seesaws: one is in balance."""

from physicslab.components import Layer, Pin
from physicslab.ecs.config import SimulationConfig
from physicslab.prefabs import BodyOptions, box, polygon
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_LONG, _HEIGHT, _ARM = 3.6, 0.55, 1.5
"""The length of a plank, the height of its middle, and how far out the light box is [m]."""
_WOOD: BodyOptions = {"material": "wood", "restitution": 0.0, "friction": 0.8}


@Scene(
    title="Seesaws",
    description="30 kg at 0.5 m hold 10 kg at 1.5 m in balance, as levers do; at 0.4 or 0.6 m they do not.",
    view=(-6.5, -0.5, 6.5, 2.6),
    teaches=("lever", "equilibrium"),
    tags=("joints", "solid bodies"),
    also="balance",
    simulation=SimulationConfig(contacts="soft"),
)
def seesaw(world: Contents) -> None:
    box(world, (0.0, -0.15), width=13.0, height=0.3, static=True, friction=0.8, name="ground")
    for name, x, arm in (("too near", -4.2, 0.4), ("in balance", 0.0, 0.5), ("too far", 4.2, 0.6)):
        corners = [(-0.4, 0.0), (0.4, 0.0), (0.0, _HEIGHT)]
        stand = polygon(
            world, (x, _HEIGHT / 3.0), corners, static=True, colour="#9aa0aa", name=f"stand {name}"
        )
        world.add(stand, Layer(touches="none"))
        plank = box(
            world, (x, _HEIGHT), width=_LONG, height=0.1, **(_WOOD | {"mass": 8.0, "name": f"plank {name}"})
        )
        # A motor at rest is the little friction of an axle.
        axle = Pin(None, plank, (x, _HEIGHT), motor_speed=0.0, max_torque=1.0)
        world.spawn(axle, name=f"axle {name}")
        for mass, way, size, colour in ((30.0, -arm, 0.5, "#6f7dff"), (10.0, _ARM, 0.3, "#e69f00")):
            place = x + way, _HEIGHT + 0.05 + 0.5 * size
            box(
                world, place, width=size, height=size, mass=mass, friction=0.8, colour=colour,
                name=f"{mass:g} kg {name}",
            )  # fmt: skip
