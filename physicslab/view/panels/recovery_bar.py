"""The bar that offers what a crash has left: restore or discard, by the mouse alone, under the toolbar."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from physicslab.ecs.fields import InvalidValue
from physicslab.files.scene import SceneError
from physicslab.view.canvas.canvas import TextStyle
from physicslab.view.controls.menus import StepPlan
from physicslab.view.controls.widgets import Widgets
from physicslab.view.panels.panels import broken
from physicslab.view.window import Window
from physicslab.world import World

__all__ = ["RecoveryBar", "discard_session", "restore_session"]


class RecoveryBar:
    """A line of words and two buttons; keys stay with the scene that runs.

    Parameters
    ----------
    widgets : Widgets
        What its buttons are made of.
    window : Window
        What is on offer there.
    ask : callable
        What is called with the choice that is clicked.

    Attributes
    ----------
    height : int
        What it takes up [px]; 0 where nothing is on offer.
    """

    def __init__(self, widgets: Widgets, window: Window, ask: Callable[[StepPlan], None]) -> None:
        self._window = window
        self._plate = widgets.plate()
        choices = (StepPlan("Restore it", restore_session), StepPlan("Discard", discard_session))
        # No lambda with a default: the widgets would take that for a parameter, and pass it what happened.
        self._buttons = [(choice, widgets.button(partial(ask, choice))) for choice in choices]
        self._top = self._room = 0
        self.height = 0

    @property
    def places(self) -> dict[str, tuple[int, int, int, int]]:
        """Where its buttons are, by what they say [px]."""
        return {
            choice.title: (button.rect.left, button.rect.top, button.rect.width, button.rect.height)
            for choice, button in self._buttons
            if button.visible
        }

    def lay_out(self, top: int, size: int) -> None:
        """Show it from ``top`` [px] on, in text of a height [px]; or hide it where nothing is on offer."""
        if not self._window.recovery.offered:
            self.height = 0
            self._plate.vanish()
            for _, button in self._buttons:
                button.reveal(False)
            return
        across, row, pad = self._window.canvas.size[0], round(1.9 * size), max(size // 4, 2)
        self._top, self.height = top, row + 2 * pad
        plate = (0, top, max(across, 2), self.height)
        if tuple(self._plate.rect) != plate or not self._plate.visible:
            self._plate.put(plate)
        width, right = 8 * size, across - 2 * size
        for choice, button in reversed(self._buttons):
            button.put((right - width, top + pad, width, row))
            button.say(choice.title)
            button.mark(choice is self._buttons[0][0])
            right -= width + size
        self._room = right - 2 * size

    def draw(self) -> None:
        """Draw its words; the buttons are drawn with all others."""
        if not self.height:
            return
        window, canvas = self._window, self._window.canvas
        size = self.height * 10 // 25
        style = TextStyle(size, window.theme.warning, bold=True)
        words = broken(f"! {window.recovery.words}", max(self._room, 2), canvas, style)[0]
        drop = (self.height - canvas.text_size(words, style)[1]) // 2
        canvas.text(words, (2 * size, self._top + drop), style)


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
