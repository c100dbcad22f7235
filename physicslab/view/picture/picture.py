"""The whole picture of a world, and a file of it, without a window or a display."""

import os
from typing import BinaryIO

import pygame

from physicslab.ecs.config import WindowConfig
from physicslab.theme import DARK, Theme
from physicslab.view.canvas.camera import Camera, Extent
from physicslab.view.canvas.canvas import Canvas
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.picture.backdrop import draw_backdrop, is_in_space
from physicslab.view.picture.bodies import draw_bodies
from physicslab.view.picture.extent import extent_of
from physicslab.view.picture.fields import draw_fields, draw_flames
from physicslab.view.picture.joints import draw_joints
from physicslab.view.picture.springs import draw_springs
from physicslab.view.picture.squash import Squash
from physicslab.view.picture.trails import draw_strobes, draw_trails
from physicslab.world import World

_WINDOW = WindowConfig()


def picture_of(
    world: World, size: tuple[int, int], theme: Theme = DARK, extent: Extent | None = None
) -> pygame.Surface:
    """Return a picture of the world as it is now.

    Parameters
    ----------
    size : tuple of two ints
        Width and height [px].
    extent : Extent, optional
        The part to be seen; by default that of its scene, or else all.
    """
    surface = pygame.Surface(size, 0, 32)
    camera = Camera(size, scale=_WINDOW.pixels_per_metre)
    shown = extent or world.view or extent_of(world)
    if shown is not None:
        camera.look_at(shown, camera.fitting_scale(shown))
    with world.active():
        draw_world(world, camera, theme, PygameCanvas(surface))
    return surface


def save_png(world: World, path_or_stream: str | os.PathLike[str] | BinaryIO) -> None:
    """Write a PNG of the world as it is now, all of it fitted into the picture.

    Parameters
    ----------
    world : World
        It is not changed.
    path_or_stream : path or binary stream
        Where to write. A file at that path is replaced.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    surface = picture_of(world, _WINDOW.size, extent=extent_of(world))
    if isinstance(path_or_stream, str | os.PathLike):
        with open(path_or_stream, "wb") as stream:
            pygame.image.save(surface, stream, "picture.png")
    else:
        pygame.image.save(surface, path_or_stream, "picture.png")


def draw_world(
    world: World, camera: Camera, theme: Theme, canvas: Canvas, *, grid: bool | None = None,
    squash: Squash | None = None,
) -> None:  # fmt: skip
    """Draw a world as it is now, with or without the grid; by default without it in space.

    Nothing of the world is changed.
    """
    world.synchronise()
    draw_backdrop(world, camera, theme, canvas, grid=not is_in_space(world) if grid is None else grid)
    draw_fields(world, camera, theme, canvas)
    draw_strobes(world, camera, theme, canvas)
    draw_trails(world, camera, theme, canvas)
    draw_flames(world, camera, theme, canvas)
    draw_bodies(world, camera, theme, canvas, squash)
    draw_springs(world, camera, theme, canvas)
    draw_joints(world, camera, theme, canvas)
