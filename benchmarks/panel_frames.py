"""Time frames of the window with the inspector and two graphs open, against frames without any panel.

``uv run python benchmarks/panel_frames.py [SCENE] [--frames N]`` shows one scene twice, and lets both make
frames in turn, so that what else the machine does meets both. It prints the median, the 95th and the 99th
percentile [ms] of each, by the clock and in time of the processor, and ends with what panels add to the 95th:
at most 2 ms are allowed. Exit code 1 says that it was more by both.
"""

from __future__ import annotations

import argparse
import gc
import os
import sys
import time

import numpy as np

os.environ.setdefault("SDL_VIDEODRIVER", "dummy")

import pygame
from frames import FRAME, SIZE, WARM_UP, press

from physicslab.components import Transform, Velocity
from physicslab.desktop.sandbox import Sandbox
from physicslab.files.scene import load_scene
from physicslab.kernels import KERNELS, compile_kernels
from physicslab.kernels.warm import load_all
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.window.window import Window

PERCENTILES = (50, 95, 99)
ALLOWED = 2.0
"""What panels may add to the 95th percentile [ms]."""


def opened(scene: str) -> Sandbox:
    """Return a window on a scene."""
    return Sandbox(load_scene(scene), Window(PygameCanvas(pygame.display.set_mode(SIZE))))


def with_panels(scene: str) -> Sandbox:
    """Return a window with a body in the inspector, a graph of its motion and one of the energies."""
    sandbox = opened(scene)
    press("m")
    sandbox.frame(FRAME)
    sandbox.window.selection.take(sandbox.world.batch(Transform, Velocity).entities.tolist()[0])
    press("m")
    sandbox.frame(FRAME)
    return sandbox


def without_panels(scene: str) -> Sandbox:
    """Return a window in which no panel is built or shown."""
    sandbox = opened(scene)
    sandbox.frame(FRAME)
    sandbox.interface.build = lambda *given: None  # type: ignore[method-assign]
    sandbox.interface.draw = lambda canvas: None  # type: ignore[method-assign]
    return sandbox


def main() -> int:
    """Print the table; return whether panels add too much."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("scene", nargs="?", default="sandbox")
    parser.add_argument("--frames", type=int, default=1200, help="how many are counted of each")
    options = parser.parse_args()
    load_all()
    compile_kernels(KERNELS)
    pygame.display.init()
    windows = {"without panels": without_panels(options.scene), "with panels": with_panels(options.scene)}
    spent = np.zeros((options.frames, len(windows), 2))
    gc.freeze()
    for n in range(-WARM_UP, options.frames):
        for k, sandbox in enumerate(windows.values()):
            wall, cpu = time.perf_counter_ns(), time.process_time_ns()
            sandbox.frame(FRAME)
            cpu, wall = time.process_time_ns() - cpu, time.perf_counter_ns() - wall
            if n >= 0:
                spent[n, k] = wall / 1e6, cpu / 1e6
    found = np.percentile(spent, PERCENTILES, axis=0)
    print(f"{options.scene:16}  median     p95     p99   ms; CPU: median     p95     p99")
    for k, name in enumerate(windows):
        wall_ms, cpu_ms = ("".join(f"{one:8.2f}" for one in found[:, k, clock]) for clock in (0, 1))
        print(f"{name:16}{wall_ms}          {cpu_ms}")
    added = found[1, 1] - found[1, 0]
    print(
        f"panels add {added[0]:.2f} ms to the 95th percentile, {added[1]:.2f} ms of CPU; {ALLOWED:g} may be"
    )
    return int(min(added) > ALLOWED)


if __name__ == "__main__":
    sys.exit(main())
