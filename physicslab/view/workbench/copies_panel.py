"""The panel of many copies: how they lie, and their numbers; what it shows is drawn as outlines meanwhile."""

from dataclasses import replace

from imgui_bundle import imgui

from physicslab.view.controls.copies import make_copies
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.copying import WAYS, Copying
from physicslab.view.window.window import Window
from physicslab.view.workbench.number_field import NumberFields
from physicslab.world import World

_WORDS = {"count": "How many", "upward": "Upwards"}
_WIDTH, _FROM_BELOW = 15.0, 7.5
"""Its width, and how far its middle is from the lower edge of the world's room, in heights of the text."""


def shown_name(name: str) -> str:
    """Return the words of a field."""
    return _WORDS.get(name, name.capitalize())


class CopiesPanel:
    """The panel of copies, with keys in its first field; text half written is kept from frame to frame."""

    def __init__(self) -> None:
        self._numbers = NumberFields()

    def build(self, ui: Ui, world: World, window: Window) -> None:
        """Build it at the left of the world; it closes where nothing is selected any more."""
        copying = window.copying
        if copying is None:
            return
        if not window.selection.bodies(world):
            window.do_next(lambda _, window: window.put("copying", None))
            return
        left, top, _, height = ui.room
        place = left + (0.5 * _WIDTH + 1.5) * ui.size, top + height - _FROM_BELOW * ui.size
        with ui.floating("Copies", place, window.closing_of("copying")):
            self._numbers.begin((world, window.selection.entities))
            way = ui.choice("way", copying.way, WAYS, width=_WIDTH * ui.size)
            if way != copying.way:
                window.do_next(lambda _, window: window.put("copying", replace(copying, way=way)))
            if imgui.is_window_appearing():
                ui.keys_go_to = "fields"
            for name in Copying.OF[copying.way]:
                self._row(ui, window, copying, name)
            count = len(copying.offsets) + 1
            tip, shown = "As one edit; Enter does so too", f"Make them: {count} in all"
            ui.button("Make copies", tip, make_copies, shown=shown)

    def _row(self, ui: Ui, window: Window, copying: Copying, name: str) -> None:
        spec = Copying.FIELDS[name]

        def commit(new: float) -> None:
            value = round(new) if spec.kind == "whole" else new
            spec.check(value)
            changed = replace(copying, **{name: value})  # type: ignore[arg-type]
            window.do_first(lambda _, window: window.put("copying", changed))

        self._numbers.row(ui, f"copies {name}", shown_name(name), spec, float(getattr(copying, name)), commit)
