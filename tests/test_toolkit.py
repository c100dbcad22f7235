"""The toolkit: nothing is done while nothing changes, contexts do not mix, and each is ended."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Callable

import numpy as np
import pygame
import pytest
from desk import SETTLED, LateCanvas, button_down, empty_world, middle_of, point, sized, tap
from imgui_bundle import imgui, implot
from numpy.typing import NDArray

from physicslab.prefabs import circle
from physicslab.theme import DARK, THEMES, Theme
from physicslab.view.toolkit.toolkit import Toolkit
from physicslab.view.toolkit.ui import Ui

SIZE = (320, 200)


def built(toolkit: Toolkit, words: str, frames: int = 4) -> Ui:
    """Build a panel with a button and a field."""
    ui = Ui(toolkit.fonts, DARK)

    def build() -> None:
        ui.begin(DARK)
        with ui.panel("panel", (20, 10, 200, 120)):
            ui.button(words)
            ui.field("field", words)

    for _ in range(frames):
        toolkit.frame(SIZE, DARK, 15.0, 1 / 60, build)
    return ui


def picture(toolkit: Toolkit) -> NDArray[np.uint8]:
    surface = pygame.Surface(SIZE, 0, 32)
    toolkit.pictures.show(surface)
    return pygame.surfarray.array3d(surface)


def test_a_picture_of_a_panel_lies_below_the_panels_before_it() -> None:
    """Pictures of the gallery lay over an open menu."""
    toolkit, red = Toolkit(), (255, 0, 0)
    ui, overlay = Ui(toolkit.fonts, DARK), pygame.Surface((200, 120))
    overlay.fill(red)

    def build() -> None:
        ui.begin(DARK)
        with ui.panel("before", (100, 0, 200, 120)):
            ui.text("menu")
        with ui.panel("behind", (0, 0, 200, 120)):
            ui.text("cards")
            ui.picture(overlay, (0, 0), pygame.Rect(0, 0, 200, 120))

    for _ in range(4):
        toolkit.frame(SIZE, DARK, 15.0, 1 / 60, build)
    surface = pygame.Surface(SIZE, 0, 32)
    toolkit.pictures.show(surface, ui.pictures)
    assert surface.get_at((50, 60))[:3] == red and surface.get_at((150, 100))[:3] != red


def test_words_with_a_power_are_broken_within_the_width_that_is_set() -> None:
    """What came after the power stood in a column of single letters."""
    toolkit, sizes = Toolkit(), {}
    ui = Ui(toolkit.fonts, DARK)

    def build() -> None:
        ui.begin(DARK)
        with ui.panel("panel", (0, 0, 320, 200)), ui.wrapping(150.0):
            for power in ("\N{SUPERSCRIPT TWO}", ""):
                words = f"every jump reaches e{power} of the height before"
                ui.text(words)
                size = imgui.get_item_rect_size()
                sizes[words] = size.x, size.y

    for _ in range(3):
        toolkit.frame(SIZE, DARK, 15.0, 1 / 60, build)
    (wide, high), (_, plain) = sizes.values()
    assert wide <= 150.0 and high <= 1.3 * plain


def test_an_idle_toolkit_builds_and_paints_nothing() -> None:
    toolkit = Toolkit()
    built(toolkit, "idle", 10)
    before = toolkit.built, toolkit.pictures.painted
    built(toolkit, "idle", 50)
    assert (toolkit.built, toolkit.pictures.painted) == before
    toolkit.refresh()
    built(toolkit, "idle", 50)
    assert (toolkit.built, toolkit.pictures.painted) == (before[0] + 1, before[1]), "the same picture is kept"
    toolkit.refresh()
    built(toolkit, "other", 50)
    assert toolkit.pictures.painted > before[1]


def test_a_window_that_stands_still_paints_nothing() -> None:
    world = empty_world()
    circle(world, (0, 0))
    desk = sized((640, 480), world)
    tap(desk, "space")
    desk.frames(40)
    toolkit = desk.sandbox.interface.toolkit
    painted = toolkit.pictures.painted
    desk.frames(100)
    assert toolkit.pictures.painted == painted


def test_panels_are_painted_when_they_are_looked_at() -> None:
    toolkit = Toolkit()
    for words in ("first", "second"):
        built(toolkit, words, 10)
        kept = list(toolkit.pictures._pictures.values())
        assert kept and not any("surface" in vars(one) for one in kept)
    picture(toolkit)
    assert all("surface" in vars(one) for one in kept)


def test_a_window_of_tests_paints_a_frame_when_its_pixels_are_looked_at() -> None:
    desk, red = sized((320, 240)), (255, 0, 0)
    canvas = desk.window.canvas
    assert isinstance(canvas, LateCanvas)
    canvas._surface.fill(red)
    point(desk, (160, 10))
    assert canvas._surface.get_at((160, 120))[:3] == canvas._surface.get_at((160, 10))[:3] == red
    assert canvas.surface.get_at((160, 120))[:3] != red != canvas.surface.get_at((160, 10))[:3]


def test_figures_that_change_together_are_painted_in_turn_those_under_the_cursor_first() -> None:
    toolkit = Toolkit()
    ui, figure = Ui(toolkit.fonts, DARK), 0
    rects = [(100 * n, 0, 90, 50) for n in range(3)]

    def build() -> None:
        ui.begin(DARK)
        for n, rect in enumerate(rects):
            with ui.panel(f"panel {n}", rect):
                ui.text(str(figure))

    def shown() -> list[bytes]:
        surface = pygame.Surface(SIZE, 0, 32)
        toolkit.pictures.show(surface)
        return [pygame.image.tobytes(surface.subsurface(rect), "RGB") for rect in rects]

    def frames(count: int) -> list[list[bool]]:
        """Return which panels are seen to change in each frame."""
        seen, pictures = [], shown()
        for _ in range(count):
            toolkit.frame(SIZE, DARK, 15.0, 1 / 60, build)
            before, pictures = pictures, shown()
            seen.append([one != other for one, other in zip(before, pictures, strict=True)])
        return seen

    frames(4)
    for pointer, first in (((-1.0, -1.0), None), ((210.0, 10.0), 2), ((110.0, 10.0), 1)):
        toolkit.follow_pointer(pointer)
        figure += 1
        toolkit.refresh()
        changes = frames(6)
        assert [sum(changed) for changed in changes] == ([0, 1, 1, 1] if first is None else [1, 1, 1, 0]) + [
            0
        ] * 2
        assert [any(column) for column in zip(*changes, strict=True)] == [True] * 3
        assert first is None or changes[0][first]
        assert not toolkit.unsettled


def test_what_lies_elsewhere_and_other_colours_are_painted_at_once() -> None:
    toolkit = Toolkit()
    ui, theme, shift = Ui(toolkit.fonts, DARK), DARK, 0

    def build() -> None:
        ui.begin(theme)
        for n in range(3):
            with ui.panel(f"panel {n}", (100 * n, shift, 90, 50)):
                ui.text("words")

    def frame() -> int:
        before = toolkit.pictures.painted
        toolkit.frame(SIZE, theme, 15.0, 1 / 60, build)
        return toolkit.pictures.painted - before

    for _ in range(4):
        frame()
    shift = 20
    toolkit.refresh()
    assert frame() == 3
    theme = next(other for other in THEMES if other is not DARK)
    assert frame() == 3 and frame() == 0


def test_two_side_by_side_do_not_mix() -> None:
    one, other = Toolkit(), Toolkit()
    alone = Toolkit()
    built(alone, "one")
    expected = picture(alone)
    for _ in range(4):
        one.wake()
        other.wake()
        a, b = built(one, "one", 1), built(other, "another, with more words", 1)
    assert set(a.places) == {"one", "field"} and "one" not in b.places
    assert np.array_equal(picture(one), expected) and not np.array_equal(picture(other), expected)
    x, y, width, height = b.places["field"]
    place = (x + width // 2, y + height // 2)
    for toolkit in (one, other):
        toolkit.take(pygame.Event(pygame.MOUSEMOTION, pos=place, rel=(0, 0), buttons=(0, 0, 0)))
    other.take(pygame.Event(pygame.MOUSEBUTTONDOWN, pos=place, button=1))
    built(one, "one", 3)
    built(other, "another, with more words", 3)
    assert other.typing and not one.typing and other.dragging and not one.dragging


def test_windows_side_by_side_do_not_mix() -> None:
    one, other = sized((640, 480)), sized((800, 600))
    button_down(one, middle_of(one, "Pause"))
    assert one.sandbox.interface.toolkit.dragging and not other.sandbox.interface.toolkit.dragging
    other.frames(SETTLED)
    assert other.ui.places["Pause"][1] > one.ui.places["Pause"][1]


def test_a_context_is_ended_with_its_toolkit() -> None:
    toolkit = Toolkit()
    built(toolkit, "words")
    context, end = weakref.ref(toolkit), toolkit._context
    assert imgui.get_current_context() is end
    del toolkit
    gc.collect()
    assert context() is None
    assert imgui.get_current_context() is None and implot.get_current_context() is None


@pytest.mark.parametrize("when", ["before", "panel", "between"])
def test_a_context_may_end_while_another_builds(when: str) -> None:
    living, dying = Toolkit(), [Toolkit()]
    built(dying[0], "soon gone")
    ui = Ui(living.fonts, DARK)

    def end() -> None:
        dying.clear()
        gc.collect()

    def build() -> None:
        ui.begin(DARK)
        if when == "before":
            end()
        with ui.panel("panel", (20, 10, 200, 120)):
            if when == "panel":
                end()
            ui.button("still there")

    if when == "between":
        end()
    for _ in range(4):
        living.frame(SIZE, DARK, 15.0, 1 / 60, build)
    assert "still there" in ui.places and picture(living).any()


def test_an_error_while_panels_are_built_leaves_a_toolkit_that_works() -> None:
    toolkit = Toolkit()

    def wrong() -> None:
        raise KeyError("of a panel")

    with pytest.raises(KeyError):
        toolkit.frame(SIZE, DARK, 15.0, 1 / 60, wrong)
    toolkit.wake()
    assert "words" in built(toolkit, "words").places


@pytest.mark.parametrize("chosen", THEMES, ids=lambda theme: theme.name)
@pytest.mark.parametrize("size", [12.0, 15.0, 24.0, 30.0])
def test_letters_are_crisp_and_in_the_colours_of_the_theme(chosen: Theme, size: float) -> None:
    """Upright strokes reach the full colour of the text: no letter is stretched from another size."""
    toolkit = Toolkit()
    ui = Ui(toolkit.fonts, chosen)

    def build() -> None:
        ui.begin(chosen)
        with ui.panel("panel", (0, 0, *SIZE)):
            ui.text("HILTE")

    for _ in range(4):
        toolkit.frame(SIZE, chosen, size, 1 / 60, build)
    shown = picture(toolkit)[4:-4, 4:-4].astype(int)
    off, contrast = (np.abs(shown - np.array(c)).max(axis=2) for c in (chosen.text, chosen.panel))
    assert np.count_nonzero(off <= 24) > size, "strokes in full colour"
    rows = np.nonzero((contrast > 100).any(axis=0))[0]
    assert 0.54 * size < rows[-1] - rows[0] + 1 < 0.68 * size, "capitals as high as asked for"


def test_panels_give_what_is_covered_from_back_to_front() -> None:
    toolkit = Toolkit()
    ui = Ui(toolkit.fonts, DARK)
    rects = [(0, 0, 100, 50), (60, 20, 100, 50)]

    def build() -> None:
        ui.begin(DARK)
        for n, rect in enumerate(rects):
            with ui.panel(f"panel {n}", rect):
                ui.text("words")

    for _ in range(4):
        toolkit.frame(SIZE, DARK, 15.0, 1 / 60, build)
    assert sorted(toolkit.covered) == rects
    inside: Callable[[int, int], bool] = lambda x, y: toolkit.covers((x, y))  # noqa: E731
    assert inside(0, 0) and inside(99, 49) and inside(159, 69)
    assert not inside(100, 10) and not inside(10, 50) and not inside(160, 70)


def test_the_cursor_in_the_world_has_no_panel_built() -> None:
    desk = sized((640, 480))
    toolkit = desk.sandbox.interface.toolkit
    left, top, *_ = desk.sandbox.interface.room()
    tap(desk, "space")

    def built_by(places: list[tuple[int, int]]) -> int:
        before = toolkit.built
        for place in places:
            point(desk, place)
        return toolkit.built - before

    desk.frames(20)
    assert built_by([middle_of(desk, "Play"), (left + 40, top + 40)]) >= 2, "on panels, and once beside them"
    desk.frames(20)
    assert built_by([(left + 40 + n, top + 40 + n) for n in range(8)]) <= 2, "but for those of each 0.2 s"
