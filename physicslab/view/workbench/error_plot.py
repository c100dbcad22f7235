"""The plot of error against run time, in a window of its own."""

from __future__ import annotations

import numpy as np
from imgui_bundle import ImVec2, imgui, implot

from physicslab.view.panels.error_study import ErrorStudy
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window

__all__ = ["build_error_plot"]

_FLOOR = 1e-17
"""Errors below this are drawn at it [m]: zero has no place on a logarithmic scale."""
_SHARE = (0.62, 0.6)
"""How much of the window the plot takes."""


def build_error_plot(ui: Ui, window: Window) -> None:
    """Build a mark for each run, methods joined by lines: fast to the left, right below."""
    study = window.error_study
    with ui.floating("Error against run time", window.middle, docks=True) as stays:
        width, height = (share * px for share, px in zip(_SHARE, window.canvas.size, strict=True))
        imgui.push_text_wrap_pos(width)
        ui.faint(f"{study.remark}. Each mark is one run: left is fast, low is right.", wrapped=False)
        imgui.pop_text_wrap_pos()
        if implot.begin_plot(
            "##error", ImVec2(width, height), implot.Flags_.no_title | implot.Flags_.no_menus
        ):
            implot.setup_axes(
                "time of the processor [ms]",
                "error [m]",
                implot.AxisFlags_.auto_fit,
                implot.AxisFlags_.auto_fit,
            )
            implot.setup_axis_scale(implot.ImAxis_.x1, implot.Scale_.log10)
            implot.setup_axis_scale(implot.ImAxis_.y1, implot.Scale_.log10)
            for n, (name, costs, errors) in enumerate(_series(study)):
                spec = implot.Spec()
                spec.marker, spec.marker_size = n % implot.Marker_.count, 5.0
                implot.plot_line(name, costs, errors, spec)
                ui.words.append(name)
            implot.end_plot()
        if ui.button("Close"):
            study.shown = False
    if not stays[0]:
        study.shown = False


def _series(study: ErrorStudy) -> list[tuple[str, np.ndarray, np.ndarray]]:
    """Return the runs of each method, the fastest first: name, times [ms], errors [m]."""
    names = list(dict.fromkeys(sample.integrator for sample in study.samples))
    found = []
    for name in names:
        runs = sorted((s.cpu_ms, max(s.error, _FLOOR)) for s in study.samples if s.integrator == name)
        costs, errors = np.array(runs, np.float64).T.copy()
        found.append((name, np.ascontiguousarray(costs), np.ascontiguousarray(errors)))
    return found
