"""Lines of graphs as tones: the pitch follows the value, ticks mark zero, gaps are silent."""

import numpy as np
import pygame
import pytest
from desk import SETTLED, click, empty_world, sized, tap
from hypothesis import example, given
from hypothesis import strategies as st
from plotting import ball_of

from physicslab.view.window.listening import HIGHEST, LASTS, LOWEST, RATE, crossings, pitches, tone

T = np.linspace(0.0, 10.0, 601)


def heard_at(wave: np.ndarray, share: float) -> float:
    """Return the strongest frequency [Hz] around a share of the tone."""
    middle, half = round(share * len(wave)), 1024
    piece = wave[max(middle - half, 0) : middle + half].astype(float)
    spectrum = np.abs(np.fft.rfft(piece * np.hanning(len(piece)), 16 * len(piece)))
    return float(np.argmax(spectrum) * RATE / (16 * len(piece)))


def test_the_least_value_is_the_lowest_tone_and_the_greatest_the_highest() -> None:
    wave = tone(T, 5.0 + np.where(T < 4.0, 0.0, np.where(T < 7.0, 1.0, 0.5)))
    assert len(wave) == round(LASTS * RATE)
    assert heard_at(wave, 0.2) == pytest.approx(LOWEST, rel=0.02)
    assert heard_at(wave, 0.55) == pytest.approx(HIGHEST, rel=0.02)
    assert heard_at(wave, 0.9) == pytest.approx(np.sqrt(LOWEST * HIGHEST), rel=0.02)


def test_a_tick_is_where_the_line_crosses_zero() -> None:
    places = crossings(T, np.cos(2.0 * np.pi * T / 10.0))
    assert [place / (LASTS * RATE) for place in places] == pytest.approx([0.25, 0.75], abs=2e-3)
    assert crossings(T, np.ones(601)) == crossings(T, np.zeros(601)) == []
    quiet, ticking = tone(T, 2.0 + np.sin(T)), tone(T, np.sin(T))
    assert np.abs(ticking).max() > 1.3 * np.abs(quiet).max()


def test_where_there_is_no_value_it_is_silent() -> None:
    values = np.where((T > 3.0) & (T < 6.0), np.nan, T)
    wave = tone(T, values)
    assert not wave[round(0.35 * len(wave)) : round(0.55 * len(wave))].any() and wave[: len(wave) // 4].any()
    assert not tone(T, np.full(601, np.nan)).any()


@given(st.lists(st.floats(allow_infinity=False), min_size=1, max_size=40))
@example([-1.7e308, 1.7e308])
@example([0.0, 5e-324])
def test_any_line_has_pitches_within_the_range(values: list[float]) -> None:
    times, line = np.arange(float(len(values))), np.array(values)
    with np.errstate(over="raise", invalid="raise", divide="raise"):
        found = pitches(times, line)
    known = found[np.isfinite(found)]
    assert np.all((known >= LOWEST * (1 - 1e-12)) & (known <= HIGHEST * (1 + 1e-12)))
    assert tone(times, line).dtype == np.int16


def test_a_line_is_heard_from_the_menu_of_its_graph(request: pytest.FixtureRequest) -> None:
    request.addfinalizer(pygame.mixer.quit)
    desk = sized((1280, 720), empty_world(gravity=(0, 0)))
    ball_of(desk)
    tap(desk, "m")
    desk.frames(SETTLED)
    click(desk, "More of graph 1")
    click(desk, "Listen")
    click(desk, "Listen: x")
    desk.frames(2)
    assert (desk.window.sounds.played, desk.window.sounds.failure) == (1, "")


def test_without_a_device_the_reason_is_said() -> None:
    desk = sized((1280, 720), empty_world(gravity=(0, 0)))
    desk.window.sounds.failure = "no device"
    ball_of(desk)
    tap(desk, "m")
    click(desk, "More of graph 1")
    click(desk, "Listen")
    click(desk, "Listen: x")
    desk.frames(2)
    assert desk.window.notice == "No sound: no device" and desk.window.sounds.played == 0
