"""What more cores could give a crowd: two at once measured, more of them projected.

``uv run python benchmarks/cores.py [SCENE ...]`` takes scenes of the benchmark, settled; both cores should be
idle. Printed are the wall clock of a step alone, and while another process makes the same steps, which
shares caches and memory with it; the share p of a step in systems that go through bodies, springs and
contacts, which threads could divide (blocks of one colour have no body in common); and by how much a step
would be faster on n cores, 1 / (1 - p + p / (n e)), where e is what two at once leave of the speed of each.
"""

import argparse
import multiprocessing
import statistics
import time
from multiprocessing.synchronize import Barrier

from physicslab.lab.bench.catalogue import SCENES
from physicslab.world import World

SETTLE, STEPS, TURNS = 300, 60, 7
"""Steps before the first turn, steps of a turn, and turns."""
CORES = 2, 4, 8
DIVISIBLE = "IntegrateSystem", "GravitySystem", "SpringSystem", "DragSystem", "ContactSystem", "ResolveSystem"


def ms_a_step(world: World, turns: int) -> float:
    """Return the median over turns of the wall clock of a step [ms]."""
    spent = []
    for _ in range(turns):
        began = time.perf_counter()
        world.run(steps=STEPS)
        spent.append((time.perf_counter() - began) / STEPS * 1e3)
    return statistics.median(spent)


def share_in_systems(world: World, ms: float) -> float:
    """Return the share of a step of ``ms`` milliseconds that is spent in systems that can be divided."""
    before = {name: timing.nanoseconds for name, timing in world.schedule.timings.items()}
    world.run(steps=STEPS)
    spent = sum(
        world.schedule.timings[name].nanoseconds - before[name] for name in DIVISIBLE if name in before
    )
    return min(1.0, spent / STEPS / 1e6 / ms)


def beside(name: str, ready: Barrier, done: Barrier) -> None:
    """Make the same steps beside the process that measures, until that has measured."""
    world = SCENES[name].build()
    world.run(steps=SETTLE)
    ready.wait()
    ms_a_step(world, 2 * TURNS)
    done.wait()


def main() -> None:
    """Print a line for each scene."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("scenes", nargs="*", default=["pyramid_60", "pile_4000", "gas_2000", "funnel"])
    for name in parser.parse_args().scenes:
        world = SCENES[name].build()
        world.run(steps=SETTLE)
        alone = ms_a_step(world, TURNS)
        share = share_in_systems(world, alone)
        ready, done = multiprocessing.Barrier(2), multiprocessing.Barrier(2)
        other = multiprocessing.Process(target=beside, args=(name, ready, done))
        other.start()
        ready.wait()
        together = ms_a_step(world, TURNS)
        done.wait()
        other.join()
        left = min(1.0, alone / together)
        gains = ", ".join(f"{n}: {1.0 / (1.0 - share + share / (n * left)):.2f}" for n in CORES)
        measured = f"{alone:.3f} ms alone, {together:.3f} beside another"
        print(f"{name}: {measured}; p = {share:.2f}, e = {left:.2f}; {gains}", flush=True)


if __name__ == "__main__":
    multiprocessing.set_start_method("spawn")
    main()
