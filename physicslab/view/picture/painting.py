"""The whole picture of a world, from back to front."""

from __future__ import annotations

from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas
from physicslab.view.canvas.theme import Theme
from physicslab.view.picture.backdrop import draw_bounds, draw_grid
from physicslab.view.picture.bodies import draw_bodies
from physicslab.view.picture.springs import draw_springs
from physicslab.view.picture.strobe import draw_strobes
from physicslab.view.picture.trails import draw_trails
from physicslab.world import World

__all__ = ["draw_world"]


def draw_world(world: World, camera: Camera, theme: Theme, canvas: Canvas, *, grid: bool = True) -> None:
    """Draw a world as it is now, with or without the grid. Nothing of the world is changed."""
    world.synchronise()
    canvas.clear(theme.background)
    if grid:
        draw_grid(camera, theme, canvas)
    draw_bounds(world.physics.bounds, camera, theme, canvas)
    draw_strobes(world, camera, theme, canvas)
    draw_trails(world, camera, theme, canvas)
    draw_bodies(world, camera, theme, canvas)
    draw_springs(world, camera, theme, canvas)
