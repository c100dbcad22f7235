"""The colour of a body."""

import re
from typing import ClassVar

from physicslab.ecs.component import Component, InvalidValue, component, field

_HEX = re.compile("#[0-9a-f]{6}")
COLOURS = {
    "Blue": "#56b4e9", "Orange": "#e69f00", "Green": "#00be8c", "Yellow": "#f0e442", "Red": "#e14f3c",
    "Pink": "#d682b4", "Violet": "#6f7dff", "Brown": "#a9713f", "Grey": "#9aa0aa", "White": "#f2f4f8",
}  # fmt: skip
"""Colours with names, from which one can be chosen."""


@component
class Colour(Component):
    """Gives a body a colour of its own; one without has that of its kind, or of its number."""

    physical: ClassVar[bool] = False
    colour: str = field(default="#56b4e9", meaning='red, green and blue, as "#rrggbb"')

    def validate(self) -> None:
        """Check that it is a colour."""
        if not _HEX.fullmatch(self.colour):
            raise InvalidValue(
                "Colour", "colour", self.colour, 'a colour "#rrggbb", in digits 0 to 9, a to f'
            )

    @property
    def rgb(self) -> tuple[int, int, int]:
        """Red, green and blue, 0 to 255.

        >>> Colour("#ff8000").rgb
        (255, 128, 0)
        """
        return rgb_of(self.colour)


def rgb_of(colour: str) -> tuple[int, int, int]:
    """Return red, green and blue, 0 to 255, of a colour as "#rrggbb"."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)
