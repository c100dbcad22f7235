"""Names of entities without an id: their kind, in plain words, and their number."""

from collections.abc import Iterable
from functools import lru_cache
from typing import Any

from physicslab.components.colour import Colour
from physicslab.components.drag import Drag
from physicslab.components.held import Held
from physicslab.components.layer import Layer
from physicslab.components.made_of import MadeOf
from physicslab.components.mass import Mass
from physicslab.components.material import Material
from physicslab.components.name import Name
from physicslab.components.shape import Shape
from physicslab.components.slope import find_slope
from physicslab.components.trail import Trail
from physicslab.components.transform import Transform
from physicslab.components.velocity import Velocity
from physicslab.ecs.text import in_words
from physicslab.languages.sentence import Sentence

_OF_BODIES = (Transform, Velocity, Mass, Material, Drag, Trail, Held, Name, Colour, Layer, MadeOf)
"""Components that do not say what an entity is."""


def plain_name(number: int, components: Iterable[Any]) -> str:
    """Return what the entity with this number and these components is called.

    >>> plain_name(3, [Transform(), Shape.circle(1.0)]), plain_name(4, [Transform(), Velocity()])
    ('circle 3', 'point 4')
    """
    parts = {type(part): part for part in components}
    if find_slope(parts) is not None:
        return _numbered("ramp", number)
    shape = parts.get(Shape)
    return name_by_kinds(number, parts, None if shape is None else shape.kind)


def name_by_kinds(number: int, kinds: Iterable[type], shape: str | None) -> str:
    """Return what the entity with this number is called, by its kinds of components and that of its shape.

    >>> name_by_kinds(5, [Transform, Shape], "box")
    'box 5'
    """
    present = list(kinds)
    if shape is not None:
        return _numbered(shape, number)
    if Velocity in present or Mass in present:
        return _numbered("point", number)
    other = next((kind for kind in present if kind not in _OF_BODIES), None)
    return _numbered(in_words(other.__name__) if other is not None else "entity", number)


@lru_cache(8192)
def _numbered(kind: str, number: int) -> str:
    return Sentence("{kind} {number}", kind=Sentence(kind), number=number)
