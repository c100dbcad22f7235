"""The offer of what a session that ended without closing has left."""

from __future__ import annotations

from imgui_bundle import imgui

from physicslab.view.controls.recovery_actions import discard_session, restore_session
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window

__all__ = ["build_recovery"]


def build_recovery(ui: Ui, window: Window) -> None:
    """Build a line of words and two buttons at the top of the world; keys stay with the scene that runs."""
    left, top, width, _ = window.room()
    height = round(2.6 * ui.size)
    with ui.panel("recovery", (left, top, width, height), padded=False):
        imgui.align_text_to_frame_padding()
        ui.text(f"  {window.recovery.words}", ui.theme.notice)
        imgui.same_line()
        if ui.button("Restore it"):
            window.deeds.append(restore_session)
        imgui.same_line()
        if ui.button("Discard"):
            window.deeds.append(discard_session)
