"""Lines as they are plotted: no more points than can be seen; slopes, areas and records."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from physicslab.view.window import record as record_module
from physicslab.view.window.record import (
    Record,
    area_between,
    line_to_show,
    path_to_show,
    range_to_show,
    slope_between,
    unbroken,
)  # fmt: skip

VALUES = st.floats(-1e6, 1e6)
GAPPY = st.one_of(VALUES, st.just(float("nan")))


def rising(n: int, seed: int) -> np.ndarray:
    return np.cumsum(np.random.default_rng(seed).uniform(1e-3, 1.0, n))


@settings(deadline=None)
@given(
    st.integers(2, 3000),
    st.integers(0, 99),
    st.integers(1, 60),
    st.floats(0.0, 1.0),
    st.floats(0.0, 1.0),
    st.data(),
)
def test_each_pixel_keeps_its_first_lowest_highest_and_last_point(
    n: int, seed: int, width: int, begin: float, end: float, data: st.DataObject
) -> None:
    x = rising(n, seed)
    y = data.draw(arrays(np.float64, n, elements=GAPPY)) if n < 300 else np.sin(x) + 0.1 * np.cos(31.0 * x)
    low, high = sorted((x[0] + begin * (x[-1] - x[0]), x[0] + end * (x[-1] - x[0])))
    shown_x, shown_y = line_to_show(x, y, low, high, width)
    assert (np.diff(shown_x) > 0).all() and set(shown_x.tolist()) <= set(x.tolist())
    if not high > low:
        return
    seen = (x >= low) & (x <= high)
    pixel, shown_pixel = (np.floor((one - low) * (width / (high - low))) for one in (x, shown_x))
    for one in np.unique(pixel[seen]):
        own, shown = (
            y[(pixel == one) & seen],
            shown_y[(shown_pixel == one) & (shown_x >= low) & (shown_x <= high)],
        )
        assert np.isnan(own).any() == np.isnan(shown).any()  # a gap stays one
        if not np.isnan(own).all():
            assert np.nanmin(shown) == np.nanmin(own) and np.nanmax(shown) == np.nanmax(own)
        assert np.array_equal(shown[[0, -1]], own[[0, -1]], equal_nan=True)


def test_a_long_line_has_no_more_points_than_a_plot_can_show() -> None:
    x = np.linspace(0.0, 600.0, 36_000)
    shown_x, shown_y = line_to_show(x, np.sin(40.0 * x), 0.0, 600.0, 300)
    assert len(shown_x) <= 4 * 302
    assert shown_y.max() > 0.999 and shown_y.min() < -0.999
    closer, _ = line_to_show(x, np.sin(40.0 * x), 100.0, 101.0, 300)
    assert len(closer) <= 70 and closer[0] <= 100.0 and closer[-1] >= 101.0


def test_a_path_that_stays_in_a_pixel_is_two_points_there() -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 30_000)
    x, y = path_to_show(np.cos(angle), np.sin(angle), (-1.0, -1.0), (1.0, 1.0), (200, 200))
    assert len(x) < 4_000
    every = {
        (int(a), int(b)) for a, b in zip((np.cos(angle) + 1) * 100, (np.sin(angle) + 1) * 100, strict=True)
    }
    kept = {(int(a), int(b)) for a, b in zip((x + 1) * 100, (y + 1) * 100, strict=True)}
    assert kept == every


@given(st.integers(2, 200), st.integers(0, 99), VALUES, VALUES, st.data())
def test_slope_and_area_of_a_straight_line_are_its_own(
    n: int, seed: int, slope: float, start: float, data: st.DataObject
) -> None:
    x = rising(n, seed)
    y = start + slope * x
    a, b = data.draw(st.integers(0, n - 1)), data.draw(st.integers(0, n - 1))
    if a == b:
        assert np.isnan(slope_between(x, y, a, b)) and area_between(x, y, a, b) == 0.0
        return
    scale = 1e-9 * (abs(start) + abs(slope) * x[-1]) / abs(x[b] - x[a])
    assert slope_between(x, y, a, b) == pytest.approx(slope, rel=1e-9, abs=scale)
    exact = start * (x[b] - x[a]) + 0.5 * slope * (x[b] ** 2 - x[a] ** 2)
    assert area_between(x, y, a, b) == pytest.approx(
        exact, rel=1e-9, abs=1e-9 * (1.0 + np.abs(y).max() * x[-1])
    )


@given(st.integers(2, 200), st.integers(0, 99), st.data())
def test_the_area_of_any_line_is_the_sum_of_trapezia(n: int, seed: int, data: st.DataObject) -> None:
    x, y = rising(n, seed), data.draw(arrays(np.float64, n, elements=VALUES))
    a = data.draw(st.integers(0, n - 2))
    b = data.draw(st.integers(a + 1, n - 1))
    expected = np.sum(0.5 * (y[a + 1 : b + 1] + y[a:b]) * np.diff(x[a : b + 1]))
    least = np.nextafter(0.0, 1.0)  # two products of a trapezium, both sides: each may be half of it off
    scale = 1e-12 * np.sum(np.abs(y)) * x[-1] + 2 * (b - a) * least
    assert area_between(x, y, a, b) == pytest.approx(expected, rel=1e-12, abs=scale)
    assert area_between(x, y, b, a) == -area_between(x, y, a, b)
    assert slope_between(x, y, b, a) == slope_between(x, y, a, b) == (y[b] - y[a]) / (x[b] - x[a])


def test_an_area_over_a_gap_is_not_defined() -> None:
    x, y = np.arange(4.0), np.array([0.0, np.nan, 1.0, 2.0])
    assert np.isnan(area_between(x, y, 0, 3)) and area_between(x, y, 2, 3) == 1.5
    assert slope_between(x, y, 0, 3) == pytest.approx(2.0 / 3.0)


def test_rounding_is_not_shown_as_a_change() -> None:
    low, high = range_to_show([np.array([12.0, 12.0 + 1e-13])])
    assert low < 11.0 and high > 13.0
    assert range_to_show([np.zeros(3)]) == (-1.0, 1.0) and range_to_show([]) == (0.0, 1.0)
    assert range_to_show([np.array([0.0, 1e-23])], none=1e-13) == (1e-23 - 1.0, 1e-23 + 1.0), "a body at rest"
    low, high = range_to_show([np.array([np.nan, 2.0]), np.array([4.0])])
    assert low < 2.0 and high > 4.0


def test_parts_of_a_line_without_gaps() -> None:
    assert unbroken(np.array([np.nan])) == [] and unbroken(np.ones(3)) == [slice(0, 3)]


# What is recorded


def test_a_record_forgets_what_comes_later_than_a_new_moment() -> None:
    record = Record()
    for n in range(10):
        record.add(0.1 * n, n, {(1, "x"): float(n)})
    record.add(0.35, 3, {(1, "x"): 99.0})
    assert np.allclose(record.times, [0.0, 0.1, 0.2, 0.3, 0.35])
    assert record.values((1, "x")).tolist() == [0.0, 1.0, 2.0, 3.0, 99.0] and record.steps[-1] == 3


def test_what_was_not_shown_is_a_gap() -> None:
    record = Record()
    record.add(0.0, 0, {(1, "x"): 1.0})
    record.add(1.0, 1, {(1, "y"): 2.0})
    record.add(2.0, 2, {(1, "x"): 3.0, (1, "y"): float("inf")})
    assert np.array_equal(record.values((1, "x")), [1.0, np.nan, 3.0], equal_nan=True)
    assert np.array_equal(record.values((1, "y")), [np.nan, 2.0, np.nan], equal_nan=True)
    assert np.isnan(record.values((7, "x"))).all()
    assert record.nearest(0.6) == 1 and record.nearest(-5.0) == 0 and record.nearest(9.0) == 2


def test_of_a_long_record_the_older_half_is_thinned(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(record_module, "CAPACITY", 1000)
    record = Record()
    for n in range(2001):
        record.add(float(n), n, {(1, "x"): 2.0 * n})
    assert len(record) <= 1000 and record.times[-1] == 2000.0 and record.times[0] == 0.0
    assert np.array_equal(record.values((1, "x")), 2.0 * record.times)
    assert np.array_equal(record.steps, record.times) and (np.diff(record.times) > 0).all()


def test_bodies_of_a_record_get_the_numbers_of_another_world() -> None:
    record = Record()
    record.add(0.0, 0, {(1, "x"): 1.0, (2, "x"): 2.0, (None, "total energy"): 3.0})
    renamed = record.renamed({1: 5})
    assert renamed.values((5, "x")).tolist() == [1.0]
    assert renamed.values((None, "total energy")).tolist() == [3.0]
    assert np.isnan(renamed.values((2, "x"))).all() and np.isnan(renamed.values((1, "x"))).all()
