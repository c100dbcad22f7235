"""A tower of ten boxes."""

from physicslab.prefabs import box, stack
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


def _fill(world: Contents) -> None:
    box(world, (0, -0.5), width=20, height=1, static=True, friction=0.6, name="floor")
    stack(world, 10)


STACK = Scene(
    name="stack",
    title="A tower of ten boxes",
    description="Ten boxes of 1 m and 1 kg on top of each other; they should stand.",
    fill=_fill,
    view=(-7.0, -1.0, 7.0, 10.4),
    moment=0.0,
    teaches=("equilibrium",),
    tags=("solid bodies",),
)
