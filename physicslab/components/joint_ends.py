"""The fields that joints share: the bodies, where it holds them, limits, motors, when it breaks."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from physicslab.components.lengths import point
from physicslab.ecs.component import InvalidValue, field
from physicslab.ecs.fields import LENGTH_LIMIT

_LIMITS = {"m": LENGTH_LIMIT, "rad": 1e9, "rad/s": 1e9, "m/s": 1e9}
"""The largest numbers of joints by their units: of larger turns and speeds rounding leaves nothing."""

type End = tuple[int, Sequence[float]]
"""A body and its anchor [m]; 0 is the world."""


def first_end() -> Any:
    """Describe the body A of a joint."""
    meaning = "first body; where absent the entity that carries the joint, the world if that has no place"
    return field(default=None, fixed=True, meaning=meaning)


def second_end() -> Any:
    """Describe the body B of a joint."""
    return field(default=None, fixed=True, meaning="second body; a fixed point of the world where absent")


def anchor_of_first() -> Any:
    """Describe the point at which a joint holds A [m]."""
    return point(0.0, 0.0, "where it holds A, in A's own frame, or a point of the world")


def anchor_of_second() -> Any:
    """Describe the point at which a joint holds B [m]."""
    return point(0.0, 0.0, "where it holds B, in B's own frame, or a point of the world")


def collides() -> Any:
    """Describe whether the two bodies of a joint touch each other."""
    return field(default=False, fixed=True, meaning="whether A and B touch each other")


def as_placed(unit: str, meaning: str, above: float = -math.inf) -> Any:
    """Describe a number that is what it is when the joint is made, unless it is given."""
    limit = _LIMITS.get(unit, math.inf)
    return field(default=None, unit=unit, above=above, limit=limit, derived="as placed", meaning=meaning)


def optional(unit: str, meaning: str, minimum: float = -math.inf) -> Any:
    """Describe a number that a joint may be without."""
    limit = _LIMITS.get(unit, math.inf)
    return field(default=None, unit=unit, minimum=minimum, limit=limit, derived="none", meaning=meaning)


def strongest(unit: str) -> Any:
    """Describe how much force or torque a motor has."""
    return optional(unit, "the most that its motor gives; as much as it takes where absent", minimum=0.0)


def breaks_at() -> Any:
    """Describe the force beyond which a joint breaks [N]."""
    return optional("N", "the force beyond which it breaks; never where absent", minimum=0.0)


def breaks_at_torque() -> Any:
    """Describe the torque beyond which a joint breaks [N m]."""
    return optional("N m", "the torque beyond which it breaks; never where absent", minimum=0.0)


def check_limits(joint: Any) -> None:
    """Refuse limits that cross."""
    if joint.is_given("lower") and joint.is_given("upper") and joint.upper < joint.lower:
        kind = type(joint)
        unit = next(spec.unit for spec in kind.FIELDS if spec.name == "upper")
        allowed = f"a finite number >= lower = {joint.lower:g} {unit}, or null"
        raise InvalidValue(kind.__name__, "upper", joint.upper, allowed)


def key_of(first: End, second: End) -> tuple[Any, ...]:
    """Return what is equal for two joints of the same points."""
    return tuple(sorted((body, *map(float, anchor)) for body, anchor in (first, second)))


def why_not_joined(first: End, second: End, known: Mapping[tuple[Any, ...], str]) -> tuple[str, str] | None:
    """Return which field keeps two ends from being joined, and what it must be; ``None`` if nothing does.

    ``known`` are the joints of a kind so far, by :func:`key_of` their ends, with what to call each.
    """
    if first[0] == second[0]:
        return "b", "another entity than a" if first[0] else "a body where a is a point of the world"
    other = known.get(key_of(first, second))
    return None if other is None else ("b", f"other points than those that {other} joins")
