"""Pace: from frames of any length to steps of one length."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab.view.window.pace import Pace

DT = 1.0 / 60.0


def run(pace: Pace, frames: list[float]) -> int:
    made = 0
    for elapsed in frames:
        pace.begin(elapsed)
        due = pace.due(DT)
        pace.done(due, DT)
        made += due
    return made


@given(st.lists(st.floats(0.001, 0.1), min_size=1, max_size=200))
def test_steps_follow_the_time_however_it_is_cut(frames: list[float]) -> None:
    pace = Pace(max_dt=0.1)
    made = run(pace, frames)
    assert abs(made * DT - sum(frames)) <= 0.5 * DT + 1e-9
    assert pace.dropped == 0.0


@pytest.mark.parametrize("rate", [10, 24, 30, 59.94, 60, 75, 144, 500])
def test_two_seconds_are_120_steps_at_any_frame_rate(rate: float) -> None:
    frames = [1.0 / rate] * int(2.0 * rate)
    rest = 2.0 - sum(frames)
    assert run(Pace(max_dt=0.1), [*frames, rest]) == 120


def test_frames_about_as_long_as_a_step_get_one_each() -> None:
    pace = Pace(max_dt=0.1)
    for n in range(600):
        pace.begin(DT + (0.002 if n % 2 else -0.002))
        assert pace.due(DT) == 1
        pace.done(1, DT)


def test_a_long_frame_is_made_up_for_only_in_part() -> None:
    pace = Pace(max_dt=0.1)
    assert run(pace, [1.5]) == 6
    assert pace.dropped == pytest.approx(1.4)


def test_steps_that_could_not_be_made_are_dropped_and_counted() -> None:
    pace = Pace(max_dt=0.1)
    pace.begin(0.1)
    assert pace.due(DT) == 6
    pace.done(2, DT)
    assert pace.dropped == pytest.approx(4 * DT)
    pace.begin(DT)
    assert pace.due(DT) == 1


def test_paused_time_is_never_made_up() -> None:
    pace = Pace(max_dt=0.1)
    pace.toggle_pause()
    assert run(pace, [0.05] * 100) == 0
    pace.toggle_pause()
    assert run(pace, [DT]) == 1
    assert pace.dropped == 0.0


def test_single_steps_while_paused() -> None:
    pace = Pace(max_dt=0.1)
    pace.queue_step()
    pace.queue_step()
    assert pace.paused
    assert run(pace, [DT, DT, DT]) == 2


def test_slow_motion_is_a_quarter() -> None:
    pace = Pace(max_dt=0.1)
    assert pace.speed == 1.0
    pace.slow_motion = True
    assert pace.speed == 0.25


def test_after_a_halt_nothing_is_made_up() -> None:
    pace = Pace(max_dt=0.1)
    pace.begin(0.1)
    pace.halt()
    assert pace.paused and pace.due(DT) == 0
    pace.toggle_pause()
    assert pace.due(DT) == 0
