"""The window in which a file is opened: by its name, from the last few, or from folders, with its picture."""

import time
from pathlib import Path

import pygame
from imgui_bundle import ImVec2, imgui

from physicslab.ecs.text import printable
from physicslab.files.listing import Entry, entries
from physicslab.view.controls import file_actions
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.scenes import Opening
from physicslab.view.window.window import Window
from physicslab.view.workbench.file_panels import build_name, recent_label
from physicslab.view.workbench.thumbnails import Thumbnails
from physicslab.world import World

_LIST, _HEIGHT = 24.0, 20.0
"""Width and height of the list of files, in heights of the text."""
_PICTURE = (16.0, 9.2)
"""Width and height of the picture beside it."""
_PERIOD = 2.0
"""Time [s] after which a folder is listed again."""


class FileBrowser:
    """A list of the last few files and of a folder; what is pointed at, by mouse or keys, has its picture."""

    def __init__(self, thumbnails: Thumbnails) -> None:
        self._thumbnails = thumbnails
        self._listed: list[Entry] = []
        self._refused = ""
        self._folder: Path | None = None
        self._until = 0.0
        self._seen: Path | None = None

    def build(self, ui: Ui, world: World, window: Window) -> None:
        """Build the field, the list, the picture and the buttons."""
        close, opening, size = window.closing_of("scenes.opening"), window.scenes.opening, ui.size
        assert opening is not None
        self._thumbnails.begin(window.language, runs=window.has_kernels())
        with ui.floating("Open a file", window.framing.middle, close):
            if imgui.is_window_appearing():
                self._folder = self._seen = None
            ui.faint("A path or a name, or the number of a line below", wrapped=False)
            if opening.folder != self._folder:
                imgui.set_keyboard_focus_here()
            entered = build_name(ui, "File to open", opening, _LIST + _PICTURE[0], close)
            ui.gap(0.2)
            wide, high = ui.fitted((_LIST + _PICTURE[0]) * size, _HEIGHT * size)
            seen = None
            with ui.child("files", ImVec2(wide - (_PICTURE[0] + 1.0) * size, high)) as is_seen:
                if is_seen:
                    seen = self._build_list(ui, window, opening)
            self._seen = seen or self._seen
            imgui.same_line()
            with ui.child("seen", ImVec2(_PICTURE[0] * size, high)) as is_seen:
                if is_seen and self._seen is not None:
                    self._build_seen(ui, window, self._seen)
            if ui.button("Open") or entered:
                window.do_next(file_actions.open_named, opening.text)
            imgui.same_line()
            if ui.button("Cancel"):
                close()

    def _build_list(self, ui: Ui, window: Window, opening: Opening) -> Path | None:
        """Build the last few files, and the folder; return the scene that is pointed at."""
        seen = None
        recent = window.scenes.recent.there
        if recent:
            self._seen = self._seen or recent[0]
            ui.faint("Opened or saved last", wrapped=False)
        for number, path in enumerate(recent, start=1):
            ui.selectable(recent_label(number, path), file_actions.open_from_list, path)
            ui.tip(printable(str(path)))
            seen = path if _is_pointed_at() else seen
        self._list(opening.folder)
        ui.faint(printable(str(opening.folder)), wrapped=False)
        ui.refusal(self._refused)
        if opening.folder.parent != opening.folder:
            ui.selectable("Up", file_actions.open_folder, opening.folder.parent, identity="the folder above")
        for entry in self._listed:
            name = printable(entry.path.name)
            if entry.is_folder:
                ui.selectable(f"{name}/", file_actions.open_folder, entry.path)
            elif entry.why_not:
                ui.selectable(f"{name}: {entry.why_not}", faint=True, identity=name)
            else:
                ui.selectable(name, file_actions.open_from_list, entry.path, identity=f"file {name}")
                seen = entry.path if _is_pointed_at() else seen
        return seen

    def _list(self, folder: Path) -> None:
        now = time.monotonic()
        if folder == self._folder and now < self._until:
            return
        self._folder, self._until, self._refused = folder, now + _PERIOD, ""
        try:
            self._listed = entries(folder)
        except OSError as error:
            self._listed, self._refused = [], f"Cannot be listed: {error.strerror or error}"

    def _build_seen(self, ui: Ui, window: Window, path: Path) -> None:
        size = ui.size
        known = self._thumbnails.known(path)
        corner, extent = imgui.get_cursor_screen_pos(), (round(_PICTURE[0] * size), round(_PICTURE[1] * size))
        picture = self._thumbnails.still(path, extent, window.theme)
        clip = pygame.Rect(round(corner.x), round(corner.y), *extent)
        if picture is not None:
            ui.picture(picture, clip.topleft, clip)
        imgui.dummy(ImVec2(*extent))
        if known is None:
            return
        ui.text(known.title, wrapped=True)
        ui.refusal(known.failure)
        ui.faint(known.words[:300])


def _is_pointed_at() -> bool:
    return bool(imgui.is_item_hovered() or imgui.is_item_focused())
