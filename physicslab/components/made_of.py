"""Materials of bodies: the table of them, and the component that keeps the name of one."""

from dataclasses import dataclass
from typing import ClassVar

from physicslab.ecs.component import Component, InvalidValue, component, field

THICKNESS = 0.01
"""Thickness [m] of the plates that bodies are cut from: mass per area is density times thickness."""


@dataclass(frozen=True, slots=True)
class Substance:
    """A material.

    Attributes
    ----------
    name, look : str
        Its name; its paint: "grain", "metal", "frost", "matt", "clear", "speckle", "plain".
    density : float
        Mass of a cubic metre [kg/m^3].
    restitution, friction : float
        Coefficients of two bodies of this material; a pair of two has the smaller restitution and the
        root of both frictions multiplied, which is a rule of the engine and no measurement.
    colour : str
        As "#rrggbb".
    source : str
        Where the numbers are from.
    """

    name: str
    density: float
    restitution: float
    friction: float
    colour: str
    look: str
    source: str

    @property
    def areal_density(self) -> float:
        """Mass of a square metre of its plates [kg/m^2]."""
        return self.density * THICKNESS


_BALLS = "ball dropped from 0.92 m (The Physics Factbook, Coefficients of Restitution, 2006)"
_SLIDING = "dry, sliding (Fuller, in AIP Handbook, 3rd ed., 1972, table 2d)"

SUBSTANCES: dict[str, Substance] = {
    one.name: one
    for one in (
        Substance(
            "wood", 700.0, 0.60, 0.48, "#b9823f", "grain",
            f"oak: density CRC Handbook; e of a {_BALLS}; mu along the grain, {_SLIDING}",
        ),
        Substance(
            "steel", 7850.0, 0.60, 0.57, "#8fa3b8", "metal",
            f"mild steel: density CRC Handbook; e of a bearing {_BALLS}; mu {_SLIDING}",
        ),
        Substance(
            "ice", 917.0, 0.90, 0.02, "#a5dcf2", "frost",
            "density at 0 deg C CRC Handbook; e of slow impacts, which leave no crack (Higa et al., Planet. "
            "Space Sci. 44 (1996) 917); mu at 0 deg C (Bowden & Tabor, Friction and Lubrication, 1950)",
        ),
        Substance(
            "rubber", 1100.0, 0.83, 1.16, "#d2574a", "matt",
            f"natural: density CRC Handbook; e of a {_BALLS}; mu at rest, dry (The Engineering ToolBox)",
        ),
        Substance(
            "glass", 2500.0, 0.66, 0.40, "#7fd0c0", "clear",
            f"soda-lime: density CRC Handbook; e of a marble {_BALLS}; mu {_SLIDING}",
        ),
        Substance(
            "stone", 2650.0, 0.80, 0.85, "#9a9486", "speckle",
            "granite: density CRC Handbook; e about that of rock on rock (Imre et al., Comput. Geosci. 34 "
            "(2008) 339); mu Byerlee, Pure Appl. Geophys. 116 (1978) 615",
        ),
    )
}  # fmt: skip
"""The materials with names, by these."""


@component
class MadeOf(Component):
    """Keeps the name of a body's material: one of the table, or a name of one's own.

    Mass, surface and colour are kept in Mass, Material and Colour.
    """

    physical: ClassVar[bool] = False
    material: str = field(default="wood", limit=40, meaning="wood, steel, ...; or a name of your own")

    def validate(self) -> None:
        """Check that it is a name."""
        if not self.material:
            raise InvalidValue("MadeOf", "material", self.material, "a text that is not empty")


def look_of(material: str) -> str:
    """Return how a material is painted.

    >>> look_of("ice"), look_of("my cheese")
    ('frost', 'plain')
    """
    known = SUBSTANCES.get(material)
    return "plain" if known is None else known.look
