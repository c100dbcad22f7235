"""The stopwatch: when bodies crossed gates, and the times between."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence

from imgui_bundle import ImVec2, imgui

from physicslab.components import Gate
from physicslab.diagnostics.stopwatch import Lap, laps
from physicslab.ecs.text import printable, table_cell
from physicslab.state.attached import place_of
from physicslab.systems.gate import GateSystem
from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.drawable_text import shortened
from physicslab.view.canvas.quantities import quantity
from physicslab.view.controls.file_actions import save_new
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["build_stopwatch", "crossings_csv"]

_ROWS = 6
_FEWER_ROWS = 3
"""Crossings that are shown, the last ones first; and where there is little room."""
_COLUMNS = (("Gate", 5.0), ("Body", 5.4), ("", 1.3), ("Time", 4.4), ("Since", 4.4))
"""Their heads, and their widths in heights of the text."""
_NARROW = 2
"""Columns that are left out where there is little room for the world."""
_MARGIN = 4.0
"""The margin of the window around its columns, in heights of the text."""
_LETTERS = 11
_MEAN = 10
"""How many of the last times are taken together."""
_ARROWS = "→↗↑↖←↙↓↘"


def build_stopwatch(ui: Ui, world: World, window: Window, room: Rect) -> None:
    """Build it in a window of its own, which begins in a corner of the room [px] where no graph is."""
    system = world.schedule.find(GateSystem)
    gates = len(world.batch(Gate))
    every = laps(system.crossings, gates) if system is not None else []
    left, top, width, _ = room
    columns = _COLUMNS if width > _width(_COLUMNS) * ui.size else _COLUMNS[_NARROW:]
    half = 0.5 * _width(columns) * ui.size
    is_taken = any(graph.side == "right" for graph in window.dashboard.graphs)
    place = left + half if is_taken else left + width - half, top + 10.0 * ui.size
    with ui.floating("Stopwatch", place) as stays:
        _build_times(ui, world, every, gates)
        _build_table(ui, world, every[-(_ROWS if columns is _COLUMNS else _FEWER_ROWS) :], columns)
        if ui.button("CSV of crossings", "Write all of them to a file", shown="CSV", enabled=bool(every)):
            window.do_next(_save)
    if not stays[0]:
        window.shows_stopwatch = False


def _build_times(ui: Ui, world: World, every: Sequence[Lap], gates: int) -> None:
    """Write the last time in large, what it is of, and the mean of the last ones."""
    last = next((lap for lap in reversed(every) if lap.since is not None), None)
    seconds = None if last is None else last.seconds
    ui.heading("-" if seconds is None else quantity(seconds, "s"))
    ui.faint(_meaning(world, last, every, gates), wrapped=False)
    alike = [
        lap.seconds
        for lap in every
        if last is not None and lap.seconds is not None and _way(lap) == _way(last)
    ][-_MEAN:]
    if len(alike) > 1:
        ui.row(f"Mean of the last {len(alike)}", quantity(math.fsum(alike) / len(alike), "s"))


def _way(lap: Lap) -> tuple[int, int, int]:
    """Return what laps have in common that measure the same: the body, and from where to where."""
    return lap.crossing.body, lap.crossing.gate, lap.since.gate if lap.since is not None else 0


def _meaning(world: World, last: Lap | None, every: Sequence[Lap], gates: int) -> str:
    if last is not None and last.since is not None:
        body = _named(world, last.crossing.body)
        if gates == 1:
            return f"Period of {body}"
        return f"{body}: {_named(world, last.since.gate)} to {_named(world, last.crossing.gate)}"
    if not gates:
        return "Draw a gate for bodies to cross"
    if not every:
        return "Nothing has crossed yet"
    return "Until it crosses again, the same way" if gates == 1 else "Until it crosses another gate"


def _width(columns: Sequence[tuple[str, float]]) -> float:
    return sum(width for _, width in columns) + _MARGIN


def _build_table(ui: Ui, world: World, rows: Sequence[Lap], columns: Sequence[tuple[str, float]]) -> None:
    cells = (
        (
            _named(world, one.gate), _named(world, one.body), arrow_of(world, one.gate, one.direction),
            quantity(one.time, "s"), "" if lap.seconds is None else quantity(lap.seconds, "s"),
        )[-len(columns) :]
        for lap in reversed(rows) for one in (lap.crossing,)
    )  # fmt: skip
    ui.table(f"{len(columns)} columns", columns, cells)
    imgui.dummy(ImVec2(1.0, 0.2 * ui.size))


def _named(world: World, entity: int) -> str:
    return shortened(printable(world.label(entity)), _LETTERS)


def arrow_of(world: World, gate: int, direction: int) -> str:
    """Return an arrow that points to where something came out of a gate."""
    if not world.has(gate, Gate):
        return ""
    way = place_of(world, gate, Gate, "end") - place_of(world, gate, Gate, "start")
    angle = way.angle + direction * 0.5 * math.pi if way else 0.0
    return _ARROWS[round(angle / (0.25 * math.pi)) % 8]


def crossings_csv(world: World) -> str:
    """Return all crossings that are kept as a table, the first one first."""
    system = world.schedule.find(GateSystem)
    every = laps(system.crossings, len(world.batch(Gate))) if system is not None else []
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["time [s]", "gate", "body", "direction", "speed [m/s]", "since [s]"])
    for lap in every:
        one, seconds = lap.crossing, lap.seconds
        since = "" if seconds is None else repr(seconds)
        names = table_cell(world.label(one.gate)), table_cell(world.label(one.body))
        writer.writerow([repr(one.time), *names, one.direction, repr(one.speed), since])
    return text.getvalue()


def _save(world: World, window: Window) -> None:
    """Write the crossings to a new file."""
    save_new(window, world, "crossings", ".csv", crossings_csv(world).encode("utf-8"))
