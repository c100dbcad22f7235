"""Screens with more pixels to the inch: the window has them all, and is as large as on others."""

import os
import sys

import pytest

from physicslab.ecs.config import WindowConfig
from physicslab.view.canvas import display


@pytest.mark.parametrize("dpi", [96.0, 144.0, 192.0])
def test_a_window_is_as_many_pixels_larger_as_they_are_smaller(
    dpi: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("SDL_WINDOWS_DPI_AWARENESS", raising=False)
    monkeypatch.setattr(display, "_dpi", lambda: dpi)
    config = WindowConfig()
    with display.Display.open(config, "test") as opened:
        assert opened.density == dpi / 96.0
        assert opened.canvas.surface.get_size() == tuple(side * dpi / 96.0 for side in config.size)
        assert os.environ["SDL_WINDOWS_DPI_AWARENESS"] == "permonitorv2"


@pytest.mark.skipif(sys.platform == "win32", reason="it has what it says")
def test_elsewhere_than_on_windows_pixels_are_of_usual_size() -> None:
    assert display._dpi() == 96.0
