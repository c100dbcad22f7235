"""Curves fitted to samples: exact ones are found exactly, and errors are those of noise that is known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from desk import click, empty_world, sized, tap

from physicslab.components import Gate
from physicslab.diagnostics.fits import FITS, fit
from physicslab.prefabs import circle


def test_exact_curves_are_found() -> None:
    x = np.linspace(2.0, 6.0, 241)
    line = fit("line", x, 3.0 - 2.0 * x)
    assert line is not None and [one.value for one in line.parameters] == pytest.approx(
        [-2.0, 3.0], abs=1e-12
    )
    fall = fit("parabola", x, 5.0 + 1.5 * x - 4.905 * x**2)
    assert fall is not None
    assert [one.value for one in fall.parameters] == pytest.approx([-9.81, 1.5, 5.0], rel=1e-10)
    wave = fit("sine", x, 0.2 + 0.7 * np.sin(2.0 * math.pi * x / 1.37 + 0.4))
    assert wave is not None
    assert [one.value for one in wave.parameters] == pytest.approx([0.7, 1.37, 0.2], rel=1e-9)
    assert np.allclose(wave.curve(x), 0.2 + 0.7 * np.sin(2.0 * math.pi * x / 1.37 + 0.4), atol=1e-9)
    assert all(one.rest < 1e-9 for one in (line, fall, wave))


@pytest.mark.parametrize("kind", FITS)
def test_errors_are_those_by_which_fits_to_noise_are_wrong(kind: str) -> None:
    random, x = np.random.default_rng(7), np.linspace(0.0, 5.0, 200)
    true = {
        "line": (2.0 * x - 1.0, (2.0, -1.0)),
        "parabola": (3.0 * x**2 + 2.0 * x - 1.0, (6.0, 2.0, -1.0)),
        "sine": (0.5 + 2.0 * np.cos(3.0 * x + 0.3), (2.0, 2.0 * math.pi / 3.0, 0.5)),
    }[kind]
    wrong = []
    for _ in range(60):
        found = fit(kind, x, true[0] + 0.05 * random.standard_normal(len(x)))
        assert found is not None and found.rest == pytest.approx(0.05, rel=0.25)
        wrong.append(
            [(one.value - value) / one.error for one, value in zip(found.parameters, true[1], strict=True)]
        )
    assert np.sqrt(np.mean(np.square(wrong), axis=0)) == pytest.approx(1.0, abs=0.3)


@pytest.mark.parametrize("kind", FITS)
def test_what_cannot_be_fitted_has_none(kind: str) -> None:
    few, nothing = np.array([0.0, 1.0]), np.full(50, np.nan)
    assert fit(kind, few, few) is None and fit(kind, np.arange(50.0), nothing) is None
    assert fit(kind, np.ones(50), np.arange(50.0)) is None
    flat = fit(kind, np.arange(50.0), np.full(50, 3.0))
    assert flat is None if kind == "sine" else flat is not None and flat.rest < 1e-9


def test_a_graph_fits_what_lies_between_its_cursors() -> None:
    world = empty_world()
    ball = circle(world, (0.0, 0.0), velocity=(1.0, 2.0))
    desk = sized((1280, 800), world)
    desk.window.selection.take(ball)
    tap(desk, "m")
    desk.frames(60)
    desk.window.pace.paused = True
    for kind, found in (("parabola", "second derivative"), ("line", "slope at 0"), ("sine", "amplitude")):
        click(desk, "More of graph 1")
        click(desk, f"Fit a {kind}")
        desk.frames(4)
        told = [words for words in desk.ui.words if found in words]
        assert len(told) == 3
        if kind == "parabola":
            assert "second derivative -9.810 m/s², slope at 0 2.000 m/s" in told[1]
    desk.window.dashboard.marks[:] = [0.2, 0.3]
    desk.frames(4)
    assert any("no such curve fits" in words or "amplitude" in words for words in desk.ui.words)
    click(desk, "More of graph 1")
    click(desk, "No fit")
    desk.frames(4)
    assert not any("amplitude" in words for words in desk.ui.words)


def test_a_graph_shows_the_time_from_gate_to_gate() -> None:
    world = empty_world(gravity_mode="none")
    ball = circle(world, (-1.0, 0.0), radius=0.2, velocity=(2.0, 0.0))
    for x in (-0.5, 0.5):
        world.spawn(Gate((x, -1.0), (x, 1.0)))
    desk = sized((1280, 800), world)
    desk.window.selection.take(ball)
    tap(desk, "m")
    desk.frames(70)
    desk.window.pace.paused = True
    click(desk, "More of graph 1")
    click(desk, "From gate to gate")
    desk.frames(4)
    assert desk.window.dashboard.marks == pytest.approx([0.25, 0.75])
    (span,) = desk.window.dashboard.fitting.spans.values()
    assert span == pytest.approx((0.25, 0.75))
