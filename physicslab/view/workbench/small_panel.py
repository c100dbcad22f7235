"""Shared parts of meters and sliders: a title with a menu behind it, and their corner."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from imgui_bundle import imgui

from physicslab.view.canvas.drawable_text import drawable, shortened
from physicslab.view.toolkit.ui import Ui

__all__ = ["build_corners", "build_title", "size_of"]

_MENU = "..."
_LETTERS = 34
"""Letters of a title."""


def size_of(ui: Ui, title: str, width: float, height: float) -> tuple[int, int]:
    """Return the width and height of a small panel [px] with a title above something so large."""
    style = imgui.get_style()
    button = imgui.calc_text_size(_MENU).x + 2.0 * style.frame_padding.x + style.item_spacing.x
    inside = max(width, imgui.calc_text_size(_words(title)).x + button)
    high = imgui.get_frame_height() + style.item_spacing.y + height
    return round(inside + 2.0 * style.window_padding.x), round(high + 2.0 * style.window_padding.y)


@contextmanager
def build_title(ui: Ui, title: str, label: str) -> Iterator[bool]:
    """Write the title, with a button of a menu at the right; the yielded value says whether it is open."""
    style = imgui.get_style()
    width = imgui.calc_text_size(_MENU).x + 2.0 * style.frame_padding.x
    imgui.align_text_to_frame_padding()
    ui.faint(_words(title), wrapped=False)
    imgui.same_line(imgui.get_window_width() - width - style.window_padding.x)
    tip = f"{label}: what it shows, and where"
    with ui.list(f"Menu of {label.lower()}", tip, shown=_MENU) as is_open:
        yield is_open


def build_corners(ui: Ui, now: str, corners: Sequence[str]) -> str | None:
    """Build a menu of corners; return the one that was chosen."""
    chosen = None
    with ui.menu("Place") as is_open:
        for corner in corners if is_open else ():
            if ui.item(corner.capitalize(), on=corner == now):
                chosen = corner
    return chosen


def _words(title: str) -> str:
    return drawable(shortened(title, _LETTERS))
