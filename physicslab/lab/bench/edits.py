"""A pile at rest that is edited before every step, as a user or a script would do it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from physicslab.components import Mass, Name, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.lab.bench.quality import overlap
from physicslab.lab.bench.scene import BenchScene
from physicslab.world import World

__all__ = ["edit_scenes"]

_MOVE = 1e-3
"""By how much a body is moved, to and fro [m]."""


def _edited(world: World) -> int:
    """Return the body that is edited: the last of those that move, which lies on top."""
    return int(world.batch(Transform, Velocity).entities[-1])


def _rename(world: World, step: int) -> None:
    """Give a body another name, on which no motion depends."""
    world.add(_edited(world), Name(f"disc {step % 2}"))


def _weigh(world: World, step: int) -> None:
    """Make a body a tenth heavier, and lighter again."""
    mass = world.component(_edited(world), Mass)
    mass.mass *= 1.1 if step % 2 == 0 else 1.0 / 1.1


def _move(world: World, step: int) -> None:
    """Move a body aside, and back."""
    place = world.component(_edited(world), Transform)
    place.position = place.position + Vector2(_MOVE if step % 2 == 0 else -_MOVE, 0.0)


def edit_scenes(build: Callable[[], World], size: int, limit: float) -> tuple[BenchScene, ...]:
    """Return the scenes of a pile that is edited.

    Parameters
    ----------
    build : callable
        Returns the pile.
    size : int
        How many bodies move.
    limit : float
        Deepest overlap that counts as right [m].
    """
    scene = partial(BenchScene, group="edits", size=size, build=build, quality=(overlap(limit),))
    return (
        scene(name="edit_name", title=f"{size:,} discs at rest, one renamed before every step", edit=_rename),
        scene(name="edit_mass", title="the same, the mass of one set", edit=_weigh),
        scene(name="edit_position", title="the same, one moved by a millimetre", edit=_move),
    )
