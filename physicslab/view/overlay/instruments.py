"""Rulers, protractors, gates and notes: where their points are, and what they read."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from physicslab.components import Protractor, Ruler
from physicslab.ecs.vector import Vector2
from physicslab.state.attached import INSTRUMENTS, place_of
from physicslab.view.canvas.quantities import quantity
from physicslab.world import World

__all__ = [
    "Instrument", "Overrides", "angle_between", "instrument_of", "instruments_of", "reading_of",
    "readings_of",
]  # fmt: skip

type Points = Mapping[str, Vector2]
type Overrides = Mapping[tuple[int, str], Vector2]


@dataclass(frozen=True, slots=True)
class Instrument:
    """One instrument of a world.

    Attributes
    ----------
    entity : int
        Its entity, 0 for one that is not made yet.
    kind : component type
        What it is.
    points : mapping of str to Vector2
        Where its points are in the world, by their names [m].
    """

    entity: int
    kind: type[Any]
    points: Points


def instrument_of(world: World, entity: int) -> Instrument | None:
    """Return the instrument that an entity is, or ``None``."""
    for kind in INSTRUMENTS:
        if world.has(entity, kind):
            return Instrument(
                entity, kind, {name: place_of(world, entity, kind, name) for name in kind.POINTS}
            )
    return None


def instruments_of(world: World, overrides: Overrides | None = None) -> Iterator[Instrument]:
    """Yield every instrument; ``overrides`` says where points are that are being dragged."""
    for kind in INSTRUMENTS:
        for entity in world.batch(kind).entities.tolist():
            points = {name: place_of(world, entity, kind, name) for name in kind.POINTS}
            for (owner, name), place in (overrides or {}).items():
                if owner == entity and name in points:
                    points[name] = place
            yield Instrument(entity, kind, points)


def angle_between(points: Points) -> float:
    """Return the angle between the arms of a protractor, from 0 to 180 degrees; 0 where an arm has no length.

    >>> angle_between({"vertex": Vector2(), "first": Vector2(2, 0), "second": Vector2(0, 1)})
    90.0
    """
    one, two = points["first"] - points["vertex"], points["second"] - points["vertex"]
    across = one.x * two.y - one.y * two.x
    return math.degrees(math.atan2(abs(across), one.dot(two))) if one and two else 0.0


def reading_of(one: Instrument) -> list[tuple[str, str]]:
    """Return what an instrument reads: names and values."""
    if one.kind is Protractor:
        return [("Angle", f"{angle_between(one.points):.2f}°")]
    if one.kind is Ruler:
        way = one.points["end"] - one.points["start"]
        return [
            ("Length", quantity(way.magnitude, "m")),
            ("Across", quantity(way.x, "m")),
            ("Up", quantity(way.y, "m")),
            ("From the right", f"{math.degrees(way.angle) if way else 0.0:.2f}°"),
        ]
    return []


def readings_of(world: World, entity: int) -> list[tuple[str, str]]:
    """Return what the instrument reads that an entity is; nothing of others."""
    one = instrument_of(world, entity)
    if one is None:
        return []
    part = world.component(entity, one.kind)
    bodies = ((name, getattr(part, f"{name}_body")) for name in one.kind.POINTS)
    attached = [(f"{name.capitalize()} attached to", world.label(body)) for name, body in bodies if body]
    return [*reading_of(one), *attached]
