"""Buttons that are clicked: the one module that imports pygame_gui."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pygame
import pygame_gui
from pygame_gui.core import ObjectID

from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.drawable_text import drawable
from physicslab.view.canvas.theme import Theme
from physicslab.view.controls.icons import IconCache
from physicslab.view.controls.widget_style import style_of

__all__ = ["Button", "Plate", "Widgets"]

_SETTLING = 20
"""Frames that widgets are kept up to date for after something happened to them; then they cost nothing."""
_NOWHERE = pygame.Rect(0, 0, 2, 2)
_BAR, _MENU = 1, 10
"""The layers of a toolbar and of what opens over it."""


class _Manager(pygame_gui.UIManager):
    """A manager that follows the events of the mouse and not its state: posted events are as good."""

    def _update_mouse_position(self) -> None:
        return


class Button(pygame_gui.elements.UIButton):
    """A button with an icon or a line of text, which may be marked as on.

    It is made once; from then on it is put elsewhere, labelled again, shown and hidden.
    """

    widgets: Widgets
    icon = ""
    _outdated = False

    def outdate(self) -> None:
        """Write its words in the widgets' new style: now if it is shown, else when it is."""
        self._outdated = not self.icon
        if self.visible:
            self._update()

    def _update(self) -> None:
        if self._outdated:
            self._outdated = False
            self.rebuild_from_changed_theme_data()

    def _set_any_images_from_theme(self) -> bool:
        """Draw the icon, in place of an image that a theme names."""
        if not self.icon:
            return False
        plain, marked = self.widgets.icons.pictures(self.icon, self.rect.size)
        self.normal_images = self.hovered_images = self.disabled_images = [plain]
        self.selected_images = [marked]
        for state in ("normal", "hovered", "disabled", "selected"):
            setattr(self, f"{state}_image_positions", [(0.5, 0.5)])
        return True

    def _set_inactive(self) -> None:
        """Go back to the state from before the press: a marked button stays marked."""
        if self.drawable_shape is not None:
            self.drawable_shape.set_active_state(self._get_appropriate_state_name())

    def put(self, rect: Rect) -> None:
        """Show it at a place [px]."""
        self._update()
        if tuple(self.rect) != rect:
            grown = tuple(self.rect.size) != rect[2:]
            self.set_relative_position(rect[:2])
            self.widgets.unsettle()
            if grown:  # what is only moved looks as before, and drawing it again takes a millisecond
                self.set_dimensions(rect[2:])
                self.remake()
        self.reveal(True)

    def remake(self) -> None:
        """Draw it again at once; by itself it would wait until its size is the same for a while."""
        self._set_any_images_from_theme()
        self.rebuild()
        self._set_inactive()
        self.widgets.unsettle()

    def reveal(self, shown: bool) -> None:
        """Show it, or hide it."""
        if bool(self.visible) != shown:
            self.widgets.unsettle()
            self.show() if shown else self.hide()

    def say(self, words: str) -> None:
        """Write other words on it."""
        words = drawable(words)
        if words != self.text:
            self.widgets.unsettle()
            self.set_text(words)

    def draw_on(self, icon: str) -> None:
        """Draw another icon on it."""
        if icon != self.icon:
            self.icon = icon
            self.remake()

    def mark(self, on: bool) -> None:
        """Mark it as on, or not; with an icon that is a bar below, not a colour alone."""
        if on != self.is_selected:
            self.widgets.unsettle()
            self.select() if on else self.unselect()

    def allow(self, usable: bool) -> None:
        """Let it be pressed, or only be read, as a heading."""
        if usable != self.is_enabled:
            self.widgets.unsettle()
            self.enable() if usable else self.disable()


class Plate(pygame_gui.elements.UIPanel):
    """What buttons lie on; clicks beside the buttons end here."""

    widgets: Widgets

    def put(self, rect: Rect) -> None:
        """Show it at a place [px]."""
        if tuple(self.rect) != rect:
            self.set_relative_position(rect[:2])
            self.set_dimensions(rect[2:])
            self.rebuild()
        if not self.visible:
            self.show()
        self.widgets.unsettle()

    def vanish(self) -> None:
        """Hide it."""
        if self.visible:
            self.widgets.unsettle()
            self.hide()


class Widgets:
    """All widgets of a window.

    Parameters
    ----------
    size : tuple of two ints
        Of the window [px].
    theme : Theme
        The colours.
    text_size : int
        Height of text [px].
    """

    def __init__(self, size: tuple[int, int], theme: Theme, text_size: int) -> None:
        pygame.font.init()
        self._look = (theme, text_size)
        self.icons = IconCache(theme)
        self._manager = _Manager(size, style_of(theme, text_size), enable_live_theme_updates=False)
        self._styles: dict[int, Any] = {}  # by the height of the text
        self._plates: list[Plate] = []
        self._buttons: list[Button] = []
        self._unsettled = _SETTLING
        self._held: set[int] = set()

    def button(self, command: Callable[[], None], *, row: bool = False, icon: str = "") -> Button:
        """Make a button, hidden until it is put somewhere; ``row`` is one of a menu."""
        name = ObjectID(class_id="@row" if row else "@tool")
        button = Button(
            _NOWHERE.copy(), "", self._manager,
            object_id=name, starting_height=(_MENU if row else _BAR) + 1,
            command={pygame_gui.UI_BUTTON_PRESSED: command, pygame_gui.UI_BUTTON_START_PRESS: lambda: None},
            visible=0,
        )  # fmt: skip
        button.widgets = self
        button.draw_on(icon)
        self._buttons.append(button)
        return button

    def plate(self, *, menu: bool = False) -> Plate:
        """Make something for buttons to lie on, hidden until it is put somewhere."""
        name = ObjectID(class_id="@menu" if menu else "@bar")
        plate = Plate(
            _NOWHERE.copy(), _MENU if menu else _BAR, self._manager, object_id=name, visible=0,
        )  # fmt: skip
        plate.widgets = self
        self._plates.append(plate)
        return plate

    def unsettle(self) -> None:
        """Note that something changed."""
        self._unsettled = _SETTLING

    def resize(self, size: tuple[int, int]) -> None:
        """Follow the size of the window [px]."""
        if size != self._manager.window_resolution:
            self._manager.set_window_resolution(size)
            self.unsettle()

    def restyle(self, theme: Theme, text_size: int) -> None:
        """Take on other colours, and another height of text [px]."""
        if (theme, text_size) == self._look:
            return
        recoloured = theme != self._look[0]
        self._look = (theme, text_size)
        if recoloured:
            self.icons = IconCache(theme)
            self._styles.clear()
        if text_size not in self._styles:
            self._styles[text_size] = self._manager.create_new_theme(style_of(theme, text_size))
        style = self._styles[text_size]
        if recoloured:
            self._manager.set_ui_theme(style, update_all_sprites=True)
            for button in self._buttons:
                button.remake()
            return
        # Where the text alone grows, only what has words changes, and most of that is hidden: to let
        # every widget look for changes takes as long as a frame.
        self._manager.ui_theme = style
        for widget in (*self._plates, *self._buttons):
            widget.ui_theme = style
        for button in self._buttons:
            button.outdate()

    def covers(self, place: tuple[float, float]) -> bool:
        """Whether a widget is at a place [px]."""
        return any(plate.visible and plate.rect.collidepoint(place) for plate in self._plates)

    def over(self, place: tuple[float, float]) -> Button | None:
        """Return the button at a place [px], the topmost where there are two, or ``None``."""
        found = [button for button in self._buttons if button.visible and button.rect.collidepoint(place)]
        return max(found, key=lambda button: button.layer, default=None)

    def take(self, event: pygame.Event) -> bool:
        """Let widgets have an event of the mouse; return whether it was meant for them alone.

        A press on a widget is theirs, and so is the release that belongs to it; a release that belongs to a
        press on the world never is.
        """
        if event.type == pygame.MOUSEBUTTONDOWN:
            if not self.covers(event.pos):
                return False
            self._held.add(event.button)
        elif event.type == pygame.MOUSEBUTTONUP:
            if event.button not in self._held:
                return False
            self._held.discard(event.button)
        self.unsettle()
        self._manager.process_events(event)
        return True

    def update(self, elapsed: float, pointer: tuple[float, float]) -> None:
        """Let widgets follow the cursor [px]; where nothing changed that costs nothing."""
        place = (int(pointer[0]), int(pointer[1]))
        if place != self._manager.mouse_position:
            here, there = self.covers(place), self.covers(self._manager.mouse_position)
            self._manager.mouse_position = place
            if here or there:
                self.unsettle()
        if self._unsettled:
            self._unsettled -= 1
            self._manager.update(elapsed)

    def draw(self, surface: pygame.Surface) -> None:
        """Draw them all."""
        self._manager.draw_ui(surface)
