"""What a user of the library waits for: recording against running, a located moment, a reset.

    uv run python benchmarks/library.py [SCENE ...]

Ratios are those of the fastest of several runs that are made in turn, in one process.
"""

import sys
import time
from collections.abc import Callable

from physicslab import World, load_scene
from physicslab.scenes import SCENES

_ROUNDS = 5
_SECONDS = 5.0


def fastest(*calls: Callable[[], object], reset: Callable[[], object]) -> list[float]:
    """Return the processor time [s] of the fastest of several calls of each, made in turn after a reset."""
    found = [float("inf")] * len(calls)
    for _ in range(_ROUNDS):
        for number, call in enumerate(calls):
            reset()
            began = time.process_time()
            call()
            found[number] = min(found[number], time.process_time() - began)
    return found


def compared(world: World) -> str:
    """Return what a run takes [ms], and by how much longer recorded ones take."""
    world.record(0.1)
    world.reset()
    run, every_step, some = fastest(
        lambda: world.run(seconds=_SECONDS),
        lambda: world.record(_SECONDS),
        lambda: world.record(_SECONDS, every=0.1),
        reset=world.reset,
    )
    return f"{1e3 * run:9.2f} {every_step / run:11.2f} {some / run:11.2f}"


def main(names: list[str]) -> None:
    """Print the table, and what the rest takes."""
    print(f"{'scene':18}{'run [ms]':>9} {'every step':>11} {'every 0.1 s':>11}   of {_SECONDS:g} s")
    for name in names or SCENES:
        print(f"{name:18}{compared(load_scene(name))}", flush=True)
    world = load_scene("drop")
    world.run(seconds=1.0)
    times = []
    for _ in range(200):
        world.run(steps=1)
        began = time.process_time()
        world.reset()
        times.append(time.process_time() - began)
    print(f"reset of drop: {1e3 * min(times):.3f} ms, {1e3 * sorted(times)[100]:.3f} ms in the middle")
    (moment,) = fastest(lambda: world.record(3.0, until="ball.x >= -2.5 m"), reset=world.reset)
    print(f"until ball.x >= -2.5 m, 30 steps: {1e3 * moment:.2f} ms")


if __name__ == "__main__":
    main(sys.argv[1:])
