"""The film that is to be made: of what, and under which name."""

from __future__ import annotations

from pathlib import Path

from imgui_bundle import imgui

from physicslab.export.film import ENDINGS
from physicslab.view.controls.film_actions import begin_film
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.filming import ALL, BACK, FORWARD, FROM_NOW
from physicslab.view.window.window import Window

__all__ = ["build_film"]

_WIDTH = 22.0
"""Of the fields, in heights of the text."""
_KINDS = {"GIF, for any browser and mail": ENDINGS[0], "MP4, small and sharp": ENDINGS[1]}


def build_film(ui: Ui, window: Window) -> None:
    """Build the choices and the buttons, in a window of its own."""
    filming, width = window.filming, _WIDTH * ui.size
    with ui.floating("Film", window.middle) as stays:
        filming.what = ui.choice("Film of", filming.what, (ALL, BACK, FORWARD, FROM_NOW), width=width)
        ending = Path(filming.name).suffix.lower()
        now = next((kind for kind, other in _KINDS.items() if other == ending), next(iter(_KINDS)))
        kind = ui.choice("Film as", now, tuple(_KINDS), width=width)
        if kind != now:
            filming.name, filming.refused = f"{Path(filming.name).stem}{_KINDS[kind]}", ""
        text, _ = ui.field("Film name", filming.name, width, wrong=bool(filming.refused))
        filming.name = text
        if imgui.is_window_appearing():
            imgui.set_keyboard_focus_here(-1)
        entered = imgui.is_item_focused() and imgui.is_key_pressed(imgui.Key.enter)
        if filming.refused:
            ui.text(filming.refused, ui.theme.error, wrapped=True)
        if ui.button("Make the film", "It plays as fast as time runs in the window now") or entered:
            window.deeds.append(begin_film)
        imgui.same_line()
        if ui.button("No film") or not stays[0]:
            filming.choosing = False
