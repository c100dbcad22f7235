"""What an entity without an id is called: by what it is, in plain words, and its number."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from physicslab.components.drag import Drag
from physicslab.components.held import Held
from physicslab.components.mass import Mass
from physicslab.components.material import Material
from physicslab.components.name import Name
from physicslab.components.shape import Shape
from physicslab.components.trail import Trail
from physicslab.components.transform import Transform
from physicslab.components.velocity import Velocity
from physicslab.ecs.text import in_words

__all__ = ["plain_name"]

_OF_BODIES = (Transform, Velocity, Mass, Material, Drag, Trail, Held, Name)
"""Components that do not say what an entity is."""


def plain_name(number: int, components: Iterable[Any]) -> str:
    """Return what the entity with this number and these components is called.

    >>> plain_name(3, [Transform(), Shape.circle(1.0)]), plain_name(4, [Transform(), Velocity()])
    ('circle 3', 'point 4')
    """
    parts = list(components)
    shape = next((part for part in parts if isinstance(part, Shape)), None)
    if shape is not None:
        return f"{shape.kind} {number}"
    if any(isinstance(part, Velocity | Mass) for part in parts):
        return f"point {number}"
    other = next((part for part in parts if not isinstance(part, _OF_BODIES)), None)
    return f"{in_words(type(other).__name__) if other is not None else 'entity'} {number}"
