"""Plots of errors on logarithmic axes: against time and force evaluations, of contacts against the step."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from physicslab.lab.accuracy.contacts.study import ContactCurve, ContactRow, ContactStudy
from physicslab.lab.accuracy.measure import Row
from physicslab.lab.accuracy.study import Study
from physicslab.lab.accuracy.tables import order_text
from physicslab.lab.report import COLOURS, new_figure, png, prepare_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

type _Style = tuple[str, str, Any]
"""Colour, marker and line."""
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
_ENGINES: dict[str, _Style] = {
    "rigid": (COLOURS["green"], "D", "-"),
    "soft": (COLOURS["blue"], "o", "-"),
    "pymunk": (COLOURS["orange"], "s", "--"),
    "box2d": (COLOURS["purple"], "v", "--"),
    "box2d_v3": (COLOURS["vermilion"], "^", "-."),
}
_CHOSEN: dict[str, dict[str, Any]] = {
    "auto": {"marker": "o", "markersize": 15, "markerfacecolor": "none", "markeredgecolor": "#222222"},
    "rigid contacts": {"marker": "D", "markersize": 6, "color": "#222222"},
}
"""The marks of what the engine chooses, in the order of :attr:`Study.chosen`: the first goes round others."""
_LOWEST, _HIGHEST = 1e-17, 1e1
"""The value at which an error of zero is drawn, and the largest of contacts."""
_ROUNDING_COLOUR, _WORDS = "#f3ead9", "#444444"
_LIMIT: dict[str, Any] = {"color": _WORDS, "linewidth": 0.8, "linestyle": (0, (1, 2))}
_COLUMNS = 4

type _Work = Callable[[ContactRow], float]
_AXES: dict[str, tuple[str, _Work]] = {
    "step": ("step [s]", lambda row: row.dt),
    "cost": ("CPU time for a second [s]", lambda row: row.cpu_s_per_s),
}


def work_precision(*studies: Study) -> bytes:
    """Return a PNG with a row of two plots for each problem.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    figure = new_figure(11.0, 0.9 + 4.4 * len(studies))
    panels = figure.subplots(len(studies), 2, squeeze=False, sharey="row")
    styles = method_styles(studies)
    for study, (by_time, by_work) in zip(studies, panels, strict=True):
        _problem_panel(by_time, study, styles, "CPU time [ms]", lambda row: row.cpu_ms)
        _problem_panel(by_work, study, styles, "force evaluations", lambda row: float(row.force_evaluations))
        by_time.set_ylabel(f"{study.problem.measure}", fontsize=9)
        by_time.set_title(study.problem.name, loc="left", fontweight="bold")
        by_work.set_title(f"after {study.problem.seconds:.4g} s", loc="right", fontsize=10)
    handles: list[Line2D | Patch] = [_handle(name, style) for name, style in styles.items()]
    marks = itertools.islice(_CHOSEN.items(), max(len(study.chosen) for study in studies))
    handles += [Line2D([], [], linestyle="", label=label, **mark) for label, mark in marks]
    if any(study.floor for study in studies):
        handles.append(Patch(color=_ROUNDING_COLOUR, label="one rounding at the start"))
    figure.legend(handles=handles, loc="outside lower center", ncols=5, frameon=False, fontsize=9)
    return png(figure)


def method_styles(studies: Sequence[Study]) -> dict[str, _Style]:
    """Return the colour, marker and line of every method that is drawn, in the order of the legend."""
    drawn = {curve.method.name: None for study in studies for curve in study.curves if curve.rows}
    further = [name for name in drawn if name not in _STYLES]
    styles = _STYLES | dict(zip(further, itertools.cycle(_FURTHER), strict=False))
    return {name: style for name, style in styles.items() if name in drawn}


def case_plot(study: ContactStudy) -> bytes:
    """Return a PNG of one contact case: error against the step, and against run time.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    figure = new_figure(11.0, 5.2)
    panels = figure.subplots(1, 2, sharey=True)
    for axes, by in zip(panels, _AXES, strict=True):
        _contact_panel(axes, study, by, markersize=5)
        axes.set_xlabel(_AXES[by][0])
    panels[0].set_ylabel(study.case.measure, fontsize=9)
    panels[0].set_title(study.case.name, loc="left", fontweight="bold")
    panels[1].set_title(study.case.title, loc="right", fontsize=9)
    _orders(panels[0], study)
    figure.legend(handles=_handles([study]), loc="outside lower center", ncols=6, frameon=False, fontsize=9)
    return png(figure)


def overview(studies: Sequence[ContactStudy], by: str) -> bytes:
    """Return a PNG of several contact cases, a small plot each.

    Parameters
    ----------
    by : str
        ``"step"``, with the fitted orders, or ``"cost"``.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    rows = len(studies) // _COLUMNS + 1  # the legend has a place of its own behind the last plot
    figure = new_figure(11.0, 2.5 * rows + 0.4)
    grid = figure.subplots(rows, _COLUMNS, sharex=True, sharey=True, squeeze=False)
    panels = [axes for line in grid for axes in line]
    for axes, study in zip(panels, studies, strict=False):
        _contact_panel(axes, study, by, markersize=3.5)
        axes.set_title(study.case.name, loc="left", fontsize=9, fontweight="bold")
        axes.tick_params(labelsize=8, labelleft=True, labelbottom=True)
        if by == "step":
            _orders(axes, study)
    for axes in panels[len(studies) :]:
        axes.set_axis_off()
    figure.supxlabel(_AXES[by][0], fontsize=9)
    figure.supylabel("largest error [m], [rad]", fontsize=9)
    panels[len(studies)].legend(handles=_handles(studies), loc="upper left", frameon=False, fontsize=9)
    return png(figure)


def _problem_panel(
    axes: Axes, study: Study, styles: dict[str, _Style], label: str, work: Callable[[Row], float]
) -> None:
    """Draw a line for each method, marks for what the engine chooses, and both limits."""
    prepare_axes(axes, logarithmic=True)
    axes.set_xlabel(label)
    for curve in study.curves:
        if curve.rows:
            style, points = styles[curve.method.name], ((work(row), row.error) for row in curve.rows)
            _curve(axes, points, style, linewidth=1.4, markersize=9 if style[1] == "*" else 5)
    for row, mark in zip(study.chosen, _CHOSEN.values(), strict=False):
        if row.error is not None and work(row) > 0.0:
            axes.plot([work(row)], [max(row.error, _LOWEST)], linestyle="", **mark)
    for level, name in ((study.problem.excellent, "excellent"), (study.problem.good, "good")):
        axes.axhline(level, **_LIMIT)
        axes.annotate(
            name, (1.0, level), xycoords=("axes fraction", "data"), xytext=(-2, 2),
            textcoords="offset points", fontsize=8, color=_WORDS, ha="right", va="bottom",
        )  # fmt: skip
    if study.floor:
        axes.axhspan(_LOWEST, study.floor, color=_ROUNDING_COLOUR, zorder=0, linewidth=0)
    errors = [max(row.error, _LOWEST) for row in study.rows if row.error is not None]
    low = min([*errors, study.problem.excellent])
    high = max([*(error for error in errors if error < 1e2), study.problem.good])
    axes.set_ylim(0.3 * low, 5.0 * high)


def _contact_panel(axes: Axes, study: ContactStudy, by: str, *, markersize: float) -> None:
    """Draw a line for each engine, and what is wanted of rigid contacts."""
    prepare_axes(axes, logarithmic=True)
    work = _AXES[by][1]
    axes.axhline(study.case.wanted, **_LIMIT)
    for curve in study.curves:
        points = ((work(row), None if row.error is None else min(row.error, _HIGHEST)) for row in curve.rows)
        order = 3 if curve.method.own else 2
        look = {"linewidth": 1.3, "markersize": markersize, "clip_on": False, "zorder": order}
        _curve(axes, points, _ENGINES[curve.method.name], **look)
    axes.set_ylim(_LOWEST, _HIGHEST)
    axes.set_yticks([10.0**power for power in range(-16, 1, 4)])
    axes.minorticks_off()


def _curve(axes: Axes, points: Iterable[tuple[float, float | None]], style: _Style, **look: Any) -> None:
    """Draw a line through errors for some work; those that there are not are left out."""
    colour, marker, line = style
    shown = [(work, max(error, _LOWEST)) for work, error in points if error is not None and work > 0.0]
    if shown:
        axes.plot(*zip(*shown, strict=True), color=colour, marker=marker, linestyle=line, **look)


def _handle(name: str, style: _Style) -> Line2D:
    """Return an entry of a legend."""
    from matplotlib.lines import Line2D

    colour, marker, line = style
    return Line2D([], [], color=colour, marker=marker, linestyle=line, label=name, linewidth=1.4)


def _orders(axes: Axes, study: ContactStudy) -> None:
    """Write the fitted orders where no line is: between errors of rounding and those of steps."""
    drawn = [curve for curve in study.curves if curve.rows and curve.order is not None]
    look: dict[str, Any] = {"xycoords": "axes fraction", "fontsize": 8, "ha": "left", "va": "center"}
    for i, curve in enumerate(drawn):
        place, colour = (0.27 + 0.17 * i, 0.36), _ENGINES[curve.method.name][0]
        axes.annotate(order_text(curve), place, color=colour, fontweight="bold", **look)
    if drawn:
        axes.annotate("order", (0.03, 0.36), color=_WORDS, **look)


def _handles(studies: Sequence[ContactStudy]) -> list[Line2D]:
    from matplotlib.lines import Line2D

    drawn: dict[str, ContactCurve] = {
        curve.method.name: curve for study in studies for curve in study.curves if curve.rows
    }
    handles = [_handle(drawn[name].method.title, style) for name, style in _ENGINES.items() if name in drawn]
    return [*handles, Line2D([], [], label="wanted with rigid contacts", **_LIMIT)]
