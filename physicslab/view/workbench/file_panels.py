"""Windows of files: to save, open and film, the gallery of scenes, and what a session has left."""

from dataclasses import dataclass
from pathlib import Path

import pygame
from imgui_bundle import ImVec2, imgui

from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.text import printable
from physicslab.export.film import ENDINGS
from physicslab.files.scene import SceneError, load_scene
from physicslab.scenes import SCENES
from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.theme import Theme
from physicslab.view.controls import file_actions
from physicslab.view.controls.file_actions import begin_film, open_from_list, scene_files
from physicslab.view.picture.picture import picture_of
from physicslab.view.toolkit.ui import Ui
from physicslab.view.toolkit.windows import widget_label
from physicslab.view.window.filming import ALL, BACK, FORWARD, FROM_NOW
from physicslab.view.window.window import Window
from physicslab.world import World

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


def build_save(ui: Ui, world: World, window: Window) -> None:
    """Build the field and its buttons, in a window of its own."""
    close = window.closing_of("naming")
    with ui.floating("Save as", window.middle, close):
        ui.faint("A file in the working directory, or a path", wrapped=False)
        text, entered = _build_name(ui, "File name", window.naming or "", _SAVE, window.naming_refused)
        window.naming = text
        if ui.button("Save") or entered:
            ui.do_next(file_actions.save_under, text)
        imgui.same_line()
        if ui.button("Cancel"):
            close()


def recent_label(number: int, path: Path) -> str:
    """Return the words of a line of the list of files, which are numbered from 1."""
    return f"{number}. {printable(path.name)}"


def build_open(ui: Ui, world: World, window: Window) -> None:
    """Build the field, a list of the last few files and the buttons, in a window of its own."""
    close = window.closing_of("opening")
    with ui.floating("Open a file", window.middle, close):
        ui.faint("A path, or the number of a line below", wrapped=False)
        text, entered = _build_name(ui, "File to open", window.opening or "", _OPEN, window.opening_refused)
        window.opening = text
        for number, path in enumerate(window.recent.there, start=1):
            ui.selectable(recent_label(number, path), file_actions.open_from_list, path)
            ui.tip(printable(str(path)))
        if ui.button("Open") or entered:
            window.do_next(file_actions.open_named, text)
        imgui.same_line()
        if ui.button("Do not open"):
            close()


def build_film(ui: Ui, world: World, window: Window) -> None:
    """Build the choices, the field and the buttons, in a window of its own."""
    filming, width, close = window.filming, _FILM * ui.size, window.closing_of("filming.choosing")
    with ui.floating("Film", window.middle, close):
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
        if ui.button("No film"):
            close()


# ---- the gallery: every scene as a card with its picture, its title and its sentence -----------------------


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
        place = left + 0.5 * width, top + 0.5 * height
        with (
            ui.floating("Scenes", place, window.closing_of("shows_gallery"), docks=True),
            ui.child("cards", inner) as is_seen,
        ):
            clip = _visible()
            for n, card in enumerate(self._cards if is_seen else ()):
                if n % columns:
                    imgui.same_line(0.0, 0.6 * size)
                self._build_card(ui, card, clip, window)

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


# ---- what a session that ended without closing has left ----------------------------------------------------


def restore_session(world: World, window: Window) -> None:
    """Open what the session on offer has left; where that fails, all stays as it is."""
    try:
        window.next_world = window.recovery.restore()
    except (SceneError, InvalidValue, OSError) as error:
        window.notify(f"Not restored: {error}", 8.0, failed=True)
    else:
        window.pace.paused = True
        window.notify("Restored, and paused: Space goes on")


def discard_session(world: World, window: Window) -> None:
    """Remove what the session on offer has left."""
    window.recovery.discard()


_OFFERS = {"Restore it": restore_session, "Discard": discard_session}
_PAD = 6
"""Room around the words [px]."""


def build_recovery(ui: Ui, window: Window, free: Rect) -> int:
    """Build words and two buttons at the top of what is free, and return how high they are [px].

    They stand in one line where that is wide enough. Keys stay with the scene that runs.
    """
    left, top, width, _ = free
    style, words = imgui.get_style(), window.recovery.words
    room = width - 2 * _PAD
    gap, line = style.item_spacing, imgui.get_frame_height()
    buttons = [imgui.calc_text_size(label).x + 2 * style.frame_padding.x for label in _OFFERS]
    in_line = imgui.calc_text_size(words).x + sum(buttons) + len(buttons) * gap.x <= room
    beside = sum(buttons) + gap.x <= room
    if in_line:
        height = line
    else:
        rows = 1 if beside else len(buttons)
        height = imgui.calc_text_size(words, wrap_width=room).y + rows * (line + gap.y)
    with ui.panel("recovery", (left, top, width, round(height) + 2 * _PAD), padded=False):
        if in_line:
            imgui.align_text_to_frame_padding()
        ui.text(words, ui.theme.notice, wrapped=not in_line)
        for n, (label, action) in enumerate(_OFFERS.items()):
            if in_line or (beside and n):
                imgui.same_line()
            ui.button(label, "", action)
    return round(height) + 2 * _PAD
