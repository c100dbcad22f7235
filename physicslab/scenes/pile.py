"""A thousand discs that fall into a container."""

from physicslab import prefabs
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


@Scene(
    title="A thousand discs",
    description="A thousand discs of 0.2 m fall into a container and come to rest.",
    view=(-6.5, -1.0, 6.5, 8.0),
    teaches=("equilibrium", "friction"),
    tags=("solid bodies", "many bodies"),
    also="sand, marbles",
)
def pile(world: Contents) -> None:
    prefabs.container(world, width=11, height=8)
    prefabs.pile(world, 1_000, (0.0, 0.5))
