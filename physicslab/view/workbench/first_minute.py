"""Help for the first minute: three cards, the tour, and the search of commands; each can be left."""

import pygame
from imgui_bundle import ImVec2, imgui

from physicslab.languages.sentence import Sentence
from physicslab.view.canvas.canvas import Rect
from physicslab.view.controls import actions, commands, saving
from physicslab.view.controls.tour import STEPS, next_step
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui
from physicslab.view.toolkit.windows import widget_label
from physicslab.view.window.tour import Search
from physicslab.view.window.window import Action, Window
from physicslab.view.workbench.thumbnails import LESSON_TAG
from physicslab.world import World

_PAD = 0.7
"""Room around what is in a panel, in heights of the text."""

# ---- three cards -------------------------------------------------------------------------------------------


_SENTENCE = "Throw something: everything here moves by the laws of mechanics."
_CARD, _CARD_HEIGHT = 11.5, 3.4
"""Least width and the height of a card, in heights of the text."""


def play(world: World, window: Window) -> None:
    """Close the cards."""
    window.put("shows_cards", False)


def learn(world: World, window: Window) -> None:
    """Open the gallery, of lessons alone at first."""
    play(world, window)
    window.scenes.tag, window.scenes.shows_gallery = LESSON_TAG, True


_CARDS = (
    ("Play", "this sandbox", "Throw, draw, stop time: Ctrl+Z takes everything back", play),
    ("Learn", "lessons, and scenes", "Predict, run, compare, explain: lessons of half an hour", learn),
    ("Build", "an empty bench", "A floor and all the tools, at t = 0", saving.begin_new),
)


def build_cards(ui: Ui, window: Window, free: Rect) -> int:
    """Build the cards at the top of what is free of the world; return how high they are [px]."""
    left, top, width, _ = free
    size, gap, line = ui.size, imgui.get_style().item_spacing, imgui.get_frame_height()
    pad = round(_PAD * size)
    inside = width - 2 * pad
    columns = 3 if inside >= 3 * _CARD * size + 2 * gap.x else 1
    card = (inside - (columns - 1) * gap.x) / columns
    rows, high = len(_CARDS) // columns, _CARD_HEIGHT * size if columns > 1 else line
    words = ui.height(_SENTENCE, float(inside))
    wide = columns > 1
    height = round(words + rows * (high + gap.y) + (1 if wide else 2) * (line + gap.y) + 2 * pad)
    with ui.panel("first steps", (left, top, width, height), rounded=True):
        imgui.set_cursor_pos(ImVec2(pad, pad))
        imgui.begin_group()
        ui.text(_SENTENCE, ui.theme.heading, wrapped=True)
        for n, (title, kind, tip, action) in enumerate(_CARDS):
            if n % columns:
                imgui.same_line()
            _build_card(ui, title, kind if wide else "", tip, action, (card, high))
        tour = "A tour in eight steps" if wide else "Tour"
        ui.button("Tour", "Eight acts, each shown until you have done it", actions.toggle_tour, shown=tour)
        if wide:
            imgui.same_line()
        ui.button("Close", "Help > First steps brings this back", play)
        imgui.end_group()
    return height


def _build_card(ui: Ui, title: str, kind: str, tip: str, action: Action, size: tuple[float, float]) -> None:
    """Build a card: a button with its title, and in a second line what it is."""
    if not kind:
        ui.button(title, tip, action, size=size)
        return
    ui.button(title, tip, action, shown="", size=size)
    low, paper, line = imgui.get_item_rect_min(), imgui.get_window_draw_list(), imgui.get_text_line_height()
    top = low.y + 0.5 * (size[1] - 2.1 * line)
    for words, colour, font in (
        (title, ui.theme.heading, ui.fonts.bold), (kind, ui.theme.faint, ui.fonts.plain),
    ):  # fmt: skip
        words = ui.written(words)
        imgui.push_font(font, ui.size)
        left = low.x + 0.5 * (size[0] - imgui.calc_text_size(words).x)
        paper.add_text(ImVec2(left, top), packed(colour), words)
        imgui.pop_font()
        top += 1.1 * line


# ---- the tour ----------------------------------------------------------------------------------------------


def build_tour(ui: Ui, window: Window, free: Rect) -> int:
    """Build the step of the tour at the top of what is free of the world; return how high it is [px]."""
    tour = window.tour
    assert tour is not None
    left, top, width, _ = free
    gap, line = imgui.get_style().item_spacing, imgui.get_frame_height()
    pad, step = round(_PAD * ui.size), STEPS[tour.number]
    high = ui.height(step.words, float(width - 2 * pad))
    height = round(high + 2 * line + 2 * gap.y + 2 * pad)
    with ui.panel("tour", (left, top, width, height), rounded=True):
        imgui.set_cursor_pos(ImVec2(pad, pad))
        imgui.begin_group()
        imgui.align_text_to_frame_padding()
        heading = Sentence(
            "{n} of {all}: {step}", n=tour.number + 1, all=len(STEPS), step=Sentence(step.title)
        )
        ui.text(heading, ui.theme.heading)
        ui.text(step.words, wrapped=True)
        ui.button("Skip this step", "", next_step)
        imgui.same_line()
        ui.button("End the tour", "Esc does so too; Help > Tour begins it again", actions.toggle_tour)
        imgui.end_group()
    return height


# ---- the search of commands --------------------------------------------------------------------------------


_WIDTH = 30.0
"""Width of the search, in heights of the text."""
_MOVES = {pygame.K_DOWN: 1, pygame.K_UP: -1}


class CommandSearch:
    """A field, and what fits what is written in it, the best first: arrows and Enter, or a click."""

    def __init__(self) -> None:
        self._all: list[commands.Command] = []
        self._found: list[commands.Command] = []
        self._text: str | None = None

    def take(self, window: Window, event: pygame.Event) -> bool:
        """Take the keys that are the search's own, while it is open; return whether this was one."""
        search = window.search
        if search is None or event.type != pygame.KEYDOWN:
            return False
        if event.key in _MOVES:
            row = search.row + _MOVES[event.key]
            window.search = Search(search.text, min(max(row, 0), max(len(self._found) - 1, 0)))
        elif event.key in (pygame.K_RETURN, pygame.K_KP_ENTER):
            if self._found:
                window.do_next(commands.run, self._found[search.row])
        elif event.key == pygame.K_ESCAPE or (event.key == pygame.K_k and event.mod & pygame.KMOD_CTRL):
            window.put("search", None)
        else:
            return False
        return True

    def build(self, ui: Ui, world: World, window: Window) -> None:
        """Build it in a window of its own."""
        search = window.search
        assert search is not None
        left, top, width, _ = ui.room
        place = left + 0.5 * width, top + 0.5 * (commands.SHOWN + 6) * imgui.get_frame_height()
        with ui.floating("Search", place, window.closing_of("search")):
            across, _ = ui.fitted(_WIDTH * ui.size, ui.size)
            if imgui.is_window_appearing():
                imgui.set_keyboard_focus_here()
                self._all, self._text = list(commands.commands(window)), None
            text, _ = ui.field("Search", search.text, across)
            if text != self._text:
                row = 0 if self._text is not None else search.row
                self._text, self._found = text, commands.find(text, self._all, ui.language)
                window.search = search = Search(text, row)
            for n, command in enumerate(self._found):
                self._build_line(ui, window, command, n == search.row, across)
            if not self._found:
                ui.faint("Nothing is called so", wrapped=False)
            imgui.dummy(ImVec2(across, (commands.SHOWN - max(len(self._found), 1)) * ui.size))

    def _build_line(self, ui: Ui, window: Window, command: commands.Command, on: bool, across: float) -> None:
        """Build a line: what it is called, and at the right the key for it."""
        corner, keys = imgui.get_cursor_pos(), ui.width(command.keys)
        identity = f"{command.words} {command.keys} {command.tip}"
        clicked, _ = imgui.selectable(widget_label("", identity), on, 0, ImVec2(across, 0.0))
        ui.note(f"Found: {command.words}")
        ui.tip(command.tip)
        if clicked:
            window.do_next(commands.run, command)
        after = imgui.get_cursor_pos()
        imgui.push_clip_rect(
            imgui.get_item_rect_min(),
            ImVec2(imgui.get_item_rect_max().x - keys - ui.size, imgui.get_item_rect_max().y), True,
        )  # fmt: skip
        imgui.set_cursor_pos(corner)
        ui.text(command.words)
        imgui.pop_clip_rect()
        imgui.set_cursor_pos(ImVec2(corner.x + across - keys, corner.y))
        ui.faint(command.keys, wrapped=False)
        imgui.set_cursor_pos(after)
