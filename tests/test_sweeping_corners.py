"""Corners that sweep past each other within a step touch and part before it ends: they meet all the same."""

from __future__ import annotations

import math

import pytest

from physicslab import World, load_scene
from physicslab.components import Transform, Velocity

_SMOOTH = {"restitution": 1.0, "friction": 0.0}


def _passing(dt: float) -> World:
    """Return a triangle that turns past the upper corner of a block, in air, once it has been there."""
    side = 0.8
    low = -side * math.sqrt(3.0) / 6.0
    corners = [[-side / 2, low], [side / 2, low], [0.0, -2.0 * low]]
    block = {"kind": "box", "width": 1.0, "height": 2.0}
    world = load_scene({
        "format": "physicslab-scene/1", "physics": {"gravity_mode": "none"},
        "simulation": {"dt": dt, "contacts": "rigid"}, "entities": [
            {"id": "block", "Transform": {"position": [0.0, -1.0]}, "Shape": block, "Material": _SMOOTH},
            {"id": "a", "Transform": {"position": [-1.3, 0.4613475331369836], "angle": 1.1091451005749444},
             "Velocity": {"linear": [10.209415899864073, 0.0], "angular": 12.581903306948735}, "Mass": {},
             "Shape": {"kind": "polygon", "vertices": corners}, "Material": _SMOOTH,
             "Drag": {"quadratic": 0.01}},
        ],
    })  # fmt: skip
    world.run(seconds=0.25)
    return world


def _motion(world: World) -> list[float]:
    return [*world.component("a", Transform).position, *world.component("a", Velocity).linear]


@pytest.mark.parametrize("steps_a_second", [27, 47, 54])
def test_corners_that_sweep_past_each_other_meet(steps_a_second: int) -> None:
    found, fine = _passing(1 / steps_a_second), _passing(1 / 1500)
    assert len(found.impacts["time"]) == len(fine.impacts["time"]) > 0
    assert _motion(found) == pytest.approx(_motion(fine), abs=1e-8)
