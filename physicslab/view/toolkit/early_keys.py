"""Keys that come before the field that they are for: what opens it was pressed, and it is not built yet."""

import pygame

_KEYS = (pygame.KEYDOWN, pygame.KEYUP, pygame.TEXTINPUT)
_OPENING = 5
"""Frames from a click on a panel, or from its opening, until a field of it has the keys."""
_LEAVING = 2
"""The first of them, in which the field that had the keys before may still have them."""


class EarlyKeys:
    """Keeps keys until what was opened for them is there: what a slow machine shows late is typed into.

    In the meantime they would act on the world, as T and W of "Two carts" did, or be lost.
    """

    def __init__(self) -> None:
        self._kept: list[pygame.Event] = []
        self._frames = 0
        self._open = ""

    def follow(self, event: pygame.Event, *, on_panel: bool) -> None:
        """Note a button that was let go, and whether it went down ``on_panel``."""
        if event.type == pygame.MOUSEBUTTONUP and on_panel:
            self._frames = _OPENING

    def take(self, event: pygame.Event, opened: str) -> bool:
        """Keep a key that comes too early; return whether it does.

        ``opened`` is the panel that keys are for by now, empty if they are for the world.
        """
        if self._notes(opened) and event.type == pygame.TEXTINPUT:
            return True  # the letter of the key that has opened it
        if not self._frames or event.type not in _KEYS:
            return False
        self._kept.append(event)
        return True

    def advance(self, opened: str, *, typing: bool) -> bool:
        """Note a frame; send what was kept once a field has the keys, or none will; return if any wait."""
        self._notes(opened)
        has_field = typing and self._frames <= _OPENING - _LEAVING
        self._frames = 0 if has_field else max(self._frames - 1, 0)
        if not self._frames:
            for event in self._kept:
                pygame.event.post(event)
            self._kept.clear()
        return bool(self._kept)

    def _notes(self, opened: str) -> bool:
        """Note the panel that keys are for; return whether it has just been opened."""
        if opened == self._open:
            return False
        self._open, self._frames = opened, _OPENING if opened else self._frames
        return bool(opened)
