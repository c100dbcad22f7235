"""Every colour there is, and the sizes on the screen that the window and the pages of runs have in common."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

type Colour = tuple[int, int, int]
"""Red, green and blue, 0 to 255."""
NOTHING = (0, 0, 0, 0)
"""A transparent colour, multiplied by its opacity of 0."""


LEGIBLE = 4.5
"""Least contrast of a body's rim to what is behind: its fill is lit on one side, and dim on the other."""
FLUID = 0.5
"""Share of its colour in the rim of a medium: bodies within it are to stand out."""
WITHIN_FLUID = 0.4
"""Share of that rim in the inside of a medium."""
RIM = 2.0
"""Width of the rims of bodies [px]."""
COORDINATE = 0.5
"""Share of the colour of text in the numbers at the edges of the world."""
WALL = 7.0
"""Thickness of the walls at the end of the world [px]."""
POINT_RADIUS = 5.0
"""How large a body without a Shape appears [px]."""
PLANET, LEAST_PLANET = 14.0, 3.5
"""Radius of the heaviest of the bodies without a Shape that attract each other, and least one [px]."""
STAR, GLOW, GLOWS = 10.0, 5.0, ((1.0, 0.35), (0.45, 0.6))
"""A body that has so many times the mass of all others is a star; how far it shines, in its radii; shares of
that, and how bright."""
MAX_SHADOWS = 400
"""Number of bodies above which none has a shadow."""
_EDGES = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
"""Shares of what is brightest, or darkest on paper, that rims of bodies with a Colour may have."""


def mixed(under: Colour, over: Colour, share: float) -> Colour:
    """Return ``under`` with a share (0 to 1) of ``over`` in it.

    >>> mixed((0, 0, 0), (200, 100, 0), 0.5)
    (100, 50, 0)
    """
    red, green, blue = (round(a + (b - a) * share) for a, b in zip(under, over, strict=True))
    return red, green, blue


def luminance(colour: Colour) -> float:
    """Return the relative luminance of a colour of sRGB (WCAG 2.2).

    >>> luminance((255, 255, 255)), luminance((0, 0, 0))
    (1.0, 0.0)
    """
    red, green, blue = (
        part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4
        for part in (part / 255.0 for part in colour)
    )
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(a: Colour, b: Colour) -> float:
    """Return the contrast ratio of two colours (WCAG 2.2).

    >>> round(contrast((0, 0, 0), (255, 255, 255)), 6)
    21.0
    """
    darker, lighter = sorted((luminance(a), luminance(b)))
    return (lighter + 0.05) / (darker + 0.05)


@dataclass(frozen=True, slots=True)
class Theme:
    """The colours of the window; everything that is drawn takes its colour from here.

    Attributes
    ----------
    name : str
        Its name.
    background : Colour
        Empty space, where one colour stands for it.
    sky_top, sky_bottom, grain : Colour, Colour, int
        Empty space above and below, and how much its pixels differ, as paper does (0 to 255).
    grid, axis : Colour
        A line each metre or so, and the lines through the origin.
    bodies : tuple of Colour
        The rims of moving bodies, in turn; also for the colour-blind (after Okabe & Ito, 2008).
    fill_share : float
        How much of the rim's colour is in a body's fill, the rest being background.
    static, earth : Colour
        The rims of static bodies and the walls of the world, and what is within.
    kinematic, held : Colour
        The rims of kinematic bodies, and of the one in the hand.
    shadow : float
        Opacity of the shadows of bodies.
    spring, rod, rope, pin : Colour
        Springs, rods and rails, ropes, screws.
    shine : Colour
        The light on rods and ropes.
    spark : Colour
        Sparks at impacts.
    panel, panel_opacity, outline : Colour, float, Colour
        Ground of text.
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
    sky_top: Colour
    sky_bottom: Colour
    grain: int
    grid: Colour
    axis: Colour
    bodies: tuple[Colour, ...]
    fill_share: float
    static: Colour
    earth: Colour
    kinematic: Colour
    held: Colour
    shadow: float
    spring: Colour
    rod: Colour
    rope: Colour
    shine: Colour
    pin: Colour
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

    @property
    def is_dark(self) -> bool:
        """Whether light stands on dark: only there can lights be added to what is behind them."""
        return sum(self.background) < sum(self.text)

    def fill(self, rim: Colour) -> Colour:
        """Return the colour inside a body with this rim."""
        return mixed(self.background, rim, self.fill_share)

    @property
    def fluid(self) -> Colour:
        """The rim of a medium."""
        return mixed(self.background, self.bodies[0], FLUID)

    @property
    def within_fluid(self) -> Colour:
        """The inside of a medium: so pale that the rims of what floats stand out from it."""
        return mixed(self.background, self.fluid, WITHIN_FLUID)

    @property
    def coordinate(self) -> Colour:
        """The numbers at the edges of the world, over sky and over ground."""
        return mixed(self.faint, self.text, COORDINATE)

    def edge(self, fill: Colour) -> Colour:
        """Return the rim of a body with this fill: it is seen all around on any of the theme's skies."""
        strongest, skies = self.shine if self.is_dark else self.heading, (self.sky_top, self.sky_bottom)
        edges = [mixed(fill, strongest, share) for share in _EDGES]
        return next(
            (edge for edge in edges if min(contrast(edge, sky) for sky in skies) >= LEGIBLE), edges[-1]
        )

    def faded(self, colours: NDArray[np.uint8], share: float | NDArray[np.float64]) -> NDArray[np.uint8]:
        """Return colours (n, 3) of which each has a share (n,), 0 to 1, the rest being background."""
        under = np.array(self.background, float)
        shares = np.asarray(share, float).reshape(-1, 1)
        mixture: NDArray[np.uint8] = np.rint(under + (colours - under) * shares).astype(np.uint8)
        return mixture


_OF_ALL: dict[str, tuple[Any, Any, Any, Any]] = {
    "name": ("dark", "light", "high contrast", "projector"),
    "background": ((17, 25, 45), (244, 239, 229), (0, 0, 0), (255, 255, 255)),
    "sky_top": ((11, 16, 32), (250, 247, 240), (0, 0, 0), (255, 255, 255)),
    "sky_bottom": ((24, 35, 58), (236, 230, 217), (0, 0, 0), (255, 255, 255)),
    "grain": (1, 5, 0, 0),
    "grid": ((43, 55, 82), (207, 200, 186), (38, 38, 38), (223, 224, 227)),
    "axis": ((64, 78, 110), (175, 168, 152), (84, 84, 84), (186, 189, 196)),
    "bodies": (
        ((92, 216, 251), (255, 183, 30), (21, 220, 155), (250, 228, 105), (255, 144, 101), (255, 147, 216),
         (151, 166, 255)),
        ((0, 73, 142), (111, 57, 0), (0, 83, 45), (40, 40, 50), (163, 11, 8), (149, 22, 110), (51, 46, 213)),
        ((84, 203, 255), (255, 183, 24), (24, 226, 165), (255, 245, 85), (255, 128, 73), (255, 152, 226),
         (132, 157, 254)),
        ((0, 93, 173), (136, 76, 0), (0, 105, 56), (60, 54, 60), (189, 28, 0), (176, 35, 115), (42, 48, 212)),
    ),
    "fill_share": (0.82, 0.82, 0.82, 0.82),
    "static": ((159, 180, 220), (104, 90, 66), (190, 190, 190), (92, 99, 114)),
    "earth": ((51, 63, 90), (206, 193, 168), (44, 44, 44), (216, 221, 230)),
    "kinematic": ((200, 206, 220), (66, 62, 56), (230, 230, 230), (58, 63, 76)),
    "held": ((255, 255, 255), (14, 12, 8), (255, 255, 255), (10, 12, 18)),
    "shadow": (0.45, 0.2, 0.0, 0.18),
    "spring": ((233, 196, 106), (140, 98, 4), (255, 225, 110), (146, 104, 8)),
    "rod": ((168, 184, 226), (78, 88, 118), (205, 218, 255), (78, 92, 134)),
    "rope": ((208, 158, 98), (140, 88, 36), (255, 190, 110), (140, 88, 36)),
    "shine": ((255, 255, 255), (255, 255, 255), (255, 255, 255), (255, 255, 255)),
    "pin": ((223, 232, 255), (44, 42, 40), (255, 255, 255), (40, 44, 54)),
    "spark": ((255, 214, 140), (205, 95, 0), (255, 240, 170), (205, 95, 0)),
    "panel": ((19, 23, 36), (250, 247, 241), (0, 0, 0), (247, 248, 250)),
    "panel_opacity": (0.9, 0.95, 1.0, 0.94),
    "outline": ((46, 55, 78), (212, 203, 186), (200, 200, 200), (196, 201, 211)),
    "text": ((226, 230, 238), (34, 29, 22), (255, 255, 255), (22, 25, 33)),
    "faint": ((145, 154, 176), (98, 89, 74), (215, 215, 215), (84, 91, 107)),
    "accent": ((110, 200, 255), (0, 86, 158), (255, 235, 60), (0, 92, 175)),
    "heading": ((245, 247, 250), (16, 12, 6), (255, 255, 255), (5, 7, 12)),
    "velocity": ((80, 215, 255), (0, 104, 180), (60, 230, 255), (0, 110, 190)),
    "force": ((255, 200, 70), (158, 88, 0), (255, 210, 40), (165, 95, 0)),
    "contact_normal": ((235, 238, 245), (46, 42, 34), (255, 255, 255), (40, 44, 56)),
    "normal_impulse": ((130, 235, 130), (10, 115, 36), (120, 255, 120), (10, 125, 40)),
    "friction_impulse": ((255, 125, 165), (190, 28, 94), (255, 140, 185), (200, 30, 100)),
    "friction_cone": ((180, 186, 205), (98, 90, 76), (210, 215, 235), (88, 94, 114)),
    "key": ((35, 42, 61), (233, 226, 211), (48, 48, 48), (224, 228, 235)),
    "key_rim": ((70, 81, 108), (184, 173, 152), (235, 235, 235), (160, 167, 181)),
    "paused": ((240, 190, 70), (130, 78, 0), (255, 210, 60), (140, 85, 0)),
    "slow": ((110, 200, 255), (0, 86, 158), (120, 220, 255), (0, 92, 175)),
    "planet": ((190, 150, 255), (102, 52, 178), (215, 180, 255), (105, 55, 185)),
    "warning": ((245, 150, 70), (152, 64, 0), (255, 175, 90), (165, 70, 0)),
    "error": ((255, 105, 100), (178, 18, 22), (255, 135, 125), (185, 20, 25)),
    "notice": ((90, 205, 160), (0, 102, 64), (110, 240, 180), (0, 110, 70)),
}  # fmt: skip
"""The values of each theme: the one at the start, a night sky; ink on paper; one for eyes or screens that
lose faint things, in black, white and strong colours; and one for a bright room, dark on white."""

DARK, LIGHT, HIGH_CONTRAST, PROJECTOR = THEMES = tuple(
    Theme(**dict(zip(_OF_ALL, column, strict=True))) for column in zip(*_OF_ALL.values(), strict=True)
)
"""Every theme, in the order in which they follow each other."""
