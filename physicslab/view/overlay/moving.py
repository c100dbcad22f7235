"""Pictures of a world one after the other, for a film, without a window or a display."""

from dataclasses import replace

import numpy as np
import pygame
from numpy.typing import NDArray

from physicslab.theme import DARK
from physicslab.view.canvas.camera import Camera, Drawing, Extent
from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.overlay.instruments import draw_instruments, instruments_of
from physicslab.view.overlay.labels import Labels
from physicslab.view.picture.picture import draw_world
from physicslab.world import World

_TEXT = 14
"""Height of the words of instruments [px]."""
_AROUND = 0.04
"""Room left around what is to be seen, as a share of the picture."""


class MovingPicture:
    """Draws a world and what measures in it again and again, as one camera sees it.

    Parameters
    ----------
    size : tuple of two ints
        Width and height [px].
    extent : Extent
        The part of the world to be seen [m].
    """

    def __init__(self, size: tuple[int, int], extent: Extent) -> None:
        self._surface = pygame.Surface(size, 0, 32)
        self._labels = Labels()
        camera = Camera(size, scale=100.0)
        camera.look_at(extent, camera.fitting_scale(extent, (0, 0, *size), _AROUND))
        # The few colours of a film are for bodies: its sky has one.
        plain = replace(DARK, grain=0, sky_top=DARK.background, sky_bottom=DARK.background)
        self._drawing = Drawing(PygameCanvas(self._surface), camera, plain, _TEXT)

    def pixels(self, world: World) -> NDArray[np.uint8]:
        """Return the world as it is now: uint8 (height, width, 4), red, green, blue and one unused."""
        on = self._drawing
        with world.active():
            draw_world(world, on.camera, on.theme, on.canvas)
            draw_instruments(world, list(instruments_of(world)), (), self._labels, (), on)
        return pixels_of(self._surface)


def part_of(surface: pygame.Surface, rect: Rect, size: tuple[int, int]) -> NDArray[np.uint8]:
    """Return the pixels of a part of a surface [px] in a picture of some size, as :func:`pixels_of` does."""
    part = surface.subsurface(pygame.Rect(rect).clip(surface.get_rect()))
    return pixels_of(part if part.get_size() == size else pygame.transform.smoothscale(part, size))


def pixels_of(surface: pygame.Surface) -> NDArray[np.uint8]:
    """Return the pixels of a surface: uint8 (height, width, 4), red, green, blue and one unused."""
    width, height = surface.get_size()
    return np.frombuffer(pygame.image.tobytes(surface, "RGBX"), np.uint8).reshape(height, width, 4)
