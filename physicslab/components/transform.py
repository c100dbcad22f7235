"""Where a body is."""

from physicslab.columns import Vector, component, field


@component
class Transform:
    """The pose of a body: where its centre of mass is and how far it has turned."""

    position: Vector = field((0.0, 0.0), unit="m", meaning="centre of mass; y points up")
    angle: float = field(0.0, unit="rad", meaning="orientation, counter-clockwise")
