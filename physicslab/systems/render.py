"""The picture of the world."""

from __future__ import annotations

from typing import TYPE_CHECKING

from physicslab.schedule import Stage, System, at
from physicslab.view.painting import draw_world

if TYPE_CHECKING:
    from physicslab.view.window import Window
    from physicslab.world import World

__all__ = ["RenderSystem"]


class RenderSystem(System):
    """Draws the world as the camera sees it, and changes nothing of it.

    Parameters
    ----------
    window : Window
        The camera, the theme and the canvas.
    """

    def __init__(self, window: Window) -> None:
        self._window = window

    @at(Stage.RENDER)
    def draw(self, world: World, elapsed: float) -> None:
        """Draw the world."""
        window = self._window
        draw_world(world, window.camera, window.theme, window.canvas)
        window.sparks.draw(window.camera, window.theme, window.canvas)
