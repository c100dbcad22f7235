"""The offer of what a session that ended without closing has left."""

from __future__ import annotations

from imgui_bundle import imgui

from physicslab.ecs.fields import InvalidValue
from physicslab.files.scene import SceneError
from physicslab.view.canvas.canvas import Rect
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["build_recovery"]


def restore_session(world: World, window: Window) -> None:
    """Open what the session on offer has left; where that fails, all stays as it is."""
    try:
        window.next_world = window.recovery.restore()
    except (SceneError, InvalidValue, OSError) as error:
        window.notify(f"Not restored: {error}", 8.0, failed=True)
    else:
        window.pace.paused = True
        window.notify("Restored, and paused: Space goes on")


def discard_session(world: World, window: Window) -> None:
    """Remove what the session on offer has left."""
    window.recovery.discard()


_OFFERS = {"Restore it": restore_session, "Discard": discard_session}
_PAD = 6
"""Room around the words [px]."""


def build_recovery(ui: Ui, window: Window, free: Rect) -> int:
    """Build words and two buttons at the top of what is free, and return how high they are [px].

    They stand in one line where that is wide enough. Keys stay with the scene that runs.
    """
    left, top, width, _ = free
    style, words = imgui.get_style(), window.recovery.words
    room = width - 2 * _PAD
    gap, line = style.item_spacing, imgui.get_frame_height()
    buttons = [imgui.calc_text_size(label).x + 2 * style.frame_padding.x for label in _OFFERS]
    in_line = imgui.calc_text_size(words).x + sum(buttons) + len(buttons) * gap.x <= room
    beside = sum(buttons) + gap.x <= room
    if in_line:
        height = line
    else:
        rows = 1 if beside else len(buttons)
        height = imgui.calc_text_size(words, wrap_width=room).y + rows * (line + gap.y)
    with ui.panel("recovery", (left, top, width, round(height) + 2 * _PAD), padded=False):
        if in_line:
            imgui.align_text_to_frame_padding()
        ui.text(words, ui.theme.notice, wrapped=not in_line)
        for n, (label, action) in enumerate(_OFFERS.items()):
            if in_line or (beside and n):
                imgui.same_line()
            if ui.button(label):
                window.do_next(action)
    return round(height) + 2 * _PAD
