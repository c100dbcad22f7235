"""The window on the screen: opened, watched and closed in one place."""

from __future__ import annotations

import contextlib
import io
import os
import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

import pygame

from physicslab.ecs.config import WindowConfig
from physicslab.files.replace import create_first, with_numbers
from physicslab.theme import DARK
from physicslab.view.canvas.drawable_text import drawable
from physicslab.view.canvas.pygame_canvas import PygameCanvas

_INVISIBLE = ("dummy", "offscreen")
"""Drivers of SDL without a window."""
_USUAL_DPI = 96.0
"""Pixels to the inch of a screen on which sizes are as they are written [1/inch]."""
_WITHOUT_WINDOW = "physicslab run SCENE needs none"


class NoScreen(OSError):
    """There is no screen to open a window on; the message is one line with a remedy."""


class Display:
    """A real window with a canvas in it, and the clock that paces its frames.

    Attributes
    ----------
    canvas : PygameCanvas
        The picture in the window; it has the window's size at any time.
    density : float
        How many pixels of the screen there are for one of usual size; text is to be that much larger.
    """

    def __init__(self, canvas: PygameCanvas, fps: int, density: float = 1.0) -> None:
        self.canvas, self.density = canvas, density
        self._period = 1.0 / fps
        self._last = self._next = time.perf_counter()

    @classmethod
    @contextmanager
    def open(cls, config: WindowConfig, title: str) -> Iterator[Display]:
        """Open a window for the length of a ``with`` block.

        Raises
        ------
        NoScreen
            If there is no screen to open it on.
        """
        # Otherwise Windows enlarges a picture of fewer pixels, and it is blurred.
        os.environ.setdefault("SDL_WINDOWS_DPI_AWARENESS", "permonitorv2")
        try:
            pygame.display.init()  # not pygame.init(): sound is not needed, and complains where there is none
            _check_visible()
            pygame.font.init()
            pygame.display.set_icon(_icon())
            density = _dpi() / _USUAL_DPI
            surface = pygame.display.set_mode(_size_at_first(config, density), pygame.RESIZABLE)
        except pygame.error as error:
            pygame.quit()
            raise NoScreen(f"no window can be opened: {error}; {_WITHOUT_WINDOW}") from error
        try:
            pygame.display.set_caption(drawable(title))
            _limit(config.least_size)
            surface.fill(DARK.background)
            pygame.display.flip()  # at once, so that no black rectangle greets the user
            yield cls(PygameCanvas(surface), config.fps, density)
        finally:
            pygame.quit()

    @property
    def title(self) -> str:
        """The caption of the window."""
        return pygame.display.get_caption()[0]

    @title.setter
    def title(self, title: str) -> None:
        title = drawable(title)
        if title != self.title:
            pygame.display.set_caption(title)

    @property
    def left(self) -> float:
        """Time [s] until the frame that is being made is due; negative once it is late."""
        return self._next + self._period - time.perf_counter()

    def show(self) -> float:
        """Show what was drawn, wait until the next frame is due, and return the time since the last [s]."""
        pygame.display.flip()
        return self.wait()

    def wait(self) -> float:
        """Wait until the next frame is due, and return the time since the last [s].

        The waits aim at fixed times and not at fixed lengths, and are not rounded to milliseconds as those of
        ``pygame.time.Clock.tick`` are: that would make 62.5 frames a second of 60, and a hitch of every 25th.
        """
        now = time.perf_counter()
        self._next = max(self._next + self._period, now)
        time.sleep(max(self._next - now, 0.0))
        before, self._last = self._last, time.perf_counter()
        return self._last - before

    def rest(self, longest: float) -> None:
        """Wait for the next event, at most so many seconds [s]; what was waited is no time of a frame."""
        deadline = time.perf_counter() + longest
        while time.perf_counter() < deadline and not pygame.event.peek(pump=True):
            time.sleep(self._period)
        self._last = self._next = time.perf_counter()

    def save_screenshot(self, directory: Path) -> Path:
        """Write a PNG of the window and return its path; raise ``OSError`` if that cannot be done."""
        name = datetime.now().strftime("physicslab-%Y%m%d-%H%M%S")
        picture = io.BytesIO()
        pygame.image.save(self.canvas.surface, picture, f"{name}.png")
        return create_first(with_numbers(directory / f"{name}.png"), picture.getvalue())


def _size_at_first(config: WindowConfig, density: float) -> list[int]:
    """Return the size of the window at the start [px]: no larger than the screen, where there is one."""
    size = [round(density * side) for side in config.size]
    if pygame.display.get_driver() in _INVISIBLE:
        return size
    screen = pygame.display.get_desktop_sizes()[0]
    return [max(min(sides), least) for *sides, least in zip(size, screen, config.least_size, strict=True)]


def _dpi() -> float:
    """Return the pixels to the inch of the screen that Windows tells a program which draws each of them."""
    if sys.platform == "win32":
        import ctypes

        return float(ctypes.windll.user32.GetDpiForSystem())
    return _USUAL_DPI


def _check_visible() -> None:
    """Refuse a driver that shows nothing, which SDL takes where there is no screen.

    One that SDL_VIDEODRIVER names is taken: tests draw without a screen.
    """
    driver = pygame.display.get_driver()
    chosen = any(os.environ.get(name) for name in ("SDL_VIDEODRIVER", "SDL_VIDEO_DRIVER"))
    if driver in _INVISIBLE and not chosen:
        pygame.quit()
        raise NoScreen(f"no window can be opened: there is no screen; {_WITHOUT_WINDOW}")


def ask_to_leave() -> None:
    """Have the window closed, as a click on its cross does."""
    if pygame.display.get_init():
        pygame.event.post(pygame.Event(pygame.QUIT))


def wants_to_leave() -> bool:
    """Whether Escape was pressed or the window closed, while there is nothing else for the user to do.

    All other events are kept, in their order, for the next reader: a key that is pressed while a kernel
    is waited for acts when it is there, and nothing seems held that is not.
    """
    events = pygame.event.get()  # of some types alone they would not come in their order
    leaves = any(
        event.type == pygame.QUIT or (event.type == pygame.KEYDOWN and event.key == pygame.K_ESCAPE)
        for event in events
    )
    for event in events:
        if not leaves:
            pygame.event.post(event)
    return leaves


def forget_clicks() -> None:
    """Drop what was clicked while there was nothing to click on; keys are kept."""
    pygame.event.get((pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP))


def _limit(size: tuple[int, int]) -> None:
    """Let the window be made no smaller than this [px], where SDL allows it.

    pygame-ce has no other way to a window made by ``set_mode``, and warns that this one will go.
    """
    with warnings.catch_warnings(), contextlib.suppress(AttributeError, pygame.error):
        warnings.simplefilter("ignore", DeprecationWarning)
        pygame.Window.from_display_module().minimum_size = size


def _icon() -> pygame.Surface:
    """Return the program's icon: a ball that hits a box. Nothing needs to be compiled for it."""
    large = pygame.Surface((256, 256), pygame.SRCALPHA, 32)
    pygame.draw.rect(large, DARK.background, large.get_rect(), border_radius=56)
    ball, box, *_ = DARK.bodies
    for colour, width in ((DARK.fill(ball), 0), (ball, 16)):
        pygame.draw.circle(large, colour, (92, 124), 56, width)
    pygame.draw.line(large, ball, (92, 124), (124, 90), 16)
    for colour, width in ((DARK.fill(box), 0), (box, 16)):
        pygame.draw.rect(large, colour, pygame.Rect(150, 92, 72, 88), width)
    pygame.draw.line(large, DARK.static, (36, 196), (220, 196), 16)
    return pygame.transform.smoothscale(large, (64, 64))
