"""Time small scenes alone, far bodies alone, and both in one world, in turns; compare with the sum.

``uv run python benchmarks/islands.py [--scenes N] [--json FILE]`` takes the scenes and the far bodies of
``tests/test_islands.py``. Printed are, for each kind of far bodies, the median and the largest ratio over the
scenes; that of a scene is the median over turns of the CPU time of both together over the sum of both alone.
"""

import argparse
import gc
import json
import statistics
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from test_islands import crowd, floor, orbits, random_scene, thirteen

from physicslab import World

BEGIN, STEPS, TURNS = 30, 240, 9
"""Steps before the first turn, steps of a turn (one call), and turns."""
FAR: dict[str, Callable[[World], object]] = {
    "a crowd of 500": partial(crowd, count=500), "13 more bodies": thirteen, "orbits": orbits,
}  # fmt: skip


def worlds_of(seed: int, far: Callable[[World], object]) -> list[World]:
    """Return a small scene alone, far bodies alone, and both in one world."""
    worlds = [World() for _ in range(3)]
    for number, world in enumerate(worlds):
        floor(world)
        if number != 1:
            random_scene(world, seed)
        if number != 0:
            far(world)
        world.run(steps=BEGIN)
    return worlds


def ratio_of(worlds: list[World]) -> float:
    """Return the time of both together over the sum of both alone."""
    ratios: list[float] = []
    for _ in range(TURNS):
        spent: list[int] = []
        for world in worlds:
            began = time.process_time_ns()
            world.run(steps=STEPS)
            spent.append(time.process_time_ns() - began)
        ratios.append(spent[2] / (spent[0] + spent[1]))
    return statistics.median(ratios)


def main() -> None:
    """Print the ratios."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--scenes", type=int, default=40)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    gc.disable()
    found: dict[str, list[float]] = {}
    for name, far in FAR.items():
        found[name] = [ratio_of(worlds_of(seed, far)) for seed in range(arguments.scenes)]
        ratios = found[name]
        print(f"{name:16} median {statistics.median(ratios):.3f}, largest {max(ratios):.3f}")
        gc.collect()
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(found, indent=1), "utf-8")


if __name__ == "__main__":
    main()
