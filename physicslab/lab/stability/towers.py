"""Towers of small cubes, and thin rods on each other."""

from __future__ import annotations

from functools import partial

from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.stability.contact_models import MODELS, touching_space
from physicslab.lab.worlds import floor, place
from physicslab.prefabs import stack

__all__ = ["TOWERS"]

_TOWERS = ((10, 0.1), (10, 0.05), (10, 0.02), (5, 0.01), (15, 0.15), (7, 0.02))
"""How many cubes, and their size [m]."""
_TOWER_S, _ROD_S = 60.0, 10.0
_ROD, _THICK = 2.0, 0.002
_WANTED = {"soft": 0.1, "rigid": 1e-6}
"""Largest distance of a cube from its place, of its size."""


def _off(contacts: str, count: int, width: float, height: float, seconds: float) -> float:
    """Return how far the body of a tower that moved most is from its place, in heights of one."""
    world = touching_space(contacts)
    floor(world)
    bodies = stack(world, count, width=width, height=height)
    starts = [place(world, body) for body in bodies]
    world.run(seconds=seconds)
    return max((place(world, b) - s).magnitude for b, s in zip(bodies, starts, strict=True)) / height


TOWERS = [
    *(
        StabilityCase(
            name=f"tower_{count}x{100 * size:g}cm_{contacts}",
            title=f"{count} cubes of {100 * size:g} cm, {model}, {_TOWER_S:g} s", group="towers",
            right=f"it stands: no cube is off by {_WANTED[contacts]:g} of its size",
            figure="farthest from its place, of a cube", limit=_WANTED[contacts],
            measure=partial(_off, contacts, count, size, size, _TOWER_S),
        )
        for count, size in _TOWERS
        for contacts, model in MODELS.items()
    ),
    *(
        StabilityCase(
            name=f"rods_{count}_{contacts}",
            title=f"{count} rods of {_ROD:g} m by {1e3 * _THICK:g} mm on each other, {model}, {_ROD_S:g} s",
            group="rods", right="none sinks by a fifth of its thickness",
            figure="farthest from its place, of a thickness", limit=0.2,
            measure=partial(_off, contacts, count, _ROD, _THICK, _ROD_S),
        )
        for count in (1, 5, 10)
        for contacts, model in MODELS.items()
    ),
]  # fmt: skip
"""Their cases."""
