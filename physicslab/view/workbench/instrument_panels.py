"""Panels of instruments: the stopwatch of gates, and the field in which a note is written."""

import math
from collections.abc import Iterator, Sequence
from functools import partial

from imgui_bundle import ImVec2, imgui

from physicslab.components import Gate, Note
from physicslab.diagnostics.stopwatch import Lap, laps
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.text import printable, table_cell
from physicslab.languages.sentence import Sentence
from physicslab.state.attached import place_of
from physicslab.systems.gate import GateSystem
from physicslab.view.canvas.drawable_text import shortened
from physicslab.view.canvas.quantities import quantity
from physicslab.view.controls.measuring import keep_note
from physicslab.view.controls.saving import save_table
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.measuring import Writing
from physicslab.view.window.window import Window
from physicslab.world import World

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


def build_stopwatch(ui: Ui, world: World, window: Window) -> None:
    """Build it in a window of its own, beside the world."""
    system = world.schedule.find(GateSystem)
    gates = len(world.batch(Gate))
    every = laps(system.crossings, gates) if system is not None else []
    left, top, width, _ = ui.room
    place = left + 0.5 * width, top + 10.0 * ui.size
    ui.stand_beside("Stopwatch", "right", 0.34, 12.0)
    with ui.floating("Stopwatch", place, window.closing_of("shows_stopwatch"), docks=True):
        _build_times(ui, world, every, gates)
        across = imgui.get_content_region_avail().x if imgui.is_window_docked() else width
        columns = _COLUMNS if across > _width(_COLUMNS) * ui.size else _COLUMNS[_NARROW:]
        _build_table(ui, world, every[-(_ROWS if columns is _COLUMNS else _FEWER_ROWS) :], columns)
        table, tip = partial(crossing_rows, world), "Write all of them to a file"
        ui.button("CSV of crossings", tip, save_table, "crossings", table, shown="CSV", enabled=bool(every))


def _build_times(ui: Ui, world: World, every: Sequence[Lap], gates: int) -> None:
    """Write the last time in large, what it is of, and the mean of the last ones."""
    last = next((lap for lap in reversed(every) if lap.since is not None), None)
    seconds = None if last is None else last.seconds
    ui.heading("-" if seconds is None else quantity(seconds, "s"))
    ui.faint(_meaning(world, last, every, gates), wrapped=imgui.is_window_docked())
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
            return Sentence("Period of {body}", body=body)
        gates_of = _named(world, last.since.gate), _named(world, last.crossing.gate)
        return Sentence("{body}: {a} to {b}", body=body, a=gates_of[0], b=gates_of[1])
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


def crossing_rows(world: World) -> Iterator[tuple[object, ...]]:
    """Yield all crossings that are kept as rows of a table with a head, the first one first."""
    system = world.schedule.find(GateSystem)
    every = laps(system.crossings, len(world.batch(Gate))) if system is not None else []
    yield "time [s]", "gate", "body", "direction", "speed [m/s]", "since [s]"
    for lap in every:
        one, since = lap.crossing, "" if lap.seconds is None else lap.seconds
        names = table_cell(world.label(one.gate)), table_cell(world.label(one.body))
        yield one.time, *names, one.direction, one.speed, since


# ---- notes -------------------------------------------------------------------------------------------------


_WIDTH, _LINES = 17.0, 3
"""Size of the field, in heights of the text and in lines."""
_FLAGS = (
    imgui.WindowFlags_.no_title_bar | imgui.WindowFlags_.no_resize | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.always_auto_resize | imgui.WindowFlags_.no_nav | imgui.WindowFlags_.no_move
)  # fmt: skip
_SPEC = next(spec for spec in Note.FIELDS if spec.name == "text")


class NotePanel:
    """Keeps what is written from frame to frame; Enter or a click elsewhere keeps the note, Esc drops it."""

    def __init__(self) -> None:
        self._writing: Writing | None = None
        self._active = False

    def build(self, ui: Ui, window: Window) -> None:
        """Build the field at the place of the note."""
        writing = window.measuring.writing
        assert writing is not None
        fresh = writing is not self._writing
        if fresh:
            self._writing, self._active = writing, False
        room, (x, y) = imgui.get_io().display_size, window.camera.to_screen(writing.spot.place)
        size = ImVec2((_WIDTH + 2.0) * ui.size, (_LINES + 4.0) * ui.size)
        corner = max(min(x, room.x - size.x), 0.0), max(min(y, room.y - size.y), 0.0)
        imgui.set_next_window_pos(ImVec2(*corner))
        imgui.begin("a note", None, _FLAGS)
        if fresh:
            imgui.set_window_focus()
            imgui.set_keyboard_focus_here()
        text, active = ui.field(
            "Note", writing.text, _WIDTH * ui.size, wrong=bool(writing.refusal), lines=_LINES
        )
        escaped = imgui.is_key_pressed(imgui.Key.escape)
        if self._active and not active and escaped:
            window.measuring.writing = None
        elif active or not self._active:
            writing.text = text
        else:
            self._keep(window, writing)
        self._active = active
        ui.faint("Enter: keep   Ctrl+Enter: next line   Esc: drop", wrapped=False)
        ui.refusal(writing.refusal)
        imgui.end()

    def finish(self, window: Window) -> str:
        """Keep what is written because of a press beside it; return why it cannot be, empty where it can."""
        writing = window.measuring.writing
        refusal = "" if writing is None else self._keep(window, writing)
        window.measuring.kept = writing is not None and not refusal
        return refusal

    def _keep(self, window: Window, writing: Writing) -> str:
        try:
            _SPEC.check(writing.text)
        except InvalidValue as error:
            writing.refusal = f"must be {error.allowed}"
            self._writing = None  # so that it is written on
            return writing.refusal
        window.do_first(_finish, writing.text)
        return ""


def _finish(world: World, window: Window, text: str) -> None:
    command = keep_note(world, window, text)
    window.measuring.writing = None
    if command is not None:
        made = window.edits.do(command)
        window.selection.entities = made or window.selection.entities
