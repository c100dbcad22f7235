"""The figures over the picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from physicslab.diagnostics.warnings import Advice, advise
from physicslab.systems.system import Stage, System, at
from physicslab.view.canvas.canvas import TextStyle
from physicslab.view.controls.controls import CONTROLS
from physicslab.view.overlay.edge_arrows import draw_edge_arrows
from physicslab.view.overlay.legend import Legend, legend_of
from physicslab.view.panels.figures import EnergyWatch, FrameMeter, measure_world
from physicslab.view.panels.help import Help
from physicslab.view.panels.hint import Hint
from physicslab.view.panels.panels import Line, Panel, broken, draw_pill, lay_out, text_size
from physicslab.view.panels.readings import cost_lines, figure_lines, left_out_lines, method_lines
from physicslab.view.panels.refresh_timer import RefreshTimer
from physicslab.view.panels.scale_bar import draw_scale_bar, scale_bar_height
from physicslab.view.panels.warnings import draw_advice
from physicslab.view.panels.work_precision import draw_work_precision

if TYPE_CHECKING:
    from physicslab.view.canvas.canvas import Rect
    from physicslab.view.canvas.theme import Colour, Theme
    from physicslab.view.controls.toolbar import Toolbar
    from physicslab.view.window import Window
    from physicslab.world import World

__all__ = ["HudSystem"]

_PERIODS = {"figures": 0.1, "costs": 0.1, "advice": 0.25}
"""Time [s] between two readings: figures that change faster cannot be read."""
_PANEL, _MARGIN = 19.5, 0.8
"""Width of the panels, and the room around them, in heights of the text."""
_LEAST = 0.45
"""The least share of the window's width between the panels that a world is fitted into."""
_BANNER = 16
"""Room that the banners need, in heights of the text."""
_MESSAGE = 0.56
"""How wide a message may be, as a share of the window: the scale bar stands beside it."""
_DROP_WORTH_SAYING = 0.005
"""Less time [s] than this, dropped within a few seconds, nobody sees."""
_DROP_SHOWN = 3.0
"""How long [s] the HUD speaks of time that was dropped."""


class HudSystem(System):
    """Writes figures, costs, banners and the controls hint over the picture; the world knows nothing of it.

    Parameters
    ----------
    window : Window
        The canvas, the theme, and the state of the clock.
    toolbar : Toolbar
        What lies at the top; the rest keeps below it.
    """

    def __init__(self, window: Window, toolbar: Toolbar) -> None:
        self._window = window
        self._toolbar = toolbar
        self._meter = FrameMeter()
        self._watch = EnergyWatch()
        self._refresh_timer = RefreshTimer(_PERIODS)
        self._lines: dict[str, tuple[list[Line], ...]] = {}
        self._placed: dict[str, Panel] = {}
        self._laid_out: tuple[tuple[int, int], Theme] | None = None
        self._world: World | None = None
        self._panels: list[Panel] = []
        self._legend: Legend | None = None
        self._advice: tuple[Advice, ...] = ()
        self._overlays = (False, False, True)
        self._middle = 0
        self._hint: Hint
        self._help: Help | None = None
        self._dropped = 0.0
        self._dropped_now = 0.0
        self._drop_until = 0.0

    @at(Stage.HUD)
    def draw(self, world: World, elapsed: float) -> None:
        """Draw everything that lies over the world."""
        window = self._window
        self._meter.note(world, elapsed)
        self._lay_out()
        self._watch.follow(world)
        overlays = window.overlays.arrows, window.overlays.impulses, window.figures
        if world is not self._world or overlays != self._overlays:
            self._world, self._overlays = world, overlays
            self._refresh_timer.all_done(window.now)
            for reading in _PERIODS:
                self._read(reading, world)
        elif (due := self._refresh_timer.due(window.now)) is not None:
            self._read(due, world)
        if window.error_study.poll():
            self._announce(window.error_study.failure)
        if window.error_study.shown and not window.help:
            draw_work_precision(window.error_study, window.canvas, window.theme)
            window.overlays.covered = [(0, 0, *window.canvas.size)]
        elif window.help:
            if self._help is None:  # made only now: it is large, and a window that is resized seldom needs it
                self._help = Help(CONTROLS, self._text_size, window.canvas, window.theme)
            self._help.draw(window.canvas)
            window.overlays.covered = [(0, 0, *window.canvas.size)]  # or labels would look out below it
        else:
            self._draw_all(world)
            self._toolbar.draw()

    def _lay_out(self) -> None:
        """Make what hangs on the size and the colours of the window anew where they are others."""
        window = self._window
        canvas, theme = window.canvas, window.theme
        if (canvas.size, theme) != self._laid_out:
            self._laid_out = canvas.size, theme
            self._toolbar.lay_out()
            hinted = [control for control in CONTROLS if not control.minor]
            self._hint = Hint(hinted, self._text_size - 1, canvas, theme)
            self._help = None
            for reading in self._lines:
                self._place(reading)

    def room(self) -> Rect:
        """Return what is left for the world [px]: below the toolbar, above the hint, between the panels.

        In a window where little would be left between the panels, they may lie over the world.
        """
        self._lay_out()
        canvas = self._window.canvas
        sides = self._sides() if self._window.figures else (0, canvas.size[0])
        left, right = sides if sides[1] - sides[0] >= _LEAST * canvas.size[0] else (0, canvas.size[0])
        top = self._toolbar.height
        return left, top, max(right - left, 1), max(self._hint.top - top, 1)

    def _sides(self) -> tuple[int, int]:
        """Return where the left panel ends and the right one begins, or the window ends [px]."""
        size, across = self._text_size, self._window.canvas.size[0]
        panel = round(_PANEL * size) + round(_MARGIN * size)
        right = across - panel
        # Else the banners would have no room between them.
        return panel, right if right - panel >= _BANNER * size else across

    def _announce(self, failure: str) -> None:
        """Say how measuring the error ended."""
        words = f"Error against run time could not be measured: {failure}" if failure else ""
        self._window.notify(words, 6.0 if failure else 0.0, failed=bool(failure))

    def _draw_all(self, world: World) -> None:
        window = self._window
        canvas, theme, size = window.canvas, window.theme, self._text_size
        for n, panel in enumerate(self._panels):
            panel.show(f"panel {n}", canvas, theme)
        if self._legend is not None:
            self._legend.draw(canvas, theme)
        self._hint.draw(canvas)
        taken = [*(panel.rect for panel in self._panels), self._hint.rect]
        taken.append((0, 0, canvas.size[0], self._toolbar.height))
        if self._legend is not None:
            taken.append(self._legend.panel.rect)
        taken.append(draw_scale_bar(window.camera, self._hint.top - size // 2, size, canvas, theme))
        taken += self._draw_banners(world)
        taken += self._draw_messages()
        draw_edge_arrows(world, window.camera, taken, size, canvas, theme)
        below = self._hint.top
        window.overlays.covered = [*taken, (0, below, canvas.size[0], canvas.size[1] - below)]

    @property
    def _text_size(self) -> int:
        return text_size(self._window.canvas)

    def _read(self, reading: str, world: World) -> None:
        """Look at the figures, the costs or what is not to be trusted."""
        if reading == "advice":
            self._advice = advise(world)
            return
        if reading == "costs":
            self._lines[reading] = ([*cost_lines(world, self._meter), *left_out_lines(world)],)
        else:
            figures = figure_lines(world, measure_world(world, self._watch), self._meter.frame_rate)
            plain = [line for line in figures if line.kind != "detail"]
            self._lines[reading] = ([*figures, *method_lines(world)], figures, plain)
        self._place(reading)

    def _place(self, reading: str) -> None:
        """Lay out what was read in a window as it is now: the figures at the left, the costs at the right."""
        window, size, across = self._window, self._text_size, self._window.canvas.size[0]
        canvas, theme = window.canvas, window.theme
        width, margin = round(_PANEL * size), round(_MARGIN * size)
        top, right = self._toolbar.height + margin, self._sides()[1]
        bottom = self._hint.top - size - sum(height + size // 2 for _, _, height in self._messages())
        for lines in self._lines[reading] if window.figures else ():
            panel = lay_out(lines, margin if reading == "figures" else right, top, width, size, canvas, theme)
            self._placed[reading] = panel
            if top + panel.rect[3] <= bottom:
                break  # else less is said, so that no message lies over it
        if not window.figures:
            self._placed.clear()
        elif right >= across:
            self._placed.pop("costs", None)
        self._panels = [self._placed[side] for side in ("figures", "costs") if side in self._placed]
        self._middle = (margin + width + right) // 2 if window.figures else across // 2
        self._place_legend()

    def _place_legend(self) -> None:
        """Put the legend below the figures or the costs, or where the costs are if there is no room."""
        window, size, panels = self._window, self._text_size, self._panels
        width, gap = round(_PANEL * size), round(0.5 * size)
        legend = legend_of(window.overlays, width, size, window.canvas, window.theme)
        if legend is not None:
            foot = self._hint.top - gap - legend.panel.rect[3]
            # The scale bar is at the foot of the right side.
            bar = size // 2 + scale_bar_height(size, window.canvas, window.theme)
            feet = [foot, *(foot - bar for _ in panels[1:])]
            below = [
                (panel, foot)
                for panel, foot in zip(panels, feet[: len(panels)], strict=True)
                if panel.rect[1] + panel.rect[3] + gap <= foot
            ]
            if not panels:
                legend = legend.moved(round(_MARGIN * size), self._toolbar.height + round(_MARGIN * size))
            elif not below:
                legend = legend.moved(panels[-1].rect[0], panels[-1].rect[1])
                self._panels = panels[:-1]
            else:
                legend = legend.moved(below[0][0].rect[0], below[0][1])
        self._legend = legend

    def _draw_banners(self, world: World) -> list[Rect]:
        """Say at the top what is not as usual, and return where [px]."""
        window = self._window
        size = self._text_size
        top = self._toolbar.height + round(_MARGIN * size)
        taken: list[Rect] = []
        for words, colour in self._banners(world):
            taken.append(draw_pill([words], self._middle, top, size + 2, colour, window.canvas, window.theme))
            top += size // 2 + taken[-1][3]
        advice = draw_advice(
            self._advice, self._middle, top, self._between, size, window.canvas, window.theme
        )
        return [*taken, *([advice] if advice is not None else [])]

    @property
    def _between(self) -> int:
        """The room between the panels at the sides [px]."""
        across, margin = self._window.canvas.size[0], round(_MARGIN * self._text_size)
        left, right = self._sides() if self._panels else (0, across)
        return right - left - 2 * margin

    def _banners(self, world: World) -> list[tuple[str, Colour]]:
        window, theme = self._window, self._window.theme
        banners: list[tuple[str, Colour]] = []
        if window.pace.paused:
            banners.append(("PAUSED", theme.paused))
        if window.pace.speed != 1.0:
            name = "SLOW MOTION" if window.pace.speed < 1.0 else "FAST MOTION"
            banners.append((f"{name} {window.pace.speed:g}x", theme.slow))
        if world.physics.gravity_mode == "planet":
            banners.append(("PLANET MODE", theme.planet))
        if window.pace.dropped > self._dropped:
            if window.now >= self._drop_until:
                self._dropped_now = 0.0
            self._dropped_now += window.pace.dropped - self._dropped
            self._dropped = window.pace.dropped
            self._drop_until = window.now + _DROP_SHOWN
        if window.now < self._drop_until and self._dropped_now >= _DROP_WORTH_SAYING:
            banners.append((f"{self._dropped_now:.2f} s DROPPED", theme.warning))
        return banners

    def _messages(self) -> list[tuple[list[str], Colour, int]]:
        """Return what went wrong and what was just done: in lines, its colour, and how high it is [px]."""
        window, canvas, theme, size = self._window, self._window.canvas, self._window.theme, self._text_size
        notice = theme.error if window.notice_failed else theme.notice
        messages: list[tuple[list[str], Colour, int]] = []
        for words, colour in ((window.error, theme.error), (window.notice, notice)):
            if words:
                style = TextStyle(size, colour, bold=True)
                lines = broken(words, round(_MESSAGE * canvas.size[0]), canvas, style)
                height = canvas.text_size("Ag", style)[1] * len(lines) + round(0.55 * size)
                messages.append((lines, colour, height))
        return messages

    def _draw_messages(self) -> list[Rect]:
        """Say above the hint what there is to say, and return where [px]."""
        canvas, theme, size = self._window.canvas, self._window.theme, self._text_size
        bottom, middle = self._hint.top - size // 2, canvas.size[0] // 2
        taken: list[Rect] = []
        for lines, colour, height in self._messages():
            taken.append(draw_pill(lines, middle, bottom - height, size, colour, canvas, theme))
            bottom -= height + size // 2
        return taken
