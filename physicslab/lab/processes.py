"""Cases of a lab in several processes, where no figure depends on what else the machine does."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait

from physicslab.kernels.warm import Warmup, is_warm

__all__ = ["in_processes"]

_WORTH_A_PROCESS = 8
"""As many cases take longer than a process needs to start."""


def in_processes[Result](work: Callable[[str], Result], names: Sequence[str]) -> Iterator[float | Result]:
    """Run a function for each name, in a process for each processor; yield shares done, and results in order.

    Parameters
    ----------
    work : callable
        A function of a module: takes a name, and returns what can be pickled.

    Raises
    ------
    BrokenProcessPool
        If a process ends before its work does, as it does where memory runs out.
    """
    workers = min(os.cpu_count() or 1, len(names) // _WORTH_A_PROCESS)
    if workers < 2:
        for done, name in enumerate(names):
            yield done / len(names)
            yield work(name)
        return
    if not is_warm():  # each process would compile the same kernels
        with Warmup() as warmup:
            while not warmup.finished:
                warmup.poll(0.1)
    # A fork would share threads of the compiled code: each worker imports for itself.
    with ProcessPoolExecutor(workers, multiprocessing.get_context("spawn")) as pool:
        futures = [pool.submit(work, name) for name in names]
        try:
            yield from _in_order(futures)
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _in_order[Result](futures: Sequence[Future[Result]]) -> Iterator[float | Result]:
    shown = 0
    while shown < len(futures):
        if futures[shown].done():
            yield futures[shown].result()
            shown += 1
        else:
            yield sum(future.done() for future in futures) / len(futures)
            wait([future for future in futures if not future.done()], return_when=FIRST_COMPLETED)
