"""Bodies that float, and bodies that sink."""

from physicslab.components import Medium, Shape, Transform
from physicslab.prefabs import box, capsule, circle
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_WATER = 1000.0
"""kg/m^2: as if everything were a metre thick."""


@Scene(
    title="Floating and sinking",
    description="What is lighter than water floats, as deep as its share of the density; a stone sinks.",
    view=(-4.6, -3.5, 4.6, 2.6),
    teaches=("buoyancy", "equilibrium"),
    tags=("liquids", "solid bodies"),
    also="boat, ship, swim, Archimedes",
)
def floating(world: Contents) -> None:
    world.spawn(Transform((0.0, -1.5)), Shape.box(8.0, 3.0), Medium(_WATER, viscosity=60.0), name="water")
    for name, x, width, y, height in (
        ("bottom", 0.0, 8.8, -3.2, 0.4), ("left", -4.2, 0.4, -1.3, 4.2), ("right", 4.2, 0.4, -1.3, 4.2)
    ):  # fmt: skip
        box(world, (x, y), width=width, height=height, static=True, name=name)
    box(world, (-3.0, 1.2), width=0.9, height=0.6, mass=0.54 * 600.0, name="wood, 0.6")
    circle(world, (-1.2, 1.6), radius=0.4, mass=0.5027 * 250.0, name="cork, 0.25")
    box(world, (0.6, 1.4), width=0.7, height=0.7, mass=0.49 * 920.0, angle=0.3, name="ice, 0.92")
    capsule(world, (2.4, 1.5), length=0.8, radius=0.2, mass=0.4457 * 500.0, angle=0.8, name="log, 0.5")
    circle(world, (3.3, 2.4), radius=0.3, mass=0.2827 * 2500.0, name="stone, 2.5")
