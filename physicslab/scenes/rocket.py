"""A rocket that starts, and one that circles."""

from physicslab.components import Thrust, Trail
from physicslab.ecs.config import PhysicsConfig
from physicslab.prefabs import box
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_RADIUS, _RATE = 2.0, 1.0
"""Radius of the circle [m], and rate of going round it [rad/s]."""


@Scene(
    title="Rockets",
    description="A push across its path leads one round in a circle; one along it makes the other faster.",
    view=(-4.5, -3.6, 3.0, 4.0),
    moment=2.0,
    teaches=("forces", "circular motion"),
    tags=("solid bodies",),
    physics=PhysicsConfig(gravity_mode="none"),
)
def rocket(world: Contents) -> None:
    # A push at a right angle to its path keeps it on a circle, as gravity keeps a planet: F = m w^2 r.
    circling = box(
        world, (_RADIUS, 0.0), width=0.3, height=0.8, velocity=(0.0, _RADIUS * _RATE),
        angular_velocity=_RATE, name="circling",
    )  # fmt: skip
    world.add(circling, Thrust((-_RADIUS * _RATE**2, 0.0), frame="body"))
    # One that is pushed along, and does not turn, goes faster and faster.
    straight = box(world, (-3.5, -3.0), width=0.3, height=0.8, name="straight")
    world.add(straight, Thrust((0.0, 0.15), frame="body", at=(0.0, -0.4)))
    for rocket in (circling, straight):
        world.add(rocket, Trail(7.0))
