"""A pendulum."""

from physicslab.components import Graph, GraphLine
from physicslab.prefabs import pendulum
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


def _fill(world: Contents) -> None:
    pendulum(world, (0.0, 3.0), length=2.0, angle=0.5, name="bob")
    graph = world.spawn(Graph())
    for quantity in ("kinetic energy", "potential energy", "total energy"):
        world.spawn(GraphLine(graph, quantity))


PENDULUM = Scene(
    name="pendulum",
    title="A pendulum",
    description="A bob on a rod of 2 m; its period is a little above 2 pi sqrt(l / g) = 2.84 s.",
    fill=_fill,
    view=(-1.5, 0.5, 1.5, 3.3),
    moment=0.9,
    teaches=("oscillations", "energy"),
    tags=("joints",),
)
