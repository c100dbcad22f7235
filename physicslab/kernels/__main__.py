"""``python -m physicslab.kernels`` fills the cache of kernels; a line "done total name" for each.

``python -m physicslab.kernels budget`` compiles all of them into an empty cache in one process, prints what
each cost, and says what is over the budget.
"""

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


def _budget() -> int:
    from physicslab.kernels import compile_budget

    costs, slowness = compile_budget.measure()
    print(compile_budget.table(costs))
    print(f"a loop of Python took {slowness:.2f} times as long as on an idle processor; divided by that,")
    over = compile_budget.check([(cost / slowness, name) for cost, name in costs])
    print("\n".join(over) or "all are within the budget")
    return 0


if __name__ == "__main__":
    compile_all_the_same()
    sys.exit({"budget": _budget}.get(" ".join(sys.argv[1:]), _fill)())
