"""Two carts on a track without friction."""

from physicslab.components import Meter, Slider
from physicslab.components.vertices import centred
from physicslab.prefabs import BodyOptions, box, polygon
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_TRACK = 4.5
"""Half the length of the track [m]."""


@Scene(
    title="Carts on a track",
    description="1 kg at 2 m/s meets 2 kg: together they keep 2 kg m/s, but not their energy, as e is 0.8.",
    view=(-4.9, -0.3, 4.9, 1.2),
    moment=2.2,
    teaches=("momentum", "collisions", "energy"),
    tags=("solid bodies",),
    also="crash, elastic, inelastic, train",
)
def carts(world: Contents) -> None:
    wall: BodyOptions = {"static": True, "friction": 0.0, "restitution": 1.0}
    box(world, (0.0, -0.1), width=2.0 * _TRACK + 0.4, height=0.2, **(wall | {"name": "track"}))
    for side, name in ((-1.0, "left end"), (1.0, "right end")):
        box(world, (side * (_TRACK + 0.1), 0.3), width=0.2, height=0.6, **(wall | {"name": name}))
    carts = []
    # A pair has the smaller restitution: that of the first cart, which a slider changes.
    for number, x, mass, speed, e, colour in (
        (1, -3.0, 1.0, 2.0, 0.8, "#56b4e9"),
        (2, 0.6, 2.0, 0.0, 1.0, "#e69f00"),
    ):
        half, high = 0.4 + 0.15 * mass, 0.3 + 0.2 * mass
        outline = [
            (-half, 0.0), (half, 0.0), (half, 0.3), (half - 0.25, high), (0.25 - half, high), (-half, 0.3)
        ]  # fmt: skip
        lowest = min(y for _, y in centred(outline))
        cart = polygon(
            world, (x, -lowest), outline, mass=mass, velocity=(speed, 0.0), fixed_rotation=True, friction=0.0,
            restitution=e, colour=colour, name=f"cart {number}",
        )  # fmt: skip
        carts.append(cart)
        world.spawn(Meter("velocity x", cart, "top left"))
    world.spawn(Meter("momentum x", corner="top right"))
    world.spawn(Slider("Mass.mass", carts[0], 0.5, 5.0))
    world.spawn(Slider("Material.restitution", carts[0], 0.0, 1.0))
