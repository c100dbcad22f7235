"""Shared parts of the plots of the labs; matplotlib is imported when a plot is drawn."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = {
    "blue": "#0072B2", "orange": "#E69F00", "green": "#009E73", "vermilion": "#D55E00", "purple": "#CC79A7",
    "sky": "#56B4E9", "grey": "#999999", "black": "#000000",
}  # fmt: skip
"""Okabe and Ito's colours, which stay apart for the colour-blind: https://jfly.uni-koeln.de/color/"""


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure of a size [inches], which needs no display.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained", dpi=110)
    FigureCanvasAgg(figure)
    return figure


def prepare_axes(axes: Axes, *, logarithmic: bool = False, grid: str = "both") -> None:
    """Give axes a pale grid below what is drawn and no frame above and to the right.

    Parameters
    ----------
    logarithmic : bool
        Whether both scales are.
    grid : str
        Across which axis its lines stand: ``"x"``, ``"y"`` or ``"both"``.
    """
    if logarithmic:
        axes.set_xscale("log")
        axes.set_yscale("log")
    axes.grid(True, which="major", axis=grid, color="#dddddd", linewidth=0.6)  # type: ignore[arg-type]
    axes.set_axisbelow(True)
    for spine in ("top", "right"):
        axes.spines[spine].set_visible(False)


def png(figure: Figure) -> bytes:
    """Return a figure as a PNG."""
    image = io.BytesIO()
    figure.savefig(image, format="png")
    return image.getvalue()
