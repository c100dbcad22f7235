"""Parts of the picture that are kept: they look as if drawn at once, and are drawn only when they change."""

from __future__ import annotations

import numpy as np
import pygame
import pytest
from numpy.typing import NDArray
from recording import RecordingCanvas

from physicslab.systems.frame.refresh_timer import RefreshTimer
from physicslab.view.canvas.canvas import Rect, TextStyle, TextSurface
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.canvas.rounded import rounded

RECT = (20, 10, 120, 60)
INK = TextStyle(14, (230, 230, 230))


def canvas() -> PygameCanvas:
    made = PygameCanvas(pygame.Surface((200, 100), 0, 32))
    made.clear((10, 40, 90))
    return made


def write(surface: TextSurface, rect: Rect = RECT, words: str = "Contacts 42") -> None:
    surface.panel(rect, (20, 24, 32), (90, 96, 110), 0.8)
    surface.text(words, (rect[0] + 8, rect[1] + 6), INK)
    surface.text("right", (rect[0] + rect[2] - 8, rect[1] + 30), INK, "right")


def colours(made: PygameCanvas) -> NDArray[np.int64]:
    return pygame.surfarray.array3d(made.surface).astype(np.int64)


def test_a_layer_looks_like_what_is_drawn_at_once() -> None:
    at_once, kept = canvas(), canvas()
    write(at_once)
    kept.layer("panel", RECT, 1, write)
    assert np.abs(colours(at_once) - colours(kept)).max() <= 3, "blended in another order, rounding apart"


def test_a_layer_is_drawn_only_when_its_version_or_its_size_changes() -> None:
    made, drawn = canvas(), []

    def draw(surface: TextSurface) -> None:
        drawn.append(surface)
        write(surface)

    for version, rect in (
        (1, RECT),
        (1, RECT),
        (2, RECT),
        (2, (*RECT[:2], 130, 60)),
        (2, (*RECT[:2], 130, 60)),
    ):
        made.layer("panel", rect, version, draw)
    assert len(drawn) == 3


def test_what_a_layer_showed_before_is_gone() -> None:
    made, fresh = canvas(), canvas()
    made.layer("panel", RECT, 1, lambda surface: write(surface, words="MMMMMMMM"))
    made.clear((10, 40, 90))
    made.layer("panel", RECT, 2, lambda surface: write(surface, words="i"))
    fresh.layer("panel", RECT, 2, lambda surface: write(surface, words="i"))
    assert np.array_equal(colours(made), colours(fresh))


def test_a_recording_canvas_notes_what_is_on_a_layer() -> None:
    noted = RecordingCanvas((200, 100))
    noted.layer("panel", RECT, 1, write)
    assert noted.words == ["Contacts 42", "right"]
    assert noted.called("panel")[0]["rect"] == RECT


@pytest.mark.parametrize("size", [(1, 1), (2, 9), (15, 15), (16, 17), (17, 17), (300, 40)])
def test_rounded_rectangles_of_any_size_are_the_same_both_ways(size: tuple[int, int]) -> None:
    made = rounded(size, (20, 24, 32), (90, 96, 110), 0.9)
    assert made.get_size() == size
    alpha = pygame.surfarray.array_alpha(made).astype(int)
    assert np.array_equal(alpha, alpha[::-1, ::-1])
    if min(size) > 16:
        assert alpha[0, 0] < 60, "the corner is cut off"
        assert alpha[size[0] // 2, 0] == alpha[size[0] // 2, size[1] // 2] == 230


def test_one_job_is_due_at_a_time_and_none_is_forgotten() -> None:
    refresh_timer = RefreshTimer({"figures": 0.1, "costs": 0.1, "advice": 0.25})
    done = [job for n in range(61) for job in refresh_timer.due(n / 60)]
    counts = {name: done.count(name) for name in ("figures", "costs", "advice")}
    assert counts["figures"] in (9, 10, 11) and counts["costs"] in (9, 10, 11) and counts["advice"] in (4, 5)


def test_after_all_was_done_nothing_is_due() -> None:
    refresh_timer = RefreshTimer({"figures": 0.1, "costs": 0.2})
    assert refresh_timer.all_due(5.0) == ["figures", "costs"]
    assert refresh_timer.due(5.05) == []
    assert [refresh_timer.due(5.11), refresh_timer.due(5.12)] == [["figures"], []]
