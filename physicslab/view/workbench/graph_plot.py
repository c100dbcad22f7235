"""The plot of a graph: its lines, those of the run before, and its cursors."""

import math

import numpy as np
import pygame
from imgui_bundle import ImVec2, imgui, implot
from numpy.typing import NDArray

from physicslab.components.quantities import KIND_OF_UNIT, QUANTITIES
from physicslab.theme import Colour
from physicslab.view.canvas.keyboard import held_keys
from physicslab.view.canvas.quantities import ROUNDING, written_unit
from physicslab.view.controls import dashboard_actions
from physicslab.view.toolkit.axes import WEIGHT, finish_axes, line_look, pad_plot, plot_rect
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui
from physicslab.view.toolkit.windows import widget_label
from physicslab.view.window.dashboard import GraphShown
from physicslab.view.window.record import Key, Record, line_to_show, path_to_show, range_to_show, unbroken
from physicslab.view.window.window import Window
from physicslab.view.workbench.graph_readings import colours_of, line_name, scale_of
from physicslab.world import World

type _Numbers = NDArray[np.float64]
type _Drawn = tuple[_Numbers, _Numbers]

_AXES = (implot.ImAxis_.y1, implot.ImAxis_.y2, implot.ImAxis_.y3)
_FAINT = 0.35
"""Opacity of the run before."""
_POINTS, _OVER = 400, 0.8
"""Points and opacity of a curve that is fitted; moments have the same opacity."""
_CLICK = 4.0
"""A press that moves the mouse no further than this [px] is a click; further, it moves the plot."""
_BELOW = 2.6
"""Height of what is written below a plot, in heights of the text."""
_LABELLED = 5.0
"""Height of a plot from which on the axis of time has its name, in heights of the text."""


class GraphPlot:
    """One plot; what is drawn is made again only where it changed."""

    def __init__(self) -> None:
        self._drawn: dict[tuple[bool, Key], tuple[object, _Drawn]] = {}
        self._ranges: dict[implot.ImAxis_, tuple[object, tuple[float, float]]] = {}
        self._pressed: tuple[float, float] | None = None

    def build(self, ui: Ui, world: World, window: Window, graph: GraphShown, height: float) -> float | None:
        """Build it; return the time under the cursor [s], ``None`` where the cursor is elsewhere."""
        pad_plot(ui.size)
        flags = implot.Flags_.no_title | implot.Flags_.no_menus | implot.Flags_.no_legend
        flags |= implot.Flags_.no_mouse_text
        follows = graph.entity not in window.dashboard.free_axes
        implot.get_input_map().fit = -1  # a double click goes to the moment
        if not implot.begin_plot(f"##plot {graph.entity}", ImVec2(-1.0, height), flags):
            return None
        axis_of = self._set_up_axes(ui, graph, window, height - _BELOW * ui.size, follows=follows)
        self._draw_lines(ui, world, graph, window, axis_of)
        self._draw_moments(ui, world, window, graph, axis_of)
        hovered = self._follow_mouse(window, graph)
        ui.places.setdefault(f"Plot of graph {graph.number}", plot_rect())
        implot.end_plot()
        return hovered

    # ---- axes ----------------------------------------------------------------------------------------------

    def _set_up_axes(
        self, ui: Ui, graph: GraphShown, window: Window, height: float, *, follows: bool
    ) -> dict[Key, implot.ImAxis_]:
        """Set up an axis for each unit, three at most; return which axis each line has."""
        across = ui.said("time [s]") if graph.across is None else _heading(ui, [graph.across])
        if graph.across is None and height < _LABELLED * ui.size:
            across = ""  # the moment is written beside the plot, with its unit
        keys = [line.key for line in graph.lines]
        self._set_up(ui, implot.ImAxis_.x1, across, graph, window, keys, follows=follows)
        units = list(dict.fromkeys(QUANTITIES[key[1]].unit for key in keys))
        axis_of: dict[Key, implot.ImAxis_] = {}
        for n, axis in enumerate(_AXES[: max(len(units), 1)]):
            own = units[n:] if n == len(_AXES) - 1 else units[n : n + 1]
            mine = [key for key in keys if QUANTITIES[key[1]].unit in own]
            self._set_up(ui, axis, _heading(ui, mine, height), graph, window, mine, follows=follows)
            axis_of |= dict.fromkeys(mine, axis)
        ui.words += finish_axes(ui.language)
        return axis_of

    def _set_up(
        self, ui: Ui, axis: implot.ImAxis_, label: str, graph: GraphShown, window: Window,
        keys: list[Key], *, follows: bool,
    ) -> None:  # fmt: skip
        """Set up one axis; while it follows what is recorded it shows all of that."""
        flags = implot.AxisFlags_.none
        if axis in _AXES[1:]:
            flags = implot.AxisFlags_.opposite | implot.AxisFlags_.no_grid_lines
        implot.setup_axis(axis, label, flags)
        ui.words.append(label)
        if follows:
            low, high = self._range(axis, graph, window, keys)
            if axis == implot.ImAxis_.x1 and graph.across is None:
                low, high = window.dashboard.fitting.spans.get(graph.entity, (low, high))
            implot.setup_axis_limits(axis, low, high, implot.Cond_.always)

    def _range(
        self, axis: implot.ImAxis_, graph: GraphShown, window: Window, keys: list[Key]
    ) -> tuple[float, float]:
        """Return what an axis is to show of this run and of the one before."""
        records = window.dashboard.record, window.dashboard.before
        state = *(record.version for record in records), *map(id, records), graph.across, tuple(keys)
        kept = self._ranges.get(axis)
        if kept is not None and kept[0] == state:
            return kept[1]
        is_across = axis == implot.ImAxis_.x1
        if is_across and graph.across is None:
            times = [record.times[~np.isnan(record.values(key))] for record in records for key in keys]
            found = range_to_show([one for one in times if len(one)], room=0.0)
        else:
            shown = [graph.across] if is_across and graph.across is not None else keys
            sizes = [scale_of(key, window.scales) for key in shown]
            none = ROUNDING * max((size for size in sizes if math.isfinite(size)), default=0.0)
            found = range_to_show([record.values(key) for record in records for key in shown], none=none)
        self._ranges[axis] = state, found
        return found

    # ---- lines ---------------------------------------------------------------------------------------------

    def _draw_lines(
        self, ui: Ui, world: World, graph: GraphShown, window: Window, axis_of: dict[Key, implot.ImAxis_]
    ) -> None:
        dashboard = window.dashboard
        keys = set(graph.keys)
        self._drawn = {kept: drawn for kept, drawn in self._drawn.items() if kept[1] in keys}
        for line, colour in zip(graph.lines, colours_of(world, ui.theme, graph), strict=True):
            implot.set_axes(implot.ImAxis_.x1, axis_of[line.key])
            name = line_name(graph, line.key, window)
            ui.words.append(name)
            for is_before, record in ((True, dashboard.before), (False, dashboard.record)):
                x, y = self._points(graph, line.key, record, is_before=is_before)
                label = widget_label(name, f"{line.entity}{' before' if is_before else ''}")
                look = line_look(colour, WEIGHT * ui.size, _FAINT if is_before else 1.0)
                for part in unbroken(y):
                    is_point = len(y[part]) == 1  # as long as the run has a single moment
                    look.marker = implot.Marker_.circle if is_point else implot.Marker_.none
                    implot.plot_line(label, x[part], y[part], look)
                    if is_before:
                        ui.words.append(f"{name} before")
            self._draw_fit(ui, window, graph, line.key, widget_label(name, f"{line.entity} fitted"))

    @staticmethod
    def _draw_fit(ui: Ui, window: Window, graph: GraphShown, key: Key, label: str) -> None:
        """Draw the curve that is fitted to a line, over what is seen of the axis."""
        fitted = window.dashboard.fitted(graph, key)
        if fitted is not None:
            limits = implot.get_plot_limits()
            x = np.linspace(limits.x.min, limits.x.max, _POINTS)
            look = line_look(ui.theme.text, 0.5 * WEIGHT * ui.size, _OVER)
            implot.plot_line(label, x, np.ascontiguousarray(fitted.curve(x)), look)

    def _points(self, graph: GraphShown, key: Key, record: Record, *, is_before: bool) -> _Drawn:
        """Return the points of a line that can be seen."""
        limits, size = implot.get_plot_limits(), implot.get_plot_size()
        width, height = max(int(size.x), 1), max(int(size.y), 1)
        corners = (limits.x.min, limits.y.min, limits.x.max, limits.y.max)
        seen = corners if graph.across is not None else (limits.x.min, limits.x.max)
        state = id(record), record.version, graph.across, seen, width, height
        kept = self._drawn.get((is_before, key))
        if kept is not None and kept[0] == state:
            return kept[1]
        if graph.across is None:
            drawn = line_to_show(record.times, record.values(key), limits.x.min, limits.x.max, width)
        else:
            x, y = record.values(graph.across), record.values(key)
            x = np.where(np.isnan(y), np.nan, x)
            y = np.where(np.isnan(x), np.nan, y)
            drawn = path_to_show(x, y, corners[:2], corners[2:], (width, height))
        self._drawn[is_before, key] = state, drawn
        return drawn

    # ---- moments -------------------------------------------------------------------------------------------

    def _draw_moments(
        self, ui: Ui, world: World, window: Window, graph: GraphShown, axis_of: dict[Key, implot.ImAxis_]
    ) -> None:
        """Mark the moment shown, that under the cursor, and the cursors A and B."""
        dashboard, theme = window.dashboard, ui.theme
        moments: list[tuple[str, float | None, Colour]] = [
            ("", world.time, theme.faint), ("", dashboard.pointed, theme.accent),
            ("A", dashboard.marks[0], theme.accent), ("B", dashboard.marks[1], theme.accent),
        ]  # fmt: skip
        for n, (name, time, colour) in enumerate(moments):
            if time is None:
                continue
            place: tuple[float, float] | None
            if graph.across is None:
                place = time, implot.get_plot_limits().y.max
                spec = line_look(colour, 1.0, _OVER)
                spec.flags = implot.ItemFlags_.no_fit
                implot.plot_inf_lines(f"##moment {n}", np.array([time]), spec)
            else:
                place = _draw_point(graph, dashboard.record, time, colour, axis_of, f"{name}##{n}")
            if name and place is not None:
                _draw_letter(ui, place, name, colour)

    def _follow_mouse(self, window: Window, graph: GraphShown) -> float | None:
        """Set cursors by clicks, go to a moment by a double click; return the time under the cursor."""
        if not implot.is_plot_hovered():
            return None
        dashboard, io = window.dashboard, imgui.get_io()
        place = io.mouse_pos.x, io.mouse_pos.y
        if io.mouse_wheel or imgui.is_mouse_dragging(0, _CLICK):
            dashboard.free_axes.add(graph.entity)
        time = self._time_at_mouse(dashboard.record, graph)
        if time is None:
            return None
        if imgui.is_mouse_clicked(0):
            self._pressed = place
        if imgui.is_mouse_double_clicked(0):
            window.do_next(dashboard_actions.go_to, time)
            self._pressed = None
        if imgui.is_mouse_released(0) and self._pressed is not None:
            if math.dist(place, self._pressed) <= _CLICK:
                dashboard.marks[1 if held_keys() & pygame.KMOD_SHIFT else 0] = time
            self._pressed = None
        return time

    @staticmethod
    def _time_at_mouse(record: Record, graph: GraphShown) -> float | None:
        """Return the recorded moment nearest to the mouse: along the axis, or on the path that is nearest."""
        mouse = implot.get_plot_mouse_pos()
        if graph.across is None:
            row = record.nearest(mouse.x)
            return None if row is None else float(record.times[row])
        best, found = math.inf, None
        limits = implot.get_plot_limits()
        span = max(limits.x.max - limits.x.min, 1e-300), max(limits.y.max - limits.y.min, 1e-300)
        for line in graph.lines:
            apart = np.hypot(
                (record.values(graph.across) - mouse.x) / span[0],
                (record.values(line.key) - mouse.y) / span[1],
            )
            if np.isfinite(apart).any():
                row = int(np.nanargmin(apart))
                if apart[row] < best:
                    best, found = float(apart[row]), float(record.times[row])
        return found


def _draw_point(
    graph: GraphShown, record: Record, time: float, colour: Colour, axis_of: dict[Key, implot.ImAxis_],
    label: str,
) -> tuple[float, float] | None:  # fmt: skip
    """Mark a moment on the paths of a graph; return where it is on the first."""
    row, first = record.nearest(time), None
    if row is None or graph.across is None:
        return None
    x = float(record.values(graph.across)[row])
    for line in graph.lines:
        y = float(record.values(line.key)[row])
        if not (math.isfinite(x) and math.isfinite(y)):
            continue
        first = first or (x, y)
        implot.set_axes(implot.ImAxis_.x1, axis_of[line.key])
        spec = line_look(colour, 1.5)
        spec.marker, spec.marker_size, spec.flags = implot.Marker_.circle, 4.0, implot.ItemFlags_.no_fit
        implot.plot_scatter(f"##{label} {line.entity}", np.array([x]), np.array([y]), spec)
    return first


def _draw_letter(ui: Ui, place: tuple[float, float], letter: str, colour: Colour) -> None:
    """Write the letter of a cursor where it is, within the plot."""
    ui.words.append(f"cursor {letter}")
    limits, text = implot.get_plot_limits(), imgui.calc_text_size(letter)
    if not limits.x.min <= place[0] <= limits.x.max:
        return
    implot.set_axes(implot.ImAxis_.x1, implot.ImAxis_.y1)
    at, corner, size = implot.plot_to_pixels(*place), implot.get_plot_pos(), implot.get_plot_size()
    room = 0.25 * ui.size
    left = min(max(at.x - 0.5 * text.x, corner.x + room), corner.x + size.x - text.x - room)
    top = min(max(at.y - 1.4 * text.y, corner.y), corner.y + size.y - text.y)
    low, high = ImVec2(left - room, top), ImVec2(left + text.x + room, top + text.y)
    paper = implot.get_plot_draw_list()
    paper.add_rect_filled(low, high, packed(colour), room)
    paper.add_text(ImVec2(left, top), packed(ui.theme.background), letter)


def _heading(ui: Ui, keys: list[Key], room: float = math.inf) -> str:
    """Return what is written along an axis: quantities, or their kinds where that is shorter, with units.

    Where there is no room for that [px], units stand alone.
    """
    names = list(dict.fromkeys(key[1] for key in keys))
    units = list(dict.fromkeys(QUANTITIES[name].unit for name in names))
    ways = [", ".join(map(ui.said, way)) for way in (names, [KIND_OF_UNIT[unit] for unit in units])]
    written = ", ".join(map(written_unit, units))
    words = f"{min(ways, key=len) if len(names) > 1 else ways[0]} [{written}]"
    return words if names and imgui.calc_text_size(words).x <= room else written
