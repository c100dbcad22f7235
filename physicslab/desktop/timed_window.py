"""A world that is stepped with the systems of a window installed, for the benchmark."""

import os
from typing import override

import pygame

from physicslab.desktop.sandbox import Sandbox
from physicslab.lab.bench.engine import Engine
from physicslab.systems.system import Stage
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.window.window import Window
from physicslab.world import World

_SIZE = (1280, 720)
_FRAME = 1.0 / 60.0


class InWindow(Engine):
    """PhysicsLab in a window that no screen shows, stepped one step a call.

    Parameters
    ----------
    world : World
        The world that is stepped.
    """

    def __init__(self, world: World) -> None:
        super().__init__(world)
        os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
        self._sandbox = Sandbox(world, Window(PygameCanvas(pygame.display.set_mode(_SIZE))))

    @override
    def run(self, steps: int) -> None:
        for _ in range(steps):
            self.world.step()

    @override
    def pause(self) -> None:
        """Draw a frame without a step, so that frame systems use what they have recorded."""
        for stage in (Stage.INPUT, Stage.RENDER, Stage.HUD):
            self._sandbox.world.frame(stage, _FRAME)
