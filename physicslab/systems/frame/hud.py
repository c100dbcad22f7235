"""The figures over the picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from physicslab.diagnostics.warnings import ModelWarning, find_warnings
from physicslab.systems.system import Stage, System, at
from physicslab.view.controls.controls import CONTROLS
from physicslab.view.controls.help import Help
from physicslab.view.controls.hint import Hint
from physicslab.view.overlay.edge_arrows import draw_edge_arrows
from physicslab.view.panels.banners import (
    DroppedTime,
    Message,
    draw_banners,
    draw_messages,
    height_of,
    lay_out_messages,
)
from physicslab.view.panels.figures import EnergyWatch, FrameMeter, measure_world
from physicslab.view.panels.laws import has_gravity
from physicslab.view.panels.panels import text_size
from physicslab.view.panels.readings import cost_lines, figure_lines, left_out_lines, method_lines
from physicslab.view.panels.refresh_timer import RefreshTimer
from physicslab.view.panels.scale_bar import draw_scale_bar
from physicslab.view.panels.side_panels import Frame, SidePanels, margin_of, sides_of
from physicslab.view.panels.warnings import draw_advice
from physicslab.view.panels.work_precision import draw_work_precision

if TYPE_CHECKING:
    from physicslab.view.canvas.canvas import Rect
    from physicslab.view.canvas.theme import Colour, Theme
    from physicslab.view.controls.toolbar import Toolbar
    from physicslab.view.window.window import Window
    from physicslab.world import World

__all__ = ["HudSystem"]

_PERIODS = {"figures": 0.1, "costs": 0.1, "advice": 0.25}
"""Time [s] between two readings: figures that change faster cannot be read."""
_MIN_ROOM = 0.45
"""Share of the window's width that panels must leave for a world to be fitted between them."""


class HudSystem(System):
    """Writes figures, costs, banners and the controls hint over the picture; the world does not depend on it.

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
        self._sides = SidePanels()
        self._dropped = DroppedTime()
        self._laid_out: tuple[tuple[int, int], Theme] | None = None
        self._world: World | None = None
        self._advice: tuple[ModelWarning, ...] = ()
        self._overlays = (False, False, True)
        self._hint: Hint
        self._help: Help | None = None

    @at(Stage.HUD)
    def draw(self, world: World, elapsed: float) -> None:
        """Draw everything that lies over the world."""
        window = self._window
        self._meter.note(world, elapsed)
        self._lay_out()
        self._watch.follow(world)
        self._refresh(world)
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

    def room(self) -> Rect:
        """Return what is left for the world [px]: below the toolbar, above the hint, between the panels.

        In a window where little would be left between the panels, they may lie over the world.
        """
        self._lay_out()
        width = self._window.canvas.size[0]
        left, right = sides_of(self._text_size, width) if self._window.figures else (0, width)
        if right - left < _MIN_ROOM * width:
            left, right = 0, width
        top = self._toolbar.height
        return left, top, max(right - left, 1), max(self._hint.top - top, 1)

    # ---- layout --------------------------------------------------------------------------------------------

    @property
    def _text_size(self) -> int:
        return text_size(self._window.canvas)

    @property
    def _frame(self) -> Frame:
        """What panels are laid out for."""
        window = self._window
        return Frame(window.canvas, window.theme, self._text_size, self._toolbar.height, self._hint.top)

    def _lay_out(self) -> None:
        """Lay out again what depends on the size and the colours of the window, where these changed."""
        window = self._window
        canvas, theme = window.canvas, window.theme
        if (canvas.size, theme) != self._laid_out:
            self._laid_out = canvas.size, theme
            self._toolbar.lay_out()
            hinted = [control for control in CONTROLS if not control.minor]
            self._hint = Hint(hinted, self._text_size - 1, canvas, theme)
            self._help = None
            self._sides.place_all(self._frame, window.overlays, window.figures, self._message_height)

    # ---- what is shown -------------------------------------------------------------------------------------

    def _refresh(self, world: World) -> None:
        """Read what is due; all of it where another world or other overlays are shown."""
        window = self._window
        overlays = window.overlays.arrows, window.overlays.impulses, window.figures
        if world is not self._world or overlays != self._overlays:
            self._world, self._overlays = world, overlays
            self._refresh_timer.all_done(window.now)
            for reading in _PERIODS:
                self._read(reading, world)
        elif (due := self._refresh_timer.due(window.now)) is not None:
            self._read(due, world)

    def _read(self, reading: str, world: World) -> None:
        """Read the figures, the costs, or what is not to be trusted."""
        if reading == "advice":
            self._advice = find_warnings(world)
            return
        if reading == "costs":
            self._sides.take(reading, ([*cost_lines(world, self._meter), *left_out_lines(world)],))
        else:
            figures = figure_lines(world, measure_world(world, self._watch), self._meter.frame_rate)
            plain = [line for line in figures if line.kind != "detail"]
            self._sides.take(reading, ([*figures, *method_lines(world)], figures, plain))
        window = self._window
        self._sides.place(reading, self._frame, window.overlays, window.figures, self._message_height)

    def _announce(self, failure: str) -> None:
        """Show how measuring the error ended."""
        words = f"Error against run time could not be measured: {failure}" if failure else ""
        self._window.notify(words, 6.0 if failure else 0.0, failed=bool(failure))

    def _banners(self, world: World) -> list[tuple[str, Colour]]:
        """Return what is not as usual, each in its colour."""
        window, theme = self._window, self._window.theme
        banners: list[tuple[str, Colour]] = []
        if window.pace.paused:
            banners.append(("PAUSED", theme.paused))
        if window.pace.speed != 1.0:
            name = "SLOW MOTION" if window.pace.speed < 1.0 else "FAST MOTION"
            banners.append((f"{name} {window.pace.speed:g}x", theme.slow))
        if world.physics.gravity_mode == "planet" and has_gravity(world):
            banners.append(("PLANET MODE", theme.planet))
        if dropped := self._dropped.recent(window.pace.dropped, window.now):
            banners.append((f"{dropped:.2f} s DROPPED", theme.warning))
        return banners

    def _messages(self) -> list[Message]:
        """Return what went wrong, and what was just done."""
        window, theme = self._window, self._window.theme
        words = (
            (window.error, theme.error),
            (window.notice, theme.error if window.notice_failed else theme.notice),
        )
        return lay_out_messages(words, self._text_size, window.canvas)

    @property
    def _message_height(self) -> int:
        return height_of(self._messages(), self._text_size)

    # ---- drawing -------------------------------------------------------------------------------------------

    def _draw_all(self, world: World) -> None:
        """Draw panels, hint, scale bar, banners, messages and arrows at the edges; none over another."""
        window, sides, bottom = self._window, self._sides, self._hint.top
        canvas, theme, size = window.canvas, window.theme, self._text_size
        for n, panel in enumerate(sides.panels):
            panel.show(f"panel {n}", canvas, theme)
        if sides.legend is not None:
            sides.legend.draw(canvas, theme)
        self._hint.draw(canvas)
        taken = [*(panel.rect for panel in sides.panels), self._hint.rect]
        taken.append((0, 0, canvas.size[0], self._toolbar.height))
        if sides.legend is not None:
            taken.append(sides.legend.panel.rect)
        taken.append(draw_scale_bar(window.camera, bottom - size // 2, size, canvas, theme))
        taken += self._draw_top(world)
        taken += draw_messages(self._messages(), bottom, size, canvas, theme)
        draw_edge_arrows(world, window.camera, taken, size, canvas, theme)
        window.overlays.covered = [*taken, (0, bottom, canvas.size[0], canvas.size[1] - bottom)]

    def _draw_top(self, world: World) -> list[Rect]:
        """Draw banners and advice below the toolbar, and return where they are [px]."""
        canvas, theme, size = self._window.canvas, self._window.theme, self._text_size
        middle, top = self._sides.middle, self._toolbar.height + margin_of(size)
        taken = draw_banners(self._banners(world), middle, top, size, canvas, theme)
        if taken:
            top = taken[-1][1] + taken[-1][3] + size // 2
        room = self._sides.between(size, canvas.size[0])
        advice = draw_advice(self._advice, middle, top, room, size, canvas, theme)
        return taken if advice is None else [*taken, advice]
