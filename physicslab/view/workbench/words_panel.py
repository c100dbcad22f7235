"""The scene in words: to be read, read out by another program, or copied."""

import pygame

from physicslab.diagnostics.description import describe
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window
from physicslab.world import World

_SIZE = (34.0, 20.0)
"""Width and height of the words, in heights of the text."""


def build_words(ui: Ui, world: World, window: Window) -> None:
    """Build the window of words, of the moment that is shown."""
    left, top, width, height = ui.room
    middle = left + 0.5 * width, top + 0.5 * height
    with ui.floating("Scene in words", middle, window.closing_of("shows_words"), docks=True):
        words = describe(world, window.language)
        ui.button("Copy the words", "They can be pasted anywhere", _copy, words)
        with ui.child("words", ui.extent(_SIZE[0] * ui.size, _SIZE[1] * ui.size)) as is_seen:
            for line in words.splitlines() if is_seen else ():
                ui.text(line, wrapped=True)


def _copy(world: World, window: Window, words: str) -> None:
    """Put the words on the clipboard."""
    try:
        pygame.scrap.put_text(words)
    except pygame.error as error:
        window.notify(f"Not done: {error}", 6.0, failed=True)
        return
    window.notify("Copied to the clipboard")
