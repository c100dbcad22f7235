"""Time: the transport at the bottom with the time line, and the history, a list to click."""

from imgui_bundle import ImVec2, imgui

from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.drawable_text import shortened
from physicslab.view.controls import actions, file_actions
from physicslab.view.controls.actions import branch_words, switch
from physicslab.view.controls.spawning import CIRCLE
from physicslab.view.controls.tool import ICONS
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.pace import Pace
from physicslab.view.window.window import Window
from physicslab.world import World

_SPEEDS = {"4x": 4.0, "2x": 2.0, "1x": 1.0, "1/2x": 0.5, "1/4x": 0.25, "1/8x": 0.125, "1/16x": 0.0625}
_HINT = "Drag: throw  ·  Left: circle  ·  Right: box  ·  Space: pause  ·  F1: keys"
_HINT_OF_TOOLS = "Drag: throw  ·  Right: box  ·  Space: pause  ·  F1: keys"
_HINT_OF_LESSONS = "Space: pause  ·  F6: next panel  ·  Esc: leave the lesson"
_HEIGHT, _NARROW, _WIDE = 1.9, 2.4, 5.2
"""Height of the buttons, and their widths, in heights of the text."""
_GRAB_PADDING = 2.0
"""The margin of Dear ImGui on each side of a slider's grab [px]."""
_MIN_LINE = 12.0
"""Width of the time line below which the hint makes room, in heights of the text."""


def build_transport(ui: Ui, rect: Rect, world: World, window: Window) -> None:
    """Build the row of buttons, the time line and the hint."""
    with ui.panel("transport", rect, padded=False):
        pace, size, icons = window.pace, ui.size, ICONS
        height = _HEIGHT * size
        imgui.set_cursor_pos_y(max(0.5 * (rect[3] - height), 0.0))
        run = ("Play", "Let time run (Space)", "play")
        play, why, icon = run if pace.paused else ("Pause", "Stop time (Space)", "pause")
        for label, tip, action, shown, width in (
            ("Restart", "Restart this scene (Ctrl+R)", file_actions.restart, icons["restart"], _NARROW),
            ("Step back", "Pause, and go back by one step (B)", actions.step_back, icons["back"], _NARROW),
            (play, why, actions.toggle_pause, f"{icons[icon]}  {ui.said(play)}", _WIDE),
            ("Step", "Pause, and make one step (.)", actions.step_once, icons["step"], _NARROW),
        ):
            ui.button(label, tip, action, shown=shown, on=width == _WIDE, size=(width * size, height))
            imgui.same_line()
        imgui.push_style_var_y(imgui.StyleVar_.frame_padding, 0.5 * (height - imgui.get_font_size()))
        _build_speed(ui, pace, window)
        imgui.same_line()
        _build_line(ui, world, window)
        imgui.pop_style_var()


def _build_speed(ui: Ui, pace: Pace, window: Window) -> None:
    now = next((name for name, speed in _SPEEDS.items() if speed == pace.speed), f"{pace.speed:g}x")
    tip = "How fast time runs (Tab: a quarter; [ and ]: half and twice)"
    chosen = ui.choice("Speed", now, list(_SPEEDS), tip, width=4.6 * ui.size)
    if chosen != now:
        window.do_next(lambda _, window: window.pace.choose(_SPEEDS[chosen] / window.pace.speed))


def _mark(ui: Ui, window: Window, first: int, last: int) -> None:
    """Draw marks over the time line, which was built last: where branches leave, and the moments of graphs.

    The moments are that under the cursor in a graph, and its cursors A and B.
    """
    low, high, dashboard = imgui.get_item_rect_min(), imgui.get_item_rect_max(), window.dashboard
    rim = _GRAB_PADDING + 0.5 * imgui.get_style().grab_min_size
    paper, half = imgui.get_window_draw_list(), 0.28 * ui.size

    def place_of(step: int | None) -> float | None:
        if step is None or not first <= step <= last:
            return None
        return low.x + rim + (high.x - low.x - 2.0 * rim) * (step - first) / (last - first)

    for n, branch in enumerate(window.edits.history.branches, start=1):
        if (x := place_of(branch.step)) is not None:
            corners = (ImVec2(x - half, low.y), ImVec2(x + half, low.y), ImVec2(x, low.y + 1.6 * half))
            paper.add_triangle_filled(*corners, packed(ui.theme.accent))
            ui.places[f"Branch {n}"] = round(x - half), round(low.y), round(2 * half), round(1.6 * half)
    for time in (dashboard.pointed, *dashboard.marks):
        x = None if time is None else place_of(dashboard.step_at(time))
        if x is not None:
            paper.add_line(ImVec2(x, low.y), ImVec2(x, high.y), packed(ui.theme.heading), 2.0)
            ui.words.append(f"mark at {time:.3f} s")


def _build_line(ui: Ui, world: World, window: Window) -> None:
    """Build the line of the steps that were made, to be gone through by dragging, and the hint beside it."""
    longest = _HINT if window.lesson is None else _HINT_OF_LESSONS
    words = _HINT_OF_TOOLS if window.lesson is None and window.tool != CIRCLE.name else longest
    if window.keys.chosen:  # the hint names usual keys
        words = longest = ""
    room, hint = imgui.get_content_region_avail().x, ui.width(longest) + ui.size
    is_hinted = room - hint > _MIN_LINE * ui.size
    history = window.edits.history
    first, last = history.steps_range
    width = room - hint if is_hinted else room
    place = ui.slider(
        "Time line", float(history.step_count), float(first), float(max(last, first + 1)),
        f"{world.time:.2f} s", width,
    )  # fmt: skip
    ui.tip(
        "Drag to go back in time, and forward again; a change there begins another branch. "
        "A mark shows where one begins (Ctrl+B goes there)"
    )
    _mark(ui, window, first, max(last, first + 1))
    if place is not None:
        window.do_next(actions.seek, round(place))
    if is_hinted:
        imgui.same_line()
        ui.faint(words, wrapped=False)


# ---- the history -------------------------------------------------------------------------------------------


_LIST_WIDTH, _LIST_HEIGHT, _LINE = 17.0, 20.0, 1.5
"""Size of the lists, and height of a line of the lower one, in heights of the text."""
_LETTERS = 34
"""How much of a branch is written in its line; the rest is in its tip."""


def build_history(ui: Ui, world: World, window: Window) -> None:
    """Build the list in a window of its own."""
    history = window.edits.history
    entries, done = history.entries, history.position
    left, top, _, _ = window.framing.room()
    width, height = ui.fitted(_LIST_WIDTH * ui.size, _LIST_HEIGHT * ui.size)
    place = left + 0.5 * width + ui.size, top + 0.5 * height + 4.0 * ui.size
    ui.stand_beside("History", "right", 0.3, 8.0)
    with ui.floating("History", place, window.closing_of("lists_history"), docks=True):
        ui.button(
            "Undo",
            "Undo one thing: the last edit, the last throw, or the run since Play (Ctrl+Z)",
            actions.undo,
            enabled=done > 0,
        )
        imgui.same_line()
        ui.button("Redo", "Redo what was undone (Ctrl+Y)", actions.redo, enabled=done < len(entries))
        below = _LINE * (len(history.branches) + 2) * ui.size if history.branches else 0.0
        room = ui.extent(width, height)
        if imgui.begin_child("entries", ImVec2(room.x, max(room.y - below, 3.0 * ui.size))):
            ui.selectable("As it was opened", _go_to, 0, on=done == 0, faint=False)
            for n, entry in enumerate(entries, start=1):
                line = f"{n}. {ui.said(entry.words)}"
                ui.selectable(line, _go_to, n, on=n == done, faint=not entry.done)
        imgui.end_child()
        _build_branches(ui, window)


def _build_branches(ui: Ui, window: Window) -> None:
    """Build a line for each branch: when it leaves what is listed above, and what was done in it."""
    history = window.edits.history
    if not history.branches:
        return
    ui.rule()
    ui.heading("Other branches")
    ui.tip("Edits and runs that a change in the past replaced; Ctrl+B switches from one to the next")
    for n, branch in enumerate(history.branches, start=1):
        words = ui.said(branch_words(branch, history.start))
        ui.selectable(f"{n}. {shortened(words, _LETTERS)}", switch, branch)
        ui.tip(words)


def _go_to(world: World, window: Window, entry: int) -> None:
    """Take back or put back edits and runs until so many are done."""
    history = window.edits.history
    window.pause_for_history(world)
    while history.position > entry and history.undo() is not None:
        pass
    while history.position < entry and history.redo() is not None:
        pass
