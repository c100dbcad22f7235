"""A light gate: a line that notes what crosses it, and when."""

from __future__ import annotations

from typing import ClassVar

from physicslab.ecs.component import Component, Vector, component, field
from physicslab.ecs.fields import LENGTH_LIMIT


@component
class Gate(Component):
    """A straight line; the moments at which bodies' centres cross it are recorded. It stops nothing."""

    physical: ClassVar[bool] = False
    POINTS: ClassVar[tuple[str, ...]] = ("start", "end")
    start: Vector = field(
        default=(0.0, 0.0), unit="m", limit=LENGTH_LIMIT, meaning="one end, in its body's frame"
    )
    end: Vector = field(
        default=(0.0, 1.0), unit="m", limit=LENGTH_LIMIT, meaning="the other end, in its body's frame"
    )
    start_body: int | None = field(default=None, meaning="the body that one end is attached to")
    end_body: int | None = field(default=None, meaning="the body that the other end is attached to")
