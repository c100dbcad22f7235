"""The figures over the picture, banners and panels."""

import math
from collections.abc import Callable, Iterable
from itertools import product

from physicslab.diagnostics.warnings import ModelWarning, find_warnings
from physicslab.languages.sentence import Sentence
from physicslab.theme import Colour, mixed
from physicslab.view.canvas.canvas import Rect, TextStyle, is_within, overlap
from physicslab.view.controls.actions import has_gravity
from physicslab.view.controls.share_actions import finish_sharing
from physicslab.view.controls.tools import TOOLS
from physicslab.view.controls.tour import follow_tour
from physicslab.view.overlay import banners
from physicslab.view.overlay.edges import (
    axis_numbers_height,
    count_under,
    draw_axis_numbers,
    draw_edge_arrows,
    draw_scale_bar,
)
from physicslab.view.overlay.legend import Legend, legends_of
from physicslab.view.overlay.marks import draw_selection
from physicslab.view.window.window import Window
from physicslab.view.workbench import figures
from physicslab.view.workbench.interface import Interface
from physicslab.world import World

_STRIP, _LEAST = 6, (14.0, 6.5)
"""How high the strip is in which words make way for windows, and how much of its width must be left: as a
rule, and where there is no such strip; in heights of the text."""
_ROUGHLY = 5.0
"""How finely [s] it is said how long compiling takes: it is estimated."""
_MARGIN = 0.6
"""Distance of what is drawn over the world from its edges and from each other, in heights of the text."""
_MESSAGE_WIDTH = 0.7
"""How wide a message beside the scale bar may be, as a share of what is left for the world."""


def _is_planet_mode(world: World) -> bool:
    return world.physics.gravity_mode == "planet" and has_gravity(world)


class Hud:
    """Figures, costs, banners and panels over the picture: what a :class:`HudSystem` is given.

    Parameters
    ----------
    window : Window
        The canvas, the theme, and the state of the clock.
    interface : Interface
        The panels around the world.

    Attributes
    ----------
    readings : mapping of callable to float
        Readers of a world, and their intervals [s]: figures that change faster cannot be read.
    """

    def __init__(self, window: Window, interface: Interface) -> None:
        self._window = window
        self._interface = interface
        self._meter = figures.FrameMeter()
        self._watch = figures.EnergyWatch()
        self._dropped = banners.DroppedTime()
        self._prepared = False  # whether it was being prepared in the last frame
        self._advice: tuple[ModelWarning, ...] = ()
        self._figures: figures.WorldFigures
        self._measures: list[figures.Line] = []
        self._details: list[figures.Line] = []
        self._windows: list[Rect] = []
        self._said: object = None
        self._paused: Rect | None = None  # where PAUSED stands
        self._beside = 0
        self._legend: tuple[object, int] = None, 0
        self.readings: dict[Callable[[World, float], None], float] = {
            self._follow: 0.0, self._read_figures: 0.2, self._read_costs: 0.2, self._read_advice: 0.25,
        }  # fmt: skip

    def draw(self, world: World, elapsed: float) -> None:
        """Draw everything that lies over the world."""
        window, interface = self._window, self._interface
        window.dashboard.follow(world, window.edits.history)
        window.dashboard.fill(window.edits.history)
        if window.impacts.shown or window.microscope.is_open:
            window.impacts.follow(world, window.edits.history)
        if window.error_study.poll():
            self._announce(window.error_study.failure)
        finish_sharing(window)
        window.trust.follow(world, window.now)
        follow_tour(world, window)
        taken = self._draw_over_world(world)
        details = self._details if window.level == "Engineer" else []
        interface.build(world, self._figures, [*self._measures, *details], elapsed)
        interface.draw(window.canvas)
        window.overlays.covered = [*taken, *interface.covered]

    # ---- what is read: what is not shown is not ------------------------------------------------------------

    def _follow(self, world: World, elapsed: float) -> None:
        self._meter.note(world, elapsed)
        self._watch.follow(world)

    def _read_figures(self, world: World, elapsed: float) -> None:
        self._figures = figures.WorldFigures(world, self._watch, self._meter.frame_rate)
        self._window.scales = self._figures.scales
        self._measures = (
            figures.measure_lines(world, self._figures) if self._window.level != "Explore" else []
        )

    def _read_costs(self, world: World, elapsed: float) -> None:
        if self._window.level == "Engineer":
            costs = [*figures.cost_lines(world, self._meter), *figures.left_out_lines(world)]
            self._details = [*figures.impulse_lines(self._figures), *figures.method_lines(world), *costs]

    def _read_advice(self, world: World, elapsed: float) -> None:
        self._advice = find_warnings(world)

    def _announce(self, failure: str) -> None:
        """Show how measuring the error ended."""
        words = f"Error against run time could not be measured: {failure}" if failure else ""
        self._window.notify(words, 6.0 if failure else 0.0, failed=bool(failure))

    def _banners(self, world: World) -> list[tuple[str, Colour]]:
        """Return what is not as usual, each in its colour."""
        window, theme = self._window, self._window.theme
        found: list[tuple[str, Colour]] = []
        if window.filming.running:
            found.append((window.filming.words, theme.accent))
        if window.pace.speed != 1.0:
            name = "SLOW MOTION" if window.pace.speed < 1.0 else "FAST MOTION"
            speed = f"{window.pace.speed:g}"
            found.append((Sentence("{motion} {speed}x", motion=Sentence(name), speed=speed), theme.slow))
        if _is_planet_mode(world):
            found.append(("PLANET MODE", theme.planet))
        dropped = self._dropped.recent(window.pace.dropped, window.now)
        if self._prepared and window.preparing is None:
            self._dropped.forget()
            dropped = 0.0
        self._prepared = window.preparing is not None
        if window.preparing is not None:
            slowly = ", slow motion until then" if dropped else ""
            left = _ROUGHLY * max(math.ceil(window.preparing / _ROUGHLY), 1)  # it is not 0 s while it goes on
            words = f"First start: preparing the physics{slowly} ({left:.0f} s)"
            found.append((words, theme.slow if dropped else theme.notice))
        elif dropped and not window.pace.paused:
            found.append((f"The computer is too slow: {dropped:.1f} s were skipped", theme.slow))
        return found

    def above(self, world: World) -> int:
        """Return the height at the top of the room that a banner takes as long as a world is shown [px]."""
        on = self._window.drawing
        style = TextStyle(on.size + 2, on.theme.planet, bold=True)
        margin = round(_MARGIN * on.size)
        return banners.pill_height(1, style, on.canvas) + margin if _is_planet_mode(world) else 0

    def _draw_advice(self, world: World, room: Rect) -> Rect | None:
        """Write what is not to be trusted, and put a ring around each body that is spoken of."""
        on = self._window.drawing
        bodies = [one.number for one in self._advice if one.number is not None]
        draw_selection(world, bodies, on, colour=on.theme.warning)
        plainly, seen_only = self._window.level != "Engineer", self._window.level == "Explore"
        return banners.draw_advice(self._advice, room, on, plainly=plainly, seen_only=seen_only)

    # ---- drawing -------------------------------------------------------------------------------------------

    def _draw_over_world(self, world: World) -> list[Rect]:
        """Draw banners, advice, messages, scale and legend, none over another; return where they are.

        If there is no room for all of them, messages come first, then banners, then advice.
        """
        window, on, room = self._window, self._window.drawing, self._interface.visible
        (left, top, width, height), size = room, on.size
        margin = round(_MARGIN * size)
        bar = draw_scale_bar(on, left + width, top + height - margin)
        numbers = axis_numbers_height(on) if window.grid else 0
        taken = [bar, *self._draw_messages(world, bar, numbers)]
        bottom = min(rect[1] for rect in taken) - margin
        begin, wide, edge = self._free_strip(at_top=True)
        begin, across, first = begin + margin, wide - 2 * margin, edge + margin
        strip = begin, first, across, bottom - first
        shown = banners.draw_banners(self._banners(world), strip, self._windows, on)
        below = shown[-1][1] + shown[-1][3] + margin if shown else first
        advice = self._draw_advice(world, (begin, below, across, bottom - below))
        taken += [*shown, *([] if advice is None else [advice])]
        legends = legends_of(window.overlays, (width - 2 * margin, height), on)
        taken += self._draw_legend(world, legends, room, margin, taken)
        over = [*taken, *self._windows]
        written = draw_axis_numbers(on, room, bar[0], over) if window.grid else []
        inner = left, top, width, max(height - numbers, 1)
        draw_edge_arrows(world, on, inner, [*over, *written])
        return taken

    def _draw_legend(
        self, world: World, forms: Iterable[Legend], room: Rect, margin: int, taken: list[Rect]
    ) -> list[Rect]:
        """Draw a form of the legend where nothing lies that is ``taken``; return where.

        It is the place, and the form, in which the fewest bodies lay when it was looked for: one that follows
        them jumps. Of those that are as good the first is drawn.
        """
        left, top, width, height = room
        others = [*taken, *self._windows]
        tops = {top + margin, *(y + high + margin for _, y, _, high in others)}
        ends = {top + height, *(y for _, y, _, _ in others)}
        places = [
            (legend, (x, y))
            for legend in forms
            for across, down in (legend.size,)
            for x in (left + margin, left + width - across - margin)
            for y in sorted(tops | {end - down - margin for end in ends})
            if not any(overlap((x, y, across, down), one) for one in others)
            and top < y <= max(top + height - down - margin, top + margin)
        ]
        if not places:
            return []
        sought = [(legend.size, at) for legend, at in places]
        if self._legend[0] != sought:
            camera = self._window.camera
            counts = [count_under(world, camera, (*at, *size)) for size, at in sought]
            self._legend = sought, counts.index(min(counts))
        legend, at = places[self._legend[1]]
        return [legend.draw(*at, self._window.drawing)]

    def _free_strip(self, *, at_top: bool) -> tuple[int, int, int]:
        """Return where a strip begins that no window lies over, how wide it is, and its outer edge [px].

        It is the one nearest to the top of the world's room, or to its foot, of which windows leave enough.
        """
        left, top, width, height = self._interface.visible
        text, foot = self._interface.text, top + height
        if not self._interface.toolkit.has_popup():  # what a menu lies over stays where it is
            self._windows = self._interface.covered
        edges = (
            [y + high for _, y, _, high in self._windows] if at_top else [y for _, y, _, _ in self._windows]
        )
        outer = top if at_top else foot
        near = sorted((edge for edge in edges if top < edge < foot), reverse=not at_top)
        for least, edge in product(_LEAST, [outer, *near]):
            low = edge if at_top else edge - _STRIP * text
            span = self._free_span(low, low + _STRIP * text)
            if span[1] >= least * text:
                return *span, edge
        return left, width, outer

    def _free_span(self, top: int, bottom: int) -> tuple[int, int]:
        """Return the begin and the width of the widest part of a strip that no window lies over [px]."""
        left, _, width, _ = self._interface.visible
        at, widest = left, (left, 0)
        over = [(x, x + wide) for x, y, wide, high in self._windows if y < bottom and y + high > top]
        for begin, end in [*sorted(over), (left + width, 0)]:
            widest = max(widest, (at, min(begin, left + width) - at), key=lambda span: span[1])
            at = max(at, end)
        return widest

    def _draw_messages(self, world: World, bar: Rect, numbers: int) -> list[Rect]:
        """Draw what went wrong or was just done, beside the scale bar or above it; return where.

        They lie above the ``numbers`` at the lower edge, which are so high [px], in the middle; others than
        before lie at one side where they would cover more bodies in the middle.
        """
        window, on, theme, size = self._window, self._window.drawing, self._window.theme, self._interface.text
        _, top, _, height = self._interface.visible
        left, width, edge = self._free_strip(at_top=False)
        colour = theme.error if window.notice_failed else theme.notice
        colour = mixed(theme.panel, colour, window.notice_share)
        paused = "PAUSED" if window.pace.paused and not self._is_drawn_at(self._paused) else ""
        words = (window.error, theme.error), (window.notice, colour), (paused, theme.paused)
        middle, bottom = left + width // 2, min(edge, top + height - numbers)
        messages = banners.lay_out_messages(words, on, round(_MESSAGE_WIDTH * width))
        if any(middle + message.width // 2 > bar[0] - size // 2 for message in messages):
            messages = banners.lay_out_messages(words, on, width - size)
            bottom = min(bottom, bar[1])
        said = tuple(text for text, _ in words), left, width, bottom, on.camera.centre, on.camera.scale
        if not messages:
            self._said = None  # the same words, later, are placed where there is room then
        elif said != self._said:
            self._said, wide = said, max(message.width for message in messages)
            high, aside = sum(message.height + size for message in messages), (wide + size) // 2
            sides = middle, left + aside, min(left + width, bar[0]) - aside
            self._beside = min(
                (x - middle for x in sides if left + aside <= x <= left + width - aside or x == middle),
                key=lambda way: count_under(
                    world, on.camera, (middle + way - wide // 2, bottom - high, wide, high)
                ),
            )
        drawn = banners.draw_messages(messages, middle + self._beside, top + size // 2, bottom, on)
        if paused and len(drawn) == len(messages):
            x, y, wide, high = drawn[-1]
            self._paused = x - size, y - size, wide + 2 * size, high + 2 * size
        return drawn

    def _is_drawn_at(self, rect: Rect | None) -> bool:
        """Whether a tool draws at the cursor, in a rectangle [px]."""
        window = self._window
        if rect is None:
            return False
        draws = TOOLS[window.sketch.name or window.tool].draws is not None
        return draws and not window.pointer_on_panel and is_within(window.pointer, rect)
