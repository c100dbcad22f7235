"""The panels that belong to the scene: graphs in windows of their own, meters and sliders in corners."""

import io

import pygame
from imgui_bundle import ImVec2, imgui

from physicslab.components import Graph
from physicslab.components.graph import TIME
from physicslab.diagnostics.fits import FITS
from physicslab.ecs.sentences import listed
from physicslab.languages.sentence import Sentence
from physicslab.view.canvas.canvas import Rect
from physicslab.view.controls import dashboard_actions
from physicslab.view.toolkit.toolkit import Toolkit
from physicslab.view.toolkit.ui import Ui
from physicslab.view.toolkit.windows import keep_inside, widget_label
from physicslab.view.window.dashboard import GraphShown
from physicslab.view.window.fitting import gate_span
from physicslab.view.window.record import Key
from physicslab.view.window.window import Window
from physicslab.view.workbench import graph_readings
from physicslab.view.workbench.graph_plot import GraphPlot
from physicslab.view.workbench.number_field import NumberFields
from physicslab.view.workbench.panel_places import Small, bar_at_top, covered, has_room, is_crowded, places
from physicslab.view.workbench.small_panels import MeterPanels, SliderPanels
from physicslab.world import World

_FLAGS = imgui.WindowFlags_.no_collapse | imgui.WindowFlags_.no_focus_on_appearing
_LEAST_PLOT = 8.5
"""Height of a plot, in heights of the text, below which it takes all the room and readings stand below."""
_ROOMY, _PER_LINE = (15.0, 10.0), 1.4
"""Width and height of a graph, and height for each line, with which its readings stand above the plot [text
heights]; in less room the plot comes first, and the readings below it can be scrolled to."""
_SHARE = 0.45
"""Share of the world's room that the first graph takes."""
_LEAST = (15.0, 12.0)
"""Least width of graphs beside each other, and height of those below each other, in heights of the text."""
_SIZE = (27.0, 20.0)
"""Width and height of a graph that lies over the world, in heights of the text."""


def owner_of(entity: int) -> str:
    """Return the name of a graph's window in Dear ImGui, without what is written as its title."""
    return widget_label("", f"graph {entity}")


class GraphPanels:
    """The windows of graphs: beside the world at their sides, unless they were moved by hand."""

    def __init__(self) -> None:
        self._sides: dict[int, str] = {}
        self._plots: dict[int, GraphPlot] = {}

    def build(self, ui: Ui, world: World, window: Window) -> None:
        """Build every graph."""
        graphs = window.dashboard.graphs
        self._sides = {graph.entity: self._sides.get(graph.entity, graph.side) for graph in graphs}
        self._plots = {graph.entity: self._plots.get(graph.entity) or GraphPlot() for graph in graphs}
        pointed = [self._build(ui, world, window, graph) for graph in graphs]
        window.dashboard.pointed = next((time for time in reversed(pointed) if time is not None), None)

    def _build(self, ui: Ui, world: World, window: Window, graph: GraphShown) -> float | None:
        """Build one; return the time under the cursor, if the cursor is in its plot."""
        entity, title = graph.entity, ui.said(_title(graph, window))
        is_sent, self._sides[entity] = self._sides[entity] != graph.side, graph.side
        ui.stand_beside(owner_of(entity), graph.side, _SHARE, _LEAST[graph.side == "right"], again=is_sent)
        room = imgui.get_io().display_size
        imgui.set_next_window_size(ImVec2(_SIZE[0] * ui.size, _SIZE[1] * ui.size), imgui.Cond_.first_use_ever)
        imgui.set_next_window_size_constraints(ImVec2(0.0, 0.0), room)
        shown, stays = imgui.begin(widget_label(f"{title} ", f"graph {entity}"), True, _FLAGS)
        ui.words.append(title)
        ui.raise_tab()
        hovered: float | None = None
        keep_inside(ImVec2(0.0, 0.0), room)
        if shown:
            free, wanted = imgui.get_content_region_avail(), _ROOMY[1] + _PER_LINE * len(graph.lines)
            is_roomy = free.x >= _ROOMY[0] * ui.size and free.y >= wanted * ui.size
            self._build_head(ui, world, window, graph, is_roomy=is_roomy)
            if is_roomy:
                graph_readings.build_words(ui, world, window, graph)
            free, words = imgui.get_content_region_avail(), 0.0
            if not is_roomy:
                words = (len(graph.lines) + 1) * imgui.get_text_line_height_with_spacing()
            height = free.y - words
            if height < _LEAST_PLOT * ui.size:
                height = free.y + imgui.get_style().window_padding.y  # no line below is seen in half
            hovered = self._plots[entity].build(ui, world, window, graph, height)
            if not is_roomy:
                graph_readings.build_moment(ui, world, window)
                graph_readings.build_words(ui, world, window, graph)
        imgui.end()
        if not stays:
            window.do_next(dashboard_actions.close_graph, graph)
        return hovered

    def _build_head(self, ui: Ui, world: World, window: Window, graph: GraphShown, *, is_roomy: bool) -> None:
        """Build the choice of lines, and what can be done with them: one row where there is little room."""
        number, dashboard = graph.number, window.dashboard
        with ui.list(f"Lines of graph {number}", "The plotted quantities", shown="Lines") as is_open:
            if is_open:
                self._build_lines(ui, world, window, graph)
        across = f"Across: {'time' if graph.across is None else graph.across[1]}"
        tip = "The quantity on the horizontal axis: the time, or another one"
        follows, follow = graph.entity not in dashboard.free_axes, f"Follow graph {number}"
        if is_roomy:
            ui.same_line_if_room(across)
            with ui.list(f"Across graph {number}", tip, shown=across) as is_open:
                if is_open:
                    self._build_across(ui, world, window, graph)
            ui.same_line_if_room("Follow")
            tip = "Let the axes follow the recording; scroll or drag in the plot to look closer"
            if ui.button(follow, tip, shown="Follow", on=follows):
                dashboard.free_axes ^= {graph.entity}
        words = "More" if is_roomy else "..."
        ui.same_line_if_room(words)
        with ui.list(f"More of graph {number}", "Cursors, fits, files, place", shown=words) as is_open:
            if is_open and not is_roomy:
                with ui.menu(across) as is_unfolded:
                    if is_unfolded:
                        self._build_across(ui, world, window, graph)
                if ui.item(follow, shown="Follow the recording", on=follows):
                    dashboard.free_axes ^= {graph.entity}
                ui.rule()
            if is_open:
                self._build_more(ui, world, window, graph)
        if is_roomy:
            graph_readings.build_moment(ui, world, window)

    @staticmethod
    def _build_lines(ui: Ui, world: World, window: Window, graph: GraphShown) -> None:
        def choose(key: Key) -> None:
            window.do_next(dashboard_actions.toggle_line, graph, key)

        gone = [line.key for line in graph.lines if line.key[0] not in (None, *world.entity_index.row_of)]
        for key in gone:
            if ui.item(f"Remove: {graph_readings.named_key(key, window)}", on=True, identity=f"remove {key}"):
                choose(key)
        graph_readings.build_quantities(ui, world, window, [line.key for line in graph.lines], choose)

    @staticmethod
    def _build_across(ui: Ui, world: World, window: Window, graph: GraphShown) -> None:
        def choose(key: Key | None) -> None:
            window.dashboard.free_axes.discard(graph.entity)
            body, name = key or (None, TIME)
            window.do_next(dashboard_actions.change, graph.entity, Graph(name, body, graph.side))

        if ui.item("Time [s]", on=graph.across is None):
            choose(None)
        graph_readings.build_quantities(ui, world, window, [graph.across] if graph.across else [], choose)

    @staticmethod
    def _build_more(ui: Ui, world: World, window: Window, graph: GraphShown) -> None:
        dashboard = window.dashboard
        for n, name in enumerate("AB"):
            if ui.item(f"Cursor {name} at the moment shown"):
                dashboard.marks[n] = world.time
        if ui.item("No cursors", enabled=dashboard.marks != [None, None]):
            dashboard.marks[:] = [None, None]
        ui.rule()
        fitting, entity = dashboard.fitting, graph.entity
        for kind in FITS:
            if ui.item(f"Fit a {kind}", on=fitting.kinds.get(entity) == kind):
                fitting.kinds[entity] = kind
        if ui.item("No fit", enabled=entity in fitting.kinds):
            del fitting.kinds[entity]
        span = gate_span(world, (key[0] for key in graph.keys))
        if ui.item("From gate to gate", enabled=span is not None) and span is not None:
            dashboard.marks[:], fitting.spans[entity] = span, span
            dashboard.free_axes.discard(entity)
        if ui.item("All of the time", enabled=entity in fitting.spans):
            del fitting.spans[entity]
        ui.rule()
        with ui.menu("Listen", f"listen to graph {graph.number}") as is_open:
            for key in graph.keys if is_open else ():
                name = graph_readings.line_name(graph, key, window)
                ui.item(f"Listen: {name}", dashboard_actions.listen, key, shown=name, tip=_LISTEN)
        ui.item("Save as a table (CSV)", dashboard_actions.save_table, graph)
        if ui.item("Save as a picture (PNG)"):
            dashboard.picture_of = graph.entity
        ui.rule()
        other = "left" if graph.side == "right" else "right"
        if ui.item(f"Put it at the {other}"):
            body, name = graph.across or (None, TIME)
            window.do_next(dashboard_actions.change, graph.entity, Graph(name, body, other))


_LISTEN = "The line as a tone: the higher it is, the higher the tone; a tick where it crosses zero"


def _title(graph: GraphShown, window: Window) -> str:
    """Return what a graph shows, in a few words."""
    bodies = list(dict.fromkeys(key[0] for key in graph.keys))
    names = [window.dashboard.label(body) for body in bodies]
    if not names:
        return Sentence("Graph {n}", n=graph.number)
    subject: str = Sentence("{body} and {n} others", body=names[0], n=len(names) - 1)
    if len(names) <= 2:
        subject = listed("and", names)
    return Sentence("Graph {n}: {what}", n=graph.number, what=subject)


class ScenePanels:
    """The panels of a scene, each at a place of its own.

    Attributes
    ----------
    small : tuple of Rect
        Where meters and sliders are [px].
    """

    def __init__(self) -> None:
        self.small: tuple[Rect, ...] = ()
        self._graphs = GraphPanels()
        self._meters = MeterPanels()
        self._sliders = SliderPanels()

    def build(
        self, ui: Ui, numbers: NumberFields, world: World, window: Window, whole: Rect, area: Rect
    ) -> None:
        """Build all that the scene has, in the ``whole`` room of the world; meters lie in ``area``."""
        dashboard = window.dashboard
        has_graphs = not dashboard.graphs or has_room(whole, ui.size)
        if has_graphs:
            self._graphs.build(ui, world, window)
        has_small, self.small = bool(dashboard.meters or dashboard.sliders), ()
        if has_graphs and not has_small:
            return
        if not has_graphs or not has_room(area, ui.size):
            _build_room_maker(ui, window, bar_at_top(area, ui.size))
            return
        small = self._small(ui, world, window, flat=False)
        if is_crowded(area, small):
            small = self._small(ui, world, window, flat=True)
        found = places(area, ui.size, small)
        if window.figures and covered(found.values()):
            _build_room_maker(ui, window, bar_at_top(area, ui.size))
            return
        self.small = tuple(found.values())
        self._meters.build(ui, world, window, found)
        self._sliders.build(ui, numbers, world, window, found)

    def _small(self, ui: Ui, world: World, window: Window, *, flat: bool) -> list[Small]:
        return [*self._meters.sizes(ui, world, window, flat=flat), *self._sliders.sizes(ui, window)]

    def forget(self) -> None:
        """Drop what is dragged or half written in panels, and how wide they were."""
        self._meters, self._sliders = MeterPanels(), SliderPanels()

    @staticmethod
    def save_picture(window: Window, toolkit: Toolkit) -> None:
        """Write the picture of a graph that is wanted, as it is painted."""
        entity, window.dashboard.picture_of = window.dashboard.picture_of, None
        graph = next((one for one in window.dashboard.graphs if one.entity == entity), None)
        picture = None if graph is None else toolkit.picture_of(owner_of(graph.entity))
        if graph is None or picture is None:
            return
        content = io.BytesIO()
        pygame.image.save(picture, content, "graph.png")
        dashboard_actions.save_picture(window.edits.world, window, graph, content.getvalue())


def _build_room_maker(ui: Ui, window: Window, place: Rect) -> None:
    """Build a button that makes room where the panel at the right leaves none, as in a small window."""
    with ui.panel("bar of panels", place, padded=False, rounded=True):
        tip = "There is no room for them here: this hides the panel at the right (I brings it back)"
        size, words = imgui.get_content_region_avail(), "Graphs" if window.dashboard.graphs else "Meters"
        if ui.button("Show meters", tip, shown=words, size=(size.x, size.y), enabled=window.figures):
            window.figures = False
