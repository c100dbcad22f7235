"""The shape of a body, with which it touches others."""

from __future__ import annotations

from typing import NamedTuple

from physicslab.components.lengths import extent
from physicslab.ecs.component import Component, InvalidValue, component, field
from physicslab.ecs.vector import Vector2


class Kind(NamedTuple):
    """A convex shape as data: a core, which sizes stretch, and a radius that rounds it.

    Attributes
    ----------
    core : tuple of pairs of floats
        Its 1 to 8 vertices, counter-clockwise about their centre of mass, in units of ``x`` and ``y``.
    x, y, radius : str
        The fields of :class:`Shape` that stretch the core along its axes, and that round it; empty for none.
    """

    core: tuple[tuple[float, float], ...]
    x: str = ""
    y: str = ""
    radius: str = ""

    @property
    def sizes(self) -> tuple[str, ...]:
        """The fields that a shape of this kind has."""
        return tuple(dict.fromkeys(name for name in (self.radius, self.x, self.y) if name))


KINDS = {
    "circle": Kind(((0.0, 0.0),), radius="radius"),
    "box": Kind(((0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5)), x="width", y="height"),
    "capsule": Kind(((0.5, 0.0), (-0.5, 0.0)), x="length", radius="radius"),
}
"""Every kind of shape. A new one is a row; loops read the table :mod:`physicslab.kernels.geometry.shapes`."""
CIRCLE, BOX = 1, 2
"""Codes in the ``kind`` column: their places in the list, from 1 on; 0 is no shape."""


def kind_of(code: int) -> Kind:
    """Return the kind of a code in the ``kind`` column, which must not be 0."""
    return list(KINDS.values())[code - 1]


@component
class Shape(Component):
    """The outline of a body, centred on its Transform. An entity without it cannot touch anything."""

    kind: str = field(choices=tuple(KINDS), fixed=True, meaning="what sort of outline")
    radius: float = extent(0.0, "radius of a circle, or of a capsule's round ends")
    width: float = extent(0.0, "extent of a box along its own x axis")
    height: float = extent(0.0, "extent of a box along its own y axis")
    length: float = extent(0.0, "distance of the centres of a capsule's round ends, along its own x axis")

    SIZES = {name: kind.sizes for name, kind in KINDS.items()}  # noqa: RUF012

    @property
    def core(self) -> tuple[Vector2, ...]:
        """The vertices of its core [m], counter-clockwise: of a circle its middle, of a box its corners."""
        kind = KINDS[self.kind]
        x, y = (float(getattr(self, name)) if name else 0.0 for name in (kind.x, kind.y))
        return tuple(Vector2(u * x, v * y) for u, v in kind.core)

    @property
    def rounding(self) -> float:
        """The radius that rounds the core [m]."""
        name = KINDS[self.kind].radius
        return float(getattr(self, name)) if name else 0.0

    @property
    def reach(self) -> float:
        """The largest distance of the outline from the middle [m]."""
        return max(corner.magnitude for corner in self.core) + self.rounding

    @staticmethod
    def circle(radius: float) -> Shape:
        """Return a circle of the given radius [m]."""
        return Shape("circle", radius=radius)

    @staticmethod
    def box(width: float, height: float) -> Shape:
        """Return a box of the given extents [m]."""
        return Shape("box", width=width, height=height)

    @staticmethod
    def capsule(length: float, radius: float) -> Shape:
        """Return a capsule of the given radius [m], whose round ends have centres so far apart [m]."""
        return Shape("capsule", radius=radius, length=length)

    def validate(self) -> None:
        """Check that the sizes are those of the kind, and greater than zero."""
        for name in (spec.name for spec in self.FIELDS if spec.name != "kind"):
            size = getattr(self, name)
            if name in self.SIZES[self.kind]:
                if size <= 0.0:
                    raise InvalidValue("Shape", name, size, f"a finite number > 0 m for a {self.kind}")
            elif size != 0.0:
                raise InvalidValue("Shape", name, size, f"left out: a {self.kind} has no {name}")
