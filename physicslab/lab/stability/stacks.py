"""Heaps that should stand."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import floor, open_space, place
from physicslab.prefabs import box, pyramid, stack
from physicslab.world import World

__all__ = ["STACKS"]

_SECONDS = 10.0


def _settled(fill: Callable[[World], list[int]], seconds: float) -> list[Vector2]:
    """Return how far each body is from where it was put, after so many seconds."""
    world = open_space(physics=PhysicsConfig(gravity=Vector2(0.0, -10.0)), contacts="soft")
    floor(world)
    bodies = fill(world)
    starts = [place(world, body) for body in bodies]
    world.run(seconds=seconds)
    return [place(world, body) - start for body, start in zip(bodies, starts, strict=True)]


def _tower(world: World, *, boxes: int, top: float) -> list[int]:
    """Spawn a tower of boxes of 1 m, the highest of another mass."""
    made = stack(world, boxes)
    height = boxes + 0.5
    return [*made, box(world, (0.0, height), width=1.0, height=1.0, mass=top, friction=0.6)]


def _off(fill: Callable[[World], list[int]], seconds: float) -> float:
    return max(moved.magnitude for moved in _settled(fill, seconds))


def _sink(fill: Callable[[World], list[int]], seconds: float) -> float:
    return max(-moved.y for moved in _settled(fill, seconds))


def _sideways(fill: Callable[[World], list[int]], seconds: float) -> float:
    return max(abs(moved.x) for moved in _settled(fill, seconds))


def _stands(name: str, title: str, fill: Callable[[World], list[int]]) -> StabilityCase:
    return StabilityCase(
        name=name, title=title, group="stacks", right="it stands: no box is off by half its width after 10 s",
        figure="farthest from its place", unit="m", limit=0.5, measure=partial(_off, fill, _SECONDS),
    )  # fmt: skip


_HEAVY_TOP = partial(_tower, boxes=10, top=100.0)

STACKS = [
    _stands("stack_100kg_stands", "ten boxes of 1 kg, 100 kg on top", _HEAVY_TOP),
    StabilityCase(
        name="stack_100kg_sink", title="ten boxes of 1 kg, 100 kg on top", group="stacks",
        right="no box sinks by more than 5 cm in 10 s", figure="deepest sink", unit="m", limit=0.05,
        measure=partial(_sink, _HEAVY_TOP, _SECONDS),
    ),
    _stands("stack_20_stands", "twenty boxes", partial(_tower, boxes=19, top=1.0)),
    _stands("stack_1e4kg_stands", "1e4 kg on 1 kg", partial(_tower, boxes=1, top=1e4)),
    StabilityCase(
        name="pyramid_60_drift", title="pyramid of 1,830 boxes, 60 s", group="stacks",
        right="no box drifts sideways by more than 0.13 m", figure="farthest drift", unit="m", limit=0.13,
        measure=partial(_sideways, partial(pyramid, base=60), 60.0), long_s=3.0,
    ),
]  # fmt: skip
