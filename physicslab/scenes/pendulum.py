"""A pendulum."""

from physicslab import prefabs
from physicslab.components import Graph, GraphLine
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


@Scene(
    title="A pendulum",
    description="A bob on a rod of 2 m; its period is a little above 2 pi sqrt(l / g) = 2.84 s.",
    view=(-1.5, 0.5, 1.5, 3.3),
    moment=0.9,
    teaches=("oscillations", "energy"),
    tags=("joints",),
    also="swing, clock",
)
def pendulum(world: Contents) -> None:
    prefabs.pendulum(world, (0.0, 3.0), length=2.0, angle=0.5, name="bob")
    graph = world.spawn(Graph())
    for quantity in ("kinetic energy", "potential energy", "total energy"):
        world.spawn(GraphLine(graph, quantity))
