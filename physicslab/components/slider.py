"""A number that is changed by sliding."""

from typing import ClassVar

from physicslab.components.charge import Charge
from physicslab.components.drag import Drag
from physicslab.components.mass import Mass
from physicslab.components.material import Material
from physicslab.components.meter import CORNERS
from physicslab.components.shape import Shape
from physicslab.components.spring import Spring
from physicslab.components.thrust import Thrust
from physicslab.components.transform import Transform
from physicslab.components.velocity import Velocity
from physicslab.ecs.component import Component, Entity, InvalidValue, Number, component, field
from physicslab.ecs.fields import Field

GRAVITY = "gravity"
"""The strength of uniform gravity, downwards: the one choice that is no field of an entity."""

SLIDER_FIELDS: dict[str, tuple[type[Component], Field]] = {
    f"{kind.__name__}.{spec.name}": (kind, spec)
    for kind in (Mass, Material, Shape, Spring, Drag, Thrust, Charge, Transform, Velocity)
    for spec in kind.FIELDS
    if spec.kind == "number" and not spec.fixed
}
"""The fields that a slider changes: the component, and the description of its field."""


@component
class Slider(Component):
    """Changes a number of an entity, or gravity, between two values, in a small panel of the window."""

    physical: ClassVar[bool] = False
    changes: str = field(choices=(GRAVITY, *SLIDER_FIELDS), meaning="what is changed")
    entity: Entity = field(default=None, meaning="whose number it is; absent for gravity")
    low: Number = field(default=0.0, meaning="the value at the left end")
    high: Number = field(default=20.0, meaning="the value at the right end")
    corner: str = field(default=CORNERS[0], choices=CORNERS, meaning="where in the window it is")

    @property
    def unit(self) -> str:
        """The SI unit of what is changed."""
        return "m/s^2" if self.changes == GRAVITY else SLIDER_FIELDS[self.changes][1].unit

    def references(self) -> dict[str, str]:
        """Return which component the entity must have."""
        return {} if self.changes == GRAVITY else {"entity": self.changes.partition(".")[0]}

    def validate(self) -> None:
        """Check that there is an entity where one is needed, and that the ends are in order and in range."""
        if (self.entity is None) != (self.changes == GRAVITY):
            needed = "".join(f"an entity with a {kind}" for kind in self.references().values())
            raise InvalidValue("Slider", "entity", self.entity, f"{needed or 'left out'} for {self.changes}")
        if self.high <= self.low:
            raise InvalidValue("Slider", "high", self.high, f"a finite number > {self.low:g} {self.unit}")
        for name in ("low", "high") if self.changes != GRAVITY else ():
            value, spec = getattr(self, name), SLIDER_FIELDS[self.changes][1]
            if not spec.lowest <= value <= spec.highest:
                raise InvalidValue("Slider", name, value, f"{spec.allowed}, as {self.changes} is")
