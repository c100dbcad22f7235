"""A tower of ten boxes."""

from physicslab import prefabs
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


@Scene(
    title="A tower of ten boxes",
    description="Ten boxes of 1 m and 1 kg on top of each other; they should stand.",
    view=(-7.0, -1.0, 7.0, 10.4),
    moment=0.0,
    teaches=("equilibrium",),
    tags=("solid bodies",),
    also="building blocks",
)
def stack(world: Contents) -> None:
    prefabs.box(world, (0, -0.5), width=20, height=1, static=True, friction=0.6, name="floor")
    prefabs.stack(world, 10)
