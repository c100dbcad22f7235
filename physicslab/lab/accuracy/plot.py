"""Work-precision plots: error against time and against force evaluations, on logarithmic axes."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from physicslab.lab.accuracy.measure import Measurement
from physicslab.lab.accuracy.study import Curve, Study
from physicslab.lab.plot import COLOURS, new_figure, png, prepare_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["method_styles", "work_precision"]

type _Style = tuple[str, str, Any]
_STYLES: dict[str, _Style] = {
    "symplectic_euler": (COLOURS["grey"], "v", ":"),
    "leapfrog": (COLOURS["blue"], "o", "-"),
    "rk4": (COLOURS["orange"], "s", "--"),
    "blanes_moan": (COLOURS["green"], "D", "-"),
    "dop853": (COLOURS["vermilion"], "^", "-."),
    "exact": (COLOURS["black"], "*", ""),
    "implicit_midpoint": (COLOURS["purple"], "X", (0, (1, 1))),
}
_FURTHER = [(COLOURS["sky"], marker, line) for line in ("-", "--") for marker in "Ph<>dp8"]
"""The styles of methods that have none of their own above."""
_CHOSEN: dict[str, dict[str, Any]] = {
    "auto": {"marker": "o", "markersize": 15, "markerfacecolor": "none", "markeredgecolor": "#222222"},
    "rigid contacts": {"marker": "D", "markersize": 6, "color": "#222222"},
}
"""The marks of what the engine chooses, in the order of :attr:`Study.chosen`: the first goes round others."""
_ERROR_FLOOR = 1e-17
"""Where an error of zero is drawn."""
_ROUNDING_COLOUR = "#f3ead9"


def work_precision(*studies: Study) -> bytes:
    """Return a PNG with a row of two plots for each problem.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    figure = new_figure(11.0, 0.9 + 4.4 * len(studies))
    panels = figure.subplots(len(studies), 2, squeeze=False, sharey="row")
    styles = method_styles(studies)
    for study, (by_time, by_work) in zip(studies, panels, strict=True):
        _panel(by_time, study, styles, "CPU time [ms]", lambda found: 1e3 * found.cpu_s)
        _panel(by_work, study, styles, "force evaluations", lambda found: float(found.evaluations))
        by_time.set_ylabel(f"{study.problem.measure}", fontsize=9)
        by_time.set_title(study.problem.name, loc="left", fontweight="bold")
        by_work.set_title(f"after {study.problem.seconds:.4g} s", loc="right", fontsize=10)
    rigid = any(study.rigid is not None for study in studies)
    _legend(figure, styles, floor=any(study.floor for study in studies), rigid=rigid)
    return png(figure)


def method_styles(studies: Sequence[Study]) -> dict[str, _Style]:
    """Return the colour, marker and line of every method that is drawn, in the order of the legend."""
    drawn = {curve.integrator.name: None for study in studies for curve in study.curves if curve.rows}
    further = [name for name in drawn if name not in _STYLES]
    styles = _STYLES | dict(zip(further, itertools.cycle(_FURTHER), strict=False))
    return {name: style for name, style in styles.items() if name in drawn}


def _panel(
    axes: Axes, study: Study, styles: dict[str, _Style], label: str, work: Callable[[Measurement], float]
) -> None:
    prepare_axes(axes, logarithmic=True)
    axes.set_xlabel(label)
    for curve in study.curves:
        if curve.rows:
            _line(axes, curve, styles[curve.integrator.name], work)
    for row, mark in zip(study.chosen, _CHOSEN.values(), strict=False):
        found = row.measurement
        if found.error is not None and work(found) > 0.0:
            axes.plot([work(found)], [max(found.error, _ERROR_FLOOR)], linestyle="", **mark)
    for level, name in ((study.problem.excellent, "excellent"), (study.problem.good, "good")):
        axes.axhline(level, color="#444444", linewidth=0.8, linestyle=(0, (1, 2)))
        axes.annotate(
            name, (1.0, level), xycoords=("axes fraction", "data"), xytext=(-2, 2),
            textcoords="offset points", fontsize=8, color="#444444", ha="right", va="bottom",
        )  # fmt: skip
    if study.floor:
        axes.axhspan(_ERROR_FLOOR, study.floor, color=_ROUNDING_COLOUR, zorder=0, linewidth=0)
    axes.set_ylim(*_range(study))


def _range(study: Study) -> tuple[float, float]:
    """Return what the axis of errors spans: every error below 100, and both limits."""
    chosen = [row.measurement for row in study.chosen]
    rows = [row.measurement for curve in study.curves for row in curve.rows] + chosen
    errors = [max(found.error, _ERROR_FLOOR) for found in rows if found.error is not None]
    low = min([*errors, study.problem.excellent])
    high = max([error for error in errors if error < 1e2] + [study.problem.good])
    return 0.3 * low, 5.0 * high


def _line(axes: Axes, curve: Curve, style: _Style, work: Callable[[Measurement], float]) -> None:
    points = [
        (work(row.measurement), max(row.measurement.error, _ERROR_FLOOR))
        for row in curve.rows
        if row.measurement.error is not None and work(row.measurement) > 0.0
    ]
    if points:
        colour, marker, line = style
        axes.plot(
            *zip(*points, strict=True), color=colour, marker=marker, linestyle=line, linewidth=1.4,
            markersize=9 if marker == "*" else 5,
        )  # fmt: skip


def _legend(figure: Figure, styles: dict[str, _Style], *, floor: bool, rigid: bool) -> None:
    """Put the legend below the plots, where no line is."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles: list[Line2D | Patch] = [
        Line2D([], [], color=colour, marker=marker, linestyle=line, label=name, linewidth=1.4)
        for name, (colour, marker, line) in styles.items()
    ]
    for label, mark in list(_CHOSEN.items())[: 2 if rigid else 1]:
        handles.append(Line2D([], [], linestyle="", label=label, **mark))
    if floor:
        handles.append(Patch(color=_ROUNDING_COLOUR, label="one rounding at the start"))
    figure.legend(handles=handles, loc="outside lower center", ncols=5, frameon=False, fontsize=9)
