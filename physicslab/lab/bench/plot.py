"""The benchmark's plot: cost against the number of bodies, and how many times longer others take."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from physicslab.lab.bench.engine import OURS
from physicslab.lab.bench.result import EngineResult
from physicslab.lab.bench.tables import BenchReport
from physicslab.lab.report import COLOURS, new_figure, png, prepare_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_COLOURS = {
    OURS: COLOURS["blue"], "pymunk": COLOURS["vermilion"], "Box2D 2.3": COLOURS["green"],
    "Box2D 3": COLOURS["purple"], "Box2D 3 C": COLOURS["orange"], "Box2D 3 C AVX2": COLOURS["orange"],
}  # fmt: skip
_STYLES = {"piles": ("o", "-"), "gases": ("s", "--"), "funnels": ("^", ":")}
_FRAME_MS = 1e3 / 60.0
"""A frame of 60 Hz."""


def bench_picture(report: BenchReport) -> bytes:
    """Return a PNG: growth to the left, ratios to the right.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    bars = _bars(report)
    figure = new_figure(13.0, max(5.0, 1.5 + 0.24 * len(bars)))
    if bars:
        left, right = figure.subplots(1, 2)
        _ratios(right, bars)
    else:  # alone there is nothing to compare with
        left = figure.subplots()
    _growth(left, report)
    return png(figure)


def _growth(axes: Axes, report: BenchReport) -> None:
    """Draw what a step costs for so many bodies, and what a frame of 60 Hz has."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    plain = FuncFormatter(lambda value, _: f"{value:,.6g}")
    prepare_axes(axes, logarithmic=True)
    axes.set_title("cost of a step, settled, ms of CPU time (median)", loc="left", fontsize=10)
    axes.set_xlabel("bodies")
    for growth in report.growths:
        marker, line = _STYLES[growth.group]
        label = f"{growth.engine}, {growth.group}: N^{growth.exponent:.2f}"
        axes.plot(growth.sizes, growth.ms, marker=marker, linestyle=line, label=label,
                  color=_COLOURS[growth.engine], linewidth=1.4, markersize=5)  # fmt: skip
    if report.growths:
        axes.axhline(_FRAME_MS, color="#888888", linewidth=0.8, linestyle=":")
        axes.annotate(
            "a frame of 60 Hz", (0.01, _FRAME_MS), xycoords=("axes fraction", "data"), xytext=(0, 3),
            textcoords="offset points", fontsize=7, color="#666666",
        )  # fmt: skip
        axes.set_xticks(sorted({size for growth in report.growths for size in growth.sizes}))
        axes.xaxis.set_minor_locator(NullLocator())
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_minor_locator(NullLocator())
        axes.xaxis.set_major_formatter(plain)
        axes.yaxis.set_major_formatter(plain)
        axes.legend(frameon=False, fontsize=8, loc="lower right")


def _bars(report: BenchReport) -> list[tuple[str, list[EngineResult]]]:
    """Return each scene that others ran, with their results; the last first, because y points up."""
    found = [
        (
            result.scene.name,
            [other for other in result.engines.values() if other.times_ours and other.name != OURS],
        )
        for result in reversed(report.scenes)
    ]
    return [(name, others) for name, others in found if others]


def _ratios(axes: Axes, bars: Sequence[tuple[str, Sequence[EngineResult]]]) -> None:
    """Draw a bar of each scene and peer, and the part that reading the state back adds."""
    axes.set_title("how many times as long as PhysicsLab others take", loc="left", fontsize=10)
    prepare_axes(axes, grid="x")
    axes.axvline(1.0, color="#222222", linewidth=0.8)
    axes.set_yticks(range(len(bars)), [name for name, _ in bars], fontsize=8)
    named: set[str] = set()
    for row, (_, others) in enumerate(bars):
        height = 0.84 / len(others)
        for n, other in enumerate(others):
            y = row + 0.42 - (n + 0.5) * height
            colour, longest = _COLOURS[other.name], other.times_ours_with_read or other.times_ours or 0.0
            label = None if other.name in named else other.name
            named.add(other.name)
            axes.barh(y, longest, height=0.9 * height, color=colour, alpha=0.3)
            axes.barh(y, other.times_ours or 0.0, height=0.9 * height, color=colour, label=label)
            figures = f"{other.times_ours:.2g}"
            if other.times_ours_with_read is not None:
                figures += f", read back {other.times_ours_with_read:.2g}"
            axes.annotate(
                figures, (longest, y), (3, 0), textcoords="offset points", va="center", fontsize=6.5
            )
    axes.set_xlim(right=1.2 * axes.get_xlim()[1])
    axes.set_ylim(-0.6, len(bars) - 0.4)
    axes.legend(frameon=False, fontsize=8, loc="upper right", title="pale: with positions read back",
                title_fontsize=8)  # fmt: skip
