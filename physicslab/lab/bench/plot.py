"""The benchmark's plot: cost against the number of bodies, and how many times longer others take."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import TYPE_CHECKING

from physicslab.lab.bench.engine import OURS
from physicslab.lab.bench.report import BenchReport
from physicslab.lab.bench.result import EngineResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["bench_picture"]

# Okabe and Ito's colours, which stay apart for the colour-blind: https://jfly.uni-koeln.de/color/
_COLOURS = {OURS: "#0072B2", "pymunk": "#D55E00", "Box2D": "#009E73"}
_STYLES = {"piles": ("o", "-"), "gases": ("s", "--")}
_FRAME = 1e3 / 60.0
"""Of 60 Hz [ms]."""


def bench_picture(report: BenchReport) -> bytes:
    """Return a PNG: growth to the left, ratios to the right.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    bars = _bars(report)
    figure = Figure(figsize=(13.0, max(5.0, 1.5 + 0.24 * len(bars))), layout="constrained", dpi=110)
    FigureCanvasAgg(figure)
    if bars:
        left, right = figure.subplots(1, 2)
        _ratios(right, bars)
    else:  # alone there is nothing to compare with
        left = figure.subplots()
    _growth(left, report)
    for axes in figure.axes:
        axes.set_axisbelow(True)
        for spine in ("top", "right"):
            axes.spines[spine].set_visible(False)
    image = io.BytesIO()
    figure.savefig(image, format="png")
    return image.getvalue()


def _growth(axes: Axes, report: BenchReport) -> None:
    """Draw what a step costs for so many bodies, and what a frame of 60 Hz has."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    plain = FuncFormatter(lambda value, _: f"{value:,.6g}")
    axes.set_title("cost of a step, settled, ms of CPU time (median)", loc="left", fontsize=10)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("bodies")
    axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
    for growth in report.growths:
        marker, line = _STYLES[growth.group]
        label = f"{growth.engine}, {growth.group}: N^{growth.exponent:.2f}"
        axes.plot(growth.sizes, growth.ms, marker=marker, linestyle=line, label=label,
                  color=_COLOURS[growth.engine], linewidth=1.4, markersize=5)  # fmt: skip
    if report.growths:
        axes.axhline(_FRAME, color="#888888", linewidth=0.8, linestyle=":")
        axes.annotate(
            "a frame of 60 Hz", (0.01, _FRAME), xycoords=("axes fraction", "data"), xytext=(0, 3),
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
    """Return each scene that others ran, with what came of it in them; the last first, for y points up."""
    found = [
        (
            result.scene.name,
            [other for other in result.engines.values() if other.ratio and other.title != OURS],
        )
        for result in reversed(report.scenes)
    ]
    return [(name, others) for name, others in found if others]


def _ratios(axes: Axes, bars: Sequence[tuple[str, Sequence[EngineResult]]]) -> None:
    """Draw a bar of each scene and peer, and the part that reading the state back adds."""
    axes.set_title("how many times as long as PhysicsLab others take", loc="left", fontsize=10)
    axes.grid(True, axis="x", color="#dddddd", linewidth=0.6)
    axes.axvline(1.0, color="#222222", linewidth=0.8)
    axes.set_yticks(range(len(bars)), [name for name, _ in bars], fontsize=8)
    named: set[str] = set()
    for row, (_, others) in enumerate(bars):
        height = 0.84 / len(others)
        for n, other in enumerate(others):
            y = row + 0.42 - (n + 0.5) * height
            colour, longest = _COLOURS[other.title], other.ratio_with_read or other.ratio or 0.0
            label = None if other.title in named else other.title
            named.add(other.title)
            axes.barh(y, longest, height=0.9 * height, color=colour, alpha=0.3)
            axes.barh(y, other.ratio or 0.0, height=0.9 * height, color=colour, label=label)
            figures = f"{other.ratio:.2g}"
            if other.ratio_with_read is not None:
                figures += f", read back {other.ratio_with_read:.2g}"
            axes.annotate(
                figures, (longest, y), (3, 0), textcoords="offset points", va="center", fontsize=6.5
            )
    axes.set_xlim(right=1.2 * axes.get_xlim()[1])
    axes.set_ylim(-0.6, len(bars) - 0.4)
    axes.legend(frameon=False, fontsize=8, loc="upper right", title="pale: with positions read back",
                title_fontsize=8)  # fmt: skip
