"""Charges on cycloids."""

from physicslab.components import Charge, Mass, Trail, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


@Scene(
    title="Crossed fields",
    description="Charges in an electric and a magnetic field drift across both, on cycloids, at 0.6 m/s.",
    view=(-3.5, -3.4, 4.0, 3.4),
    moment=3.0,
    teaches=("electricity",),
    tags=("charges",),
    also="magnet, Hall effect",
    physics=PhysicsConfig(gravity_mode="none", electric_field=Vector2(0.0, -1.2), magnetic_field=-2.0),
)
def crossed_fields(world: Contents) -> None:
    # All drift at E / B = 0.6 m/s to the right; the second, which is as fast from the start, goes straight.
    for n, (speed, charge) in enumerate(((0.0, 1.0), (0.6, 1.0), (0.0, 2.0), (2.0, 1.0), (0.0, -1.0))):
        world.spawn(
            Transform((-3.0, 2.6 - 1.3 * n)), Velocity((speed, 0.0)), Mass(1.0), Charge(charge),
            Trail(10.0), name=f"{charge:g} C, {speed:g} m per s",
        )  # fmt: skip
