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


@pytest.mark.parametrize("side", [-1, 1])
def test_one_end_of_a_rod_meets_the_floor_while_the_lower_one_lifts(side: int) -> None:
    """It went in by 16 mm: of two points of a meeting the deeper one was followed, which opens."""
    world = load_scene({
        "format": "physicslab-scene/1", "physics": {"gravity_mode": "none"},
        "simulation": {"dt": 1 / 240, "substeps": 1, "contacts": "soft", "collisions": "step"}, "entities": [
            {"id": "floor", "Transform": {"position": [0.0, -0.5]}, "Material": {"restitution": 0.0},
             "Shape": {"kind": "box", "width": 10.0, "height": 1.0}},
            {"id": "rod", "Transform": {"position": [0.0, 0.1014], "angle": -0.2156 * side}, "Mass": {},
             "Velocity": {"linear": [0.0, -5.653], "angular": 58.2 * side},
             "Shape": {"kind": "capsule", "length": 0.2, "radius": 0.08}, "Material": {"restitution": 0.0}},
        ],
    })  # fmt: skip
    rod, lowest = world.component("rod", Transform), math.inf
    for _ in world.stepping(steps=4):
        lowest = min(lowest, rod.position.y - 0.1 * abs(math.sin(rod.angle)) - 0.08)
    assert lowest > -1e-3
