"""The playground that the window opens with."""

import math

from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.prefabs import BodyOptions, box, circle, pendulum
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


@Scene(
    title="Sandbox",
    description="A floor, a ramp, a pile of boxes and a pendulum to play with.",
    view=(-5.9, -0.5, 5.9, 5.9),
    teaches=("energy", "collisions"),
    tags=("joints", "solid bodies"),
    physics=PhysicsConfig(bounds=(-5.8, -0.4, 5.8, 5.8)),
    # The pile sleeps until something touches it: the rest is moved at life's speed by plain Python too, while
    # kernels are compiled on a first start.
    simulation=SimulationConfig(sleeping=True),
)
def sandbox(world: Contents) -> None:
    # The lower restitution of a pair counts: what falls here bounces as its own says.
    for name, place, width, height, angle in (
        ("floor", (0.0, -0.2), 11.6, 0.4, 0.0), ("ramp", (-4.0, 0.9), 3.2, 0.16, -0.42),
    ):  # fmt: skip
        made = BodyOptions(name=name, angle=angle, static=True, friction=0.6, restitution=1.0)
        box(world, place, width=width, height=height, **made)
    for n, radius in enumerate((0.22, 0.3, 0.18)):
        position = (-5.1 + 0.62 * n, 2.2 - 0.28 * n)
        circle(world, position, radius=radius, mass=5.0 * math.pi * radius**2, restitution=0.3)
    for row in range(4):
        for column in range(4 - row):
            position = (2.4 + 0.52 * column + 0.26 * row, 0.25 + 0.5 * row)
            box(world, position, width=0.5, height=0.5, restitution=0.1, friction=0.6)
    pendulum(world, (0.4, 4.6), length=2.6, angle=-1.0, radius=0.28, mass=2.0, restitution=0.3, name="bob")
    circle(world, (-0.9, 0.4), radius=0.4, mass=1.5, restitution=0.7, name="ball")
