"""``python -m physicslab.kernels`` fills the cache of kernels; a line "done total name" for each."""

import sys

from physicslab.kernels.interpreter import compile_all_the_same
from physicslab.kernels.warm import Progress, Warmup


def _fill() -> int:
    shown = Progress(-1, 0)
    with Warmup() as warmup:
        while not warmup.finished:
            progress = warmup.poll(0.1)
            if progress != shown:
                print(progress.done, progress.total, progress.name, flush=True)
                shown = progress
    return 0 if shown.done == shown.total else 1


if __name__ == "__main__":
    compile_all_the_same()
    sys.exit(_fill())
