"""The benchmark's plot: cost against the number of bodies, and how many times longer others take."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from physicslab.bench.engine import OURS
from physicslab.bench.report import BenchReport

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["bench_picture"]

# Okabe and Ito's colours, which stay apart for the colour-blind: https://jfly.uni-koeln.de/color/
_COLOURS = {OURS: "#0072B2", "pymunk": "#D55E00", "Box2D": "#009E73"}
_STYLES = {"piles": ("o", "-"), "gases": ("s", "--")}


def bench_picture(report: BenchReport) -> bytes:
    """Return a PNG: growth to the left, ratios to the right.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12.0, 5.0), layout="constrained", dpi=110)
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    for axes in (left, right):
        axes.set_axisbelow(True)
        for spine in ("top", "right"):
            axes.spines[spine].set_visible(False)
    _growth(left, report)
    _ratios(right, report)
    image = io.BytesIO()
    figure.savefig(image, format="png")
    return image.getvalue()


def _growth(axes: Axes, report: BenchReport) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
    axes.set_xlabel("bodies")
    axes.set_ylabel("ms a step, median")
    axes.set_title("growth", loc="left", fontweight="bold")
    for growth in report.growths:
        marker, line = _STYLES[growth.group]
        label = f"{growth.engine}, {growth.group}: N^{growth.exponent:.2f}"
        axes.plot(growth.sizes, growth.ms, marker=marker, linestyle=line, label=label,
                  color=_COLOURS[growth.engine], linewidth=1.4, markersize=5)  # fmt: skip
    if report.growths:
        axes.legend(frameon=False, fontsize=8)


def _ratios(axes: Axes, report: BenchReport) -> None:
    """Draw a bar of each scene and peer, and the part that reading the state back adds."""
    bars = [
        (f"{result.scene.name}, {found.title}", found)
        for result in reversed(report.scenes)
        for found in reversed(result.engines.values())
        if found.title != OURS and found.ratio is not None
    ]
    axes.grid(True, axis="x", color="#dddddd", linewidth=0.6)
    axes.set_title("times longer than PhysicsLab (pale: with positions read back)", loc="left", fontsize=10)
    axes.axvline(1.0, color="#222222", linewidth=0.8)
    axes.set_yticks(range(len(bars)), [name for name, _ in bars], fontsize=7)
    for y, (_, found) in enumerate(bars):
        colour = _COLOURS[found.title]
        if found.ratio_with_read is not None:
            axes.barh(y, found.ratio_with_read, height=0.8, color=colour, alpha=0.3)
        axes.barh(y, found.ratio or 0.0, height=0.5, color=colour)
