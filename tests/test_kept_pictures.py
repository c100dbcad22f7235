"""Rectangles that are kept, and readings that are taken in turn."""

from __future__ import annotations

import numpy as np
import pygame
import pytest

from physicslab.systems.frame.hud import RefreshTimer
from physicslab.view.canvas.surface_cache import rounded


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
