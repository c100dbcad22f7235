"""The title of a scene and its notes in the panel: read there, and written there."""

from imgui_bundle import imgui

from physicslab.files.checks import SceneError
from physicslab.files.reader import checked_scene_text
from physicslab.history import SetText
from physicslab.view.controls.tool import ICONS
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window
from physicslab.world import World

_LINES = 5
"""Lines of the field of notes."""
_FIELDS = {"title": ("Title", 1), "description": ("Notes on the scene", _LINES)}


class AboutPanel:
    """Keeps what is written from frame to frame; Enter or a click elsewhere keeps it, Esc drops it."""

    def __init__(self) -> None:
        self._written: dict[str, str] = {}
        self._refused: dict[str, str] = {}
        self._fresh = self._active = False

    def build(self, ui: Ui, world: World, window: Window) -> None:
        """Build the texts, or the fields in which they are written."""
        if self._written:
            self._build_fields(ui, world, window)
            return
        ui.heading(world.title or world.name or "Untitled scene")
        begun = self._is_clicked(ui)
        for line in world.description.splitlines():
            ui.faint(line)
            begun = self._is_clicked(ui) or begun
        words = f"{ICONS['note']}  Title and notes"
        if ui.button("Title and notes", "Write what the scene is called and what it is about", shown=words):
            begun = True
        if begun:
            self._written = {key: getattr(world, key) for key in _FIELDS}
            self._refused, self._fresh, self._active = {}, True, False

    def _is_clicked(self, ui: Ui) -> bool:
        ui.tip("Click to change it")
        return bool(imgui.is_item_clicked())

    def _build_fields(self, ui: Ui, world: World, window: Window) -> None:
        is_active = False
        for key, (label, lines) in _FIELDS.items():
            if self._fresh:
                imgui.set_keyboard_focus_here()
                self._fresh = False
            ui.faint(label, wrapped=False)
            text, active = ui.field(label, self._written[key], wrong=key in self._refused, lines=lines)
            is_active |= active
            if active or not self._active:
                self._written[key] = text
            ui.refusal(self._refused.get(key, ""))
        ui.faint("Enter: keep   Esc: drop")
        if self._active and not is_active:
            if imgui.is_key_pressed(imgui.Key.escape):
                self._written = {}
            elif not imgui.is_key_pressed(imgui.Key.tab):
                self._keep(world, window)
        self._active = is_active

    def finish(self, window: Window) -> str:
        """Keep what is written because of a press beside it; return why it cannot be, empty where it can."""
        return self._keep(window.edits.world, window)

    def _keep(self, world: World, window: Window) -> str:
        self._refused = {}
        for key, text in self._written.items():
            try:
                checked_scene_text(key, text.strip(), "")
            except SceneError as error:
                self._refused[key] = str(error)
        if not self._refused:
            changed = {key: text.strip() for key, text in self._written.items()}
            window.do_first(_change, {key: new for key, new in changed.items() if new != getattr(world, key)})
            self._written = {}
        return next(iter(self._refused.values()), "")


def _change(world: World, window: Window, texts: dict[str, str]) -> None:
    words = "title and notes of the scene" if len(texts) > 1 else ""
    window.edits.do_all([SetText(key, text) for key, text in texts.items()], words)
