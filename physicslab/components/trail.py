"""How much of a body's path is shown."""

from typing import ClassVar

from physicslab.ecs.component import Component, Number, component, field


@component
class Trail(Component):
    """Makes the world record where the body has been."""

    physical: ClassVar[bool] = False
    length: Number = field(default=2.0, unit="s", above=0.0, meaning="how far back the record goes")
