"""The cost of compiling: every kernel once, in one process, into an empty cache.

``python tests/compile_budget.py`` prints what each cost, and what is over the budget.

The first launch waits for it, so it does not grow unnoticed. Processor time is counted, which other programs
on the machine change less than the time that passes; by as much as they do, a loop of Python takes longer,
and the limits are for that much more. Kernels come in the order of the first launch; an inner
function counts for the first that calls it.
"""

import gc
import os
import shutil
import tempfile
import time
from pathlib import Path

from physicslab.kernels import cache
from physicslab.kernels.compiler import KERNELS
from physicslab.kernels.interpreter import compile_all_the_same
from physicslab.kernels.keys import platform_key
from physicslab.kernels.loading import load, prepare
from physicslab.kernels.warm import load_all, mark_warm, name_of, rank_of
from physicslab.lab.report import machine

LIMIT_TOTAL_S = 60.0
LIMIT_EACH_S = 6.0
"""Limits wanted on an idle processor. A limit of cost is printed and fails nothing: whoever exceeds it says
by how much, and it is not moved."""
_SAMPLE, _SAMPLE_S = 500_000, 0.0255
"""Steps of a loop that is timed between kernels, and what it takes on the processor of the limits, idle."""
_EVERY = 8
"""Kernels from one such loop to the next."""


def measure() -> tuple[list[tuple[float, str]], float]:
    """Compile every kernel into an empty cache; return processor seconds and names, in that order.

    And how many times as long as on the idle processor of the limits a loop took meanwhile, at least 1. What
    was compiled then goes into the real cache, so that it need not be compiled again. Call it in a fresh
    process, before any module of kernels is imported.
    """
    target = cache.cache_directory()
    # Beside the real cache, and so on the same disk.
    with tempfile.TemporaryDirectory(prefix="budget-", dir=target) as fresh:
        cache.use_directory(Path(fresh))
        try:
            load_all()
            prepare()
            gc.disable()
            costs, samples = [], []
            for jitted in sorted(KERNELS, key=lambda jitted: rank_of(name_of(jitted))):
                start = time.process_time()
                load(jitted)
                costs.append((time.process_time() - start, name_of(jitted)))
                if len(costs) % _EVERY == 1:
                    samples.append(_sample())
        finally:
            gc.enable()
            cache.use_directory(target)
        _keep(Path(fresh), target)
    mark_warm()
    return costs, max(1.0, sum(samples) / len(samples) / _SAMPLE_S)


def _sample() -> float:
    """Return the processor time of a loop of Python [s]."""
    start, total = time.process_time(), 0
    for i in range(_SAMPLE):
        total += i * i % 7
    return time.process_time() - start


def _keep(fresh: Path, target: Path) -> None:
    """Move compiled kernels to where they are kept, in place of those that are there."""
    for folder in fresh.iterdir():
        shutil.rmtree(target / folder.name, ignore_errors=True)
        os.replace(folder, target / folder.name)


def check(
    costs: list[tuple[float, str]], each: float = LIMIT_EACH_S, total: float = LIMIT_TOTAL_S
) -> list[str]:
    """Return what exceeds the budget, a line each; nothing where all is within it."""
    found = [f"{name}: {cost:.1f} s, more than {each:g} s" for cost, name in costs if cost > each]
    whole = sum(cost for cost, _ in costs)
    return found + ([f"all kernels: {whole:.1f} s, more than {total:g} s"] if whole > total else [])


def table(costs: list[tuple[float, str]]) -> str:
    """Return the costs as text, the largest first, with their sum and the processor that they are of."""
    rows = [
        f"{cost:7.2f} s  {name.removeprefix('physicslab.kernels.')}" for cost, name in sorted(costs)[::-1]
    ]
    whole = sum(cost for cost, _ in costs)
    processor = f"{machine()['cpu']} ({platform_key()['processor']})"
    return "\n".join([*rows, f"{whole:7.2f} s  all {len(costs)} kernels, of processor time; {processor}"])


def main() -> None:
    """Measure and tell; a limit of cost fails nothing."""
    costs, slowness = measure()
    print(table(costs))
    print(f"a loop of Python took {slowness:.2f} times as long as on an idle processor; divided by that,")
    over = check([(cost / slowness, name) for cost, name in costs])
    print("\n".join(over) or "all are within the budget")


if __name__ == "__main__":
    compile_all_the_same()
    main()
