"""Error against run time: how far measuring has come, then a plot, and a table to choose a method from."""

import math
from functools import partial

import numpy as np
from imgui_bundle import ImVec2, imgui, implot
from numpy.typing import NDArray

from physicslab.history import SetSimulation
from physicslab.view.canvas.quantities import round_quantity
from physicslab.view.controls import file_actions, saving
from physicslab.view.toolkit.axes import finish_axes, plot_rect
from physicslab.view.toolkit.style import as_vector
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.lab_process import ErrorStudy, Sample
from physicslab.view.window.window import Window
from physicslab.world import World

_TITLE = "Error against run time"
_FLOOR = 1e-17
"""Errors below this are drawn at it [m]: zero has no place on a logarithmic scale."""
_TABLE = 25.0
"""Width of the table, in heights of the text."""
_PLOT = (22.0, 60.0)
"""The least width of a plot beside it, and the largest, in heights of the text."""
_HEIGHT = 26.0
"""The largest height of both, in heights of the text."""
_WORDS = 12.0
"""Height of all that is above and below them, in heights of the text."""
_LEAST = 10.0
"""The least height of a plot, and of the table below it, in heights of the text: the window is scrolled."""
_LEGEND = 16.0
"""The height in heights of the text from which on a plot has room for a legend."""
_NEAR = 0.7
"""How near to a mark the cursor must be to point at it, in heights of the text."""
_ROOM = 2.0
"""By what factor axes go beyond the marks."""


def build_error_plot(ui: Ui, window: Window) -> None:
    """Build how far it is while the scene is measured, and what was found after that."""
    if window.error_study.running:
        _build_progress(ui, window)
    elif window.error_study.shown:
        _build_result(ui, window)


def _build_progress(ui: Ui, window: Window) -> None:
    study, (left, top, width, _) = window.error_study, window.framing.room()
    place, stop = (left + 0.5 * width, top + 4.0 * ui.size), partial(window.do_next, file_actions.study_error)
    with ui.floating("Measuring the error", place, stop):
        ui.bar("Measuring this scene with every method", study.progress, study.share, ui.theme.accent)
        ui.button("Stop", "Give up measuring (F5)", file_actions.study_error)


def _build_result(ui: Ui, window: Window) -> None:
    study, size, (width, height) = window.error_study, ui.size, window.canvas.size
    room = 0.9 * window.framing.room()[2]
    beside = room >= (_TABLE + _PLOT[0]) * size
    wide = (_TABLE + _PLOT[1]) * size
    wide = min(room, wide) if beside else min(max(room, _TABLE * size), 0.9 * width)
    high = min(0.9 * height - _WORDS * size, _HEIGHT * size)
    least = _LEAST * size
    is_low = not beside and high < 2.0 * least
    with ui.floating(_TITLE, window.framing.middle, window.closing_of("error_study.shown")):
        if not is_low:
            _build_words(ui, study, wide)
        plot = (wide - _TABLE * size, high) if beside else (wide, max(0.55 * high, least))
        _build_plot(ui, study, window, plot)
        if beside:
            imgui.same_line()
        if is_low:  # what is not in sight is scrolled to
            _build_buttons(ui, study)
            _build_words(ui, study, wide)
        _build_table(ui, study, window, (_TABLE * size, high) if beside else (wide, max(0.45 * high, least)))
        if not is_low:
            _build_buttons(ui, study)


def _build_buttons(ui: Ui, study: ErrorStudy) -> None:
    if ui.button("Close"):
        study.shown = False
    imgui.same_line()
    save, tip = saving.save_table, "Write the table to a file"
    ui.button("CSV of all runs", tip, save, "errors", study.rows, shown="CSV")


def _build_words(ui: Ui, study: ErrorStudy, wide: float) -> None:
    with ui.wrapping(wide):
        ui.faint(
            f"How far bodies are off after {study.seconds:g} s: each mark is one run, left is fast, low "
            f"is right. Compared with {study.reference}; there is no known answer. A click on a mark, or "
            "on a name in the table, runs the scene by it.",
            wrapped=False,
        )
        if study.chaotic:
            ui.text(_chaos(study), ui.theme.paused)


def _chaos(study: ErrorStudy) -> str:
    """Return why a chaotic scene has no error, and until when it has one."""
    moved = round_quantity(study.rounding, "m")
    words = ["This scene is chaotic."]
    if study.horizon is not None:
        words.append(
            f"It has no error but a horizon, {study.horizon:.3g} s from the start. Until then every error "
            "grows, that of one rounding too, which no method avoids; after it any run is one of many "
            "possible futures: energy, momentum and averages hold, places do not."
        )
    if study.rounding_shows:
        words.append(
            f"One rounding at the start moves a body by {moved} in {study.seconds:g} s. No method can be "
            "right about places below that line, whichever is lower here."
        )
    return " ".join(words)


def _build_plot(ui: Ui, study: ErrorStudy, window: Window, size: tuple[float, float]) -> None:
    flags = implot.Flags_.no_title | implot.Flags_.no_menus
    if size[1] < _LEGEND * ui.size:
        flags |= implot.Flags_.no_legend
    if not implot.begin_plot("##error", ImVec2(*size), flags):
        return
    series = _series(study)
    implot.setup_axes(ui.written("processor time [ms]"), ui.written("largest error [m]"))
    implot.setup_axis_scale(implot.ImAxis_.x1, implot.Scale_.log10)
    implot.setup_axis_scale(implot.ImAxis_.y1, implot.Scale_.log10)
    costs = np.concatenate([line[1] for line in series])
    errors = np.concatenate([line[2] for line in series])
    implot.setup_axes_limits(*_limits(costs), *_limits(errors))
    implot.setup_legend(_emptiest_corner(np.log(costs), np.log(errors)))
    ui.words += finish_axes(ui.language)
    for n, (name, times, distances) in enumerate(series):
        spec = implot.Spec()
        spec.marker, spec.marker_size = n % implot.Marker_.count, 5.0
        spec.line_color = spec.marker_fill_color = spec.marker_line_color = as_vector(
            ui.theme.bodies[n % len(ui.theme.bodies)]
        )
        implot.plot_line(ui.written(name), times, distances, spec)
    if study.rounding > 0.0:
        spec = implot.Spec()
        spec.flags, spec.line_color = implot.InfLinesFlags_.horizontal, as_vector(ui.theme.faint)
        implot.plot_inf_lines(ui.said("one rounding at the start"), np.array([study.rounding]), spec)
    _build_marks(ui, study, window)
    ui.places["Plot of errors"] = plot_rect()
    implot.end_plot()


def _build_marks(ui: Ui, study: ErrorStudy, window: Window) -> None:
    """Let the mark at the cursor show what it stands for, and a click choose its method and step."""
    reach, cursor = _NEAR * ui.size, imgui.get_mouse_pos()
    nearest, least = None, reach
    for n, run in enumerate(sorted(study.samples, key=lambda run: run.cpu_ms)):
        mark = implot.plot_to_pixels(run.cpu_ms, max(run.error, _FLOOR))
        ui.places[f"{run.name} {n + 1}"] = (
            round(mark.x - reach), round(mark.y - reach), round(2 * reach), round(2 * reach)
        )  # fmt: skip
        distance = math.hypot(mark.x - cursor.x, mark.y - cursor.y)
        if distance < least:
            nearest, least = run, distance
    if nearest is None or not implot.is_plot_hovered():
        return
    words = f"A click runs this scene by {nearest.name} {nearest.step}"
    ui.words.append(words)
    imgui.set_tooltip(words)
    if imgui.is_mouse_clicked(imgui.MouseButton_.left):
        window.do_next(_use, nearest)


def _build_table(ui: Ui, study: ErrorStudy, window: Window, size: tuple[float, float]) -> None:
    """Build a row for each run, the fastest first; a click chooses its method and step for this scene."""
    flags = imgui.TableFlags_
    if not imgui.begin_table(
        "runs", 4, flags.scroll_y | flags.row_bg | flags.sizing_fixed_fit, ImVec2(*size)
    ):
        return
    imgui.table_setup_scroll_freeze(0, 1)
    for head in ("Method", "Step", "Time", "Error"):
        imgui.table_setup_column(head)
    imgui.table_headers_row()
    for n, run in enumerate(sorted(study.samples, key=lambda run: run.cpu_ms)):
        imgui.table_next_row()
        imgui.table_next_column()
        ui.button(f"Use run {n + 1}", "Run this scene by it from here on", _use, run, shown=run.name)
        for words in (run.step, f"{run.cpu_ms:.3g} ms", run.words):
            imgui.table_next_column()
            ui.text(words)
    imgui.end_table()


def _use(world: World, window: Window, run: Sample) -> None:
    """Choose the settings of a run."""
    window.edits.do(SetSimulation(run.settings))
    step = f", {run.step}" if run.step else ""
    window.notify(f"This scene is run by {run.name}{step} from here on")


def _limits(values: NDArray[np.float64]) -> tuple[float, float]:
    """Return the ends of a logarithmic axis that has room for all of these, one power of ten at least.

    >>> [float(end) for end in _limits(np.array([1.0, 100.0]))]
    [0.5, 200.0]
    """
    low, high = float(values.min()) / _ROOM, float(values.max()) * _ROOM
    missing = max(10.0 * low / high, 1.0) ** 0.5
    return low / missing, high * missing


def _emptiest_corner(x: NDArray[np.float64], y: NDArray[np.float64]) -> int:
    """Return the corner of a plot with the fewest marks, of equals the one at the upper right."""
    right, top = x > 0.5 * (x.min() + x.max()), y > 0.5 * (y.min() + y.max())
    place = implot.Location_
    corners = {
        place.north_east: right & top, place.north_west: ~right & top,
        place.south_west: ~right & ~top, place.south_east: right & ~top,
    }  # fmt: skip
    return min(corners, key=lambda corner: int(corners[corner].sum()))


def _series(study: ErrorStudy) -> list[tuple[str, NDArray[np.float64], NDArray[np.float64]]]:
    """Return the runs of each method, the fastest first: name, times [ms], errors [m].

    Those of which it is known only that the error is at most so large are apart.
    """
    found = []
    for name, at_most in dict.fromkeys((sample.name, sample.at_most) for sample in study.samples):
        runs = sorted(
            (s.cpu_ms, max(s.error, _FLOOR)) for s in study.samples if s.name == name and s.at_most == at_most
        )
        costs, errors = np.array(runs, np.float64).T.copy()
        shown = f"{name}, at most" if at_most else name
        found.append((shown, np.ascontiguousarray(costs), np.ascontiguousarray(errors)))
    return found
