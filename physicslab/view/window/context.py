"""The menu of a place, and what is given the body that is clicked next."""

from dataclasses import dataclass

from physicslab.ecs.component import Component
from physicslab.ecs.vector import Vector2


@dataclass(slots=True)
class Context:
    """The menu of a place that is open.

    Attributes
    ----------
    entity : int, optional
        The entity there; ``None`` for empty space.
    is_body : bool
        Whether that is a body.
    pixel, place : tuple of two floats, Vector2
        Where it is, on the screen [px] and in the world [m].
    is_shown : bool
        Whether it was opened already.
    """

    entity: int | None
    is_body: bool
    pixel: tuple[float, float]
    place: Vector2
    is_shown: bool = False


@dataclass(frozen=True, slots=True)
class Picking:
    """The field of an entity's component that the body is for which is clicked next."""

    entity: int
    kind: type[Component]
    field: str
