"""Work-precision plots: error against time and against force evaluations, on logarithmic axes."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from physicslab.lab.accuracy.measure import Measurement
from physicslab.lab.accuracy.study import Curve, Study

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["work_precision"]

# Okabe and Ito's colours, which stay apart for the colour-blind: https://jfly.uni-koeln.de/color/
_STYLES: dict[str, tuple[str, str, Any]] = {
    "symplectic_euler": ("#999999", "v", ":"),
    "leapfrog": ("#0072B2", "o", "-"),
    "rk4": ("#E69F00", "s", "--"),
    "blanes_moan": ("#009E73", "D", "-"),
    "dop853": ("#D55E00", "^", "-."),
    "exact": ("#000000", "*", ""),
    "implicit_midpoint": ("#CC79A7", "X", (0, (1, 1))),
}
_LEAST = 1e-17
"""Where an error of zero is drawn."""


def work_precision(*studies: Study) -> bytes:
    """Return a PNG with a row of two plots for each problem.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 0.9 + 4.4 * len(studies)), layout="constrained", dpi=110)
    FigureCanvasAgg(figure)
    panels = figure.subplots(len(studies), 2, squeeze=False, sharey="row")
    for study, (by_time, by_work) in zip(studies, panels, strict=True):
        _panel(by_time, study, "CPU time [ms]", lambda found: 1e3 * found.cpu_s)
        _panel(by_work, study, "force evaluations", lambda found: float(found.evaluations))
        by_time.set_ylabel(f"{study.problem.measure}", fontsize=9)
        by_time.set_title(study.problem.name, loc="left", fontweight="bold")
        by_work.set_title(f"after {study.problem.seconds:.4g} s", loc="right", fontsize=10)
    _legend(figure, studies)
    image = io.BytesIO()
    figure.savefig(image, format="png")
    return image.getvalue()


def _panel(axes: Axes, study: Study, label: str, work: Callable[[Measurement], float]) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.set_xlabel(label)
    for spine in ("top", "right"):
        axes.spines[spine].set_visible(False)
    for curve in study.curves:
        _line(axes, curve, work)
    auto = study.auto.measurement
    if auto.error is not None and work(auto) > 0.0:
        axes.plot(
            [work(auto)], [max(auto.error, _LEAST)], marker="o", markersize=15, markerfacecolor="none",
            markeredgecolor="#222222", linestyle="",
        )  # fmt: skip
    for level, name in ((study.problem.excellent, "excellent"), (study.problem.good, "good")):
        axes.axhline(level, color="#444444", linewidth=0.8, linestyle=(0, (1, 2)))
        axes.annotate(
            name, (1.0, level), xycoords=("axes fraction", "data"), xytext=(-2, 2),
            textcoords="offset points", fontsize=8, color="#444444", ha="right", va="bottom",
        )  # fmt: skip
    if study.floor:
        axes.axhspan(_LEAST, study.floor, color="#f3ead9", zorder=0, linewidth=0)
    axes.set_ylim(*_range(study))


def _range(study: Study) -> tuple[float, float]:
    """Return what the axis of errors spans: every error up to ten times the scale of the problem."""
    rows = [row.measurement for curve in study.curves for row in curve.rows] + [study.auto.measurement]
    errors = [max(found.error, _LEAST) for found in rows if found.error is not None]
    low = min([*errors, study.problem.excellent])
    high = max([error for error in errors if error < 1e2] + [study.problem.good])
    return 0.3 * low, 5.0 * high


def _line(axes: Axes, curve: Curve, work: Callable[[Measurement], float]) -> None:
    points = [
        (work(row.measurement), max(row.measurement.error, _LEAST))
        for row in curve.rows
        if row.measurement.error is not None and work(row.measurement) > 0.0
    ]
    if points:
        colour, marker, line = _STYLES.get(curve.integrator.name, ("#56B4E9", "P", "-"))
        axes.plot(
            *zip(*points, strict=True), color=colour, marker=marker, linestyle=line, linewidth=1.4,
            markersize=9 if marker == "*" else 5,
        )  # fmt: skip


def _legend(figure: Figure, studies: tuple[Study, ...]) -> None:
    """Put the legend below the plots, where no line is."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles: list[Line2D | Patch] = []
    shown = {curve.integrator.name for study in studies for curve in study.curves if curve.rows}
    for name, (colour, marker, line) in _STYLES.items():
        if name in shown:
            handles.append(
                Line2D([], [], color=colour, marker=marker, linestyle=line, label=name, linewidth=1.4)
            )
    handles.append(
        Line2D([], [], marker="o", markersize=12, markerfacecolor="none", markeredgecolor="#222222",
               linestyle="", label="auto")
    )  # fmt: skip
    if any(study.floor for study in studies):
        handles.append(Patch(color="#f3ead9", label="one rounding at the start"))
    figure.legend(handles=handles, loc="outside lower center", ncols=5, frameon=False, fontsize=9)
