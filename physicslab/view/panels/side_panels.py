"""The panels at both sides of the window: figures at the left, costs at the right, the legend below them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from physicslab.view.canvas.canvas import Canvas
from physicslab.view.canvas.theme import Theme
from physicslab.view.overlay.overlays import Overlays
from physicslab.view.panels.legend import Legend, legend_of
from physicslab.view.panels.panels import Line, Panel, lay_out
from physicslab.view.panels.scale_bar import scale_bar_height

__all__ = ["Frame", "SidePanels", "margin_of", "sides_of"]

_WIDTH, _MARGIN = 19.5, 0.8
"""Width of the panels, and the room around them, in heights of the text."""
_MIDDLE_WIDTH = 16
"""Room that the banners need between the panels, in heights of the text."""


@dataclass(frozen=True, slots=True)
class Frame:
    """What panels are laid out for.

    Attributes
    ----------
    canvas, theme : Canvas, Theme
        What they will be drawn with.
    text_size : int
        Height of the text [px].
    top, bottom : int
        Where the toolbar ends and the controls hint begins [px from the top].
    """

    canvas: Canvas
    theme: Theme
    text_size: int
    top: int
    bottom: int


def margin_of(text_size: int) -> int:
    """Return the room around the panels [px]."""
    return round(_MARGIN * text_size)


def sides_of(text_size: int, width: int) -> tuple[int, int]:
    """Return where the left panel ends and the right one begins in a window of a width [px].

    Where banners would have no room between them there is no right panel: it begins where the window ends.
    """
    left = round(_WIDTH * text_size) + margin_of(text_size)
    right = width - left
    return left, right if right - left >= _MIDDLE_WIDTH * text_size else width


class SidePanels:
    """What was read of the world, laid out.

    Attributes
    ----------
    panels : list of Panel
        The panels that are shown.
    legend : Legend, optional
        The legend of the arrows that are shown.
    middle : int
        The middle of the room between the panels [px].
    """

    def __init__(self) -> None:
        self.panels: list[Panel] = []
        self.legend: Legend | None = None
        self.middle = 0
        self._versions: dict[str, Sequence[Sequence[Line]]] = {}
        self._placed: dict[str, Panel] = {}

    def take(self, side: str, versions: Sequence[Sequence[Line]]) -> None:
        """Take the lines of a side, ``"figures"`` or ``"costs"``: versions of them, the longest first."""
        self._versions[side] = versions

    def place_all(self, frame: Frame, overlays: Overlays, shown: bool, messages: int) -> None:
        """Lay out everything: the window or its colours are others."""
        for side in self._versions:
            self.place(side, frame, overlays, shown, messages)

    def place(self, side: str, frame: Frame, overlays: Overlays, shown: bool, messages: int) -> None:
        """Lay out one side, if panels are to be shown, and the legend below.

        Parameters
        ----------
        messages : int
            Height of the messages above the controls hint [px]: panels keep above them.
        """
        size, width = frame.text_size, frame.canvas.size[0]
        panel_width, margin, right = round(_WIDTH * size), margin_of(size), sides_of(size, width)[1]
        left = margin if side == "figures" else right
        top, bottom = frame.top + margin, frame.bottom - size - messages
        for lines in self._versions[side] if shown else ():
            panel = lay_out(lines, left, top, panel_width, size, frame.canvas, frame.theme)
            self._placed[side] = panel
            if top + panel.rect[3] <= bottom:
                break
        if not shown:
            self._placed.clear()
        elif right >= width:
            self._placed.pop("costs", None)
        self.panels = [self._placed[name] for name in ("figures", "costs") if name in self._placed]
        self.middle = (margin + panel_width + right) // 2 if shown else width // 2
        self._place_legend(frame, overlays)

    def _place_legend(self, frame: Frame, overlays: Overlays) -> None:
        """Put the legend below the figures or the costs, or where the costs are if there is no room."""
        size, panels = frame.text_size, self.panels
        gap, margin = round(0.5 * size), margin_of(size)
        legend = legend_of(overlays, round(_WIDTH * size), size, frame.canvas, frame.theme)
        if legend is None:
            self.legend = None
            return
        foot = frame.bottom - gap - legend.panel.rect[3]
        # The scale bar is at the foot of the right side.
        bar = size // 2 + scale_bar_height(size, frame.canvas, frame.theme)
        feet = [foot, *(foot - bar for _ in panels[1:])][: len(panels)]
        places = [
            (panel.rect[0], top)
            for panel, top in zip(panels, feet, strict=True)
            if panel.rect[1] + panel.rect[3] + gap <= top
        ]
        if not panels:
            self.legend = legend.moved(margin, frame.top + margin)
        elif places:
            self.legend = legend.moved(*places[0])
        else:
            self.legend = legend.moved(panels[-1].rect[0], panels[-1].rect[1])
            self.panels = panels[:-1]

    def between(self, text_size: int, width: int) -> int:
        """Return the room between the panels in a window of a width [px]."""
        left, right = sides_of(text_size, width) if self.panels else (0, width)
        return right - left - 2 * margin_of(text_size)
