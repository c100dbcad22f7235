"""Time whole frames of the window: simulation, drawing and HUD, with every overlay on.

``uv run python benchmarks/frames.py [--frames N] [--keys vte]`` prints the median, the 99th percentile and
the maximum [ms] of each part. No screen is needed: SDL's dummy driver takes the picture, 1280 x 720 pixels. A
frame of 60 Hz has 16.7 ms. Each step of a frame is 1/60 s of the world, so "total" is what a frame costs that
keeps up; "CPU" is the same frame by the clock of the process, which does not run while another program has
the processor. ``--slowest K`` lists the parts of the K slowest frames of each scene, garbage collection
included. As in the program, what was loaded is not searched for garbage.
"""

from __future__ import annotations

import argparse
import gc
import os
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

os.environ.setdefault("SDL_VIDEODRIVER", "dummy")

import pygame

from physicslab.desktop.sandbox import Sandbox
from physicslab.ecs.config import PhysicsConfig
from physicslab.files.scene import load_scene
from physicslab.kernels import KERNELS, compile_kernels
from physicslab.kernels.warm import load_all
from physicslab.prefabs import container, gas, pile
from physicslab.systems.standard import standard_systems
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.window.window import Window
from physicslab.world import World

FRAME = 1.0 / 60.0
SIZE = (1280, 720)
SMALLEST, LARGEST = (640, 480), (1920, 1080)
PARTS = ("input", "sim", "draw", "hud", "total", "CPU", "gc")
SHOWN = 6
"""How many of the parts are in the table."""
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


def resize(sandbox: Sandbox, size: tuple[int, int]) -> None:
    """Give the window another size [px], as SDL does when its border is dragged."""
    canvas = sandbox.window.canvas
    assert isinstance(canvas, PygameCanvas)
    canvas.surface = pygame.display.set_mode(size)


def drag_border(sandbox: Sandbox, frame: int) -> None:
    """Make the window larger and smaller, between a small screen and a large one, and let it rest at both.

    The border moves for 20 frames by a twentieth of the way each; in the rest, as long, the text follows.
    """
    way = min(frame % 40, 20) / 20.0
    share = way if frame % 80 < 40 else 1.0 - way
    size = tuple(round(a + share * (b - a)) for a, b in zip(SMALLEST, LARGEST, strict=True))
    if size != sandbox.window.canvas.size:
        resize(sandbox, (size[0], size[1]))


def maximise(sandbox: Sandbox, frame: int) -> None:
    """Change between a small window and a large one at once, every half second."""
    if frame % 30 == 0:
        resize(sandbox, LARGEST if frame % 60 == 0 else SMALLEST)


def cases(keys: str) -> list[Case]:
    """Return what is timed: with the overlays of these keys, and the large pile plain as well."""
    return [
        Case("pile, falling", lambda: load_scene("pile"), 0.0, keys),
        Case("pile, landing", lambda: load_scene("pile"), 1.0, keys),
        Case("pile, settled", lambda: load_scene("pile"), 12.0, keys),
        Case("gas", small_gas, 0.0, keys),
        Case("large pile, settled", large_pile, 20.0, ""),
        Case("large pile, settled", large_pile, 20.0, keys),
        *(Case(f"pile, settled, {key}", lambda: load_scene("pile"), 12.0, key) for key in keys),
        *(Case(f"large pile, {key}", large_pile, 20.0, key) for key in keys),
        Case("gas, trails", small_gas, 0.0, "t"),
        Case("large pile, wheel", large_pile, 20.0, "t", turn_wheel),
        Case("large pile, dragged", large_pile, 20.0, "t", drag_border),
        Case("large pile, maximised", large_pile, 20.0, "t", maximise),
    ]


def press(name: str) -> None:
    """Post the press of a key, by its name in SDL."""
    code = pygame.key.key_code(name)
    pygame.event.post(pygame.Event(pygame.KEYDOWN, key=code, mod=0, unicode="", scancode=0))


class Collections:
    """How long garbage collection took so far [ns]."""

    def __init__(self) -> None:
        self.nanoseconds = 0
        self._began = 0
        gc.callbacks.append(self._note)

    def _note(self, phase: str, info: dict[str, int]) -> None:
        if phase == "start":
            self._began = time.perf_counter_ns()
        else:
            self.nanoseconds += time.perf_counter_ns() - self._began


def measure(
    case: Case, frames: int, collections: Collections
) -> tuple[np.ndarray[tuple[int, int], np.dtype[np.float64]], Sandbox]:
    """Return what each part of each frame took [ms], a frame a row, and the sandbox as it is then."""
    world = case.build()
    world.run(seconds=case.seconds)
    sandbox = Sandbox(world, Window(PygameCanvas(pygame.display.set_mode(SIZE))))
    for key in case.keys:
        press(key)
    spent = np.zeros((frames, len(PARTS)))
    timings = world.schedule.timings
    gc.freeze()
    for n in range(-WARM_UP, frames):
        before = {name: timing.nanoseconds for name, timing in timings.items()}
        collected, cpu, start = collections.nanoseconds, time.process_time_ns(), time.perf_counter_ns()
        if case.disturb is not None:
            case.disturb(sandbox, n + WARM_UP)
        sandbox.frame(FRAME)
        total, cpu = time.perf_counter_ns() - start, time.process_time_ns() - cpu
        if n >= 0:
            own = {name: timing.nanoseconds - before.get(name, 0) for name, timing in timings.items()}
            heard, draw, hud = own["InputSystem"], own["RenderSystem"], own["HudSystem"]
            collected = collections.nanoseconds - collected
            spent[n] = heard, total - heard - draw - hud, draw, hud, total, cpu, collected
    return spent / 1e6, sandbox


def print_slowest(spent: np.ndarray[tuple[int, int], np.dtype[np.float64]], count: int) -> None:
    """Say what the slowest frames were made of."""
    for n in np.argsort(-spent[:, PARTS.index("total")])[:count]:
        parts = "  ".join(f"{part} {value:.2f}" for part, value in zip(PARTS, spent[n], strict=True))
        print(f"    frame {n}: {parts}")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--frames", type=int, default=300, help="how many are counted of each scene")
    parser.add_argument("--keys", default="vte", help="which are pressed first: V, T and E")
    parser.add_argument("--slowest", type=int, default=0, help="how many slow frames are taken apart")
    parser.add_argument("--only", default="", help="what is in the names of the scenes to be timed")
    options = parser.parse_args()
    load_all()
    compile_kernels(KERNELS)
    collections = Collections()
    columns = "".join(f"{part:>21}" for part in PARTS[:SHOWN])
    print(f"{'scene':22}{'bodies':>7}  {'on':5}{columns}   median, p99, maximum, ms")
    for case in cases(options.keys):
        if options.only not in case.name:
            continue
        spent, sandbox = measure(case, options.frames, collections)
        percentiles = np.percentile(spent[:, :SHOWN], (50, 99, 100), axis=0)
        row = "".join(f"{a:8.2f}{b:6.1f}{c:6.1f} " for a, b, c in percentiles.T)
        bodies = len(sandbox.world.entities())
        print(f"{case.name:22}{bodies:7}  {case.keys or '-':5}{row}", flush=True)
        print_slowest(spent, options.slowest)


if __name__ == "__main__":
    main()
