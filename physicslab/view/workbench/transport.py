"""Play, pause and step at the bottom, the clock, and how fast time runs."""

from __future__ import annotations

from imgui_bundle import imgui

from physicslab.view.canvas.canvas import Rect
from physicslab.view.controls import actions, file_actions
from physicslab.view.controls.icons import ICONS
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.pace import Pace
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["build_transport"]

_SPEEDS = {"4x": 4.0, "2x": 2.0, "1x": 1.0, "1/2x": 0.5, "1/4x": 0.25, "1/8x": 0.125, "1/16x": 0.0625}
_HINT = "Drag a body to throw it  ·  Left: new circle  ·  Right: new box  ·  Space: pause  ·  F1: all keys"


def build_transport(ui: Ui, rect: Rect, world: World, window: Window) -> None:
    """Build the row of buttons, the clock and the hint."""
    with ui.panel("transport", rect, padded=False):
        pace, size = window.pace, ui.size
        height = 1.9 * size
        imgui.set_cursor_pos_y(max(0.5 * (rect[3] - height), 0.0))
        if ui.button(
            "Restart", "Start this scene again (Ctrl+R)", shown=ICONS["restart"], size=(2.4 * size, height)
        ):
            window.deeds.append(file_actions.restart)
        imgui.same_line()
        label, icon = ("Play", "play") if pace.paused else ("Pause", "pause")
        words = f"{ICONS[icon]}  {label}"
        if ui.button(label, f"{label} (Space)", shown=words, on=True, size=(5.2 * size, height)):
            window.deeds.append(actions.toggle_pause)
        imgui.same_line()
        if ui.button("Step", "Pause, and make one step (.)", shown=ICONS["step"], size=(2.4 * size, height)):
            window.deeds.append(actions.step)
        imgui.same_line()
        _build_speed(ui, pace, window)
        imgui.same_line()
        imgui.align_text_to_frame_padding()
        ui.text(f"{world.time:.2f} s")
        room = imgui.get_content_region_avail().x
        imgui.same_line(max(17.0 * size, 0.0) + 3.2 * size)
        if imgui.get_content_region_avail().x > imgui.calc_text_size(_HINT).x and room > 0:
            imgui.align_text_to_frame_padding()
            ui.faint(_HINT, wrapped=False)


def _build_speed(ui: Ui, pace: Pace, window: Window) -> None:
    now = next((name for name, speed in _SPEEDS.items() if speed == pace.speed), f"{pace.speed:g}x")
    imgui.push_style_var_y(imgui.StyleVar_.frame_padding, 0.5 * (1.9 * ui.size - imgui.get_font_size()))
    tip = "How fast time runs (Tab: a quarter; [ and ]: half and twice)"
    chosen = ui.choice("Speed", now, list(_SPEEDS), tip, width=4.6 * ui.size)
    imgui.pop_style_var()
    if chosen != now:
        speed = _SPEEDS[chosen]

        def deed(world: World, window: Window) -> None:
            window.pace.choose(speed / window.pace.speed)

        window.deeds.append(deed)
