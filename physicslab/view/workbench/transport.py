"""The transport at the bottom: start again, step back, play, step, how fast time runs, and the time line."""

from __future__ import annotations

from imgui_bundle import ImVec2, imgui

from physicslab.view.canvas.canvas import Rect
from physicslab.view.controls import actions, file_actions
from physicslab.view.controls.icons import ICONS
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.pace import Pace
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["build_transport"]

_SPEEDS = {"4x": 4.0, "2x": 2.0, "1x": 1.0, "1/2x": 0.5, "1/4x": 0.25, "1/8x": 0.125, "1/16x": 0.0625}
_HINT = "Drag: throw  ·  Left: circle  ·  Right: box  ·  Space: pause  ·  F1: keys"
_HEIGHT, _NARROW, _WIDE = 1.9, 2.4, 5.2
"""Height of the buttons, and their widths, in heights of the text."""
_MIN_LINE = 12.0
"""Width of the time line below which the hint makes room, in heights of the text."""


def build_transport(ui: Ui, rect: Rect, world: World, window: Window) -> None:
    """Build the row of buttons, the time line and the hint."""
    with ui.panel("transport", rect, padded=False):
        pace, size, icons = window.pace, ui.size, ICONS
        height, narrow = _HEIGHT * size, _NARROW * size
        imgui.set_cursor_pos_y(max(0.5 * (rect[3] - height), 0.0))
        if ui.button(
            "Restart", "Start this scene again (Ctrl+R)", shown=icons["restart"], size=(narrow, height)
        ):
            window.deeds.append(file_actions.restart)
        imgui.same_line()
        if ui.button(
            "Step back", "Pause, and go back by one step (B)", shown=icons["back"], size=(narrow, height)
        ):
            window.deeds.append(actions.step_back)
        imgui.same_line()
        label, icon = ("Play", "play") if pace.paused else ("Pause", "pause")
        words = f"{icons[icon]}  {label}"
        if ui.button(label, f"{label} (Space)", shown=words, on=True, size=(_WIDE * size, height)):
            window.deeds.append(actions.toggle_pause)
        imgui.same_line()
        if ui.button("Step", "Pause, and make one step (.)", shown=icons["step"], size=(narrow, height)):
            window.deeds.append(actions.step)
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
        speed = _SPEEDS[chosen]

        def deed(world: World, window: Window) -> None:
            window.pace.choose(speed / window.pace.speed)

        window.deeds.append(deed)


def _build_line(ui: Ui, world: World, window: Window) -> None:
    """Build the line of the steps that were made, to be gone through by dragging, and the hint beside it."""
    room, hint = imgui.get_content_region_avail().x, imgui.calc_text_size(_HINT).x + ui.size
    is_hinted = room - hint > _MIN_LINE * ui.size
    history = window.edits.history
    first, last = history.steps_range
    width = room - hint if is_hinted else room
    place = ui.slider(
        "Time line", float(history.step_count), float(first), float(max(last, first + 1)),
        f"{world.time:.2f} s", width,
    )  # fmt: skip
    ui.tip("Drag to go back in time, and forward again; what is changed there begins another future")
    _mark_moments(ui, window, first, max(last, first + 1))
    if place is not None:
        step = round(place)
        window.deeds.append(lambda world, window: actions.seek(window, step))
    if is_hinted:
        imgui.same_line()
        ui.faint(_HINT, wrapped=False)


def _mark_moments(ui: Ui, window: Window, first: int, last: int) -> None:
    """Mark the moment under the cursor in a graph, and the cursors A and B, over the time line."""
    dashboard = window.dashboard
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    half = 0.5 * imgui.get_style().grab_min_size
    for time in (dashboard.pointed, *dashboard.marks):
        step = None if time is None else dashboard.step_at(time)
        if step is None or not first <= step <= last:
            continue
        x = low.x + half + (high.x - low.x - 2.0 * half) * (step - first) / (last - first)
        paper = imgui.get_window_draw_list()
        paper.add_line(ImVec2(x, low.y), ImVec2(x, high.y), packed(ui.theme.heading), 2.0)
        ui.words.append(f"mark at {time:.3f} s")
