"""The panels around the world: menus, tools, transport, and the selection or the world in figures."""

from collections.abc import Callable, Sequence
from functools import partial
from operator import attrgetter

import pygame
from imgui_bundle import imgui

from physicslab.languages.language import language
from physicslab.languages.sentence import Sentence
from physicslab.view.canvas.canvas import Canvas, Rect
from physicslab.view.controls.tools import TOOLS
from physicslab.view.toolkit.early_keys import EarlyKeys
from physicslab.view.toolkit.style import bar_height
from physicslab.view.toolkit.toolkit import Toolkit, Walk, is_for_files
from physicslab.view.toolkit.ui import Ui
from physicslab.view.toolkit.windows import LEAST_WORLD
from physicslab.view.window.window import Window
from physicslab.view.workbench import world_panel
from physicslab.view.workbench.about_panel import AboutPanel
from physicslab.view.workbench.context_menu import build_context
from physicslab.view.workbench.copies_panel import CopiesPanel
from physicslab.view.workbench.error_plot import build_error_plot
from physicslab.view.workbench.figures import Line, WorldFigures
from physicslab.view.workbench.file_browser import FileBrowser
from physicslab.view.workbench.file_panels import build_film, build_recovery, build_save
from physicslab.view.workbench.first_minute import CommandSearch, build_cards, build_tour
from physicslab.view.workbench.gallery import Gallery
from physicslab.view.workbench.impact_panel import build_impacts
from physicslab.view.workbench.inspector import build_inspector
from physicslab.view.workbench.instrument_panels import NotePanel, build_stopwatch
from physicslab.view.workbench.lesson_panel import LessonPanel
from physicslab.view.workbench.maker_panel import build_maker
from physicslab.view.workbench.menus import build_help, build_menu_bar, build_palette, palette_width
from physicslab.view.workbench.microscope_panel import build_microscope
from physicslab.view.workbench.number_field import NumberFields
from physicslab.view.workbench.scene_panels import ScenePanels
from physicslab.view.workbench.share_panel import build_share, build_sharing
from physicslab.view.workbench.thumbnails import Thumbnails
from physicslab.view.workbench.transport import build_history, build_transport
from physicslab.view.workbench.words_panel import build_words
from physicslab.world import World

# ---- the layout: the world first, panels around it ---------------------------------------------------------


_PALETTE, _SIDE, _TRANSPORT, _ICONS = 7.3, 16.7, 3.0, 2.5
"""Widths of palette and side panel, height of the transport, width of icons, in heights of the text."""
_WIDE = 44.0
"""Width of the world's room from which on windows stand at its sides, not below, in heights of the text."""
_LEAST_WITH_NAMES = 0.5
"""Share of the window's width that is left to the world where tools have their names, or they are icons."""
_MIN_WORLD = 0.34
"""Share of the window's width that is always left to the world: the side panel lies over it if it must."""


class Layout:
    """The rectangles of a window [px].

    Attributes
    ----------
    menu, palette, transport, side, room : Rect
        The menu bar, the tools, the transport, the panel at the right, and what is left for the world.
    names : bool
        Whether there is room for the names of tools.
    width : str
        Whether the world is ``"wide"`` beside the panel at the right, be it shown or not, or ``"narrow"``.
    """

    def __init__(self, size: tuple[int, int], text: int, *, side: bool, palette: float = 0.0) -> None:
        """Lay a window out for text of a height [px], with or without the panel at the right.

        The tools are as wide as their names ask for, ``palette`` [px], and usually wider.
        """
        width, height = size
        top, foot, left = bar_height(text), round(_TRANSPORT * text), round(max(_PALETTE * text, palette))
        beside = round(_SIDE * text)
        self.names = width - left - (beside if side else 0) >= _LEAST_WITH_NAMES * width
        if not self.names:
            left = round(_ICONS * text)
        right = beside if side else 0
        middle, across = max(height - top - foot, 1), width - left - right
        self.width = "wide" if width - left - beside >= _WIDE * text else "narrow"
        if across < _MIN_WORLD * width:
            across = width - left
        self.menu: Rect = (0, 0, width, top)
        self.palette: Rect = (0, top, left, middle)
        self.transport: Rect = (0, height - foot, width, foot)
        self.side: Rect = (width - right, top, right, middle)
        self.room: Rect = (left, top, max(across, 1), middle)

    @property
    def visible(self) -> Rect:
        """The part of the world's room that the panel at the right does not lie over [px]."""
        left, top, width, height = self.room
        return left, top, max(min(width, self.side[0] - left), 1), height


# ---- the panels --------------------------------------------------------------------------------------------


_PERIOD = 0.2
"""Time [s] after which panels are built again where nothing was done: faster digits cannot be read."""
_WAIT = 0.05
"""Time [s] for which new figures are not shown, so that one frame does not read and show them."""
_BESIDE = 12
"""How near to a panel a press makes no body: it may have been meant for that [px]."""
_WATCHED = attrgetter(
    "canvas.size", "context", "copying", "dashboard.state", "edits.history.branches", "error_study.shown",
    "figures", "filming.choosing", "filming.naming.refused", "help", "impacts.shown", "language", "level",
    "lists_history", "making.choosing", "making.naming.refused", "making.refused",
    "microscope.state", "pace.paused", "pace.speed", "scenes.recovery.offered",
    "scenes.shows_gallery", "search", "selection.entities", "sharing.choosing", "sharing.naming.refused",
    "shows_cards", "shows_stopwatch", "shows_words", "tool", "tour", "trust.state",
)  # fmt: skip
"""The state of a window that panels show beside figures."""
type _Build = Callable[[Ui, World, Window], None]
_BEFORE: dict[str, _Build] = {
    "shows_stopwatch": build_stopwatch, "impacts.shown": build_impacts, "microscope.record": build_microscope,
}  # fmt: skip
_AFTER: dict[str, _Build] = {
    "scenes.naming": build_save, "filming.choosing": build_film,
    "sharing.choosing": build_share, "making.choosing": build_maker,
    "lists_history": build_history, "shows_words": build_words, "help": build_help,
}  # fmt: skip
"""The builders of the panels that are open: those below others at first, and those above them."""
_BUTTONS = (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP)


class Interface:
    """The panels of a window. They change nothing: what a click is to do is put on ``Window.pending``.

    Parameters
    ----------
    window : Window
        The window as it is shown.

    Attributes
    ----------
    ui : Ui
        The panels built last: where each widget is, and all texts.
    toolkit : Toolkit
        The builder and painter of panels.
    """

    def __init__(self, window: Window) -> None:
        self._window = window
        self.toolkit = Toolkit()
        self._walk, self._early = Walk(self.toolkit), EarlyKeys()
        self.ui = Ui(self.toolkit.fonts, window.theme)
        self.ui.do_next = window.do_next
        self._numbers = NumberFields()
        self._thumbnails = Thumbnails()
        self._gallery, self._browser = Gallery(self._thumbnails), FileBrowser(self._thumbnails)
        self._search = CommandSearch()
        self._scene_panels = ScenePanels()
        self._copies, self._lesson = CopiesPanel(), LessonPanel()
        self._note, self._about = NotePanel(), AboutPanel()
        self._next = self._palette = 0.0
        self._figures: WorldFigures | None = None
        self._measured = 0
        self._offer_height = self._bar_height = (
            0  # of what is offered at the top of the room, and the first [px]
        )
        self._seen: tuple[object, ...] = ()
        self._free: Rect | None = None  # what docked windows leave of the world's room [px]
        self._arranged = "", ""  # for which width windows were arranged, and how
        self._fitted: tuple[object, ...] = ()  # for which sizes of window and text windows were docked
        self._built: tuple[object, ...] = ()  # for which they were built last

    def forget(self) -> None:
        """Drop all that is half written or dragged in panels: it was for a world that is shown no more."""
        self._numbers, self._note, self._about = NumberFields(), NotePanel(), AboutPanel()
        self._scene_panels.forget()
        self.ui.scenes += 1

    @property
    def text(self) -> int:
        """Height of the text [px]."""
        return self._window.drawing.size

    @property
    def layout(self) -> Layout:
        """The layout."""
        window = self._window
        return Layout(window.canvas.size, self.text, side=window.figures, palette=self._palette)

    def room(self) -> Rect:
        """Return what is left for the world [px]: no panel lies over it, and what is fitted to it is seen."""
        left, top, width, height = self.layout.visible if self._free is None else self._free
        bar = min(self._bar_height, height - 1)
        return left, top + bar, width, height - bar

    def small(self) -> tuple[Rect, ...]:
        """Return where meters and sliders are [px]."""
        return self._scene_panels.small

    @property
    def visible(self) -> Rect:
        """The part of the window where words can be drawn over the world: no panel covers it [px]."""
        left, top, width, height = self.layout.visible if self._free is None else self._free
        taken = min(self._offer_height, height - 1)
        return left, top + taken, width, height - taken

    @property
    def _opened(self) -> str:
        """The panel that keys are for, empty if they are for the world."""
        return self._window.in_front or ("" if self._window.measuring.writing is None else "note")

    def take(self, event: pygame.Event) -> bool:
        """Let panels have an event first; return whether the world is not to see it.

        A press in the world takes over what is half written in a field, before it selects anything else.
        """
        if event.type in (pygame.MOUSEMOTION, *_BUTTONS):
            self.toolkit.follow_pointer(event.pos)
        if self._early.take(event, self._opened):
            return True
        if self._search.take(self._window, event):
            return True
        self._walk.follow(event)
        if event.type in (pygame.KEYDOWN, pygame.MOUSEBUTTONDOWN):
            self.ui.writes_at_once = False
        taken = self.toolkit.take(event)
        gives_up = event.type == pygame.KEYDOWN and event.key == pygame.K_ESCAPE
        if gives_up and not taken and not self._opened:
            taken = self._numbers.drop_refused()
        self._early.follow(event, on_panel=taken)
        if event.type in (pygame.MOUSEMOTION, *_BUTTONS):
            self._window.pointer_beside_panel = self.toolkit.covers(event.pos, _BESIDE)
        if gives_up and taken:
            self._window.note_closed()
        saves = event.type == pygame.KEYDOWN and is_for_files(event)
        if (event.type == pygame.MOUSEBUTTONDOWN and not taken) or saves:
            refusal = self._finish_fields()
            if refusal:
                self._window.notify(refusal, 6.0, failed=True)
        return taken

    def _finish_fields(self) -> str:
        """Take over what is half written in a field, and return why it is refused; empty where it is not.

        Text for bodies that are shown no more is dropped.
        """
        self._begin_numbers()
        return self._numbers.finish() or self._note.finish(self._window) or self._about.finish(self._window)

    def _begin_numbers(self) -> None:
        self._numbers.begin((self._window.edits.world, self._window.selection.entities))

    def build(self, world: World, figures: WorldFigures, lines: Sequence[Line], elapsed: float) -> None:
        """Build panels where something may have changed since they were built last.

        Parameters
        ----------
        figures : WorldFigures
            Figures of the world.
        lines : sequence of Line
            Further lines, for those who measure and for engineers.
        elapsed : float
            Time [s] since the last frame.
        """
        window = self._window
        self.ui.language = window.canvas.language = language(window.language)
        width = self.layout.width
        if self._is_cramped():
            window.arrangements[width] = ""
        if (width, window.arrangements[width]) != self._arranged:
            self._arranged = width, window.arrangements[width]
            self.toolkit.arrange(window.arrangements[width])
            self.ui.rearrange(window.arrangements[width])
        self._follow_keys()
        seen = self._state(world)
        late, is_new, self._figures = window.now - self._next, figures is not self._figures, figures
        # Figures of forces are of the same step as their arrows.
        is_due = late >= (_WAIT if is_new else 0.0) or window.measured.number != self._measured
        self._measured = window.measured.number
        if seen != self._seen or is_due:
            if seen != self._seen:
                self.toolkit.wake()
            else:
                self.toolkit.refresh()
            self._seen, self._next = seen, window.now + _PERIOD

        def build() -> None:
            self.ui.begin(window.theme, self.layout.visible, is_narrow=width == "narrow")
            self._walk.mark()
            self._build(world, figures, lines)
            if window.edits.held and not imgui.is_any_item_active():
                window.do_next(lambda _, window: window.edits.release())

        if self.toolkit.frame(window.canvas.size, window.theme, float(self.text), elapsed, build):
            self._walk.end(is_alone=not window.in_front)
            self._built = window.canvas.size, self.text
            window.arrangements[width] = self.ui.arranged(self.toolkit.arrangement())
            self._arranged = width, window.arrangements[width]
        if self._early.advance(self._opened, typing=self.toolkit.typing):
            self.toolkit.wake()

    def _is_cramped(self) -> bool:
        """Whether docked windows leave the world no width since the text or the window has another size."""
        sizes, fitted = (self._window.canvas.size, self.text), self._fitted
        if sizes != self._built or sizes == fitted:
            return False
        self._fitted = sizes
        least = min(LEAST_WORLD * self.text, self.layout.visible[2])
        return bool(fitted) and self._free is not None and self._free[2] < least

    def _follow_keys(self) -> None:
        """Let keys go to a menu or a panel, if they are to."""
        window = self._window
        if window.keys_go_to == "fields" and not window.figures:
            window.figures = True  # and in the next frame the panel is there
            return
        self.ui.keys_go_to, window.keys_go_to = window.keys_go_to, ""
        self._walk.begin(self.ui.keys_go_to)
        self.ui.writes_at_once |= self.ui.keys_go_to == "panel"

    def _state(self, world: World) -> tuple[object, ...]:
        """Return what panels show beside figures."""
        window = self._window
        return (
            world, world.motion_edits, world.revision, world.time if window.pace.paused else None,
            window.error_study.share if window.error_study.running else None,
            window.sharing.share if window.sharing.running else None,
            window.scenes.naming and window.scenes.naming.refused, window.measuring.writing is None,
            window.lesson and window.lesson.state,
            window.scenes.opening and (window.scenes.opening.refused, window.scenes.opening.folder),
            *_WATCHED(window),
        )  # fmt: skip

    def _build(self, world: World, figures: WorldFigures, lines: Sequence[Line]) -> None:
        ui, window, layout = self.ui, self._window, self.layout
        free = ui.dock(layout.visible)
        self._free = free if free != layout.visible else None
        ui.room = self.visible
        self._begin_numbers()
        build_menu_bar(ui, world, window)
        self._palette = palette_width(ui)
        build_palette(ui, layout.palette, window, names=layout.names)
        build_transport(ui, layout.transport, world, window)
        if window.figures:
            with ui.panel("side", layout.side):
                world_panel.build_levels(ui, window)
                imgui.begin_disabled(window.lesson is not None)  # numbers can be looked at, not changed
                if window.selection.entities:
                    build_inspector(ui, self._numbers, world, window)
                else:
                    self._about.build(ui, world, window)
                    ui.gap(0.2)
                    world_panel.build_world(ui, world, figures, window)
                    drawn = TOOLS[window.tool].draws
                    if drawn is not None and drawn.by_recipe:
                        world_panel.build_recipe(ui, self._numbers, drawn, window)
                    if window.level == "Engineer":
                        world_panel.build_settings(ui, self._numbers, world, window)
                imgui.end_disabled()
                if window.level != "Explore":
                    ui.rule(0.3)
                    if window.selection.entities:
                        ui.heading("The world")
                    world_panel.build_figures(ui, lines, after_bars=not window.selection.entities)
                    ui.rule(0.3)
                    self._build_counts(ui, figures, window)
        self._scene_panels.build(ui, self._numbers, world, window, layout.visible, self.visible)
        self._copies.build(ui, world, window)
        build_context(ui, world, window)
        if window.lesson is not None:
            self._lesson.build(ui, window, window.lesson)
        for panel, build in _BEFORE.items():
            if window.is_open(panel):
                build(ui, world, window)
        if window.measuring.writing is not None:
            self._note.build(ui, window)
        self._build_offers(ui)
        build_error_plot(ui, window)
        if window.sharing.running:
            build_sharing(ui, window)
        for panel, build in _AFTER.items():
            if window.is_open(panel):
                build(ui, world, window)
        if window.search is not None:
            self._search.build(ui, world, window)
        if window.scenes.opening is not None:
            self._browser.build(ui, world, window)
        elif window.scenes.shows_gallery:
            self._gallery.build(ui, window)
        if (window.scenes.opening is not None or window.scenes.shows_gallery) and self._thumbnails.missing:
            self.toolkit.wake()

    def _build_offers(self, ui: Ui) -> None:
        """Build what is offered at the top of the world's room, one below the other."""
        window, (left, top, width, height) = self._window, self.layout.visible
        if self._free is not None:
            left, top, width, height = self._free
        self._offer_height = 0
        for shown, build in (
            (window.scenes.recovery.offered, build_recovery), (window.shows_cards, build_cards),
            (window.tour is not None, build_tour),
        ):  # fmt: skip
            if shown:
                free = left, top + self._offer_height, width, height - self._offer_height
                self._offer_height += build(ui, window, free)
            if build is build_recovery:  # a bar over all of the width, as those of the window
                self._bar_height = self._offer_height

    def _build_counts(self, ui: Ui, figures: WorldFigures, window: Window) -> None:
        """Write the numbers that say how much there is to do."""
        asleep = Sentence("{bodies}, {asleep} asleep", bodies=figures.bodies, asleep=figures.asleep)
        ui.row("Bodies", asleep if figures.asleep else f"{figures.bodies}")
        ui.row("Contacts", f"{figures.contacts}", "Pairs that touch", lesser=False)
        if window.level == "Engineer":
            ui.row("Candidate pairs", f"{figures.candidate_pairs}", "Pairs that are near each other")
            ui.row("Frame rate", f"{figures.frame_rate:.0f} FPS")

    def draw(self, canvas: Canvas) -> None:
        """Show panels as they were built last."""
        canvas.paint(partial(self.toolkit.pictures.show, overlays=self.ui.pictures))
        self._scene_panels.save_picture(self._window, self.toolkit)

    @property
    def covered(self) -> list[Rect]:
        """The rectangles of panels [px]."""
        return self.toolkit.covered
