"""Every colour there is."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["DARK", "HIGH_CONTRAST", "NOTHING", "PROJECTOR", "THEMES", "Colour", "Theme", "mixed"]

type Colour = tuple[int, int, int]
"""Red, green and blue, 0 to 255."""
NOTHING = (0, 0, 0, 0)
"""What covers nothing, multiplied by its opacity of none."""


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
    spring, pin, bounds : Colour
        Springs, the fixed points that hold them, the walls of the world.
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


DARK = Theme(
    name="dark",
    background=(15, 17, 23),
    grid=(25, 28, 37),
    axis=(41, 46, 60),
    bodies=(
        (86, 180, 233),
        (230, 159, 0),
        (0, 190, 140),
        (240, 228, 66),
        (225, 100, 40),
        (214, 130, 180),
        (95, 125, 255),
    ),
    fill_share=0.52,
    static=(112, 121, 140),
    kinematic=(200, 206, 220),
    held=(255, 255, 255),
    spring=(160, 168, 186),
    pin=(214, 219, 230),
    bounds=(98, 108, 130),
    spark=(255, 220, 150),
    panel=(22, 25, 34),
    panel_opacity=0.88,
    outline=(47, 53, 69),
    text=(226, 230, 238),
    faint=(139, 147, 165),
    accent=(110, 200, 255),
    heading=(245, 247, 250),
    velocity=(80, 215, 255),
    force=(255, 200, 70),
    contact_normal=(235, 238, 245),
    normal_impulse=(130, 235, 130),
    friction_impulse=(255, 125, 165),
    friction_cone=(180, 186, 205),
    key=(38, 43, 57),
    key_rim=(72, 80, 101),
    paused=(240, 190, 70),
    slow=(110, 200, 255),
    planet=(190, 150, 255),
    warning=(245, 150, 70),
    error=(255, 105, 100),
    notice=(90, 205, 160),
)
"""The theme at the start."""

HIGH_CONTRAST = Theme(
    name="high contrast",
    background=(0, 0, 0),
    grid=(38, 38, 38),
    axis=(84, 84, 84),
    bodies=(
        (110, 205, 255),
        (255, 175, 0),
        (0, 225, 165),
        (255, 245, 80),
        (255, 125, 60),
        (255, 150, 215),
        (130, 155, 255),
    ),
    fill_share=0.50,
    static=(190, 190, 190),
    kinematic=(230, 230, 230),
    held=(255, 255, 255),
    spring=(225, 225, 225),
    pin=(255, 255, 255),
    bounds=(175, 175, 175),
    spark=(255, 240, 170),
    panel=(0, 0, 0),
    panel_opacity=1.0,
    outline=(200, 200, 200),
    text=(255, 255, 255),
    faint=(215, 215, 215),
    accent=(255, 235, 60),
    heading=(255, 255, 255),
    velocity=(60, 230, 255),
    force=(255, 210, 40),
    contact_normal=(255, 255, 255),
    normal_impulse=(120, 255, 120),
    friction_impulse=(255, 140, 185),
    friction_cone=(210, 215, 235),
    key=(48, 48, 48),
    key_rim=(235, 235, 235),
    paused=(255, 210, 60),
    slow=(120, 220, 255),
    planet=(215, 180, 255),
    warning=(255, 175, 90),
    error=(255, 135, 125),
    notice=(110, 240, 180),
)
"""For eyes or screens that lose faint things: black, white and strong colours."""

PROJECTOR = Theme(
    name="projector",
    background=(255, 255, 255),
    grid=(233, 235, 239),
    axis=(200, 204, 212),
    bodies=(
        (3, 106, 186),
        (177, 121, 13),
        (6, 155, 88),
        (73, 56, 24),
        (191, 67, 6),
        (165, 58, 120),
        (44, 52, 197),
    ),
    fill_share=0.45,
    static=(92, 99, 114),
    kinematic=(58, 63, 76),
    held=(10, 12, 18),
    spring=(88, 95, 112),
    pin=(40, 44, 54),
    bounds=(105, 113, 132),
    spark=(205, 95, 0),
    panel=(247, 248, 250),
    panel_opacity=0.94,
    outline=(196, 201, 211),
    text=(22, 25, 33),
    faint=(84, 91, 107),
    accent=(0, 92, 175),
    heading=(5, 7, 12),
    velocity=(0, 110, 190),
    force=(165, 95, 0),
    contact_normal=(40, 44, 56),
    normal_impulse=(10, 125, 40),
    friction_impulse=(200, 30, 100),
    friction_cone=(88, 94, 114),
    key=(224, 228, 235),
    key_rim=(160, 167, 181),
    paused=(140, 85, 0),
    slow=(0, 92, 175),
    planet=(105, 55, 185),
    warning=(165, 70, 0),
    error=(185, 20, 25),
    notice=(0, 110, 70),
)
"""For a bright room: dark on white."""

THEMES = (DARK, HIGH_CONTRAST, PROJECTOR)
"""Every theme, in the order in which they follow each other."""
