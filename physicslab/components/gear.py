"""A gear, which couples two joints."""

from collections.abc import Callable, Mapping

from physicslab.components import joint_ends as ends
from physicslab.ecs.component import Component, Derived, Entity, InvalidValue, Number, component, field

COUPLED = "an entity with a Pin or a Slot, and not both"
"""The allowed ends."""
_OTHER_JOINT = "another entity than first"
"""The allowed ``second``."""


@component
class Gear(Component):
    """Couples the coordinates of two joints, the angle of a Pin [rad] or the way of a Slot [m].

    That of the second changes by ``ratio`` times as much as that of the first: the other way below zero.
    """

    first: Entity = field(fixed=True, meaning="entity with the first Pin or Slot")
    second: Entity = field(fixed=True, meaning="entity with the second Pin or Slot")
    ratio: Number = field(default=-1.0, meaning="change of the second coordinate by that of the first")
    offset: Derived = ends.as_placed("1", "the second coordinate less ratio times the first")
    collide: bool = ends.collides()
    breaks: Derived = ends.breaks_at()

    def validate(self) -> None:
        """Check that there are two joints, and that they are coupled."""
        for name in ("first", "second"):
            if getattr(self, name) is None:
                raise InvalidValue("Gear", name, None, COUPLED)
        if self.ratio == 0.0:
            raise InvalidValue("Gear", "ratio", self.ratio, "a finite number other than 0")


def why_not_coupled(
    first: int, second: int, joints: Callable[[int], int], known: Mapping[frozenset[int], str]
) -> tuple[str, int, str] | None:
    """Return which field keeps two entities from being coupled, which of them it names, and what it must be.

    ``joints`` returns how many of a Pin and a Slot an entity has; ``known`` are the gears so far, by the
    entities that they couple, with what to call each. ``None`` if nothing does.
    """
    for name, end in (("first", first), ("second", second)):
        if joints(end) != 1:
            return name, end, COUPLED
    if first == second:
        return "second", second, _OTHER_JOINT
    other = known.get(frozenset((first, second)))
    return None if other is None else ("second", second, f"another joint than {other} couples")
