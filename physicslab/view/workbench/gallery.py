"""The gallery: every scene as a card with its picture, one's own first, found by words and by tags."""

import re
from collections.abc import Sequence
from pathlib import Path
from textwrap import shorten
from typing import Any

import pygame
from imgui_bundle import ImVec2, imgui

from physicslab.ecs.text import printable
from physicslab.files.listing import scenes_here
from physicslab.lessons.catalogue import LESSONS
from physicslab.scenes import SCENES
from physicslab.view.controls.commands import plain, spellings
from physicslab.view.controls.file_actions import open_from_list
from physicslab.view.controls.lesson_actions import open_lesson
from physicslab.view.toolkit.ui import Ui
from physicslab.view.toolkit.windows import widget_label
from physicslab.view.window.window import Window
from physicslab.view.workbench.thumbnails import OF_LESSON, Known, Source, Thumbnails, lesson_of

_CARD = (15.0, 14.2)
"""Width and height of a card, in heights of the text."""
_PICTURE = (14.0, 8.0)
"""Width and height of its picture."""
_SHARE = 0.94
"""How much of the room of the world the gallery takes at most."""
_HEAD = 8.2
"""Height of what stands above the cards, at most, in heights of the text."""
_LINES = 3.4
"""How many lines tags may fill as buttons."""
_OWN = "my own"
"""The tag of files."""


class Gallery:
    """Cards in rows. Scenes are read and pictures are made when they are first needed, one a frame."""

    def __init__(self, thumbnails: Thumbnails) -> None:
        self._thumbnails = thumbnails
        self._sources: list[Source] = []
        self._words, self._tag = "", ""
        self._keeps_focus = False
        self._hovered: Source | None = None

    def refresh(self, window: Window) -> None:
        """Look again which scene files there are; those here come first, then the last few of elsewhere."""
        files = scenes_here()
        for path in files:
            self._thumbnails.forget(path)
        others = [path for path in window.scenes.recent.there if path not in files]
        self._sources = [*files, *others, *SCENES, *(f"{OF_LESSON}{name}" for name in LESSONS)]

    def build(self, ui: Ui, window: Window) -> None:
        """Build the search and the cards in a window over the world."""
        size = ui.size
        _, _, width, height = window.framing.room()
        if width < 2.0 * _CARD[0] * size or _SHARE * height < (4.0 + _HEAD + _CARD[1]) * size:
            width, height = window.canvas.size  # large letters beside a small world
        columns = max(int(_SHARE * width / ((_CARD[0] + 0.6) * size)), 1)
        inner = ImVec2(columns * (_CARD[0] + 0.6) * size + 1.5 * size, _SHARE * height - (4.0 + _HEAD) * size)
        self._thumbnails.begin(window.language, runs=window.has_kernels())
        close = window.closing_of("scenes.shows_gallery")
        with ui.floating("Scenes", window.framing.middle, close, docks=True):
            if imgui.is_window_appearing():
                self._words, self._tag = "", window.scenes.tag
                self.refresh(window)
                imgui.set_keyboard_focus_here()
            found = self._build_search(ui, window, columns)
            hovered, self._hovered = self._hovered, None
            with ui.child("cards", inner) as is_seen:
                clip = _visible()
                for n, (source, known) in enumerate(found if is_seen else ()):
                    if n % columns:
                        imgui.same_line(0.0, 0.6 * size)
                    self._build_card(ui, source, known, clip, window, moves=source == hovered)
                if not found:
                    ui.faint("No scene has these words; Backspace takes letters back", wrapped=False)

    def _build_search(self, ui: Ui, window: Window, columns: int) -> list[tuple[Source, Known]]:
        """Build the field and the tags; return the scenes that are to be shown."""
        if imgui.is_key_pressed(imgui.Key.escape):
            window.closing_of("scenes.shows_gallery")()
        if self._keeps_focus:
            imgui.set_keyboard_focus_here()
        self._words, _ = ui.field("Search scenes", self._words, min(columns, 2) * _CARD[0] * ui.size)
        entered = imgui.is_item_focused() and imgui.is_key_pressed(imgui.Key.enter)
        end = columns * (_CARD[0] + 0.6) * ui.size
        hint = "words of a title or a text; Enter opens the first"
        ui.same_line_if_room(hint, end)
        ui.faint(hint, wrapped=False)
        every = [(source, known) for source in self._sources if (known := self._known(source)) is not None]
        tags = dict.fromkeys(tag for _, known in every for tag in known.tags)
        ordered = ("", *sorted(tags, key=lambda tag: (tag != _OWN, ui.said(tag).casefold())))
        clicked = self._build_tags(ui, ordered, end)
        wanted = _parted(plain(self._words)).split()
        found = [
            (source, known)
            for source, known in every
            if (not self._tag or self._tag in known.tags)
            and (not wanted or all(f" {word}" in _text(ui, source, known) for word in wanted))
        ]
        # The next letters are for the search, too.
        self._keeps_focus = clicked or (entered and not (found and wanted))
        if entered and found and wanted:
            window.do_next(*_opening(found[0][0]))
        return found

    def _build_tags(self, ui: Ui, tags: Sequence[str], end: float) -> bool:
        """Build a button for each tag, or a list of them where these would fill more than a few lines.

        Return whether one was clicked.
        """
        if sum(ui.button_width(tag or "all") + 0.6 * ui.size for tag in tags) > _LINES * end:
            before = self._tag
            self._tag = ui.choice(
                "Tag", before, lambda: {tag: tag or "all" for tag in tags}, shown=before or "all",
                width=min(_CARD[0] * ui.size, end),
            )  # fmt: skip
            return self._tag != before
        clicked = False
        for n, tag in enumerate(tags):
            if n:
                ui.same_line_if_room(tag, end)
            if ui.button(f"Tag: {tag or 'all'}", shown=tag or "all", on=tag == self._tag):
                self._tag, clicked = tag, imgui.is_mouse_released(imgui.MouseButton_.left)
        return clicked

    def _known(self, source: Source) -> Known | None:
        known = self._thumbnails.known(source)
        if isinstance(source, Path):
            if known is None:
                return Known(printable(source.name), "", (_OWN,))
            return Known(known.title, known.words, (_OWN, *known.tags), known.failure)
        return known

    def _build_card(
        self, ui: Ui, source: Source, known: Known, clip: pygame.Rect, window: Window, *, moves: bool
    ) -> None:
        size = ui.size
        extent = ImVec2(_CARD[0] * size, _CARD[1] * size)
        corner = imgui.get_cursor_screen_pos()
        imgui.begin_group()
        clicked = imgui.selectable(widget_label("", f"card {source}"), False, 0, extent)[0]
        ui.note(f"Scene: {known.title}")
        if imgui.is_item_hovered() or imgui.is_item_focused():
            self._hovered = source
        if clicked:
            window.do_next(*_opening(source))
        imgui.set_cursor_screen_pos(ImVec2(corner.x + 0.5 * size, corner.y + 0.5 * size))
        box = pygame.Rect(
            round(corner.x + 0.5 * size), round(corner.y + 0.5 * size),
            round(_PICTURE[0] * size), round(_PICTURE[1] * size),
        )  # fmt: skip
        if box.colliderect(clip):
            made = self._thumbnails.moving if moves else self._thumbnails.still
            picture = made(source, box.size, window.theme)
            if picture is not None:
                ui.picture(picture, (box.x, box.y), clip)
        imgui.set_cursor_screen_pos(ImVec2(corner.x + 0.5 * size, corner.y + (_PICTURE[1] + 0.9) * size))
        imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + _PICTURE[0] * size)
        ui.text(known.title)
        imgui.set_cursor_screen_pos(
            ImVec2(corner.x + 0.5 * size, imgui.get_cursor_screen_pos().y - 0.2 * size)
        )
        _build_words(ui, source, known)
        imgui.pop_text_wrap_pos()
        imgui.set_cursor_screen_pos(ImVec2(corner.x, corner.y + extent.y))
        imgui.dummy(ImVec2(extent.x, 0.0))
        imgui.end_group()


def _opening(source: Source) -> tuple[Any, ...]:
    """Return the action that opens a scene or a lesson, and what it is given."""
    name = lesson_of(source)
    return (open_lesson, name) if name else (open_from_list, source)


def _build_words(ui: Ui, source: Source, known: Known) -> None:
    """Write why a file cannot be read, or which file it is, or what is said of a scene."""
    if known.failure:
        ui.text(known.failure[:120], ui.theme.error)
        return
    words = known.words
    if isinstance(source, Path):
        name = printable(source.name)
        words = words if name == known.title else f"{name}. {words}"
        words = words if source.parent == Path.cwd() else f"{printable(str(source.parent))}: {words}"
    ui.faint(shorten(words, 150, placeholder=" ..."), wrapped=False)


def _text(ui: Ui, source: Source, known: Known) -> str:
    """Return all words by which a scene is found, in English and in the language of the window."""
    name = source.name if isinstance(source, Path) else source
    texts = known.title, known.words, name, *known.tags, *known.also
    return f" {_parted(' '.join(one for text in texts for one in spellings(text, ui.language)))}"


def _parted(text: str) -> str:
    """Return the words of a text, with single blanks between them."""
    return " ".join(re.split(r"[\W_]+", text))


def _visible() -> pygame.Rect:
    """Return what can be seen of the window that is being built [px]."""
    place, extent = imgui.get_window_pos(), imgui.get_window_size()
    return pygame.Rect(round(place.x), round(place.y), round(extent.x), round(extent.y))
