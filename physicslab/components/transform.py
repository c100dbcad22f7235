"""The position and angle of a body."""

from physicslab.ecs.component import Component, Number, Vector, component, field
from physicslab.ecs.fields import COORDINATE_LIMIT


@component
class Transform(Component):
    """The pose of a body: where its centre of mass is and how far it has turned."""

    position: Vector = field(
        default=(0.0, 0.0), unit="m", limit=COORDINATE_LIMIT, meaning="centre of mass; y points up"
    )
    angle: Number = field(default=0.0, unit="rad", meaning="orientation, counter-clockwise")
