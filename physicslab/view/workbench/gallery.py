"""The gallery: every scene as a card with its picture, its title and its sentence."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pygame
from imgui_bundle import ImVec2, imgui

from physicslab.ecs.text import printable
from physicslab.files.scene import SceneError, load_scene
from physicslab.scenes import SCENES
from physicslab.view.canvas.theme import Theme
from physicslab.view.controls.file_actions import open_from_list
from physicslab.view.controls.scene_files import scene_files
from physicslab.view.picture.picture import picture_of
from physicslab.view.toolkit.labels import widget_label
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window

__all__ = ["Gallery"]

_CARD = (15.0, 14.2)
"""Width and height of a card, in heights of the text."""
_PICTURE = (14.0, 8.0)
"""Width and height of its picture."""
_SHARE = 0.94
"""How much of the room of the world the gallery takes at most."""


@dataclass(frozen=True, slots=True)
class _Card:
    source: str | Path
    title: str
    words: str


class Gallery:
    """Cards in rows. Pictures are drawn when they are first seen, one a frame, and kept."""

    def __init__(self) -> None:
        self._pictures: dict[tuple[str | Path, tuple[int, int], str], pygame.Surface] = {}
        self._cards: list[_Card] = []

    def refresh(self) -> None:
        """Look again which scene files there are."""
        self._cards = [_Card(name, scene.title, scene.description) for name, scene in SCENES.items()]
        try:
            files = scene_files(Path.cwd())
        except OSError:
            files = []
        self._cards += [_Card(path, printable(path.name), "In the working directory") for path in files]

    @property
    def is_complete(self) -> bool:
        """Whether every card that was seen has its picture."""
        return not self._missing

    _missing = False

    def build(self, ui: Ui, window: Window) -> None:
        """Build the cards in a window over the world."""
        if not self._cards:
            self.refresh()
        size = ui.size
        left, top, width, height = window.room()
        columns = max(int(_SHARE * width / ((_CARD[0] + 0.6) * size)), 1)
        inner = ImVec2(columns * (_CARD[0] + 0.6) * size + 1.5 * size, _SHARE * height - 4.0 * size)
        self._missing = False
        with ui.floating("Scenes", (left + 0.5 * width, top + 0.5 * height), docks=True) as stays:
            if imgui.begin_child("cards", inner):
                clip = _visible()
                for n, card in enumerate(self._cards):
                    if n % columns:
                        imgui.same_line(0.0, 0.6 * size)
                    self._build_card(ui, card, clip, window)
            imgui.end_child()
        if not stays[0]:
            window.shows_gallery = False

    def _build_card(self, ui: Ui, card: _Card, clip: pygame.Rect, window: Window) -> None:
        size = ui.size
        extent = ImVec2(_CARD[0] * size, _CARD[1] * size)
        corner = imgui.get_cursor_screen_pos()
        imgui.begin_group()
        clicked = imgui.selectable(widget_label("", f"card {card.source}"), False, 0, extent)[0]
        ui.note(f"Scene: {card.title}")
        if clicked:
            window.do_next(open_from_list, card.source)
        imgui.set_cursor_screen_pos(ImVec2(corner.x + 0.5 * size, corner.y + 0.5 * size))
        box = pygame.Rect(
            round(corner.x + 0.5 * size), round(corner.y + 0.5 * size),
            round(_PICTURE[0] * size), round(_PICTURE[1] * size),
        )  # fmt: skip
        if box.colliderect(clip):
            picture = self._picture(card.source, box.size, window.theme)
            if picture is not None:
                ui.picture(picture, (box.x, box.y), clip)
        imgui.set_cursor_screen_pos(ImVec2(corner.x + 0.5 * size, corner.y + (_PICTURE[1] + 0.9) * size))
        imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + _PICTURE[0] * size)
        ui.text(card.title)
        imgui.set_cursor_screen_pos(
            ImVec2(corner.x + 0.5 * size, imgui.get_cursor_screen_pos().y - 0.2 * size)
        )
        ui.faint(card.words, wrapped=False)
        imgui.pop_text_wrap_pos()
        imgui.set_cursor_screen_pos(ImVec2(corner.x, corner.y + extent.y))
        imgui.dummy(ImVec2(extent.x, 0.0))
        imgui.end_group()

    def _picture(self, source: str | Path, size: tuple[int, int], theme: Theme) -> pygame.Surface | None:
        """Return the picture of a scene; ``None`` for now where another was drawn in this frame."""
        key = source, size, theme.name
        if key not in self._pictures:
            if self._missing:
                return None
            self._missing = True
            try:
                self._pictures[key] = picture_of(load_scene(source), size, theme)
            except (SceneError, OSError, ValueError):
                self._pictures[key] = pygame.Surface(size, 0, 32)
        return self._pictures[key]


def _visible() -> pygame.Rect:
    """Return what can be seen of the window that is being built [px]."""
    place, extent = imgui.get_window_pos(), imgui.get_window_size()
    return pygame.Rect(round(place.x), round(place.y), round(extent.x), round(extent.y))
