"""Every colour there is."""

from dataclasses import dataclass
from typing import Any

type Colour = tuple[int, int, int]
"""Red, green and blue, 0 to 255."""
NOTHING = (0, 0, 0, 0)
"""A transparent colour, multiplied by its opacity of 0."""


def mixed(under: Colour, over: Colour, share: float) -> Colour:
    """Return ``under`` with a share (0 to 1) of ``over`` in it.

    >>> mixed((0, 0, 0), (200, 100, 0), 0.5)
    (100, 50, 0)
    """
    red, green, blue = (round(a + (b - a) * share) for a, b in zip(under, over, strict=True))
    return red, green, blue


@dataclass(frozen=True, slots=True)
class Theme:
    """The colours of the window; everything that is drawn takes its colour from here.

    Attributes
    ----------
    name : str
        What it is called.
    background, grid, axis : Colour
        Empty space, a line each metre or so, and the lines through the origin.
    bodies : tuple of Colour
        The rims of moving bodies, in turn; also for the colour-blind (after Okabe & Ito, 2008).
    fill_share : float
        How much of the rim's colour is in a body's fill, the rest being background.
    static, kinematic, held : Colour
        The rims of static bodies, of kinematic ones, and of the one in the hand.
    spring, rod, rope, pin, bounds : Colour
        Springs, rods and rails, ropes, screws, the walls of the world.
    shine : Colour
        The light on rods and ropes.
    spark : Colour
        Sparks at impacts.
    panel, panel_opacity, outline : Colour, float, Colour
        What text stands on.
    text, faint, accent, heading : Colour
        Figures; the words beside them; a number that matters; titles.
    velocity, force, contact_normal : Colour
        Arrows of velocities, of forces, and of the normals of contacts.
    normal_impulse, friction_impulse, friction_cone : Colour
        Arrows of the impulses at contacts, and the cone of the friction that is possible.
    key, key_rim : Colour
        The caps of the keys in the controls hint.
    paused, slow, planet, warning, error, notice : Colour
        The banners.
    """

    name: str
    background: Colour
    grid: Colour
    axis: Colour
    bodies: tuple[Colour, ...]
    fill_share: float
    static: Colour
    kinematic: Colour
    held: Colour
    spring: Colour
    rod: Colour
    rope: Colour
    shine: Colour
    pin: Colour
    bounds: Colour
    spark: Colour
    panel: Colour
    panel_opacity: float
    outline: Colour
    text: Colour
    faint: Colour
    accent: Colour
    heading: Colour
    velocity: Colour
    force: Colour
    contact_normal: Colour
    normal_impulse: Colour
    friction_impulse: Colour
    friction_cone: Colour
    key: Colour
    key_rim: Colour
    paused: Colour
    slow: Colour
    planet: Colour
    warning: Colour
    error: Colour
    notice: Colour

    def body(self, entity: int) -> Colour:
        """Return the colour of a moving body."""
        return self.bodies[entity % len(self.bodies)]

    def fill(self, rim: Colour) -> Colour:
        """Return the colour inside a body with this rim."""
        return mixed(self.background, rim, self.fill_share)


_OF_ALL: dict[str, tuple[Any, Any, Any]] = {
    "name": ("dark", "high contrast", "projector"),
    "background": ((15, 17, 23), (0, 0, 0), (255, 255, 255)),
    "grid": ((25, 28, 37), (38, 38, 38), (233, 235, 239)),
    "axis": ((41, 46, 60), (84, 84, 84), (200, 204, 212)),
    "bodies": (
        ((86, 180, 233), (230, 159, 0), (0, 190, 140), (240, 228, 66), (225, 100, 40), (214, 130, 180),
         (95, 125, 255)),
        ((110, 205, 255), (255, 175, 0), (0, 225, 165), (255, 245, 80), (255, 125, 60), (255, 150, 215),
         (130, 155, 255)),
        ((3, 106, 186), (177, 121, 13), (6, 155, 88), (73, 56, 24), (191, 67, 6), (165, 58, 120),
         (44, 52, 197)),
    ),
    "fill_share": (0.52, 0.5, 0.45),
    "static": ((112, 121, 140), (190, 190, 190), (92, 99, 114)),
    "kinematic": ((200, 206, 220), (230, 230, 230), (58, 63, 76)),
    "held": ((255, 255, 255), (255, 255, 255), (10, 12, 18)),
    "spring": ((226, 190, 92), (255, 225, 110), (146, 104, 8)),
    "rod": ((150, 168, 214), (205, 218, 255), (78, 92, 134)),
    "rope": ((208, 158, 98), (255, 190, 110), (140, 88, 36)),
    "shine": ((255, 255, 255), (255, 255, 255), (255, 255, 255)),
    "pin": ((214, 219, 230), (255, 255, 255), (40, 44, 54)),
    "bounds": ((98, 108, 130), (175, 175, 175), (105, 113, 132)),
    "spark": ((255, 220, 150), (255, 240, 170), (205, 95, 0)),
    "panel": ((22, 25, 34), (0, 0, 0), (247, 248, 250)),
    "panel_opacity": (0.88, 1.0, 0.94),
    "outline": ((47, 53, 69), (200, 200, 200), (196, 201, 211)),
    "text": ((226, 230, 238), (255, 255, 255), (22, 25, 33)),
    "faint": ((139, 147, 165), (215, 215, 215), (84, 91, 107)),
    "accent": ((110, 200, 255), (255, 235, 60), (0, 92, 175)),
    "heading": ((245, 247, 250), (255, 255, 255), (5, 7, 12)),
    "velocity": ((80, 215, 255), (60, 230, 255), (0, 110, 190)),
    "force": ((255, 200, 70), (255, 210, 40), (165, 95, 0)),
    "contact_normal": ((235, 238, 245), (255, 255, 255), (40, 44, 56)),
    "normal_impulse": ((130, 235, 130), (120, 255, 120), (10, 125, 40)),
    "friction_impulse": ((255, 125, 165), (255, 140, 185), (200, 30, 100)),
    "friction_cone": ((180, 186, 205), (210, 215, 235), (88, 94, 114)),
    "key": ((38, 43, 57), (48, 48, 48), (224, 228, 235)),
    "key_rim": ((72, 80, 101), (235, 235, 235), (160, 167, 181)),
    "paused": ((240, 190, 70), (255, 210, 60), (140, 85, 0)),
    "slow": ((110, 200, 255), (120, 220, 255), (0, 92, 175)),
    "planet": ((190, 150, 255), (215, 180, 255), (105, 55, 185)),
    "warning": ((245, 150, 70), (255, 175, 90), (165, 70, 0)),
    "error": ((255, 105, 100), (255, 135, 125), (185, 20, 25)),
    "notice": ((90, 205, 160), (110, 240, 180), (0, 110, 70)),
}  # fmt: skip
"""The values of each theme: the one at the start; one for eyes or screens that lose faint things, in black,
white and strong colours; and one for a bright room, dark on white."""

DARK, HIGH_CONTRAST, PROJECTOR = THEMES = tuple(
    Theme(**dict(zip(_OF_ALL, column, strict=True))) for column in zip(*_OF_ALL.values(), strict=True)
)
"""Every theme, in the order in which they follow each other."""
