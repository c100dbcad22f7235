"""Keys that come before the field that they are for: a click has opened it, and it is not built yet."""

import pygame

_KEYS = (pygame.KEYDOWN, pygame.KEYUP, pygame.TEXTINPUT)
_OPENING = 5
"""Frames from a click on a panel until a field of it has the keys."""


class EarlyKeys:
    """Keeps keys until what was clicked for is there: what a slow machine shows late is typed into.

    In the meantime they would act on the world, as T and W of "Two carts" did.
    """

    def __init__(self) -> None:
        self._kept: list[pygame.Event] = []
        self._frames = 0

    def follow(self, event: pygame.Event, *, on_panel: bool) -> None:
        """Note a button that was let go, and whether it went down ``on_panel``."""
        if event.type == pygame.MOUSEBUTTONUP and on_panel:
            self._frames = _OPENING

    def take(self, event: pygame.Event) -> bool:
        """Keep a key that comes too early; return whether it does."""
        if not self._frames or event.type not in _KEYS:
            return False
        self._kept.append(event)
        return True

    def advance(self, *, typing: bool) -> bool:
        """Note a frame; send what was kept once a field has the keys, or none will; return if any wait."""
        self._frames = 0 if typing else max(self._frames - 1, 0)
        if not self._frames:
            for event in self._kept:
                pygame.event.post(event)
            self._kept.clear()
        return bool(self._kept)
