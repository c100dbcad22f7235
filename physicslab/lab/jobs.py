"""The work of a lab: jobs one after the other, or in processes where no figure depends on the machine."""

import gc
import os
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait

from physicslab.kernels.warm import Warmup, is_warm
from physicslab.lab.processes import Processes

type Job[Result] = Generator[float, None, Result]
"""Work that yields the share of it that is done (0 to 1) now and then, and returns the result."""

_WORTH_A_PROCESS = 8
"""As many cases take longer than a process needs to start."""


def run_jobs[Result](jobs: Iterable[tuple[float, Job[Result]]]) -> Iterator[float | Result]:
    """Run jobs one after the other; yield the share of the whole that is done, and each result.

    Each begins with the garbage of the one before collected: worlds hold cycles.

    Parameters
    ----------
    jobs : iterable of pairs
        How much of the whole each is, in any unit, and the job.
    """
    listed = list(jobs)
    whole, done = sum(weight for weight, _ in listed) or 1.0, 0.0  # a scene may have no bodies: a weight of 0
    for weight, job in listed:
        gc.collect()
        yield done / whole
        yield (yield from scaled(job, done / whole, (done + weight) / whole))
        done += weight


def scaled[Result](job: Job[Result], low: float, high: float) -> Job[Result]:
    """Do a job that is the part from ``low`` to ``high`` of a whole.

    >>> def halves():
    ...     yield 0.5
    ...     return "done"
    >>> list(scaled(halves(), 0.6, 1.0)), result_of(scaled(halves(), 0.6, 1.0))
    ([0.8], 'done')
    """
    while True:
        try:
            share = next(job)
        except StopIteration as end:
            found: Result = end.value
            return found
        yield low + (high - low) * share


def result_of[Result](job: Job[Result], show: Callable[[float], object] = float) -> Result:
    """Do a job, show each share that is done, and return the result."""
    while True:
        try:
            show(next(job))
        except StopIteration as end:
            found: Result = end.value
            return found


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
    ProcessEnded
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
    with Processes(workers) as pool:
        futures = {name: future for run in runs for future in [pool.submit(_each, work, run)] for name in run}
        try:
            yield from _in_order(futures, names)
        except BaseException:  # else the end of the block waits
            pool.abandon()
            raise


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
