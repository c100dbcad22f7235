"""Two trains of gears that begin and end with the same wheels."""

from physicslab.components import Layer, Meter, Pin
from physicslab.prefabs import gears
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_SPEED, _MODULE = 1.0, 0.05
"""The speed of the motors [rad/s], and the diameter for a tooth [m]."""


@Scene(
    title="Gear trains",
    description="48 teeth drive 16 three times as fast, whatever is between; one more wheel turns it round.",
    view=(-4.4, -2.8, 3.4, 2.8),
    teaches=("machines", "circular motion"),
    tags=("joints", "solid bodies"),
)
def gear_train(world: Contents) -> None:
    for n, (y, teeth) in enumerate(((1.35, (48, 12, 16)), (-1.35, (48, 20, 32, 16))), 1):
        wheels = gears(
            world, (-2.6, y), teeth, module=_MODULE, angular_velocity=_SPEED, mass=10.0, name=f"motor {n}"
        )
        world.component(wheels[0], Pin).motor_speed = -_SPEED  # of the ground against the wheel
        for wheel in wheels:
            world.add(wheel, Layer(touches="none"))
        world.spawn(Meter("angular velocity", wheels[-1], "top right" if n == 1 else "bottom right"))
