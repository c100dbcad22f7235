"""A crane whose trolley stops, and a ball on its rope that does not."""

from physicslab.components import Rope, Slot
from physicslab.ecs.config import SimulationConfig
from physicslab.prefabs import box, circle
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_SPEED, _HEIGHT, _LENGTH, _STOP = 1.6, 5.0, 3.6, 0.6
"""Speed [m/s] and height [m] of the trolley; length of the rope [m], and where the trolley stops [m]."""


@Scene(
    title="A crane",
    description="The trolley stops, the ball swings on: what moves keeps momentum, until it hits a wall.",
    view=(-5.4, -0.5, 5.4, 5.8),
    moment=3.2,
    teaches=("momentum", "oscillations", "energy"),
    tags=("joints", "solid bodies"),
    simulation=SimulationConfig(contacts="soft"),
)
def crane(world: Contents) -> None:
    yellow, start = "#e8b33a", -3.0
    box(world, (0.0, -0.2), width=11.0, height=0.4, static=True, friction=0.8, name="ground")
    box(world, (-4.4, 2.7), width=0.4, height=5.4, static=True, colour=yellow, name="tower")
    box(world, (-0.6, _HEIGHT + 0.3), width=8.6, height=0.24, static=True, colour=yellow, name="jib")
    trolley = box(
        world, (start, _HEIGHT), width=0.6, height=0.2, mass=50.0, velocity=(_SPEED, 0.0), colour="#9aa0aa",
        name="trolley",
    )  # fmt: skip
    ball = circle(
        world, (start, _HEIGHT - _LENGTH), radius=0.4, mass=100.0, velocity=(_SPEED, 0.0), material="steel",
        restitution=0.0, name="ball",
    )  # fmt: skip
    world.spawn(
        Slot(None, trolley, (start, _HEIGHT), upper=_STOP - start, motor_speed=_SPEED, max_force=2000.0),
        name="rail",
    )
    world.spawn(Rope(trolley, ball, length=_LENGTH), name="rope")
    for row in range(4):
        for column in range(2):
            place = (1.6 + 0.5 * column, 0.25 + 0.5 * row)
            box(world, place, width=0.5, height=0.5, mass=4.0, material="wood", restitution=0.0)
