"""A row of dominoes, the first of which is pushed."""

from physicslab.prefabs import box
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


@Scene(
    title="Twenty dominoes",
    description="A push on the first brings down the last: a wave that takes its energy from their height.",
    view=(-7.0, -1.0, 8.0, 2.5),
    moment=1.4,
    teaches=("energy", "waves"),
    tags=("solid bodies",),
)
def dominoes(world: Contents) -> None:
    box(world, (0, -0.5), width=20, height=1, static=True, friction=0.6, name="floor")
    for i in range(20):
        angular_velocity = -2.0 if i == 0 else 0.0
        box(
            world, (0.6 * i - 5.7, 0.6), width=0.2, height=1.2, mass=0.5, friction=0.4,
            velocity=(-0.6 * angular_velocity, 0.0), angular_velocity=angular_velocity,
        )  # fmt: skip
