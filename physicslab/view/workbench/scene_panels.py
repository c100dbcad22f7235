"""The panels that belong to the scene: graphs, meters and sliders."""

from __future__ import annotations

import io

import pygame
from imgui_bundle import imgui

from physicslab.view.canvas.canvas import Rect
from physicslab.view.controls import dashboard_actions
from physicslab.view.toolkit.toolkit import Toolkit
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window
from physicslab.view.workbench.graph_panel import GraphPanels, owner_of
from physicslab.view.workbench.meter_panel import MeterPanels
from physicslab.view.workbench.panel_places import bar_at_top, has_room, places
from physicslab.view.workbench.slider_panel import SliderPanels
from physicslab.world import World

__all__ = ["ScenePanels"]


class ScenePanels:
    """The panels of a scene, each at a place of its own."""

    def __init__(self) -> None:
        self._graphs = GraphPanels()
        self._meters = MeterPanels()
        self._sliders = SliderPanels()

    def build(self, ui: Ui, world: World, window: Window, area: Rect) -> None:
        """Build all that the scene has, within a part of the window."""
        dashboard = window.dashboard
        if ui.once == imgui.Cond_.always:
            self._graphs.put_back()
        if not dashboard.is_shown:
            return
        if not has_room(area, ui.size):
            _build_bar(ui, window, bar_at_top(area, ui.size))
            return
        small = [*self._meters.sizes(ui, world, window), *self._sliders.sizes(ui, window)]
        found = places(area, ui.size, self._graphs.free(dashboard.graphs), small, dashboard.active)
        self._meters.build(ui, world, window, found)
        self._sliders.build(ui, world, window, found)
        self._graphs.build(ui, world, window, found)

    def finish(self) -> str:
        """Take over what is half written in a field; return why it is refused, empty where it is not."""
        return self._sliders.finish()

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


def _build_bar(ui: Ui, window: Window, place: Rect) -> None:
    """Build a button that makes room where the panel at the right leaves none, as in a small window."""
    with ui.panel("bar of panels", place, padded=False, rounded=True):
        tip = "There is no room for graphs here: this hides the panel at the right (I brings it back)"
        size = imgui.get_content_region_avail()
        if ui.button("Show graphs", tip, shown="Graphs", size=(size.x, size.y), enabled=window.figures):
            window.figures = False
