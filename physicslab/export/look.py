"""The look of the window, as the player of a page is given it: its colours and the laws of its light."""

from typing import Any

from physicslab import theme
from physicslab.theme import DARK, LIGHT, Colour, Theme

_OWN = {
    "background", "sky_top", "sky_bottom", "panel", "text", "faint", "accent", "grid", "axis", "static",
    "earth", "kinematic", "spring", "rod", "rope", "pin", "shine", "spark",
    "fluid", "within_fluid",
}  # fmt: skip
"""Colours that a page calls as the window does."""
_LIGHTS = ("LIGHT_", "BRIGHT", "DIM", "SHADOW_", "WEDGE", "DEEP", "HATCH")
_SIZES = (
    "RIM", "WALL", "POINT_RADIUS", "PLANET", "LEAST_PLANET", "STAR", "GLOW", "GLOWS", "MAX_SHADOWS",
)  # fmt: skip
"""Laws of light, and sizes, as the player gets them."""


def _colours(of: Theme) -> dict[str, str]:
    """Return the colours of a page by name, each as "#rrggbb"."""
    found: dict[str, Colour] = {name: getattr(of, name) for name in sorted(_OWN)}
    found |= {"line": of.outline, "on-accent": of.background, "arrow": of.velocity}
    found |= {f"b{n}": colour for n, colour in enumerate(of.bodies)}
    return {name: _written(colour) for name, colour in found.items()}


def _written(colour: Colour) -> str:
    red, green, blue = colour
    return f"#{red:02x}{green:02x}{blue:02x}"


def edges_of(fill: Colour) -> list[str]:
    """Return the rims of a body that has a colour of its own: in a dark and in a light page."""
    return [_written(of.edge(fill)) for of in (DARK, LIGHT)]


def style() -> str:
    """Return the colours of a page as custom properties of CSS, for both kinds of screens."""
    dark, light = (
        " ".join(f"--{name}: {colour};" for name, colour in _colours(of).items()) for of in (DARK, LIGHT)
    )
    return f":root {{ {dark} }}\n@media (prefers-color-scheme: light) {{ :root {{ {light} }} }}\n"


def look() -> dict[str, Any]:
    """Return what the player paints bodies with: names of colours, shares and sizes [px]."""
    from physicslab.kernels import finishes  # with numba, which the window imports when it must

    lights = {name.lower(): getattr(finishes, name) for name in dir(finishes) if name.startswith(_LIGHTS)}
    sizes = {name.lower(): getattr(theme, name) for name in _SIZES}
    return {
        "colours": list(_colours(DARK)), "bodies": len(DARK.bodies), "fill": DARK.fill_share,
        "shadows": [DARK.shadow, LIGHT.shadow], **lights, **sizes,
    }  # fmt: skip
