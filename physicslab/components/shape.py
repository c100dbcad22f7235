"""The shape of a body, with which it touches others."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from physicslab.components.lengths import extent
from physicslab.components.vertices import centred, plain, why_no_chain, why_not_convex, why_off_centre
from physicslab.ecs.component import Component, InvalidValue, Number, Points, component, field
from physicslab.ecs.fields import LENGTH_LIMIT, POINTS
from physicslab.ecs.vector import Vector2


class Kind(NamedTuple):
    """A convex shape as data: a core, which sizes stretch, and a radius that rounds it.

    Attributes
    ----------
    core : tuple of pairs of floats
        Its 1 to 8 vertices, counter-clockwise about their centre of mass, in units of ``x`` and ``y``;
        empty where each shape has its own.
    x, y, radius : str
        The fields of :class:`Shape` that stretch the core along its axes, and that round it; empty for none.
    own : pair of ints
        The least and the largest number of ``vertices`` that a shape of this kind has of its own; 0 for none.
    part : int
        How many of its vertices are a convex part, of which it is one after the other; 0 where it is convex.
    """

    core: tuple[tuple[float, float], ...]
    x: str = ""
    y: str = ""
    radius: str = ""
    own: tuple[int, int] = (0, 0)
    part: int = 0

    @property
    def fields(self) -> tuple[str, ...]:
        """The fields that a shape of this kind has."""
        names = ("vertices" if self.own[1] else "", self.radius, self.x, self.y)
        return tuple(dict.fromkeys(name for name in names if name))


KINDS = {
    "circle": Kind(((0.0, 0.0),), radius="radius"),
    "box": Kind(((0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5)), x="width", y="height"),
    "capsule": Kind(((0.5, 0.0), (-0.5, 0.0)), x="length", radius="radius"),
    "polygon": Kind((), radius="radius", own=(3, 8)),
    "chain": Kind((), own=(2, 1000), part=2),
}
"""Every kind of shape. A new one is a row; loops read the table :mod:`physicslab.kernels.geometry.shapes`."""
CIRCLE, BOX, CHAIN = 1, 2, 5
"""Codes in the ``kind`` column: their places in the list, from 1 on; 0 is no shape."""
STAYS = "that of a body without Velocity: a chain does not move"
"""The message's end where a chain has a Velocity."""


def kind_of(code: int) -> Kind:
    """Return the kind of a code in the ``kind`` column, which must not be 0."""
    return list(KINDS.values())[code - 1]


@component
class Shape(Component):
    """The outline of a body, centred on its Transform. An entity without it cannot touch anything."""

    kind: str = field(choices=tuple(KINDS), fixed=True, meaning="what sort of outline")
    radius: Number = extent(0.0, "radius of a circle, of a capsule's round ends, or of a polygon's corners")
    width: Number = extent(0.0, "extent of a box along its own x axis")
    height: Number = extent(0.0, "extent of a box along its own y axis")
    length: Number = extent(0.0, "distance of the centres of a capsule's round ends, along its own x axis")
    vertices: Points = field(
        default=(),
        unit="m",
        limit=LENGTH_LIMIT,
        meaning="corners of a polygon, counter-clockwise, from its centre; of a chain, solid on its left",
    )

    HAS = {name: kind.fields for name, kind in KINDS.items()}  # noqa: RUF012

    @property
    def core(self) -> tuple[Vector2, ...]:
        """The vertices of its core [m], counter-clockwise: of a circle its middle, of a box its corners.

        Those of a chain go there and back again.
        """
        kind = KINDS[self.kind]
        if kind.part:
            return (*self.vertices, *self.vertices[-2:0:-1])
        if kind.own[1]:
            return self.vertices
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

    @staticmethod
    def chain(vertices: Sequence[Vector2 | tuple[float, float]]) -> Shape:
        """Return a chain of segments between 2 to 1,000 vertices [m], solid on its left, for a fixed body.

        It is a loop where the last vertex is the first one.
        """
        return Shape("chain", vertices=vertices)

    @staticmethod
    def polygon(vertices: Sequence[Vector2 | tuple[float, float]], radius: float = 0.0) -> Shape:
        """Return a convex polygon of 3 to 8 vertices [m], counter-clockwise, rounded by a radius [m].

        They are shifted so that its centre of mass is at the origin, as those of a Shape are.

        Raises
        ------
        InvalidValue
            If they are not those of such a polygon: where they are, before they are shifted.
        """
        fields = {spec.name: spec for spec in Shape.FIELDS}
        given = POINTS.value_of(fields["vertices"].check(vertices))
        rounding = fields["radius"].check(radius)
        if (refused := why_not_convex(given, *KINDS["polygon"].own)) is not None:
            raise InvalidValue("Shape", "vertices", plain(given), refused)
        return Shape("polygon", radius=rounding, vertices=centred(given, rounding))

    def validate(self) -> None:
        """Check that the sizes are those of the kind and above zero, and that vertices are a polygon."""
        kind, fields = KINDS[self.kind], self.HAS[self.kind]
        values = [(spec, getattr(self, spec.name)) for spec in self.FIELDS[1:]]
        for spec, value in values:
            if spec.name not in fields and value != spec.default:
                allowed = f"left out: a {self.kind} has no {spec.name}, it has {' and '.join(fields)}"
                raise InvalidValue("Shape", spec.name, plain(value), allowed)
        for spec, value in values:
            if spec.name in fields and spec.kind == "number" and value <= 0.0 and not kind.own[1]:
                raise InvalidValue("Shape", spec.name, value, f"a finite number > 0 m for a {self.kind}")
        if kind.own[1]:
            self._check_vertices(kind)

    def _check_vertices(self, kind: Kind) -> None:
        if kind.part:
            refused = why_no_chain(self.vertices, *kind.own)
        else:
            refused = why_not_convex(self.vertices, *kind.own) or why_off_centre(self.vertices, self.radius)
        if refused is not None:
            raise InvalidValue("Shape", "vertices", plain(self.vertices), refused)
