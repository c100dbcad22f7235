"""Fields of components that are points and lengths: their unit, and how large they may be."""

from typing import Any

from physicslab.ecs.component import field
from physicslab.ecs.fields import LENGTH_LIMIT


def point(x: float, y: float, meaning: str) -> Any:
    """Describe a point in the frame of a body or of the world; by default it is at (x, y) [m]."""
    return field(default=(x, y), unit="m", limit=LENGTH_LIMIT, meaning=meaning)


def extent(default: float, meaning: str) -> Any:
    """Describe a length >= 0 [m]."""
    return field(default=default, unit="m", minimum=0.0, limit=LENGTH_LIMIT, meaning=meaning)
