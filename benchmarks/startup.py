"""Time the start of the window: from the command to the first picture, and to the first simulated frame.

``uv run python benchmarks/startup.py [SCENE] [--runs N] [--cold] [--seconds S]`` starts ``python main.py``
as a user does, and prints for each run and as medians, wall and CPU time [s] since the process was started:

- window: the first picture is in the window, a bar of progress or the scene
- first step: a picture of the world is shown that has made a step
- moves after: how long after the window that is
- life's speed: how long after the window the world has first moved for a second in at most 1.05 s, and as
  CPU time of the window's own process; "held" is its speed from then on, until every kernel is compiled
- all kernels: every kernel is compiled, and in the cache (with ``--cold``, which waits for it)
- all CPU: of all processes until the window is closed, those that compile included
- slowest: the longest time [ms] between two pictures from then on, and how many exceeded 33 ms

``--cold`` gives each run a cache of its own that is empty, as on the first launch: of kernels, and of
Python's bytecode, numba's included. Without it a run before the counted ones fills both. SDL's dummy driver
takes the picture unless SDL_VIDEODRIVER says otherwise. The load average before each run is printed: wall
times are those of an idle machine only where it is near 0, CPU times nearly so.
"""

from __future__ import annotations

import argparse
import itertools
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
HOOK = """
import atexit, importlib.abc, importlib.machinery, json, os, sys, time

moments, state = {"flips": [], "times": []}, {"world": None}
SECONDS = float(os.environ["STARTUP_SECONDS"])
PATIENCE = float(os.environ["STARTUP_PATIENCE"])

def now():
    return time.time() - float(os.environ["STARTUP_BEGAN"]), time.process_time()

def watch_display():
    import pygame
    flip = pygame.display.flip
    def watched():
        flip()
        wall, cpu = now()
        moments.setdefault("window", (wall, cpu))
        if state["world"] is not None:
            moments.setdefault("first_step", (wall, cpu))
            moments["flips"].append(wall)
            moments["times"].append((wall, cpu, state["world"].time))
            done = "all_kernels" in moments or wall > PATIENCE
            if done and wall > moments["first_step"][0] + SECONDS:
                pygame.event.post(pygame.Event(pygame.QUIT))
    pygame.display.flip = watched

def watch_world():
    world = sys.modules["physicslab.world"].World
    step = world.step
    def watched(self, *arguments, **named):
        state["world"] = self
        return step(self, *arguments, **named)
    world.step = watched

def watch_kernels():
    warm = sys.modules["physicslab.kernels.warm"]
    mark = warm.mark_warm
    def watched():
        mark()
        moments["all_kernels"] = now()
    warm.mark_warm = watched

HOOKS = {
    "physicslab.view.canvas.display": watch_display, "physicslab.world": watch_world,
    "physicslab.kernels.warm": watch_kernels,
}

class Finder(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name not in HOOKS:
            return None
        spec = importlib.machinery.PathFinder.find_spec(name, path)
        execute = spec.loader.exec_module
        def execute_and_watch(module):
            execute(module)
            HOOKS[name]()
        spec.loader.exec_module = execute_and_watch
        return spec

sys.meta_path.insert(0, Finder())
atexit.register(lambda: json.dump(moments, open(os.environ["STARTUP_FILE"], "w")))
"""
"""Put into the started program as its ``sitecustomize``: it notes when pictures are shown."""


def start(scene: str, cache: Path, seconds: float, patience: float = 0.0) -> dict[str, float]:
    """Start the program once; return the times [s] of its first pictures and its slowest frame [ms]."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "sitecustomize.py").write_text(HOOK)
        reported = Path(folder) / "moments.json"
        environment = {"SDL_VIDEODRIVER": "dummy", **os.environ} | {
            "PYTHONPATH": folder, "XDG_CACHE_HOME": str(cache), "XDG_STATE_HOME": folder,
            "PYTHONPYCACHEPREFIX": str(cache / "bytecode"), "PYTHONDONTWRITEBYTECODE": "",
            "STARTUP_BEGAN": repr(time.time()), "STARTUP_FILE": str(reported),
            "STARTUP_SECONDS": str(seconds), "STARTUP_PATIENCE": str(patience),
        }  # fmt: skip
        command = (sys.executable, str(ROOT / "main.py"), scene)
        before = _children_cpu()
        subprocess.run(command, env=environment, check=True, cwd=folder)
        cpu = _children_cpu() - before
        moments = json.loads(reported.read_text())
    flips = moments["flips"]
    until = moments.get("all_kernels", (flips[-1],))[0]
    gaps = [1e3 * (after - before) for before, after in itertools.pairwise(flips)]
    return {
        "window": moments["window"][0],
        "window CPU": moments["window"][1],
        "first step": moments["first_step"][0],
        "first step CPU": moments["first_step"][1],
        "moves after": moments["first_step"][0] - moments["window"][0],
        "moves after, CPU": moments["first_step"][1] - moments["window"][1],
        **_life(moments["times"], moments["window"], until),
        **({"all kernels": moments["all_kernels"][0]} if "all_kernels" in moments else {}),
        "all CPU": cpu,
        "slowest, ms": max(gaps),
        "above 33 ms": sum(gap > 33.4 for gap in gaps),
    }


def _life(
    times: list[tuple[float, float, float]], opened: tuple[float, float], until: float
) -> dict[str, float]:
    """Return when the world first moved at life's speed for a second, and how fast it was from then on."""
    first = 0
    for wall, cpu, time_now in times:
        while time_now - times[first][2] > 1.0:
            first += 1
        began, _, time_then = times[first]
        if time_now - time_then > 0.9 and wall - began <= 1.05 * (time_now - time_then):
            ends = max((one for one in times if one[0] <= max(until, wall)), default=times[-1])
            held = (ends[2] - time_then) / max(ends[0] - began, 1e-9)
            return {
                "life's speed": began - opened[0],
                "life's speed, CPU": times[first][1] - opened[1],
                "held": held,
                "CPU for a second": (cpu - times[first][1]) / (time_now - time_then),
            }
    return {}


def _children_cpu() -> float:
    """Return the processor time [s] of all processes that this one has started, and of those they started."""
    times = os.times()
    return times.children_user + times.children_system


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("scene", nargs="?", default="sandbox")
    parser.add_argument("--runs", type=int, default=5, help="how many are counted")
    parser.add_argument("--seconds", type=float, default=3.0, help="how long each simulates")
    parser.add_argument("--cold", action="store_true", help="with an empty cache, as on a first launch")
    parser.add_argument("--patience", type=float, default=600.0, help="how long --cold waits for all kernels")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as kept:
        if not options.cold:
            command = (sys.executable, "-m", "physicslab.kernels")
            environment = os.environ | {"XDG_CACHE_HOME": kept}
            subprocess.run(command, env=environment, stdout=subprocess.DEVNULL, check=True, cwd=ROOT)
            start(options.scene, Path(kept), 0.5)
        rows = []
        for number in range(options.runs):
            cache = Path(kept) / f"run-{number}" if options.cold else Path(kept)
            print(f"load {os.getloadavg()[0]:.1f}  ", end="")
            rows.append(
                start(options.scene, cache, options.seconds, options.patience if options.cold else 0.0)
            )
            print("  ".join(f"{name} {value:.3f}" for name, value in rows[-1].items()), flush=True)
    print(
        "median:  "
        + "  ".join(f"{name} {statistics.median(r[name] for r in rows if name in r):.3f}" for name in rows[0])
    )


if __name__ == "__main__":
    main()
