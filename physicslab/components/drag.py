"""How strongly a body is slowed by what it moves through."""

from physicslab.ecs.component import Component, Number, component, field


@component
class Drag(Component):
    """Slows a body by F = -(linear + quadratic |v|) v, as air and water at rest do."""

    linear: Number = field(default=0.0, unit="kg/s", minimum=0.0, meaning="force per speed")
    quadratic: Number = field(default=0.0, unit="kg/m", minimum=0.0, meaning="force per speed squared")
