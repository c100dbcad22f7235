"""Letters that the window's own font has not are written in a font of the system, where there is one."""

import numpy as np
import pygame
import pytest
from desk import empty_world, sized

from physicslab.prefabs import circle
from physicslab.theme import DARK
from physicslab.view.canvas import surface_cache, system_font
from physicslab.view.canvas.canvas import TextStyle
from physicslab.view.canvas.surface_cache import SurfaceCache
from physicslab.view.canvas.system_font import FAR

STYLE = TextStyle(20, DARK.text)
needs_font = pytest.mark.skipif(
    system_font.system_font("球") is None, reason="no font of the system has ideographs"
)


def picture(words: str) -> np.ndarray:
    return pygame.surfarray.array_alpha(SurfaceCache().text(words, STYLE))


@pytest.mark.parametrize("words", ["两个球", "ボール", "충돌", "運動", "كرة", "כדור"])
def test_such_letters_are_known(words: str) -> None:
    assert FAR.fullmatch(words)
    assert FAR.split(f"a {words}: 2·10⁻⁶ µ Ω ж")[1] == words


@needs_font
def test_each_letter_has_a_picture_of_its_own() -> None:
    shapes = {picture(letter).tobytes() for letter in "球碰撞ボ충"}
    assert len(shapes) == 5, "a missing letter is a box, the same for all"


@needs_font
def test_mixed_lines_are_as_wide_as_their_pieces() -> None:
    cache = SurfaceCache()
    widths = [cache.text_size(words, STYLE)[0] for words in ("Saved ", "红球", ".json")]
    assert cache.text_size("Saved 红球.json", STYLE)[0] == sum(widths)
    assert cache.text("Saved 红球.json", STYLE).get_size() == cache.text_size("Saved 红球.json", STYLE)


@pytest.mark.skipif(system_font.system_font("ك") is None, reason="no font of the system has such letters")
def test_arabic_and_hebrew_letters_are_no_boxes() -> None:
    shapes = {picture(letter).tobytes() for letter in "كرةבדו"}
    assert len(shapes) == 6 and picture("ك").tobytes() != picture("\U000e0fff").tobytes()


def test_without_such_a_font_nothing_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(surface_cache, "system_font", lambda letter: None)
    assert picture("球").shape[0] > 0


def test_names_of_any_letters_are_shown_in_the_window() -> None:
    world = empty_world(gravity=(0, 0))
    world.title = "两个球的碰撞"
    ball = circle(world, (0, 0), radius=0.5, name="红球")
    desk = sized((1280, 720), world)
    desk.window.selection.take(ball)
    desk.frames(4)
    assert {"两个球的碰撞", "红球"} <= set(desk.ui.words)
