"""What stands where it was put."""

from __future__ import annotations

from functools import partial

from physicslab.ecs.config import SimulationConfig
from physicslab.lab.accuracy.contacts.case import Pose, single
from physicslab.lab.worlds import empty_world, floor
from physicslab.prefabs import box
from physicslab.world import World

__all__ = ["RESTING"]


def _stack(count: int, simulation: SimulationConfig) -> World:
    world = empty_world(simulation)
    floor(world)
    for i in range(count):
        box(world, (0, i + 0.5), width=1, height=1, friction=0.6, name=f"cube {i}")
    return world


def _places(count: int, t: float) -> dict[str, Pose]:
    return {f"cube {i}": (0.0, i + 0.5, 0.0) for i in range(count)}


RESTING = tuple(
    single(
        f"rest_{count}", title, "where every cube is after 2 s", partial(_stack, count), (120,),
        partial(_places, count), group="resting", source="they stay where they were put",
    )
    for count, title in ((1, "A cube of 1 m on a floor"), (10, "Ten cubes of 1 m on each other"))
)  # fmt: skip
"""Their cases."""
