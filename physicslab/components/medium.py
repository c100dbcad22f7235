"""A region that is filled with a fluid."""

from physicslab.ecs.component import Component, Number, Vector, component, field


@component
class Medium(Component):
    """Fills the Shape of a fixed entity with a fluid: water, air, honey. Bodies pass through it.

    Under uniform gravity it lifts what is within it by the weight that the fluid would have there. Along each
    metre of wetted outline it pulls by (viscosity + quadratic |u|) u with u, the velocity of the flow
    against the outline.
    """

    density: Number = field(default=1.0, unit="kg/m^2", minimum=0.0, meaning="mass of a square metre")
    viscosity: Number = field(
        default=0.0, unit="kg/(m s)", minimum=0.0, meaning="drag per speed and metre of outline"
    )
    quadratic: Number = field(
        default=0.0, unit="kg/m^2", minimum=0.0, meaning="drag per speed squared and metre of outline"
    )
    flow: Vector = field(default=(0.0, 0.0), unit="m/s", meaning="velocity of the fluid: a current, a wind")
