"""Cases of a lab in several processes, where no figure depends on what else the machine does."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait

from physicslab.kernels.warm import Warmup, is_warm

__all__ = ["in_processes"]

_WORTH_A_PROCESS = 8
"""As many cases take longer than a process needs to start."""


def in_processes[Result](
    work: Callable[[str], Result], names: Sequence[str], runs: Sequence[Sequence[str]]
) -> Iterator[float | Result]:
    """Run a function for each name, in a process for each processor; yield shares done, and results in order.

    Parameters
    ----------
    work : callable
        A function of a module: takes a name, and returns what can be pickled.
    runs : sequence of sequences of str
        The names again, in the order in which they begin; those of one sequence share a process.

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
        futures = {name: future for run in runs for future in [pool.submit(_each, work, run)] for name in run}
        try:
            yield from _in_order(futures, names)
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _each[Result](work: Callable[[str], Result], names: Sequence[str]) -> dict[str, Result]:
    return {name: work(name) for name in names}


def _in_order[Result](
    futures: Mapping[str, Future[dict[str, Result]]], names: Sequence[str]
) -> Iterator[float | Result]:
    for name in names:
        while not futures[name].done():
            yield sum(future.done() for future in futures.values()) / len(futures)
            wait([future for future in futures.values() if not future.done()], return_when=FIRST_COMPLETED)
        yield futures[name].result()[name]
