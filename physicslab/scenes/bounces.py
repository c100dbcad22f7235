"""Balls of different restitution, side by side."""

from physicslab.prefabs import box, circle
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


@Scene(
    title="Five restitutions",
    description="Five balls fall from one height; each bounce reaches e squared of the height before.",
    view=(-7.0, -1.0, 7.0, 5.2),
    moment=1.2,
    teaches=("energy", "collisions"),
    tags=("solid bodies",),
    also="free fall, jump, bouncing ball",
)
def bounces(world: Contents) -> None:
    box(world, (0, -0.5), width=14, height=1, static=True, restitution=1, name="floor")
    for i, restitution in enumerate((0.0, 0.25, 0.5, 0.75, 1.0)):
        circle(world, (2 * i - 4, 4), radius=0.3, restitution=restitution, name=f"e = {restitution:g}")
