"""Keys that go through the widgets of panels in place of the mouse."""

from __future__ import annotations

import pygame
from imgui_bundle import imgui

from physicslab.view.toolkit.toolkit import Toolkit

__all__ = ["Walk"]

_MENUS = "##MainMenuBar"
"""The window that Dear ImGui has the menus in; the mark of the keys is put on a menu where they are built."""
_FLAGS = imgui.WindowFlags_
_INERT = _FLAGS.no_nav_inputs | _FLAGS.tooltip | _FLAGS.popup


class Walk:
    """Which panel has the keys: Tab and arrows go through its widgets, Esc gives them back to the world.

    Parameters
    ----------
    toolkit : Toolkit
        What builds the panels; it takes keys for them while ``toolkit.walked``.
    """

    def __init__(self, toolkit: Toolkit) -> None:
        self._toolkit = toolkit
        self._panel = ""
        self._begins = self._ends = False

    def begin(self, keys_go_to: str) -> None:
        """Let keys go to the menus, to the fields of the panel at the right, or to the next panel."""
        if not keys_go_to:
            return
        named = {"menu": _MENUS, "fields": "side"}
        self._panel = named.get(keys_go_to) or self._next()
        self._begins = self._toolkit.walked = True
        self._toolkit.wake()

    def _next(self) -> str:
        """Return the name of the panel to the right of the one that has the keys, or below it."""
        self._toolkit.enter()
        windows = sorted(imgui.get_current_context().windows, key=lambda one: (one.pos.x, one.pos.y))
        names = [str(one.name) for one in windows if _has_widgets(one)]
        walked = names.index(self._panel) + 1 if self._toolkit.walked and self._panel in names else 0
        return names[walked % len(names)] if names else ""

    def follow(self, event: pygame.Event) -> None:
        """Begin where Tab leaves a field, and end at a click or Esc; before panels take the event."""
        toolkit, key = self._toolkit, getattr(event, "key", 0)
        if event.type == pygame.MOUSEBUTTONDOWN:
            toolkit.walked = False
        elif event.type == pygame.KEYDOWN and key == pygame.K_TAB and toolkit.typing:
            window = imgui.get_current_context().nav_window
            if window is not None:  # None where a press in the world has just ended the writing
                self._panel = str(window.root_window.name)
                toolkit.walked = True
        elif event.type == pygame.KEYDOWN and key == pygame.K_ESCAPE and toolkit.has_keys:
            self._ends = not toolkit.has_popup()

    def mark(self) -> None:
        """Put the mark of the keys on a widget of a panel that has them from now on; before it is built."""
        panel = imgui.internal.find_window_by_name(self._panel)
        if self._begins and panel is not None and self._panel != _MENUS:
            imgui.internal.focus_window(panel)
            imgui.internal.nav_init_window(panel, True)
            imgui.set_nav_cursor_visible(True)
        self._begins = False

    def end(self) -> None:
        """Give the keys back to the world after Esc, or a line of a menu; after panels are built."""
        toolkit, panel = self._toolkit, imgui.get_current_context().nav_window
        in_menus = toolkit.walked and self._panel == _MENUS
        left = in_menus and not toolkit.has_popup() and panel is not None and panel.name != _MENUS
        if self._ends or left:
            imgui.set_window_focus()
            self._ends = toolkit.walked = False


def _has_widgets(window: imgui.internal.Window) -> bool:
    """Whether a window is in sight that keys can go through the widgets of, as they cannot of a tip."""
    nested = window.flags & _FLAGS.child_window and not window.dock_id
    hidden = window.hidden or not window.active or window.name == _MENUS
    return not (hidden or nested or window.flags & _INERT)
