"""``python -m physicslab.kernels`` fills the cache of kernels; a line "done total name" for each."""

from __future__ import annotations

import os
import sys
import time

from physicslab.kernels import KERNELS, compile_kernels
from physicslab.kernels.interpreter import compile_all_the_same
from physicslab.kernels.warm import Progress, Warmup, load_all

_YIELDING = 15
"""By how much others come first, as Unix counts it."""


def _fill() -> int:
    shown = Progress(-1, 0)
    with Warmup() as warmup:
        while not warmup.finished:
            progress = warmup.poll()
            if progress != shown:
                print(progress.done, progress.total, progress.name, flush=True)
                shown = progress
            time.sleep(0.05)
    return 0 if shown.done == shown.total else 1


def _work() -> int:
    """Compile the kernels whose names come in, a line each, and say so when one is done."""
    if hasattr(os, "nice"):
        os.nice(_YIELDING)  # a scene may run by now in the process that waits for the rest
    names = load_all()
    for line in sys.stdin:
        compile_kernels((KERNELS[names.index(line.strip())],))
        print(line.strip(), flush=True)
    return 0


if __name__ == "__main__":
    compile_all_the_same()
    sys.exit(_work() if sys.argv[1:] == ["worker"] else _fill())
