"""The figures over the picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from physicslab.schedule import Stage, System, at
from physicslab.view.canvas import TextStyle
from physicslab.view.controls import CONTROLS
from physicslab.view.figures import FrameMeter, WorldFigures, measure_world
from physicslab.view.hint import Hint
from physicslab.view.legend import Legend, legend_of
from physicslab.view.panels import Line, Panel, broken, draw_pill, lay_out, text_size
from physicslab.view.quantities import quantity

if TYPE_CHECKING:
    from physicslab.view.theme import Colour
    from physicslab.view.window import Window
    from physicslab.world import World

__all__ = ["HudSystem"]

_PERIOD = 0.1
"""Time [s] between two readings: figures that change faster cannot be read."""
_BANNER = 16
"""Room that the banners need, in heights of the text."""
_DROP_SHOWN = 3.0
"""How long [s] the HUD speaks of time that was dropped."""


class HudSystem(System):
    """Writes figures, costs, banners and the controls hint over the picture; the world knows nothing of it.

    Parameters
    ----------
    window : Window
        The canvas, the theme, and the state of the clock.
    """

    def __init__(self, window: Window) -> None:
        self._window = window
        self._meter = FrameMeter()
        self._next_reading = 0.0
        self._size = (0, 0)
        self._panels: list[Panel] = []
        self._legend: Legend | None = None
        self._overlays = (False, False)
        self._middle = 0
        self._hint: Hint
        self._dropped = 0.0
        self._dropped_now = 0.0
        self._drop_until = 0.0

    @at(Stage.HUD)
    def draw(self, world: World, elapsed: float) -> None:
        """Draw everything that lies over the world."""
        window = self._window
        canvas, theme = window.canvas, window.theme
        self._meter.note(world, elapsed)
        if canvas.size != self._size:
            self._size = canvas.size
            self._hint = Hint(CONTROLS, self._text_size - 1, canvas, theme)
            self._next_reading = window.now
        overlays = window.overlays.arrows, window.overlays.impulses
        if window.now >= self._next_reading or overlays != self._overlays:
            self._overlays = overlays
            self._next_reading = window.now + _PERIOD
            self._read(world)
        for panel in self._panels:
            panel.draw(canvas, theme)
        if self._legend is not None:
            self._legend.draw(canvas, theme)
        self._hint.draw(canvas)
        self._draw_banners(world)
        self._draw_messages()

    @property
    def _text_size(self) -> int:
        return text_size(self._window.canvas)

    def _read(self, world: World) -> None:
        canvas, theme, size = self._window.canvas, self._window.theme, self._text_size
        width, margin = round(19.5 * size), round(0.8 * size)
        figures = [*_figure_lines(world, measure_world(world), self._meter.frame_rate), *_method_lines(world)]
        costs = [*_cost_lines(world, self._meter), *_left_out_lines(world)]
        self._panels = [lay_out(figures, margin, margin, width, size, canvas, theme)]
        right = canvas.size[0] - width - margin
        if right - (margin + width) >= _BANNER * size:  # or the banners would have no room between them
            self._panels.append(lay_out(costs, right, margin, width, size, canvas, theme))
        else:
            right = canvas.size[0]
        self._middle = (margin + width + right) // 2
        self._place_legend()

    def _place_legend(self) -> None:
        """Put the legend below the figures or the costs, or where the costs are if there is no room."""
        window, size, panels = self._window, self._text_size, self._panels
        width, gap = panels[0].rect[2], round(0.5 * size)
        legend = legend_of(window.overlays, width, size, window.canvas, window.theme)
        if legend is not None:
            foot = self._hint.top - gap - legend.panel.rect[3]
            below = [panel for panel in panels if panel.rect[1] + panel.rect[3] + gap <= foot]
            if not below:
                legend = legend.moved(panels[-1].rect[0], panels[-1].rect[1])
                self._panels = panels[:-1]
            else:
                legend = legend.moved(below[0].rect[0], foot)
        self._legend = legend
        window.overlays.covered = [
            *(panel.rect for panel in self._panels),
            *([legend.panel.rect] if legend is not None else []),
            (0, self._hint.top, *window.canvas.size),
        ]

    def _draw_banners(self, world: World) -> None:
        """Say at the top what is not as usual."""
        window = self._window
        size = self._text_size
        top = round(0.8 * size)
        for words, colour in self._banners(world):
            top += size // 2 + draw_pill(
                [words], self._middle, top, size + 2, colour, window.canvas, window.theme
            )

    def _banners(self, world: World) -> list[tuple[str, Colour]]:
        window, theme = self._window, self._window.theme
        banners: list[tuple[str, Colour]] = []
        if window.pace.paused:
            banners.append(("PAUSED", theme.paused))
        if window.pace.slow_motion:
            banners.append((f"SLOW MOTION {window.pace.speed:g}x", theme.slow))
        if world.physics.gravity_mode == "planet":
            banners.append(("PLANET MODE", theme.planet))
        if window.pace.dropped > self._dropped:
            if window.now >= self._drop_until:
                self._dropped_now = 0.0
            self._dropped_now += window.pace.dropped - self._dropped
            self._dropped = window.pace.dropped
            self._drop_until = window.now + _DROP_SHOWN
        if window.now < self._drop_until:
            banners.append((f"{self._dropped_now:.2f} s DROPPED", theme.warning))
        return banners

    def _draw_messages(self) -> None:
        """Say above the hint what went wrong, and what was just done."""
        window, canvas, theme = self._window, self._window.canvas, self._window.theme
        size = self._text_size
        bottom = self._hint.top - size // 2
        for words, colour in ((window.error, theme.error), (window.notice, theme.notice)):
            if words:
                style = TextStyle(size, colour, bold=True)
                lines = broken(words, round(0.7 * canvas.size[0]), canvas, style)
                height = canvas.text_size("Ag", style)[1] * len(lines) + round(0.55 * size)
                draw_pill(lines, canvas.size[0] // 2, bottom - height, size, colour, canvas, theme)
                bottom -= height + size // 2


def _figure_lines(world: World, figures: WorldFigures, frame_rate: float) -> list[Line]:
    energy = figures.energy
    return [
        Line(world.title or "PhysicsLab", kind="heading"),
        Line("Frame rate", f"{frame_rate:.0f} FPS"),
        Line("Time", f"{world.time:.2f} s"),
        Line("Bodies", f"{figures.bodies}"),
        Line("Candidate pairs", f"{figures.candidate_pairs}"),
        Line("Contacts", f"{figures.contacts}"),
        Line("Kinetic energy", quantity(energy.kinetic, "J")),
        Line("linear", quantity(energy.kinetic_linear, "J"), "detail"),
        Line("rotational", quantity(energy.kinetic_angular, "J"), "detail"),
        Line("Total momentum", quantity(figures.momentum, "kg m/s")),
        Line("Gravity", _gravity(world)),
    ]


def _gravity(world: World) -> str:
    physics = world.physics
    if physics.gravity_mode == "none" or (physics.gravity_mode == "linear" and not physics.gravity):
        return "off"
    if physics.gravity_mode == "planet":
        return f"G = {physics.G:.4g} N m²/kg²"
    if physics.gravity.x == 0.0:
        return f"{abs(physics.gravity.y):.4g} m/s² {'down' if physics.gravity.y < 0.0 else 'up'}"
    return f"({physics.gravity.x:.3g}, {physics.gravity.y:.3g}) m/s²"


def _method_lines(world: World) -> list[Line]:
    simulation = world.simulation
    parts = "substep" if simulation.substeps == 1 else "substeps"
    return [
        Line(kind="gap"),
        Line("Integrator", f"{simulation.dt * 1e3:.3g} ms in {simulation.substeps} {parts}", "heading"),
        Line(world.integrator.title, kind="remark"),
        Line(f"because: {world.integrator_reason}", kind="remark"),
    ]


def _plain(name: str) -> str:
    return name.removesuffix("System")


def _cost_lines(world: World, meter: FrameMeter) -> list[Line]:
    running = [system.name for system in world.schedule.running]
    costs = {name: meter.cost.get(name, 0.0) for name in running}
    lines = [Line("Running", "time per frame", "heading")]
    lines += [Line(_plain(name), f"{cost:.2f} ms") for name, cost in costs.items()]
    return [*lines, Line("Together", f"{sum(costs.values()):.2f} ms")]


def _left_out_lines(world: World) -> list[Line]:
    if not world.schedule.left_out:
        return []
    lines = [Line(kind="gap"), Line("Left out", kind="heading")]
    lines += [Line(f"{_plain(out.name)}: {out.reason}", kind="remark") for out in world.schedule.left_out]
    return lines
