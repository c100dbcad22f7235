"""A hanging bridge that carries what falls on it."""

import math

from physicslab.components import Pin
from physicslab.ecs.config import SimulationConfig
from physicslab.prefabs import box, circle
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_PLANKS, _LENGTH, _THICKNESS, _RADIUS = 20, 0.4, 0.12, 12.0
"""How many planks; the length and the thickness of each, and the radius of the arc in which they hang [m]."""


@Scene(
    title="A hanging bridge",
    description="Twenty planks on pins carry what falls on them: each pin tells the force that it holds.",
    # A plank that is hit takes a way of its own until its pins act, at the end of the substep.
    simulation=SimulationConfig(substeps=8),
    view=(-4.6, -2.0, 4.6, 3.4),
    teaches=("forces", "equilibrium"),
    tags=("joints", "solid bodies"),
    also="rope",
)
def bridge(world: Contents) -> None:
    one = 2.0 * math.asin(0.5 * _LENGTH / _RADIUS)  # the angle that one plank takes of the arc
    half, top = _RADIUS * math.sin(0.5 * _PLANKS * one), _RADIUS * math.cos(0.5 * _PLANKS * one)
    left, right = (
        box(world, (side * (half + 1.5), -1.5), width=3.0, height=3.0, static=True, name=f"{name} cliff")
        for name, side in (("left", -1.0), ("right", 1.0))
    )
    before, end = left, (1.5, 1.5)
    middle = _RADIUS * math.cos(0.5 * one)
    for n in range(_PLANKS):
        angle = (n + 0.5 - 0.5 * _PLANKS) * one
        place = middle * math.sin(angle), top - middle * math.cos(angle)
        plank = box(
            world, place, width=_LENGTH, height=_THICKNESS, mass=10.0, angle=angle, name=f"plank {n + 1}"
        )
        world.spawn(Pin(before, plank, end, (-0.5 * _LENGTH, 0.0)))
        before, end = plank, (0.5 * _LENGTH, 0.0)
    world.spawn(Pin(right, before, (-1.5, 1.5), end))
    for n, mass in enumerate((5.0, 20.0, 60.0)):
        radius = 0.2 + 0.12 * n
        circle(
            world, (1.6 * (n - 1), 0.9 + 0.7 * n), radius=radius, mass=mass, friction=0.6, name=f"{mass:g} kg"
        )
