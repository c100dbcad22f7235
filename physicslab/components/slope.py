"""The slope of a fixed wedge, by which it is a ramp."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from physicslab.components.shape import Shape
from physicslab.components.transform import Transform
from physicslab.components.velocity import Velocity
from physicslab.ecs.vector import Vector2

_SQUARE = 1e-9
"""Share of its sides by which a corner of a ramp may not be a right angle, or a side not be level."""


class Slope(NamedTuple):
    """A fixed wedge that stands on its level side: the foot and the top of its slope [m]."""

    foot: Vector2
    top: Vector2

    @property
    def angle(self) -> float:
        """How steep it is [rad]."""
        way = self.top - self.foot
        return math.atan2(abs(way.y), abs(way.x))


def find_slope(parts: Mapping[type, Any]) -> Slope | None:
    """Return the slope of a ramp with these components, by their kinds; ``None`` for anything else."""
    shape, transform = parts.get(Shape), parts.get(Transform)
    if shape is None or transform is None or Velocity in parts:
        return None
    if shape.kind != "polygon" or len(shape.vertices) != 3 or transform.angle or shape.radius:
        return None
    corners = [transform.position + vertex for vertex in shape.vertices]
    for n, corner in enumerate(corners):
        for foot, top in ((corners[n - 1], corners[n - 2]), (corners[n - 2], corners[n - 1])):
            size = (top - foot).magnitude
            if max(abs(foot.y - corner.y), abs(top.x - corner.x)) <= _SQUARE * size:
                return Slope(foot, top)
    return None
