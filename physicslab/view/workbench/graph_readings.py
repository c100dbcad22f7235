"""Readings beside a plot: each line with its value, slopes and areas; menus to choose a quantity from."""

from collections.abc import Callable, Iterable
from contextlib import nullcontext

import numpy as np
from imgui_bundle import ImVec2, imgui

from physicslab.components import Spring, Transform, Velocity
from physicslab.components.quantities import (
    BODY_QUANTITIES,
    JOINT_QUANTITIES,
    QUANTITIES,
    SPRING_QUANTITIES,
    WORLD_QUANTITIES,
)
from physicslab.diagnostics.quantities import why_undefined
from physicslab.languages.sentence import Sentence
from physicslab.state.joint_rows import KINDS
from physicslab.theme import Colour, Theme, mixed
from physicslab.view.canvas.quantities import (
    product,
    quantity,
    quotient,
    with_error,
    without_rounding,
    written_unit,
)
from physicslab.view.controls import dashboard_actions
from physicslab.view.picture.bodies import named_colour
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.dashboard import GraphShown
from physicslab.view.window.record import Key, area_between, slope_between
from physicslab.view.window.window import Window
from physicslab.world import World

# ---- menus from which a quantity of a body, or of the world, is chosen -------------------------------------


_OFFERED = 24
"""Bodies that a menu lists beside those that are selected or shown already."""


def _grouped(names: Iterable[str]) -> dict[str, list[str]]:
    """Return names by the group in which a menu has them."""
    groups: dict[str, list[str]] = {}
    for name in names:
        groups.setdefault(QUANTITIES[name].group, []).append(name)
    return groups


def _quantities(world: World, entity: int | None) -> dict[str, list[str]]:
    """Return the quantities of an entity, or of the world for ``None``, by group."""
    if entity is None:
        return _grouped(WORLD_QUANTITIES)
    names = BODY_QUANTITIES if world.has(entity, Transform) else ()
    names += JOINT_QUANTITIES if any(world.has(entity, kind) for kind in KINDS) else ()
    return _grouped(names + (SPRING_QUANTITIES if world.has(entity, Spring) else ()))


def unit_of(key: Key) -> str:
    """Return the unit of a quantity, as people write it."""
    return written_unit(QUANTITIES[key[1]].unit)


def scale_of(key: Key, scales: dict[str, float]) -> float:
    """Return how large a quantity is where it is not rounding; 0 of accounts, whose rounding is shown."""
    quantity = QUANTITIES[key[1]]
    return 0.0 if quantity.group else scales.get(quantity.unit, 0.0)


def named_key(key: Key, window: Window) -> str:
    """Return what a quantity is called, with its body: ``"ball: speed"``."""
    body = window.dashboard.label(key[0])
    return Sentence("{body}: {quantity}", body=body, quantity=Sentence(key[1]))


def build_quantities(
    ui: Ui, world: World, window: Window, shown: Iterable[Key], choose: Callable[[Key], None]
) -> None:
    """Build a menu for the world and for each body, joint and spring, a line for each of its quantities.

    Parameters
    ----------
    shown : iterable of Key
        The marked ones: they are chosen already.
    choose : callable
        Called with what is clicked.
    """
    marked = set(shown)
    for body in (None, *_offered(world, window, marked)):
        name = "The world" if body is None else world.label(body)
        with ui.menu(name, f"quantities of {body}") as is_open:
            if not is_open:
                continue
            for group, quantities in _quantities(world, body).items():
                with ui.menu(group) if group else nullcontext(True) as is_unfolded:
                    for quantity in quantities if is_unfolded else ():
                        key = (body, quantity)
                        if ui.item(f"{quantity} [{unit_of(key)}]", on=key in marked):
                            choose(key)


def _offered(world: World, window: Window, marked: set[Key]) -> list[int]:
    """Return what a menu offers: what is shown or selected, what moves, other bodies, joints and springs."""
    chosen = [*(body for body, _ in sorted(marked, key=str)), *window.selection.entities]
    moving, placed = world.batch(Transform, Velocity), world.batch(Transform)
    offered = [*moving.entities[:_OFFERED].tolist(), *placed.entities[:_OFFERED].tolist()]
    holding = [entity for kind in (*KINDS, Spring) for entity in world.batch(kind).entities.tolist()]
    there = {*placed.entities.tolist(), *holding}
    every = *chosen, *offered[:_OFFERED], *holding[:_OFFERED]
    bodies = dict.fromkeys(body for body in every if body in there)
    return [body for body in bodies if body is not None]


# ---- readings ----------------------------------------------------------------------------------------------


_VALUE = "-0.0000"
"""As wide as most values are: what follows stays in its place while they change."""
_PALE, _DIM, _TINT = 0.45, 0.65, 0.6
"""Share of a colour in its tints: what a body's second line has, its third, and those that follow."""
_GREY, _TOLD_APART = (0.86, 0.55), 24
"""The shares where its second line would differ from its first by less than so much of a channel (of 255)."""
_MARK = 1.1
"""Length of the mark in a line's colour, in heights of the text."""


def colours_of(world: World, theme: Theme, graph: GraphShown) -> list[Colour]:
    """Return the colour of each line: that of its body, in turn for those of the world; tints of the same."""
    found: list[Colour] = []
    for n, line in enumerate(graph.lines):
        body = line.key[0]
        colour = own = theme.body(n) if body is None else named_colour(world, theme, body)
        pale = mixed(theme.text, own, _PALE)
        tints = pale, mixed(theme.panel, own, _DIM)
        if max(abs(a - b) for a, b in zip(pale, own, strict=True)) < _TOLD_APART:  # black among black letters
            tints = mixed(theme.panel, own, _GREY[0]), mixed(theme.panel, own, _GREY[1])
        for tint in tints:
            colour = tint if colour in found else colour
        while colour in found and colour != theme.text:
            colour = mixed(theme.text, colour, _TINT)
        found.append(colour if colour != theme.text else own)
    return found


def line_name(graph: GraphShown, key: Key, window: Window) -> str:
    """Return what a line is called: its body too, where lines are of several."""
    alone = len({other[0] for other in graph.keys}) == 1
    return key[1] if alone else named_key(key, window)


def build_words(ui: Ui, world: World, window: Window, graph: GraphShown) -> None:
    """Build what is written beside the plot of a graph: its cursors, if there are any, and its lines."""
    build_cursors(ui, window, graph)
    build_readings(ui, world, window, graph)


def build_readings(ui: Ui, world: World, window: Window, graph: GraphShown) -> None:
    """Write every line with its colour, and its value at the moment under the cursor or at that shown.

    A curve that is fitted, or between two cursors slope and area, are written in place of the value.
    """
    dashboard = window.dashboard
    row = dashboard.record.nearest(world.time if dashboard.pointed is None else dashboard.pointed)
    if not graph.lines:
        ui.faint("Lines: choose what is plotted")
        return
    spans = _fits(window, graph) or _spans(window, graph)
    style = imgui.get_style()
    used, room, scales = 0.0, imgui.get_content_region_avail().x, window.scales
    for colour, key in _entries(ui, world, graph):
        name = line_name(graph, key, window)
        if spans is not None:
            if colour is not None:
                _entry(ui, colour, name, spans[key], wrapped=True)
            continue
        value, usual = _value(world, window, key, row, scales), f"{_VALUE} {unit_of(key)}"
        width = (_MARK + 0.4) * ui.size if colour is not None else 0.0
        width += ui.width(f"{ui.said(name)} ")
        width += max(ui.width(usual), ui.width(value))
        if used and used + width <= room:
            imgui.same_line(used + style.window_padding.x)
        else:
            used = 0.0
        used += width + 0.8 * ui.size
        _entry(ui, colour, name, value)


def build_moment(ui: Ui, world: World, window: Window) -> None:
    """Write of which moment the values are, at the right of the row that was begun, or below it."""
    record, pointed = window.dashboard.record, window.dashboard.pointed
    row = record.nearest(world.time if pointed is None else pointed)
    if row is None:
        return
    past = window.dashboard.past
    words = f"t {record.times[row]:.3f} s" if past is None else f"the past: {past.share:.0%}"
    imgui.same_line()
    room = imgui.get_content_region_avail().x - ui.width(words)
    if room < 0.0:
        imgui.new_line()
    else:
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + room)
        imgui.align_text_to_frame_padding()
    ui.text(words)


def _entries(ui: Ui, world: World, graph: GraphShown) -> list[tuple[Colour | None, Key]]:
    """Return what is across, and every line with its colour."""
    across: list[tuple[Colour | None, Key]] = [] if graph.across is None else [(None, graph.across)]
    colours = colours_of(world, ui.theme, graph)
    return [*across, *((colour, line.key) for colour, line in zip(colours, graph.lines, strict=True))]


def _entry(ui: Ui, colour: Colour | None, name: str, value: str, *, wrapped: bool = False) -> None:
    if colour is not None:
        corner, height = imgui.get_cursor_screen_pos(), imgui.get_text_line_height()
        low = ImVec2(corner.x, corner.y + 0.5 * height - 0.1 * ui.size)
        high = ImVec2(corner.x + _MARK * ui.size, low.y + 0.2 * ui.size)
        imgui.get_window_draw_list().add_rect_filled(low, high, packed(colour), 0.1 * ui.size)
        imgui.dummy(ImVec2(_MARK * ui.size, height))
        imgui.same_line(0.0, 0.4 * ui.size)
    ui.faint(name, wrapped=False)
    imgui.same_line(0.0, imgui.calc_text_size(" ").x)
    if wrapped and ui.width(value) > imgui.get_content_region_avail().x:
        imgui.new_line()
    ui.text(value, wrapped=wrapped)


def _value(world: World, window: Window, key: Key, row: int | None, scales: dict[str, float]) -> str:
    """Return a value in words, or the reason why it is missing."""
    record = window.dashboard.record
    value = np.nan if row is None else float(record.values(key)[row])
    if np.isnan(value):
        why = why_undefined(world, key[1], key[0])
        return f"({why})" if why else "not recorded"
    words = quantity(without_rounding(value, scale_of(key, scales)), unit_of(key))
    is_gone = key[0] is not None and key[0] not in world.entity_index.row_of
    return f"{words} (gone)" if is_gone and world.time >= record.times[-1] else words


def build_cursors(ui: Ui, window: Window, graph: GraphShown) -> None:
    """Build a button for each cursor that is set, which goes to its moment; and what clears them."""
    marks = window.dashboard.marks
    if marks == [None, None]:
        return
    for name, time in zip("AB", marks, strict=True):
        words = ("Shift-click: B" if name == "B" else "Click: A") if time is None else f"{name} {time:.3f} s"
        if name == "B":
            ui.same_line_if_room(words)
        if time is None:
            imgui.align_text_to_frame_padding()
            ui.faint(words, wrapped=False)
        elif ui.button(f"Go to {name} in graph {graph.number}", "Pause, and go to this moment", shown=words):
            window.do_next(dashboard_actions.go_to, time)
    ui.same_line_if_room("Clear")
    if ui.button(f"Clear cursors in graph {graph.number}", "Remove the cursors A and B", shown="Clear"):
        marks[:] = [None, None]
    a, b = marks
    if a is not None and b is not None:
        words = f"B - A {b - a:.3f} s"
        ui.same_line_if_room(words)
        imgui.align_text_to_frame_padding()
        ui.text(words)


def _spans(window: Window, graph: GraphShown) -> dict[Key, str] | None:
    """Return of each line its slope and its area between the cursors in words; ``None`` without two."""
    dashboard = window.dashboard
    record, (a, b) = dashboard.record, dashboard.marks
    first, last = (None if time is None else record.nearest(time) for time in (a, b))
    if first is None or last is None:
        return None
    across = record.times if graph.across is None else record.values(graph.across)
    unit = "s" if graph.across is None else QUANTITIES[graph.across[1]].unit
    found: dict[Key, str] = {}
    for line in graph.lines:
        values, own = record.values(line.key), QUANTITIES[line.key[1]].unit
        slope = slope_between(across, values, first, last)
        area = area_between(across, values, first, last)
        if np.isnan(slope) and np.isnan(area):
            found[line.key] = "not recorded from A to B"
            continue
        words = "slope not defined" if np.isnan(slope) else f"slope {_words(slope, quotient(own, unit))}"
        more = "not all recorded" if np.isnan(area) else f"area {_words(area, product(own, unit))}"
        found[line.key] = f"{words}, {more}"
    return found


def _fits(window: Window, graph: GraphShown) -> dict[Key, str] | None:
    """Return the curve that is fitted to each line in words; ``None`` if the graph fits none."""
    dashboard = window.dashboard
    if graph.entity not in dashboard.fitting.kinds:
        return None
    unit = "s" if graph.across is None else QUANTITIES[graph.across[1]].unit
    found: dict[Key, str] = {key: "" for key in graph.keys}
    for line in graph.lines:
        fitted, own = dashboard.fitted(graph, line.key), QUANTITIES[line.key[1]].unit
        if fitted is None:
            found[line.key] = "no such curve fits"
            continue
        parts = []
        for one in fitted.parameters:
            of = own if one.up else unit
            for _ in range(-one.across):
                of = quotient(of, unit)
            parts.append(f"{one.name} {with_error(one.value, one.error, written_unit(of))}")
        parts.append(f"leaves {_words(fitted.rest, own)} (rms)")
        found[line.key] = ", ".join(parts)
    return found


def _words(value: float, unit: str) -> str:
    return quantity(value, written_unit(unit)).rstrip()
