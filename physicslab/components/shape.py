"""The shape of a body, with which it touches others."""

from __future__ import annotations

from physicslab.components.lengths import extent
from physicslab.ecs.component import Component, InvalidValue, component, field

CIRCLE = 1
"""Code of a circle in the ``kind`` column; 0 is no shape."""
BOX = 2
"""Code of a box in the ``kind`` column."""


@component
class Shape(Component):
    """The outline of a body, centred on its Transform. An entity without it cannot touch anything."""

    kind: str = field(choices=("circle", "box"), fixed=True, meaning="what sort of outline")
    radius: float = extent(0.0, "radius of a circle")
    width: float = extent(0.0, "extent of a box along its own x axis")
    height: float = extent(0.0, "extent of a box along its own y axis")

    SIZES = {"circle": ("radius",), "box": ("width", "height")}  # noqa: RUF012

    @staticmethod
    def circle(radius: float) -> Shape:
        """Return a circle of the given radius [m]."""
        return Shape("circle", radius=radius)

    @staticmethod
    def box(width: float, height: float) -> Shape:
        """Return a box of the given extents [m]."""
        return Shape("box", width=width, height=height)

    def validate(self) -> None:
        """Check that the sizes are those of the kind, and greater than zero."""
        for name in ("radius", "width", "height"):
            size = getattr(self, name)
            if name in self.SIZES[self.kind]:
                if size <= 0.0:
                    raise InvalidValue("Shape", name, size, f"a finite number > 0 m for a {self.kind}")
            elif size != 0.0:
                raise InvalidValue("Shape", name, size, f"left out: a {self.kind} has no {name}")
