"""How a body moves."""

from physicslab.ecs.component import Component, Number, Vector, component, field


@component
class Velocity(Component):
    """How a body moves. An entity without it is static."""

    linear: Vector = field(default=(0.0, 0.0), unit="m/s", meaning="velocity of the centre of mass")
    angular: Number = field(default=0.0, unit="rad/s", meaning="angular velocity, counter-clockwise")
