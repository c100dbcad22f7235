"""A push and a turning that a body carries with it, steady or swinging in time."""

from physicslab.components.lengths import point
from physicslab.ecs.component import Component, Number, Vector, component, field

FRAMES = ("world", "body")
"""In whose directions a force is given."""


@component
class Thrust(Component):
    """Pushes a body by force * cos(2 pi f t + phase) at a point of it, and turns it by a torque alike.

    A rocket's thrust has frame "body" and no frequency, a shaker or a drive a frequency.
    """

    force: Vector = field(default=(0.0, 0.0), unit="N", meaning="force")
    torque: Number = field(default=0.0, unit="N m", meaning="torque beside that of the force")
    frame: str = field(default="world", choices=FRAMES, meaning="whether the force turns with the body")
    at: Vector = point(0.0, 0.0, "where the force acts, in the body's own frame")
    frequency: Number = field(default=0.0, unit="Hz", minimum=0.0, meaning="how often it swings, 0: steady")
    phase: Number = field(default=0.0, unit="rad", meaning="phase of the swing at t = 0")
