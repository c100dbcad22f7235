"""A length in the world."""

from __future__ import annotations

from typing import ClassVar

from physicslab.ecs.component import Component, Vector, component, field
from physicslab.ecs.fields import LENGTH_LIMIT


@component
class Ruler(Component):
    """Measures from one point to another; an end attached to a body follows it."""

    physical: ClassVar[bool] = False
    POINTS: ClassVar[tuple[str, ...]] = ("start", "end")
    start: Vector = field(
        default=(0.0, 0.0),
        unit="m",
        limit=LENGTH_LIMIT,
        meaning="where it begins, in the frame of the body that this end is attached to, or of the world",
    )
    end: Vector = field(
        default=(1.0, 0.0),
        unit="m",
        limit=LENGTH_LIMIT,
        meaning="where it ends, in the frame of the body that this end is attached to, or of the world",
    )
    start_body: int | None = field(default=None, meaning="the body that its beginning is attached to")
    end_body: int | None = field(default=None, meaning="the body that its end is attached to")
