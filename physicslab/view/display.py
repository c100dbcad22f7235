"""The window on the screen: opened, watched and closed in one place."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

import pygame

from physicslab.config import WindowConfig
from physicslab.view.pygame_canvas import PygameCanvas

__all__ = ["Display"]


class Display:
    """A real window with a canvas in it, and the clock that paces its frames.

    Attributes
    ----------
    canvas : PygameCanvas
        The picture in the window; it has the window's size at any time.
    """

    def __init__(self, canvas: PygameCanvas, fps: int) -> None:
        self.canvas = canvas
        self._period = 1.0 / fps
        self._last = self._next = time.perf_counter()

    @classmethod
    @contextmanager
    def open(cls, config: WindowConfig, title: str) -> Iterator[Display]:
        """Open a window for the length of a ``with`` block.

        Raises
        ------
        OSError
            If there is no screen to open it on.
        """
        try:
            pygame.display.init()  # not pygame.init(): sound is not needed, and complains where there is none
            pygame.font.init()
            surface = pygame.display.set_mode(config.size, pygame.RESIZABLE)
        except pygame.error as error:
            pygame.quit()
            raise OSError(f"no window can be opened: {error}") from error
        try:
            pygame.display.set_caption(title)
            yield cls(PygameCanvas(surface), config.fps)
        finally:
            pygame.quit()

    def show(self) -> float:
        """Show what was drawn, wait until the next frame is due, and return the time since the last [s].

        The waits aim at fixed times and not at fixed lengths, and are not rounded to milliseconds as those of
        ``pygame.time.Clock.tick`` are: that would make 62.5 frames a second of 60, and a hitch of every 25th.
        """
        pygame.display.flip()
        now = time.perf_counter()
        self._next = max(self._next + self._period, now)
        time.sleep(max(self._next - now, 0.0))
        before, self._last = self._last, time.perf_counter()
        return self._last - before

    def save_screenshot(self, directory: Path) -> Path:
        """Write a PNG of the window and return its path; raise ``OSError`` if that cannot be done."""
        name = datetime.now().strftime("physicslab-%Y%m%d-%H%M%S")
        path = directory / f"{name}.png"
        count = 1
        while path.exists():
            count += 1
            path = directory / f"{name}-{count}.png"
        with path.open("wb") as stream:
            pygame.image.save(self.canvas.surface, stream, path.name)
        return path
