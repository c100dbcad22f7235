"""The field in which a note is written, at its place in the world."""

from __future__ import annotations

from imgui_bundle import ImVec2, imgui

from physicslab.components import Note
from physicslab.ecs.fields import InvalidValue
from physicslab.view.controls.measuring import keep_note
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.measuring import Writing
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["NotePanel"]

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
        if writing.refusal:
            ui.text(writing.refusal, ui.theme.error, wrapped=True)
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
