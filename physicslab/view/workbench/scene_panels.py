"""The panels that belong to the scene: graphs in windows of their own, meters and sliders in corners."""

import io

import pygame
from imgui_bundle import ImVec2, imgui

from physicslab.components import Graph
from physicslab.components.graph import TIME
from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.drawable_text import drawable
from physicslab.view.controls import dashboard_actions
from physicslab.view.toolkit.toolkit import Toolkit
from physicslab.view.toolkit.ui import Ui
from physicslab.view.toolkit.windows import widget_label
from physicslab.view.window.dashboard import GraphShown
from physicslab.view.window.record import Key
from physicslab.view.window.window import Window
from physicslab.view.workbench import graph_readings
from physicslab.view.workbench.graph_plot import GraphPlot
from physicslab.view.workbench.number_field import NumberFields
from physicslab.view.workbench.panel_places import bar_at_top, has_room, is_bar, places
from physicslab.view.workbench.small_panels import MeterPanels, SliderPanels
from physicslab.world import World

_FLAGS = imgui.WindowFlags_.no_collapse
_LEAST_PLOT = 6.0
"""Height of a plot at least, in heights of the text: what is below the rest can be scrolled to."""
_LEAST = (12.0, 9.0)
"""Width and height down to which a graph can be made by hand, in heights of the text."""


def owner_of(entity: int) -> str:
    """Return the name of a graph's window in Dear ImGui, without what is written as its title."""
    return widget_label("", f"graph {entity}")


class GraphPanels:
    """The windows of graphs. One that was moved by hand stays where it was put."""

    def __init__(self) -> None:
        self._put: dict[int, Rect] = {}
        self._moved: set[int] = set()
        self._plots: dict[int, GraphPlot] = {}

    def put_back(self) -> None:
        """Let every graph be put where it is at first, those that were moved or docked too."""
        self._put, self._moved = {}, set()

    def free(self, graphs: tuple[GraphShown, ...]) -> dict[int, str]:
        """Return the graphs that are put beside each other, and the side of each."""
        living = {graph.entity for graph in graphs}
        self._moved &= living
        self._put = {entity: rect for entity, rect in self._put.items() if entity in living}
        self._plots = {entity: plot for entity, plot in self._plots.items() if entity in living}
        return {graph.entity: graph.side for graph in graphs if graph.entity not in self._moved}

    def build(self, ui: Ui, world: World, window: Window, places: dict[int, Rect]) -> None:
        """Build every graph at its place."""
        pointed: float | None = None
        bar: Rect | None = None
        for graph in window.dashboard.graphs:
            place = places.get(graph.entity)
            if place is not None and is_bar(place, ui.size):
                self._put.pop(graph.entity, None)
                bar = place
                continue
            hovered = self._build(ui, world, window, graph, place)
            pointed = hovered if hovered is not None else pointed
        if bar is not None:
            _build_bar(ui, window, bar, places)
        window.dashboard.pointed = pointed

    def _build(
        self, ui: Ui, world: World, window: Window, graph: GraphShown, place: Rect | None
    ) -> float | None:
        """Build one; return the time under the cursor, if the cursor is in its plot."""
        entity = graph.entity
        title = _title(graph, window)
        known = imgui.internal.find_window_by_name(owner_of(entity))
        if known is not None and known.dock_id and ui.once != imgui.Cond_.always:
            self._moved.add(entity)  # a place would take it out of where it is docked
        elif place is not None and place != self._put.get(entity):
            when = imgui.Cond_.first_use_ever if known is None else imgui.Cond_.always
            imgui.set_next_window_pos(ImVec2(place[0], place[1]), when)
            imgui.set_next_window_size(ImVec2(place[2], place[3]), when)
            self._put[entity] = place
        room = imgui.get_io().display_size
        least = ImVec2(
            *(min(share * ui.size, px) for share, px in zip(_LEAST, (room.x, room.y), strict=True))
        )
        if place is not None:
            least = ImVec2(min(least.x, place[2]), min(least.y, place[3]))
        imgui.set_next_window_size_constraints(least, room)
        shown, stays = imgui.begin(widget_label(f"{title} ", f"graph {entity}"), True, _FLAGS)
        ui.words.append(drawable(title))
        hovered: float | None = None
        self._follow_hand(entity)
        if shown:
            self._build_head(ui, world, window, graph)
            graph_readings.build_cursors(ui, window, graph)
            graph_readings.build_readings(ui, world, window, graph)
            height = max(imgui.get_content_region_avail().y, _LEAST_PLOT * ui.size)
            plot = self._plots.setdefault(entity, GraphPlot())
            hovered = plot.build(ui, world, window, graph, height)
        imgui.end()
        if not stays:
            window.do_next(dashboard_actions.close_graph, graph)
        return hovered

    def _follow_hand(self, entity: int) -> None:
        """Note whether a graph was moved or resized by hand, and keep its title within the display."""
        place, size, room = imgui.get_window_pos(), imgui.get_window_size(), imgui.get_io().display_size
        put = self._put.get(entity)
        held = imgui.is_mouse_dragging(0) and imgui.is_window_focused()
        if held and put is not None and (place.x, place.y, size.x, size.y) != tuple(map(float, put)):
            self._moved.add(entity)
        x, y = max(min(place.x, room.x - size.x), 0.0), max(min(place.y, room.y - size.y), 0.0)
        if (x, y) != (place.x, place.y) and not imgui.is_window_docked():
            imgui.set_window_pos(ImVec2(x, y))

    def _build_head(self, ui: Ui, world: World, window: Window, graph: GraphShown) -> None:
        """Build the choice of lines, and what can be done with them."""
        number, dashboard = graph.number, window.dashboard
        with ui.list(f"Lines of graph {number}", "The plotted quantities", shown="Lines") as is_open:
            if is_open:
                self._build_lines(ui, world, window, graph)
        across = f"Across: {'time' if graph.across is None else graph.across[1]}"
        ui.same_line_if_room(across)
        tip = "The quantity on the horizontal axis: the time, or another one"
        with ui.list(f"Across graph {number}", tip, shown=across) as is_open:
            if is_open:
                self._build_across(ui, world, window, graph)
        ui.same_line_if_room("Follow")
        follows = graph.entity not in dashboard.free_axes
        tip = "Let the axes follow the recording; scroll or drag in the plot to look closer"
        if ui.button(f"Follow graph {number}", tip, shown="Follow", on=follows):
            dashboard.free_axes ^= {graph.entity}
        ui.same_line_if_room("More")
        with ui.list(f"More of graph {number}", "Cursors, files, place", shown="More") as is_open:
            if is_open:
                self._build_more(ui, world, window, graph)
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
        ui.item("Save as a table (CSV)", dashboard_actions.save_table, graph)
        if ui.item("Save as a picture (PNG)"):
            dashboard.picture_of = graph.entity
        ui.rule()
        other = "left" if graph.side == "right" else "right"
        if ui.item(f"Put it at the {other}"):
            body, name = graph.across or (None, TIME)
            window.do_next(dashboard_actions.change, graph.entity, Graph(name, body, other))


def _build_bar(ui: Ui, window: Window, bar: Rect, places: dict[int, Rect]) -> None:
    """Build what opens a graph, by its number, where there is room for one alone."""
    with ui.panel("bar of graphs", bar, padded=False, rounded=True):
        height = imgui.get_content_region_avail().y
        imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + 0.5 * (height - imgui.get_text_line_height()))
        ui.faint("Graph", wrapped=False)
        for graph in window.dashboard.graphs:
            place = places.get(graph.entity)
            if place is None:
                continue
            imgui.same_line()
            imgui.set_cursor_pos_y(0.5 * (bar[3] - height))
            tip, is_open = f"Open {_title(graph, window)}", not is_bar(place, ui.size)
            if ui.button(
                f"Open graph {graph.number}", tip, shown=f"{graph.number}", on=is_open, size=(0, height)
            ):
                window.dashboard.active = graph.entity


def _title(graph: GraphShown, window: Window) -> str:
    """Return what a graph shows, in a few words."""
    bodies = list(dict.fromkeys(key[0] for key in graph.keys))
    names = [window.dashboard.label(body) for body in bodies]
    subject = ", ".join(names) if len(names) <= 2 else f"{names[0]} and {len(names) - 1} others"
    return f"Graph {graph.number}: {subject}" if names else f"Graph {graph.number}"


class ScenePanels:
    """The panels of a scene, each at a place of its own."""

    def __init__(self) -> None:
        self._graphs = GraphPanels()
        self._meters = MeterPanels()
        self._sliders = SliderPanels()

    def build(self, ui: Ui, numbers: NumberFields, world: World, window: Window, area: Rect) -> None:
        """Build all that the scene has, within a part of the window."""
        dashboard = window.dashboard
        if ui.once == imgui.Cond_.always:
            self._graphs.put_back()
        if not dashboard.is_shown:
            return
        if not has_room(area, ui.size):
            _build_room_maker(ui, window, bar_at_top(area, ui.size))
            return
        small = [*self._meters.sizes(ui, world, window), *self._sliders.sizes(ui, window)]
        found = places(area, ui.size, self._graphs.free(dashboard.graphs), small, dashboard.active)
        self._meters.build(ui, world, window, found)
        self._sliders.build(ui, numbers, world, window, found)
        self._graphs.build(ui, world, window, found)

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
        tip = "There is no room for graphs here: this hides the panel at the right (I brings it back)"
        size = imgui.get_content_region_avail()
        if ui.button("Show graphs", tip, shown="Graphs", size=(size.x, size.y), enabled=window.figures):
            window.figures = False
