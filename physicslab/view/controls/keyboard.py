"""Without a mouse: keys move the cursor, click, and go to menus and panels."""

from typing import Any

import pygame

from physicslab.view.canvas.canvas import is_within
from physicslab.view.controls import copies, tools
from physicslab.view.controls.actions import nudger, turner
from physicslab.view.window.window import Action, Window
from physicslab.world import World

_STEP = 10
"""How far an arrow moves the cursor [px]; with Shift held by one."""


def open_menu(world: World, window: Window) -> None:
    """Open the first menu."""
    window.keys_go_to = "menu"


def walk(world: World, window: Window) -> None:
    """Let keys go through the buttons and fields of the next panel."""
    window.keys_go_to = "panel"


def enter(world: World, window: Window) -> None:
    """Go to the first field of the selection, or do what is typed or shown; else click with the tool.

    A tool that is dragged is pressed by one Enter and let go by the next. While a button is held to draw, as
    after typing numbers, Enter puts down the point of that drawing.
    """
    if window.sketch.held and not window.presses_by_key:
        _post(pygame.MOUSEBUTTONDOWN, _cursor(window), button=window.sketch.held)
    elif window.hand.entity is not None and window.sketch.typed:
        tools.give_typed(world, window)
    elif window.copying is not None:
        copies.make_copies(world, window)
    elif window.selection.entities and not window.presses_by_key:
        window.keys_go_to = "fields"
    else:
        place, drags = _cursor(window), tools.TOOLS[window.tool].drags
        if not window.presses_by_key:
            _post(pygame.MOUSEBUTTONDOWN, place, button=pygame.BUTTON_LEFT)
        if window.presses_by_key or not drags:
            _post(pygame.MOUSEBUTTONUP, place, button=pygame.BUTTON_LEFT)
        window.presses_by_key = drags and not window.presses_by_key


def _cursor(window: Window) -> tuple[int, int]:
    """Return where the cursor is [px]; where it was not in the world yet, that is the middle of it."""
    inside = window.has_pointed and is_within(window.pointer, window.framing.room())
    x, y = window.pointer if inside else window.framing.middle
    return round(x), round(y)


def _post(kind: int, place: tuple[int, int], **more: Any) -> None:
    """Post an event of the mouse, as the mouse itself does."""
    pygame.event.post(pygame.Event(kind, pos=place, touch=False, by_key=True, **more))


def _arrow(across: int, down: int, step: int) -> Action:
    """Return what moves all that is selected by a pixel; without one, the cursor by a step.

    With Shift held, an arrow to the side turns the selection.
    """
    nudge = turner(-across) if step == 1 and across else nudger(across, -down)

    def move(world: World, window: Window) -> None:
        if window.selection.entities and not window.presses_by_key:
            nudge(world, window)
            return
        left, top, width, height = window.framing.room()
        x, y = _cursor(window)
        x = min(max(x + step * across, left), left + width - 1)
        y = min(max(y + step * down, top), top + height - 1)
        _post(pygame.MOUSEMOTION, (x, y), rel=(0, 0), buttons=(int(window.presses_by_key), 0, 0))

    return move


ARROWS = {
    f"{held}{name}": _arrow(across, down, step)
    for name, across, down in (("left", -1, 0), ("right", 1, 0), ("up", 0, -1), ("down", 0, 1))
    for held, step in (("", _STEP), ("shift+", 1))
}
"""The action of each arrow, alone and with Shift held, by its name in SDL."""
