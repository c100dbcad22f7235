"""Stacks, pyramids, towers of small cubes and thin rods on each other, which should stand."""

from collections.abc import Callable
from functools import partial

from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import MODELS, StabilityCase, touching_space
from physicslab.lab.worlds import displacements, floor, open_space
from physicslab.prefabs import box, pyramid, stack
from physicslab.world import World

type _Fill = Callable[[World], list[int]]

_TOWERS = ((10, 0.1), (10, 0.05), (10, 0.02), (5, 0.01), (15, 0.15), (7, 0.02))
"""How many cubes, and their size [m]."""
_TOWER_S, _ROD_S = 60.0, 10.0
_ROD, _THICK = 2.0, 0.002
_WANTED = {"soft": 0.1, "rigid": 1e-6}
"""Largest distance of a cube from its place, of its size."""


def _moved(fill: _Fill, seconds: float = 10.0) -> list[Vector2]:
    world = open_space(gravity=10.0, contacts="soft")
    floor(world)
    return displacements(world, fill(world), lambda: world.run(seconds=seconds))


def _top(world: World, *, boxes: int, top: float) -> list[int]:
    """Spawn a tower of boxes of 1 m, the highest of another mass."""
    return [
        *stack(world, boxes),
        box(world, (0.0, boxes + 0.5), width=1.0, height=1.0, mass=top, friction=0.6),
    ]


def _off(fill: _Fill) -> float:
    return max(moved.magnitude for moved in _moved(fill))


def _sink(fill: _Fill) -> float:
    return max(-moved.y for moved in _moved(fill))


def _sideways(fill: _Fill, seconds: float) -> float:
    return max(abs(moved.x) for moved in _moved(fill, seconds))


def _share_off(contacts: str, count: int, width: float, height: float, seconds: float) -> float:
    """Return how far the body of a tower that moved most is from its place, in heights of one."""
    world = touching_space(contacts=contacts)
    floor(world)
    bodies = stack(world, count, width=width, height=height)
    moved = displacements(world, bodies, lambda: world.run(seconds=seconds))
    return max(way.magnitude for way in moved) / height


_case = partial(StabilityCase, group="stacks", unit="m")
_stands = partial(
    _case, right="it stands: no box is off by half its width after 10 s", figure="farthest from its place",
    limit=0.5,
)  # fmt: skip
_HEAVY = partial(_top, boxes=10, top=100.0)

STANDING = (
    _stands(
        name="stack_100kg_stands", title="ten boxes of 1 kg, 100 kg on top", measure=partial(_off, _HEAVY)
    ),
    _case(
        name="stack_100kg_sink", title="ten boxes of 1 kg, 100 kg on top", limit=0.05,
        right="no box sinks by more than 5 cm in 10 s", figure="deepest sink", measure=partial(_sink, _HEAVY),
    ),
    _stands(
        name="stack_20_stands", title="twenty boxes", measure=partial(_off, partial(_top, boxes=19, top=1.0))
    ),
    _stands(
        name="stack_1e4kg_stands", title="1e4 kg on 1 kg",
        measure=partial(_off, partial(_top, boxes=1, top=1e4)),
    ),
    _case(
        name="pyramid_60_drift", title="pyramid of 1,830 boxes, 60 s", limit=0.13, long_s=3.0,
        right="no box drifts sideways by more than 0.13 m", figure="farthest drift",
        measure=partial(_sideways, partial(pyramid, base=60), 60.0),
    ),
    *(
        StabilityCase(
            name=f"tower_{count}x{100 * size:g}cm_{contacts}", group="towers",
            title=f"{count} cubes of {100 * size:g} cm, {model}, {_TOWER_S:g} s",
            right=f"it stands: no cube is off by {_WANTED[contacts]:g} of its size",
            figure="farthest from its place, of a cube", limit=_WANTED[contacts],
            measure=partial(_share_off, contacts, count, size, size, _TOWER_S),
        )
        for count, size in _TOWERS
        for contacts, model in MODELS.items()
    ),
    *(
        StabilityCase(
            name=f"rods_{count}_{contacts}", group="rods", limit=0.2,
            title=f"{count} rods of {_ROD:g} m by {1e3 * _THICK:g} mm on each other, {model}, {_ROD_S:g} s",
            right="none sinks by a fifth of its thickness", figure="farthest from its place, of a thickness",
            measure=partial(_share_off, contacts, count, _ROD, _THICK, _ROD_S),
        )
        for count in (1, 5, 10)
        for contacts, model in MODELS.items()
    ),
)  # fmt: skip
