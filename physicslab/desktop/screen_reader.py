"""The window as a screen reader gets it: every control with its name, value and place, and the scene.

AccessKit (extra ``access``) hands it to the system: on Linux to AT-SPI, which Orca reads. Nothing is made
while no reader is connected, and a window without the package works as ever.
"""

import time
from importlib import import_module
from queue import SimpleQueue
from typing import Any

import pygame

from physicslab.diagnostics.description import describe
from physicslab.view.canvas.canvas import Rect
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window
from physicslab.world import World

_PERIOD, _SCENE_PERIOD = 0.2, 1.0
"""How often controls, and the scene, are told again [s]."""
_ROLES = {
    "button": "BUTTON", "menu item": "MENU_ITEM", "menu": "MENU_ITEM", "check box": "CHECK_BOX",
    "combo box": "COMBO_BOX", "list item": "LIST_BOX_OPTION", "radio": "RADIO_BUTTON", "slider": "SLIDER",
    "text": "TEXT_INPUT",
}  # fmt: skip
_SWITCHES = ("check box", "radio")
_ROOT, _SCENE, _NOTICE, _FIRST = range(1, 5)
"""Numbers of nodes; those of controls follow."""


def _installed() -> Any:
    """Return the package, or ``None`` where it is not there or has nothing for this system."""
    try:
        kit: Any = import_module("accesskit")
    except ImportError:
        return None
    return kit if hasattr(kit, "unix") else None


class ScreenReader:
    """Tells the system what is in the window, and does what a reader's user presses.

    Parameters
    ----------
    kit : module, optional
        AccessKit; that which is installed where absent.
    """

    def __init__(self, kit: Any = None) -> None:
        self._kit = _installed() if kit is None else kit
        self._pressed: SimpleQueue[int] = SimpleQueue()
        self._numbers: dict[str, int] = {}
        self._due, self._scene, self._scene_due = 0.0, "", 0.0
        self._in_front: bool | None = None
        self._adapter: Any = None
        if self._kit is not None:
            self._adapter = self._kit.unix.Adapter(self._began, self._asks, lambda: None)

    def follow(self, world: World, window: Window, ui: Ui) -> None:
        """Do what was pressed, and tell what the last frame has shown."""
        if self._adapter is None:
            return
        while not self._pressed.empty():
            self._press(self._pressed.get(), ui)
        in_front = pygame.key.get_focused()
        if in_front != self._in_front:
            self._in_front = in_front
            self._adapter.update_window_focus_state(in_front)
        now = time.monotonic()
        if now >= self._due:
            self._due = now + _PERIOD
            self._place(window)
            self._adapter.update_if_active(lambda: self._tree(world, window, ui))

    # These two are called in threads of the adapter.

    def _began(self) -> Any:
        return self._update(_ROOT, {_ROOT: self._root("", [])})

    def _asks(self, request: Any) -> None:
        if request.action == self._kit.Action.CLICK:
            self._pressed.put(request.target)

    def _press(self, number: int, ui: Ui) -> None:
        """Click the middle of a control."""
        label = next((label for label, known in self._numbers.items() if known == number), "")
        if label not in ui.places:
            return
        left, top, width, height = ui.places[label]
        place = left + width // 2, top + height // 2
        pygame.event.post(
            pygame.Event(pygame.MOUSEMOTION, pos=place, rel=(0, 0), buttons=(0,) * 3, touch=False)
        )
        for kind in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP):
            pygame.event.post(pygame.Event(kind, pos=place, button=pygame.BUTTON_LEFT, touch=False))

    def _tree(self, world: World, window: Window, ui: Ui) -> Any:
        kit, nodes = self._kit, dict[int, Any]()
        for label, (role, value) in ui.spoken.items():
            number = self._numbers.setdefault(label, _FIRST + len(self._numbers))
            nodes[number] = node = kit.Node(getattr(kit.Role, _ROLES[role]))
            node.set_label(ui.said(label))
            node.set_bounds(self._rect(ui.places[label]))
            node.add_action(kit.Action.CLICK)
            if role in _SWITCHES or value == "on":
                node.set_toggled(kit.Toggled.TRUE if value == "on" else kit.Toggled.FALSE)
            elif value:
                node.set_value(value)
        nodes[_SCENE] = scene = kit.Node(kit.Role.DOCUMENT)
        scene.set_label(self._told(world, window))
        scene.set_bounds(self._rect(window.framing.room()))
        nodes[_NOTICE] = notice = kit.Node(kit.Role.STATUS)
        notice.set_label(ui.said(window.notice))
        notice.set_live(kit.Live.POLITE)
        nodes[_ROOT] = self._root(ui.said(world.title), [*nodes])
        focus = self._numbers.get(ui.focused, _ROOT)
        return self._update(focus if focus in nodes else _ROOT, nodes)

    def _told(self, world: World, window: Window) -> str:
        """Return the scene in words, made once a second."""
        if time.monotonic() >= self._scene_due:
            self._scene_due = time.monotonic() + _SCENE_PERIOD
            self._scene = describe(world, window.language)
        return self._scene

    def _place(self, window: Window) -> None:
        """Say where the window is on the screen."""
        left, top = pygame.display.get_window_position() if pygame.display.get_surface() else (0, 0)
        there = self._rect((left, top, *window.canvas.size))
        self._adapter.set_root_window_bounds(there, there)

    def _rect(self, place: Rect) -> Any:
        left, top, width, height = place
        return self._kit.Rect(left, top, left + width, top + height)

    def _root(self, title: str, children: list[int]) -> Any:
        node = self._kit.Node(self._kit.Role.WINDOW)
        node.set_label(f"{title} - PhysicsLab" if title else "PhysicsLab")
        node.set_children(children)
        return node

    def _update(self, focus: int, nodes: dict[int, Any]) -> Any:
        update = self._kit.TreeUpdate(focus)
        update.tree = self._kit.Tree(_ROOT)
        for number, node in nodes.items():
            update.nodes.append((number, node))
        return update
