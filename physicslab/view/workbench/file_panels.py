"""Windows in which a file is named: the scene to be saved, the file to be opened, the film to be made."""

from __future__ import annotations

from pathlib import Path

from imgui_bundle import imgui

from physicslab.ecs.text import printable
from physicslab.export.film import ENDINGS
from physicslab.view.controls import file_actions
from physicslab.view.controls.file_actions import begin_film
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.filming import ALL, BACK, FORWARD, FROM_NOW
from physicslab.view.window.window import Window

__all__ = ["build_film", "build_open", "build_save", "recent_label"]

_SAVE, _OPEN, _FILM = 24.0, 28.0, 22.0
"""Widths of the fields, in heights of the text."""
_KINDS = {"GIF, for any browser and mail": ENDINGS[0], "MP4, small and sharp": ENDINGS[1]}


def _build_name(ui: Ui, label: str, text: str, width: float, refused: str) -> tuple[str, bool]:
    """Build the field of a name, and why it is refused; return the name, and whether Enter was pressed."""
    if imgui.is_window_appearing():
        imgui.set_keyboard_focus_here()
    text, _ = ui.field(label, text, width * ui.size, wrong=bool(refused))
    entered = imgui.is_item_focused() and imgui.is_key_pressed(imgui.Key.enter)
    if refused:
        ui.text(refused, ui.theme.error, wrapped=True)
    return text, entered


def build_save(ui: Ui, window: Window) -> None:
    """Build the field and its buttons, in a window of its own."""
    with ui.floating("Save as", window.middle) as stays:
        ui.faint("A file in the working directory, or a path", wrapped=False)
        text, entered = _build_name(ui, "File name", window.naming or "", _SAVE, window.naming_refused)
        window.naming = text
        if ui.button("Save") or entered:
            window.do_next(file_actions.save_under, text)
        imgui.same_line()
        if ui.button("Cancel") or not stays[0]:
            window.naming = None


def recent_label(number: int, path: Path) -> str:
    """Return the words of a line of the list of files, which are numbered from 1."""
    return f"{number}. {printable(path.name)}"


def build_open(ui: Ui, window: Window) -> None:
    """Build the field, a list of the last few files and the buttons, in a window of its own."""
    with ui.floating("Open a file", window.middle) as stays:
        ui.faint("A path, or the number of a line below", wrapped=False)
        text, entered = _build_name(ui, "File to open", window.opening or "", _OPEN, window.opening_refused)
        window.opening = text
        for number, path in enumerate(window.recent.there, start=1):
            if ui.selectable(recent_label(number, path)):
                window.do_next(file_actions.open_from_list, path)
            ui.tip(printable(str(path)))
        if ui.button("Open") or entered:
            window.do_next(file_actions.open_named, text)
        imgui.same_line()
        if ui.button("Do not open") or not stays[0]:
            window.opening = None


def build_film(ui: Ui, window: Window) -> None:
    """Build the choices, the field and the buttons, in a window of its own."""
    filming, width = window.filming, _FILM * ui.size
    with ui.floating("Film", window.middle) as stays:
        filming.what = ui.choice("Film of", filming.what, (ALL, BACK, FORWARD, FROM_NOW), width=width)
        ending = Path(filming.name).suffix.lower()
        now = next((kind for kind, other in _KINDS.items() if other == ending), next(iter(_KINDS)))
        kind = ui.choice("Film as", now, tuple(_KINDS), width=width)
        if kind != now:
            filming.name, filming.refused = f"{Path(filming.name).stem}{_KINDS[kind]}", ""
        filming.name, entered = _build_name(ui, "Film name", filming.name, _FILM, filming.refused)
        if ui.button("Make the film", "It plays as fast as time runs in the window now") or entered:
            window.do_next(begin_film)
        imgui.same_line()
        if ui.button("No film") or not stays[0]:
            filming.choosing = False
