"""A ball that falls on a floor and bounces."""

from physicslab.prefabs import box, circle
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


@Scene(
    title="A ball on a floor",
    description="A ball keeps 0.8 of its approach speed at every bounce; friction sets it rolling.",
    view=(-5.0, -1.0, 5.0, 4.8),
    moment=1.3,
    teaches=("energy", "collisions"),
    tags=("solid bodies",),
    also="free fall, bouncing ball",
)
def drop(world: Contents) -> None:
    box(world, (0, -0.5), width=20, height=1, static=True, restitution=0.8, friction=0.6, name="floor")
    circle(world, (-3, 4), radius=0.25, velocity=(1, 0), restitution=0.8, friction=0.6, name="ball")
