"""Properties of bodies that are made with the mouse."""

from dataclasses import dataclass
from typing import ClassVar

from physicslab.ecs.fields import LENGTH_LIMIT, Field


@dataclass(frozen=True, slots=True)
class Recipe:
    """The properties of the next circle or box.

    Attributes
    ----------
    size : float
        Radius of a circle, half the width of a box [m]; 0 for one of several sizes in turn.
    density : float
        Mass per area [kg/m^2].
    restitution, friction : float
        Of its surface.
    """

    size: float = 0.0
    density: float = 5.0
    restitution: float = 0.4
    friction: float = 0.5

    FIELDS: ClassVar[tuple[Field, ...]] = (
        Field("size", "number", unit="m", minimum=0.0, limit=LENGTH_LIMIT,
              meaning="radius, or half the width; 0 for one of several sizes in turn"),
        Field("density", "number", unit="kg/m^2", above=0.0, limit=1e12, meaning="mass per area"),
        Field("restitution", "number", minimum=0.0, maximum=1.0, meaning="share of the speed given back"),
        Field("friction", "number", minimum=0.0, limit=1e6, meaning="Coulomb friction coefficient"),
    )  # fmt: skip
