"""Titles, names and messages of any letters and any length: drawn as far as they can be, at once."""

from __future__ import annotations

import pygame
import pytest
from deadline import deadline
from desk import Desk, empty_world
from recording import RecordingCanvas

from physicslab.components import Spring
from physicslab.prefabs import circle
from physicslab.view.canvas.canvas import TextStyle
from physicslab.view.canvas.display import Display
from physicslab.view.canvas.drawable_text import MAX_LETTERS
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.overlay.banners import broken

WORDS = {
    "invisible": "\u200b\u200b\u2060\ufeff",
    "null": "before\0after",
    "half a pair": "caf\udce9",
    "control": "\x1b[2J\x07 line\nbreak",
    "long word": "W" * 5000,
    "long text": "word " * 100_000,
    "blank": "   ",
    "combining": "e" + "\u0301" * 3000,
    "astral": "\U0001f680" * 300,
}


@pytest.mark.parametrize("words", WORDS.values(), ids=WORDS)
def test_a_window_shows_any_title_and_any_message(words: str) -> None:
    world = empty_world()
    world.title = words
    circle(world, (0, 0))
    desk = Desk(world)
    desk.window.error = desk.window._notice = words
    desk.window.notify(words)
    with deadline(words[:20], seconds=10):
        desk.frames(12)


@pytest.mark.parametrize("words", WORDS.values(), ids=WORDS)
def test_a_line_is_as_wide_as_announced_whatever_it_holds(words: str) -> None:
    canvas = PygameCanvas(pygame.Surface((64, 32), 0, 32))
    style = TextStyle(14, (255, 255, 255))
    canvas.text(words, (0, 0), style)
    canvas.text(words, (0, 0), style, "right")
    width, height = canvas.text_size(words, style)
    assert width >= 0 and 0 < height < 40


@pytest.mark.parametrize("words", WORDS.values(), ids=WORDS)
def test_the_caption_takes_any_title(words: str) -> None:
    pygame.display.init()
    display = Display(PygameCanvas(pygame.display.set_mode((64, 64))), 60)
    display.title = words
    assert len(display.title) <= MAX_LETTERS


def test_a_long_word_is_cut_with_few_looks_at_the_font() -> None:
    class Counting(RecordingCanvas):
        looks = 0

        def text_size(self, words: str, style: TextStyle) -> tuple[int, int]:
            Counting.looks += 1
            return RecordingCanvas.text_size(self, words, style)

    canvas, style = Counting((640, 480)), TextStyle(14, (255, 255, 255))
    lines = broken("W" * 5000, 200, canvas, style)
    assert all(canvas.text_size(line, style)[0] <= 200 for line in lines)
    assert sum(map(len, lines)) == MAX_LETTERS and len(lines[0]) == 26
    assert Counting.looks < 20 * len(lines)


def test_banners_write_powers_of_ten_as_panels_do() -> None:
    canvas, style = RecordingCanvas((640, 480)), TextStyle(14, (255, 255, 255))
    assert broken("off by 2.8e-05 m", 600, canvas, style) == ["off by 2.8·10⁻⁵ m"]


def test_a_spring_as_long_as_numbers_go_is_drawn() -> None:
    world = empty_world()
    bob = circle(world, (0, 0))
    world.add(bob, Spring(anchor_b=(0.0, 2.0), rest_length=1e150, stiffness=1e-300))
    desk = Desk(world)
    desk.key("space")
    desk.frames(3)
