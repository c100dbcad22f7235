"""Time whole frames of the window: simulation, drawing and HUD, with every overlay on.

``uv run python benchmarks/frames.py [--frames N] [--keys vte]`` prints the median, the 99th percentile and
the maximum [ms] of each part. No screen is needed: SDL's dummy driver takes the picture, 1280 x 720 pixels. A
frame of 60 Hz has 16.7 ms. Each step of a frame is 1/60 s of the world, so "total" is what a frame costs that
keeps up.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

os.environ.setdefault("SDL_VIDEODRIVER", "dummy")

import pygame

from physicslab.config import PhysicsConfig
from physicslab.kernels import KERNELS, compile_kernels
from physicslab.kernels.warm import load_all
from physicslab.prefabs import container, gas, pile
from physicslab.sandbox import Sandbox
from physicslab.scene import load_scene
from physicslab.systems.standard import standard_systems
from physicslab.view.pygame_canvas import PygameCanvas
from physicslab.view.window import Window
from physicslab.world import World

FRAME = 1.0 / 60.0
SIZE = (1280, 720)
PARTS = ("sim", "draw", "hud", "total")
WARM_UP = 60
"""Frames that are not counted: fonts, caches and scales settle in them."""


@dataclass(frozen=True, slots=True)
class Case:
    """A world, how long it has run when the overlays are turned on [s], and which keys turn them on.

    ``disturb`` is what the user does to the window in each frame, if anything.
    """

    name: str
    build: Callable[[], World]
    seconds: float
    keys: str
    disturb: Callable[[Sandbox, int], None] | None = None


def small_gas() -> World:
    """Return a thousand elastic discs between four walls."""
    walls = (-6.0, -3.5, 6.0, 3.5)
    physics = PhysicsConfig(gravity_mode="none", bounds=walls, bounds_restitution=1.0, bounds_friction=0.0)
    world = World(*standard_systems(), physics=physics)
    gas(world, 1_000, walls, radius=0.06)
    return world


def large_pile() -> World:
    """Return four thousand discs that fall into a container."""
    world = World(*standard_systems())
    container(world, width=25, height=16)
    pile(world, 4_000, (0.0, 0.5), columns=90)
    return world


def turn_wheel(sandbox: Sandbox, frame: int) -> None:
    """Zoom in and out about the middle, a notch a frame."""
    sandbox.window.pointer = (0.5 * SIZE[0], 0.5 * SIZE[1])
    notch = 1 if frame % 40 < 20 else -1
    pygame.event.post(pygame.Event(pygame.MOUSEWHEEL, x=0, y=notch, precise_y=float(notch), flipped=False))


def drag_border(sandbox: Sandbox, frame: int) -> None:
    """Make the window larger and smaller, by 20 pixels a frame."""
    shift = 20 * abs(20 - frame % 40)
    canvas = sandbox.window.canvas
    assert isinstance(canvas, PygameCanvas)
    canvas.surface = pygame.display.set_mode((SIZE[0] - shift, SIZE[1] - shift // 2))


def cases(keys: str) -> list[Case]:
    """Return what is timed: with the overlays of these keys, and the large pile plain as well."""
    return [
        Case("pile, falling", lambda: load_scene("pile"), 0.0, keys),
        Case("pile, landing", lambda: load_scene("pile"), 1.0, keys),
        Case("pile, settled", lambda: load_scene("pile"), 12.0, keys),
        Case("gas", small_gas, 0.0, keys),
        Case("large pile, settled", large_pile, 20.0, ""),
        Case("large pile, settled", large_pile, 20.0, keys),
        Case("pile, wheel", lambda: load_scene("pile"), 12.0, "", turn_wheel),
        Case("pile, resized", lambda: load_scene("pile"), 12.0, "", drag_border),
        Case("large pile, wheel", large_pile, 20.0, "", turn_wheel),
        Case("large pile, resized", large_pile, 20.0, "", drag_border),
    ]


def press(name: str) -> None:
    """Post the press of a key, by its name in SDL."""
    code = pygame.key.key_code(name)
    pygame.event.post(pygame.Event(pygame.KEYDOWN, key=code, mod=0, unicode="", scancode=0))


def measure(case: Case, frames: int) -> tuple[np.ndarray[tuple[int, int], np.dtype[np.float64]], Sandbox]:
    """Return what each part of each frame took [ms], a frame a row, and the sandbox as it is then."""
    world = case.build()
    world.run(seconds=case.seconds)
    sandbox = Sandbox(world, Window(PygameCanvas(pygame.display.set_mode(SIZE))))
    for key in case.keys:
        press(key)
    spent = np.zeros((frames, len(PARTS)))
    timings = world.schedule.timings
    for n in range(-WARM_UP, frames):
        if case.disturb is not None:
            case.disturb(sandbox, n + WARM_UP)
        before = {name: timing.nanoseconds for name, timing in timings.items()}
        start = time.perf_counter_ns()
        sandbox.frame(FRAME)
        total = time.perf_counter_ns() - start
        if n >= 0:
            own = {name: timing.nanoseconds - before.get(name, 0) for name, timing in timings.items()}
            draw, hud = own["RenderSystem"], own["HudSystem"]
            spent[n] = total - draw - hud, draw, hud, total
    return spent / 1e6, sandbox


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--frames", type=int, default=300, help="how many are counted of each scene")
    parser.add_argument("--keys", default="vte", help="which are pressed first: V, T and E")
    parser.add_argument("--only", default="", help="what is in the names of the scenes to be timed")
    options = parser.parse_args()
    load_all()
    compile_kernels(KERNELS)
    columns = "".join(f"{part:>23}" for part in PARTS)
    print(f"{'scene':22}{'bodies':>7}  {'on':5}{columns}   median / p99 / maximum, ms")
    for case in cases(options.keys):
        if options.only not in case.name:
            continue
        spent, sandbox = measure(case, options.frames)
        middle, high, most = np.percentile(spent, (50, 99, 100), axis=0)
        row = "".join(f"{a:8.2f} /{b:6.2f}/{c:6.2f}" for a, b, c in zip(middle, high, most, strict=True))
        bodies = len(sandbox.world.entities())
        print(f"{case.name:22}{bodies:7}  {case.keys or '-':5}{row}", flush=True)


if __name__ == "__main__":
    main()
