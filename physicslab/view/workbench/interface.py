"""The panels around the world: menus, tools, transport, and the selection or the world in figures."""

from collections.abc import Callable, Sequence
from operator import attrgetter

import pygame

from physicslab.view.canvas.canvas import Canvas, Rect
from physicslab.view.toolkit.style import bar_height
from physicslab.view.toolkit.toolkit import Toolkit, Walk
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window
from physicslab.view.workbench import world_panel
from physicslab.view.workbench.error_plot import build_error_plot
from physicslab.view.workbench.figures import Line, WorldFigures
from physicslab.view.workbench.file_panels import Gallery, build_film, build_open, build_recovery, build_save
from physicslab.view.workbench.impact_panel import build_impacts
from physicslab.view.workbench.inspector import build_inspector
from physicslab.view.workbench.instrument_panels import NotePanel, build_stopwatch
from physicslab.view.workbench.menus import build_help, build_menu_bar, build_palette
from physicslab.view.workbench.microscope_panel import build_microscope
from physicslab.view.workbench.number_field import NumberFields
from physicslab.view.workbench.scene_panels import ScenePanels
from physicslab.view.workbench.transport import build_history, build_transport
from physicslab.world import World

# ---- the layout: the world first, panels around it ---------------------------------------------------------


_PALETTE, _SIDE, _TRANSPORT = 6.9, 16.8, 3.0
"""Widths of the palette and the side panel, height of the transport, in heights of the text."""
_MIN_WORLD = 0.34
"""Share of the window's width that is always left to the world: the side panel lies over it if it must."""


class Layout:
    """The rectangles of a window [px].

    Attributes
    ----------
    menu, palette, transport, side, room : Rect
        The menu bar, the tools, the transport, the panel at the right, and what is left for the world.
    """

    def __init__(self, size: tuple[int, int], text: int, *, side: bool) -> None:
        """Lay a window out for text of a height [px], with or without the panel at the right."""
        width, height = size
        top, foot, left = bar_height(text), round(_TRANSPORT * text), round(_PALETTE * text)
        right = round(_SIDE * text) if side else 0
        middle, across = max(height - top - foot, 1), width - left - right
        if across < _MIN_WORLD * width:
            across = width - left
        self.menu: Rect = (0, 0, width, top)
        self.palette: Rect = (0, top, left, middle)
        self.transport: Rect = (0, height - foot, width, foot)
        self.side: Rect = (width - right, top, right, middle)
        self.room: Rect = (left, top, max(across, 1), middle)

    @property
    def panels(self) -> tuple[Rect, ...]:
        """All that is not left for the world [px]."""
        return self.menu, self.palette, self.transport, self.side

    @property
    def visible(self) -> Rect:
        """The part of the world's room that the panel at the right does not lie over [px]."""
        left, top, width, height = self.room
        return left, top, max(min(width, self.side[0] - left), 1), height


# ---- the panels --------------------------------------------------------------------------------------------


_PERIOD = 0.2
"""Time [s] after which panels are built again where nothing was done: faster digits cannot be read."""
_RECIPES = {"circle": "Circle", "box": "Box"}
"""The tools that make bodies to a recipe."""
_WATCHED = attrgetter(
    "canvas.size", "dashboard.state", "edits.history.branches", "error_study.shown", "figures",
    "filming.choosing", "filming.refused", "help", "impacts.shown", "level", "lists_history",
    "measured.number", "microscope.state", "naming_refused", "opening_refused", "pace.paused", "pace.speed",
    "recovery.offered", "selection.entities", "shows_gallery", "shows_stopwatch", "tool", "trust.state",
)  # fmt: skip
"""The state of a window that panels show beside figures."""
type _Build = Callable[[Ui, World, Window], None]
_BEFORE: dict[str, _Build] = {
    "shows_stopwatch": build_stopwatch, "impacts.shown": build_impacts, "microscope.record": build_microscope,
}  # fmt: skip
_AFTER: dict[str, _Build] = {
    "naming": build_save, "filming.choosing": build_film, "opening": build_open,
    "lists_history": build_history, "help": build_help,
}  # fmt: skip
"""The builders of the panels that are open: those below others at first, and those above them."""
_BUTTONS = (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP)


class Interface:
    """The panels of a window. They change nothing: what a click is to do is put on ``Window.pending``.

    Parameters
    ----------
    window : Window
        What is shown and what is on.

    Attributes
    ----------
    ui : Ui
        What was built last: where each widget is, and all that is written.
    toolkit : Toolkit
        What builds and paints them.
    """

    def __init__(self, window: Window) -> None:
        self._window = window
        self.toolkit = Toolkit()
        self._walk = Walk(self.toolkit)
        self.ui = Ui(self.toolkit.fonts, window.theme)
        self.ui.do_next = window.do_next
        self._numbers = NumberFields()
        self._gallery = Gallery()
        self._scene_panels = ScenePanels()
        self._note = NotePanel()
        self._next = 0.0
        self._offer_height = 0  # of the offer to restore a session [px]
        self._seen: tuple[object, ...] = ()
        self._free: Rect | None = None  # what docked windows leave of the world's room [px]
        self._arrangement = ""

    def forget(self) -> None:
        """Drop all that is half written or dragged in panels: it was for a world that is shown no more."""
        self._numbers, self._note = NumberFields(), NotePanel()
        self._scene_panels.forget()
        self.ui.scenes += 1

    @property
    def text(self) -> int:
        """Height of the text [px]."""
        return self._window.drawing.size

    @property
    def layout(self) -> Layout:
        """The layout."""
        return Layout(self._window.canvas.size, self.text, side=self._window.figures)

    def room(self) -> Rect:
        """Return what is left for the world [px]."""
        return self.layout.room if self._free is None else self._free

    @property
    def visible(self) -> Rect:
        """The part of the window where words can be drawn over the world: no panel covers it [px]."""
        left, top, width, height = self.layout.visible if self._free is None else self._free
        taken = min(self._offer_height, height - 1) if self._window.recovery.offered else 0
        return left, top + taken, width, height - taken

    def take(self, event: pygame.Event) -> bool:
        """Let panels have an event first; return whether the world is not to see it.

        A press in the world takes over what is half written in a field, before it selects anything else.
        """
        if event.type in (pygame.MOUSEMOTION, *_BUTTONS):
            self.toolkit.follow_pointer(event.pos)
        self._walk.follow(event)
        taken = self.toolkit.take(event)
        if event.type == pygame.MOUSEBUTTONDOWN and not taken:
            refusal = self._finish_fields()
            if refusal:
                self._window.notify(refusal, 6.0, failed=True)
        return taken

    def _finish_fields(self) -> str:
        """Take over what is half written in a field, and return why it is refused; empty where it is not.

        Text for bodies that are shown no more is dropped.
        """
        self._begin_numbers()
        return self._numbers.finish() or self._note.finish(self._window)

    def _begin_numbers(self) -> None:
        self._numbers.begin((self._window.edits.world, self._window.selection.entities))

    def build(self, world: World, figures: WorldFigures, lines: Sequence[Line], elapsed: float) -> None:
        """Build panels where something may have changed since they were built last.

        Parameters
        ----------
        figures : WorldFigures
            What was measured of the world.
        lines : sequence of Line
            What those see beside who measure, and engineers.
        elapsed : float
            Time [s] since the last frame.
        """
        window = self._window
        rearranged = window.arrangement != self._arrangement
        if rearranged:
            self._arrangement = window.arrangement
            self.toolkit.arrange(window.arrangement)
        self._follow_keys()
        seen = self._state(world)
        if seen != self._seen or window.now >= self._next:
            if seen != self._seen:
                self.toolkit.wake()
            else:
                self.toolkit.refresh()
            self._seen, self._next = seen, window.now + _PERIOD

        def build() -> None:
            self.ui.begin(window.theme, self.layout.visible, rearranged=rearranged and not window.arrangement)
            self._walk.mark()
            self._build(world, figures, lines)

        if self.toolkit.frame(window.canvas.size, window.theme, float(self.text), elapsed, build):
            self._walk.end()
            window.arrangement = self._arrangement = self.toolkit.arrangement()

    def _follow_keys(self) -> None:
        """Let keys go to a menu or a panel, if they are to."""
        window = self._window
        if window.keys_go_to == "fields" and not window.figures:
            window.figures = True  # and in the next frame the panel is there
            return
        self.ui.keys_go_to, window.keys_go_to = window.keys_go_to, ""
        self._walk.begin(self.ui.keys_go_to)

    def _state(self, world: World) -> tuple[object, ...]:
        """Return what panels show beside figures."""
        window = self._window
        return (
            world, world.motion_edits, world.revision, world.time if window.pace.paused else None,
            window.error_study.share if window.error_study.running else None,
            window.naming is None, window.opening is None, window.measuring.writing is None,
            *_WATCHED(window),
        )  # fmt: skip

    def _build(self, world: World, figures: WorldFigures, lines: Sequence[Line]) -> None:
        ui, window, layout = self.ui, self._window, self.layout
        free = ui.dock(layout.visible)
        self._free = free if free != layout.visible else None
        ui.room = self.visible
        self._begin_numbers()
        build_menu_bar(ui, world, window)
        build_palette(ui, layout.palette, window)
        build_transport(ui, layout.transport, world, window)
        if window.figures:
            with ui.panel("side", layout.side):
                world_panel.build_levels(ui, window)
                if window.selection.entities:
                    build_inspector(ui, self._numbers, world, window)
                else:
                    world_panel.build_world(ui, world, figures, window)
                    if window.tool in _RECIPES:
                        world_panel.build_recipe(ui, self._numbers, _RECIPES[window.tool], window)
                    if window.level == "Engineer":
                        world_panel.build_settings(ui, self._numbers, world, window)
                if window.level != "Explore":
                    ui.rule(0.3)
                    world_panel.build_figures(ui, lines)
                if window.level != "Explore" or not window.selection.entities:
                    ui.rule(0.3)
                    self._build_counts(ui, figures)
        self._scene_panels.build(ui, self._numbers, world, window, self.visible)
        for panel, build in _BEFORE.items():
            if window.is_open(panel):
                build(ui, world, window)
        if window.measuring.writing is not None:
            self._note.build(ui, window)
        if window.recovery.offered:
            self._offer_height = build_recovery(ui, window, layout.visible)
        build_error_plot(ui, window)
        for panel, build in _AFTER.items():
            if window.is_open(panel):
                build(ui, world, window)
        if window.shows_gallery:
            self._gallery.build(ui, window)
            if not self._gallery.is_complete:
                self.toolkit.wake()

    def _build_counts(self, ui: Ui, figures: WorldFigures) -> None:
        """Write the numbers that say how much there is to do."""
        ui.row("Bodies", f"{figures.bodies}" + (f", {figures.asleep} asleep" if figures.asleep else ""))
        ui.row("Contacts", f"{figures.contacts}", "Pairs that touch", lesser=False)
        ui.row("Candidate pairs", f"{figures.candidate_pairs}", "Pairs that are near each other")
        ui.row("Frame rate", f"{figures.frame_rate:.0f} FPS")

    def draw(self, canvas: Canvas) -> None:
        """Show panels as they were built last."""
        canvas.paint(self.toolkit.pictures.show)
        if self.ui.pictures:
            canvas.paint(self.ui.show_pictures)
        self._scene_panels.save_picture(self._window, self.toolkit)

    @property
    def covered(self) -> list[Rect]:
        """The rectangles of panels [px]."""
        return self.toolkit.covered
