"""Graphs in windows of their own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from imgui_bundle import ImVec2, ImVec4, imgui, implot

from physicslab.ecs.text import printable
from physicslab.files.new_scene import file_stem
from physicslab.files.replace import create_file
from physicslab.view.canvas.theme import Colour
from physicslab.view.controls.scene_files import new_paths
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.graphs import Graph
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["build_graphs"]

_SIZE = (27.0, 15.0)
"""Width and height of a new graph, in heights of the text."""
_GAP = 0.8
"""Room between two, in heights of the text."""


def build_graphs(ui: Ui, window: Window) -> None:
    """Build every graph, and drop those that were closed."""
    closed = [graph for n, graph in enumerate(window.graphs) if not _build(ui, graph, n, window)]
    for graph in closed:
        window.graphs.remove(graph)


def _build(ui: Ui, graph: Graph, number: int, window: Window) -> bool:
    """Build one, and return whether it stays."""
    left, top, width, height = window.room()
    rows = max(int((height - ui.size) / ((_SIZE[1] + _GAP) * ui.size)), 1)
    across = left + width - (number // rows + 1) * (_SIZE[0] + _GAP) * ui.size
    imgui.set_next_window_pos(
        ImVec2(max(across, left), top + (_GAP + number % rows * (_SIZE[1] + _GAP)) * ui.size),
        ui.once,
    )
    imgui.set_next_window_size(ImVec2(_SIZE[0] * ui.size, _SIZE[1] * ui.size), ui.once)
    shown, stays = imgui.begin(f"{graph.title}##graph {graph.number}", True, imgui.WindowFlags_.no_collapse)
    ui.words.append(graph.title)
    if shown:
        _build_head(ui, graph, window)
        _build_plot(ui, graph, window.edits.world.time)
    imgui.end()
    return bool(stays)


def _build_head(ui: Ui, graph: Graph, window: Window) -> None:
    """Build the choice of lines, and what can be done with them."""
    if ui.button(f"Lines of {graph.title}", "What is plotted", shown="Lines"):
        imgui.open_popup("lines")
    if imgui.begin_popup("lines"):
        for quantity in graph.quantities:
            if ui.item(f"{quantity.name} [{quantity.unit}]", on=quantity.name in graph.chosen):
                graph.toggle(quantity.name)
        imgui.end_popup()
    imgui.same_line()
    if ui.button(
        f"Follow {graph.title}", "Let the axes follow what is recorded", shown="Follow", on=graph.follows
    ):
        graph.follows = not graph.follows
    imgui.same_line()
    if ui.button(f"CSV of {graph.title}", "Write what is shown to a file", shown="CSV"):
        window.deeds.append(lambda world, window: _save(graph, world, window))


def _build_plot(ui: Ui, graph: Graph, now: float) -> None:
    units = {quantity.name: quantity.unit for quantity in graph.quantities}
    shown = list(dict.fromkeys(units[name] for name in graph.chosen))
    flags = implot.Flags_.no_title | implot.Flags_.no_menus
    if not implot.begin_plot(f"##plot {graph.number}", ImVec2(-1.0, -1.0), flags):
        return
    fit = implot.AxisFlags_.auto_fit if graph.follows else implot.AxisFlags_.none
    implot.setup_axes("time [s]", ", ".join(shown), fit, fit)
    implot.setup_legend(implot.Location_.north_west)
    for n, (name, line) in enumerate(graph.chosen.items()):
        colour = ui.theme.bodies[n % len(ui.theme.bodies)]
        old = graph.before.get(name)
        if old is not None and len(old.times):
            implot.plot_line(f"{name} before", old.times, old.values, _look(colour, 0.35))
        if len(line.times):
            implot.plot_line(name, line.times, line.values, _look(colour, 1.0))
        ui.words.append(name)
    implot.plot_inf_lines("##now", np.array([now]), _look(ui.theme.faint, 0.8))
    if implot.is_plot_hovered() and (imgui.get_io().mouse_wheel or imgui.is_mouse_dragging(0)):
        graph.follows = False
    implot.end_plot()


def _look(colour: Colour, opacity: float) -> implot.Spec:
    spec = implot.Spec()
    red, green, blue = colour
    spec.line_color, spec.line_weight = ImVec4(red / 255, green / 255, blue / 255, opacity), 2.0
    return spec


def _save(graph: Graph, world: World, window: Window) -> None:
    """Write a graph to a new file where the program was started, and say what came of it."""
    stem = file_stem(f"{world.name or 'graph'}-{graph.title}")
    content = graph.csv().encode("utf-8")
    for path in new_paths(Path.cwd(), stem, ".csv"):
        try:
            create_file(path, content)
        except FileExistsError:
            continue
        except OSError as error:
            window.notify(f"The graph could not be saved: {error.strerror or error}", 6.0, failed=True)
            return
        window.notify(f"Saved {printable(str(path))}")
        return
