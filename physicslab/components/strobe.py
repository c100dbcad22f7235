"""Positions of a body at regular moments, as pictures by a strobe light show it."""

from typing import ClassVar

from physicslab.ecs.component import Component, Number, component, field


@component
class Strobe(Component):
    """Makes the world keep the body's place and angle every so many seconds, for its outline to be drawn."""

    physical: ClassVar[bool] = False
    interval: Number = field(
        default=0.1, unit="s", minimum=0.001, meaning="time between two pictures, which are at its multiples"
    )
    count: int = field(default=40, minimum=1, maximum=200, meaning="how many of the last pictures are shown")
