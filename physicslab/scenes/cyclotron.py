"""A charge that is driven in step with its circling."""

import math

from physicslab.components import Charge, Mass, Thrust, Trail, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_FIELD = 4.0
"""The magnetic field [T]: 1 C with 1 kg goes round with as many radians a second, at any speed."""


@Scene(
    title="A cyclotron",
    description="A push in step with the circling of a charge drives it outwards; out of step it does not.",
    view=(-4.0, -2.4, 4.0, 2.4),
    moment=3.0,
    teaches=("electricity", "circular motion", "energy"),
    tags=("charges",),
    also="magnet, accelerator",
    physics=PhysicsConfig(gravity_mode="none", magnetic_field=_FIELD),
)
def cyclotron(world: Contents) -> None:
    for name, share in (("in step", 1.0), ("out of step", 1.15)):
        world.spawn(
            Transform((-1.7 if share == 1.0 else 2.3, 0.0)), Velocity(), Mass(1.0), Charge(),
            Thrust((1.2, 0.0), frequency=share * _FIELD / (2.0 * math.pi)), Trail(10.0), name=name,
        )  # fmt: skip
