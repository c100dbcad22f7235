"""The look of the widgets, from the colours of the window."""

from __future__ import annotations

from typing import Any

from physicslab.view.canvas.theme import Colour, Theme

__all__ = ["style_of"]


def style_of(theme: Theme, text_size: int) -> dict[str, Any]:
    """Return a theme as pygame_gui writes it."""

    def button(ground: Colour, words: Colour) -> dict[str, str]:
        paints = {
            "normal": (ground, words), "hovered": (theme.key, theme.heading),
            "active": (theme.key_rim, theme.heading), "selected": (theme.key, theme.accent),
            "disabled": (ground, theme.faint),
        }  # fmt: skip
        return {
            f"{state}_{part}": _written(colour)
            for state, (under, over) in paints.items()
            for part, colour in (
                ("bg", under), ("text", over), ("border", over if state == "selected" else under)
            )
        }  # fmt: skip

    font = {"name": "noto_sans", "size": str(text_size), "style": "regular"}
    shape = {"shape": "rounded_rectangle", "shape_corner_radius": "5", "shadow_width": "0"}
    panel = {"dark_bg": _written(theme.panel), "normal_border": _written(theme.outline)}
    left = {"text_horiz_alignment": "left", "text_horiz_alignment_padding": str(text_size // 2)}
    flat, framed = {**shape, "border_width": "1"}, {**shape, "shape_corner_radius": "8", "border_width": "1"}
    return {
        "@tool": {"colours": button(theme.panel, theme.text), "font": font, "misc": flat},
        "@row": {"colours": button(theme.panel, theme.text), "font": font, "misc": {**flat, **left}},
        "@bar": {"colours": panel, "misc": {"shadow_width": "0", "border_width": "0"}},
        "@menu": {"colours": {**panel, "normal_border": _written(theme.key_rim)}, "misc": framed},
    }


def _written(colour: Colour) -> str:
    return "rgb({}, {}, {})".format(*colour)
