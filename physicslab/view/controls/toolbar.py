"""The toolbar: a button for every control, at the top of the window."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import pygame

from physicslab.view.canvas.canvas import Rect, TextStyle
from physicslab.view.controls.controls import CONTROLS, Control
from physicslab.view.controls.menus import MENUS, StepPlan
from physicslab.view.controls.popup import Popup
from physicslab.view.controls.widgets import Button, Widgets
from physicslab.view.panels.panels import text_size
from physicslab.view.panels.recovery_bar import RecoveryBar

if TYPE_CHECKING:
    from physicslab.view.window import Window
    from physicslab.world import World

__all__ = ["Toolbar"]

_STILL = 0.2
"""Time [s] that the window keeps its size before its text follows."""
_PERIOD = 0.1
"""Time [s] between two looks at what is on."""
_PATIENCE = 0.35
"""How long [s] the cursor rests on a button before its tip is shown."""
_MORE = Control("", "", group="window", icon="more", menu="more", tip="More")
"""The button for what there is no room for."""


class Toolbar:
    """A row of buttons made from the table of controls, the menus that some open, and their tips.

    Where the window is too narrow for all, the minor ones are in a menu behind the last button.

    Parameters
    ----------
    window : Window
        What is shown and what is on.

    """

    def __init__(self, window: Window) -> None:
        self._window = window
        self._text_size = text_size(window.canvas)
        self._sized = (window.canvas.size, window.now)
        self._widgets = Widgets(window.canvas.size, window.theme, self._text_size)
        self._asked: list[Control | StepPlan] = []
        self._plate = self._widgets.plate()
        self._buttons: dict[Control, Button] = {
            control: self._button(control) for control in (*CONTROLS, _MORE) if control.icon
        }
        self._popup = Popup(self._widgets, self._asked_for)
        self._bar = RecoveryBar(self._widgets, window, self._asked_for)
        self._laid_out: tuple[object, ...] = ()
        self._hidden: list[Control] = []
        self._look_at = 0.0
        self._menu = ""
        self._resting: tuple[Button | None, float] = (None, 0.0)
        self._height = 0
        self.lay_out()

    def _button(self, control: Control) -> Button:
        return self._widgets.button(lambda: self._asked.append(control), icon=control.icon)

    def _asked_for(self, choice: StepPlan) -> None:
        self._asked.append(choice)

    @property
    def height(self) -> int:
        """What it takes up of the window [px], from the top down, with what is offered below it."""
        return self._height + self._bar.height

    @property
    def offers(self) -> dict[str, Rect]:
        """Where the buttons of the recovery bar are, by what they say [px]."""
        return self._bar.places

    def _settle(self) -> None:
        """Let text grow or shrink with the window once its border is let go: that draws everything anew."""
        window = self._window
        if window.canvas.size != self._sized[0]:
            self._sized = (window.canvas.size, window.now)
        if window.now - self._sized[1] >= _STILL or window.now == 0.0:
            self._text_size = text_size(window.canvas)

    @property
    def places(self) -> dict[str, Rect]:
        """Where the button of each control is, by its label [px], but for those in the last one's menu."""
        return {
            control.label: (button.rect.left, button.rect.top, button.rect.width, button.rect.height)
            for control, button in self._buttons.items()
            if button.visible
        }

    @property
    def lines(self) -> dict[str, Rect]:
        """Where each line of the open menu is, by what it says [px]."""
        return self._popup.titles

    @property
    def _side(self) -> int:
        return min(max(round(2.05 * self._text_size), 28), 40)

    def lay_out(self) -> None:
        """Put the buttons where they belong in a window of this size, in the colours of its theme."""
        window, size = self._window, self._window.canvas.size
        self._settle()
        now = (size, window.theme, self._text_size)
        if now == self._laid_out:
            self._bar.lay_out(self._height, self._text_size)
            return
        self._laid_out = now
        self._widgets.resize(size)
        self._widgets.restyle(window.theme, self._text_size)
        side, pad = self._side, max(self._text_size // 4, 2)
        shown = [control for control in self._buttons if control is not _MORE]
        room = size[0] - 2 * pad
        if self._width(shown, side) > room:
            kept = list(shown)
            while kept and self._width([*kept, _MORE], side) > room:
                kept.remove(next((c for c in reversed(kept) if c.minor and not c.menu), kept[-1]))
            shown = [*kept, _MORE]
        self._hidden = [control for control in self._buttons if control not in shown and control is not _MORE]
        self._height = side + 2 * pad
        self._plate.put((0, 0, max(size[0], 2), self._height))
        self._bar.lay_out(self._height, self._text_size)
        x, before = max((size[0] - self._width(shown, side)) // 2, pad), shown[0].group
        for control, button in self._buttons.items():
            if control not in shown:
                button.reveal(False)
                continue
            x += self._gap if control.group != before else 0
            before = control.group
            button.put((x, pad, side, side))
            x += side + 1
        self._look_at = 0.0

    @property
    def _gap(self) -> int:
        return self._text_size // 2 + (4 if self._window.canvas.size[0] > 1100 else 0)

    def _width(self, shown: list[Control], side: int) -> int:
        groups = sum(a.group != b.group for a, b in itertools.pairwise(shown))
        return len(shown) * (side + 1) + groups * self._gap

    def take(self, world: World, event: pygame.Event) -> bool:
        """Let the toolbar have an event of the mouse first; return whether the world is not to see it."""
        window = self._window
        if window.help:
            return False
        if event.type == pygame.MOUSEWHEEL:
            over = self._widgets.covers(window.pointer)
            if over and window.menu:
                self._popup.turn(-1 if event.y > 0 else 1)
                self._look_at = 0.0
            return over
        taken = self._widgets.take(event)
        if not taken and event.type == pygame.MOUSEBUTTONDOWN and window.menu:
            window.menu = ""  # a click beside a menu closes it, and does nothing else
            self._follow_menu(world)
            return True
        self._obey(world)
        if taken:
            self._look_at = 0.0
        return taken

    def _obey(self, world: World) -> None:
        """Do what was clicked."""
        window, asked, self._asked = self._window, self._asked, []
        for wish in asked:
            if isinstance(wish, StepPlan):
                window.menu = ""
                if wish.choose is not None:
                    wish.choose(world, window)
            elif wish.menu:
                window.menu = "" if window.menu == wish.menu else wish.menu
            else:
                window.menu = ""
                wish.pressed(world, window)
            self._look_at = 0.0
        if asked:
            self._follow_menu(world)

    def follow(self, world: World, elapsed: float) -> None:
        """Show what is on, where the cursor is, and the menu that is open; several times a second."""
        window = self._window
        self.lay_out()
        button = self._widgets.over(window.pointer)
        if button is not self._resting[0]:
            self._resting = button, window.now
        if window.now >= self._look_at or window.menu != self._menu:
            self._menu = window.menu
            self._look_at = window.now + _PERIOD
            for control, shown in self._buttons.items():
                shown.mark(control.on(world, window))
                if control.icon == "pause":
                    shown.draw_on("play" if window.pace.paused else "pause")
            self._follow_menu(world)
        self._widgets.update(elapsed, window.pointer)

    def _follow_menu(self, world: World) -> None:
        window, size = self._window, self._text_size
        if not window.menu:
            self._popup.close()
            return
        width, height = window.canvas.size
        named = next(control for control in self._buttons if control.menu == window.menu)
        anchor = self._buttons[named if named not in self._hidden else _MORE].rect
        room = (size // 2, self.height + 2, width - size, height - self.height - size // 2)
        if window.menu == _MORE.menu:
            choices = [_choice(control, world, window) for control in self._hidden]
        else:
            choices = MENUS[window.menu](world, window)
        self._popup.open(choices, tuple(anchor), room, size, window.canvas, window.theme)

    def draw(self) -> None:
        """Draw it, with the tip of the button that the cursor rests on."""
        self._window.canvas.paint(self._widgets.draw)
        self._bar.draw()
        self._draw_tip()

    def _draw_tip(self) -> None:
        window, (button, since) = self._window, self._resting
        if button is None or not button.visible or window.now - since < _PATIENCE:
            return
        control = next((c for c, b in self._buttons.items() if b is button), None)
        if control is None or window.menu:
            return
        size, canvas, theme = self._text_size, window.canvas, window.theme
        words, cap = TextStyle(size, theme.text), TextStyle(size - 1, theme.accent, bold=True)
        pad, room = size // 2, canvas.text_size(control.tip, words)
        keys = canvas.text_size(control.label, cap) if control.label else (0, 0)
        width, height = room[0] + keys[0] + pad * (4 if control.label else 2), room[1] + pad
        left = min(max(button.rect.centerx - width // 2, pad), max(canvas.size[0] - width - pad, 0))
        top = self.height + 4
        canvas.panel((left, top, width, height), theme.key, theme.key_rim)
        canvas.text(control.tip, (left + pad, top + pad // 2), words)
        drop = (room[1] - keys[1]) // 2
        canvas.text(control.label, (left + 3 * pad + room[0], top + pad // 2 + drop), cap)


def _choice(control: Control, world: World, window: Window) -> StepPlan:
    return StepPlan(f"{control.tip}  ({control.label})", control.pressed, control.on(world, window))
