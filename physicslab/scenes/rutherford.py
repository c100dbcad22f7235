"""Charges that scatter at a nucleus."""

from physicslab.components import Charge, Mass, Trail, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


@Scene(
    title="Rutherford's experiment",
    description="Light charges fly at a heavy one: few come near it, and the nearest are thrown back.",
    view=(-4.4, -3.0, 4.4, 3.0),
    moment=2.0,
    teaches=("electricity", "energy"),
    tags=("charges",),
    also="atom, nucleus, scattering",
    physics=PhysicsConfig(gravity_mode="none", coulomb_constant=1.0),
)
def rutherford(world: Contents) -> None:
    world.spawn(Transform(), Charge(20.0), Mass(1.0), name="nucleus")
    for n in range(-5, 6):
        world.spawn(
            Transform((-4.0, 0.22 * n + 0.02)), Velocity((2.5, 0.0)), Mass(1.0), Charge(0.1), Trail(6.0),
            name=f"particle {n + 6}",
        )  # fmt: skip
