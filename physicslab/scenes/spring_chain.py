"""A chain of balls and springs between two fixed points."""

from physicslab.prefabs import chain
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


@Scene(
    title="A chain of springs",
    description="Twenty balls on springs sag like a hanging chain; waves run along it and die out.",
    view=(-4.2, 0.2, 4.2, 3.6),
    teaches=("waves", "oscillations"),
    tags=("springs", "solid bodies"),
    also="rope",
)
def spring_chain(world: Contents) -> None:
    chain(world, 20, (-4.0, 3.0), (4.0, 3.0), hold_end=True)
