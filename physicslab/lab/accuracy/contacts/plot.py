"""Plots of contact cases: error against the step, and against run time, on logarithmic axes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from physicslab.lab.accuracy.contacts.study import ContactCurve, ContactRow, ContactStudy
from physicslab.lab.accuracy.contacts.tables import order_text
from physicslab.lab.plot import COLOURS, new_figure, png, prepare_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["case_plot", "overview"]

_STYLES: dict[str, tuple[str, str, Any]] = {
    "rigid": (COLOURS["green"], "D", "-"),
    "soft": (COLOURS["blue"], "o", "-"),
    "pymunk": (COLOURS["orange"], "s", "--"),
    "box2d": (COLOURS["purple"], "v", "--"),
    "box2d_v3": (COLOURS["vermilion"], "^", "-."),
}
_LOWEST, _HIGHEST = 1e-17, 1e1
"""What the axes of errors span; an error of zero, and one beyond them, is drawn at the end."""
_COLUMNS = 4
_WORDS = "#444444"

type _Work = Callable[[ContactRow], float]
_AXES: dict[str, tuple[str, _Work]] = {
    "step": ("step [s]", lambda row: row.dt),
    "cost": ("CPU time for a second [s]", lambda row: row.cpu_s_per_s),
}


def case_plot(study: ContactStudy) -> bytes:
    """Return a PNG of one case: error against the step, and against run time.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    figure = new_figure(11.0, 5.2)
    panels = figure.subplots(1, 2, sharey=True)
    for axes, by in zip(panels, _AXES, strict=True):
        _panel(axes, study, by, markersize=5)
        axes.set_xlabel(_AXES[by][0])
    panels[0].set_ylabel(study.case.measure, fontsize=9)
    panels[0].set_title(study.case.name, loc="left", fontweight="bold")
    panels[1].set_title(study.case.title, loc="right", fontsize=9)
    _orders(panels[0], study)
    figure.legend(handles=_handles([study]), loc="outside lower center", ncols=6, frameon=False, fontsize=9)
    return png(figure)


def overview(studies: Sequence[ContactStudy], by: str) -> bytes:
    """Return a PNG of several cases, a small plot each.

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
        _panel(axes, study, by, markersize=3.5)
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


def _panel(axes: Axes, study: ContactStudy, by: str, *, markersize: float) -> None:
    prepare_axes(axes, logarithmic=True)
    work = _AXES[by][1]
    axes.axhline(study.case.wanted, color=_WORDS, linewidth=0.8, linestyle=(0, (1, 2)))
    for curve in study.curves:
        points = [
            (work(row), min(max(row.error, _LOWEST), _HIGHEST))
            for row in curve.rows
            if row.error is not None and work(row) > 0.0
        ]
        if points:
            colour, marker, line = _STYLES[curve.engine.name]
            axes.plot(
                *zip(*points, strict=True), color=colour, marker=marker, linestyle=line, linewidth=1.3,
                markersize=markersize, clip_on=False, zorder=3 if curve.engine.own else 2,
            )  # fmt: skip
    axes.set_ylim(_LOWEST, _HIGHEST)
    axes.set_yticks([10.0**power for power in range(-16, 1, 4)])
    axes.minorticks_off()


def _orders(axes: Axes, study: ContactStudy) -> None:
    """Write the fitted orders where no line is: between errors of rounding and those of steps."""
    drawn = [curve for curve in study.curves if curve.rows and curve.order is not None]
    for i, curve in enumerate(drawn):
        axes.annotate(
            order_text(curve), (0.27 + 0.17 * i, 0.36), xycoords="axes fraction", fontsize=8,
            color=_STYLES[curve.engine.name][0], ha="left", va="center", fontweight="bold",
        )  # fmt: skip
    if drawn:
        axes.annotate(
            "order", (0.03, 0.36), xycoords="axes fraction", fontsize=8, color=_WORDS, ha="left", va="center"
        )


def _handles(studies: Sequence[ContactStudy]) -> list[Any]:
    from matplotlib.lines import Line2D

    drawn: dict[str, ContactCurve] = {
        curve.engine.name: curve for study in studies for curve in study.curves if curve.rows
    }
    handles = [
        Line2D(
            [], [], color=colour, marker=marker, linestyle=line, label=drawn[name].engine.title, linewidth=1.3
        )
        for name, (colour, marker, line) in _STYLES.items()
        if name in drawn
    ]
    wanted = Line2D(
        [], [], color=_WORDS, linestyle=(0, (1, 2)), linewidth=0.8, label="wanted with rigid contacts"
    )
    return [*handles, wanted]
