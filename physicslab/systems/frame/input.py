"""What the user does to the world and to the window."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import pygame

from physicslab.systems.system import Stage, System, at
from physicslab.view.controls import actions
from physicslab.view.controls.controls import KEYS, RELEASES
from physicslab.view.controls.spawning import spawn_box

if TYPE_CHECKING:
    from physicslab.view.controls.toolbar import Toolbar
    from physicslab.view.controls.tools import Tool
    from physicslab.view.window import Window
    from physicslab.world import World

__all__ = ["InputSystem"]

_OF_THE_MOUSE = (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP, pygame.MOUSEWHEEL)
"""What is offered to the toolbar first."""

_OTHER_USE = pygame.KMOD_ALT | pygame.KMOD_META
"""With these keys held, another key is meant for the desktop: Alt+Tab is no slow motion."""


class InputSystem(System):
    """Turns what SDL reports into actions, and leads the body that is held.

    It reacts to reports alone and never asks for the state of keys and buttons, so that posted events are as
    good as real ones.

    Parameters
    ----------
    window : Window
        Where the cursor is, and what is held.
    toolbar : Toolbar
        What lies over the world; clicks on it are its own.
    """

    def __init__(self, window: Window, toolbar: Toolbar) -> None:
        self._window = window
        self._toolbar = toolbar
        self._panning = 0  # the button that drags the picture
        self._tool: Tool | None = None  # what the left button was pressed with
        self._handlers: dict[int, Callable[[World, pygame.Event], None]] = {
            pygame.KEYDOWN: self._key,
            pygame.KEYUP: self._key_up,
            pygame.MOUSEBUTTONDOWN: self._press,
            pygame.MOUSEBUTTONUP: self._release,
            pygame.MOUSEMOTION: self._motion,
            pygame.MOUSEWHEEL: self._wheel,
            pygame.WINDOWFOCUSLOST: self._leave,
            pygame.WINDOWMINIMIZED: self._leave,
            pygame.WINDOWHIDDEN: self._leave,
            pygame.QUIT: lambda world, event: actions.close(world, window),
        }

    @at(Stage.INPUT)
    def handle(self, world: World, elapsed: float) -> None:
        """Do everything that was asked for since the last frame."""
        window = self._window
        window.now += elapsed
        for event in pygame.event.get():
            handler = self._handlers.get(event.type)
            if handler is None:
                continue
            if event.type in _OF_THE_MOUSE and self._toolbar.take(world, event):
                window.pointer = getattr(event, "pos", window.pointer)
            else:
                handler(world, event)
        window.follow_size(world)
        window.trails.follow(world)
        window.hand.move(window.place, window.now)
        window.hand.lead(world, window.coming(world), window.pace.paused)
        self._toolbar.follow(world, elapsed)

    def _key(self, world: World, event: pygame.Event) -> None:
        mod = getattr(event, "mod", 0)
        ctrl = "ctrl+" if mod & pygame.KMOD_CTRL else ""
        action = KEYS.get(ctrl + pygame.key.name(event.key).lower())
        if action is not None and not mod & _OTHER_USE:
            action(world, self._window)

    def _key_up(self, world: World, event: pygame.Event) -> None:
        action = RELEASES.get(pygame.key.name(event.key).lower())
        if action is not None:  # whatever else is held by now: what was begun must end
            action(world, self._window)

    def _press(self, world: World, event: pygame.Event) -> None:
        self._window.pointer = event.pos
        if (
            self._window.help or self._window.error_study.shown
        ):  # nothing is to happen behind what lies over all
            self._window.help = self._window.error_study.shown = False
            return
        if event.button == pygame.BUTTON_LEFT:
            self._tool = self._window.tool
            self._tool.press(world, self._window)
        elif event.button == pygame.BUTTON_RIGHT:
            spawn_box(world, self._window)
        if event.button == pygame.BUTTON_MIDDLE or (self._tool is not None and self._tool.pans):
            self._panning = event.button

    def _release(self, world: World, event: pygame.Event) -> None:
        self._window.pointer = event.pos
        if event.button == pygame.BUTTON_LEFT and self._tool is not None:
            self._tool.release(world, self._window)
            self._tool = None
        if event.button == self._panning:
            self._panning = 0

    def _motion(self, world: World, event: pygame.Event) -> None:
        window = self._window
        if not event.buttons[0]:  # let go where no report came from, as over another window
            window.hand.drop(world)
            if self._tool is not None:
                window.spring_tool.cancel()
                self._tool = None
        if self._panning and not event.buttons[self._panning - 1]:
            self._panning = 0
        if self._panning:
            dx, dy = event.pos[0] - window.pointer[0], event.pos[1] - window.pointer[1]
            window.camera.pan(dx, dy)
        window.pointer = event.pos

    def _wheel(self, world: World, event: pygame.Event) -> None:
        notches = getattr(event, "precise_y", event.y)
        actions.zoom(self._window, notches)

    def _leave(self, world: World, event: pygame.Event) -> None:
        """Hold nothing while the user is elsewhere."""
        self._window.hand.drop(world)
        self._window.spring_tool.cancel()
        self._panning, self._tool = 0, None
