"""The work of a lab: jobs one after the other, or in processes where no figure depends on the machine.

Each process is led by a thread, has a pipe of its own, and ends with it.
"""

import gc
import multiprocessing
import os
import queue
import signal
import threading
import traceback
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from multiprocessing.connection import Connection
from multiprocessing.connection import wait as wait_for_end
from multiprocessing.context import SpawnProcess
from typing import Any

from physicslab.kernels.warm import Warmup, is_warm

_HAS_MASKS = hasattr(signal, "pthread_sigmask")
"""Whether signals can be held back, as everywhere but on Windows."""
_PATIENCE_S = 5.0
"""How long [s] a process without work may take to end."""

type _Call = tuple[Future[Any], Callable[..., Any], tuple[Any, ...], dict[str, Any]]


class ProcessEnded(BrokenExecutor):
    """A process ended before its work did.

    Attributes
    ----------
    status : int or None
        Its exit status; the negative number of the signal that ended it.
    """

    def __init__(self, status: int | None) -> None:
        super().__init__("a process was ended from outside; is there enough memory?")
        self.status = status


class NoProcess(BrokenExecutor, OSError):
    """No process can be started: the system has none left, or no memory, or this folder is gone."""


class Processes(Executor):
    """Processes that end without a word with the one that began them, killed as it may be, or by Ctrl+C.

    Whoever waits here waits for a pipe of which one process alone has the other end: if that process ends, be
    it in the midst of a message, the pipe ends too. The call that it worked on fails, others do not, and
    another process takes its place. Pools of the standard library share their pipes, and wait for ever for
    the rest of a message. Threads start the processes, since Python interrupts the main thread alone.

    A fork would share threads of the compiled code: each process imports for itself. Until it has, Ctrl+C
    waits, else Python would write where in an import it was.

    Parameters
    ----------
    count : int
        How many processes there are at most. Each call starts one, until there are as many.
    """

    def __init__(self, count: int) -> None:
        self._max_workers = count
        self._calls: queue.SimpleQueue[_Call | None] = queue.SimpleQueue()
        self._leaders: list[threading.Thread] = []
        self._lock = threading.Lock()
        self._processes: set[SpawnProcess] = set()
        self._closed = self._abandoned = False

    def submit[**P, T](self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Hand over a call, for which a process may be started."""
        if self._closed:
            raise RuntimeError("no call can be handed over after the end")
        future: Future[T] = Future()
        self._calls.put((future, fn, args, kwargs))
        if len(self._leaders) < self._max_workers:
            leader = threading.Thread(target=self._lead, name="leader", daemon=True)
            self._leaders.append(leader)
            leader.start()
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End each process after its work, or after all that has been handed over."""
        self._closed = True
        if cancel_futures:
            while not self._calls.empty():
                call = self._calls.get()
                if call is not None:
                    call[0].cancel()
        for _ in self._leaders:
            self._calls.put(None)
        if wait:
            for leader in self._leaders:
                leader.join()

    def abandon(self) -> None:
        """End all processes at once, in the midst of their work."""
        with self._lock:
            self._abandoned = True
            for process in self._processes:
                process.kill()
        self.shutdown(wait=False, cancel_futures=True)

    def _lead(self) -> None:
        """Hand calls over to a process, one after the other; to another one where it ends."""
        worker = None
        while (call := self._calls.get()) is not None:
            future, *what = call
            if not future.set_running_or_notify_cancel():
                continue
            try:
                worker = worker or self._started()
                if worker is None:
                    raise EOFError
                worker[1].send(what)
                done, answer = worker[1].recv()
            except NoProcess as error:
                future.set_exception(error)
            except (EOFError, OSError):
                future.set_exception(ProcessEnded(worker and self._ended(*worker)))
                worker = None
            except Exception as error:  # it cannot be pickled
                future.set_exception(error)
            else:
                (future.set_result if done else future.set_exception)(answer)
        if worker is not None:
            self._ended(*worker)

    def _started(self) -> tuple[SpawnProcess, Connection] | None:
        """Return a process and the pipe to it; none once all are given up.

        Raises
        ------
        NoProcess
            If none can be started.
        """
        with self._lock:
            if self._abandoned:
                return None
            try:
                process, here, there = self._start()
            except OSError as error:
                raise NoProcess(f"no process can be started: {error.strerror or error}") from error
            self._processes.add(process)
        there.close()
        return process, here

    @staticmethod
    def _start() -> tuple[SpawnProcess, Connection, Connection]:
        """Return a new process, and both ends of a pipe to it."""
        here, there = multiprocessing.Pipe()
        process = multiprocessing.get_context("spawn").Process(target=_work, args=(there,), daemon=True)
        if _HAS_MASKS:
            from multiprocessing import resource_tracker  # Windows has none

            resource_tracker.ensure_running()  # which lets signals through
            signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT,))  # the process inherits it
        process.start()
        return process, here, there

    def _ended(self, process: SpawnProcess, connection: Connection) -> int | None:
        """Have a process end, and return its exit status."""
        connection.close()
        wait_for_end([process.sentinel], _PATIENCE_S)
        with self._lock:  # no other thread may take the status of a child meanwhile
            self._processes.discard(process)
            process.kill()
            process.join()
        return process.exitcode


# ---- in the process ----------------------------------------------------------------------------------------


def _work(connection: Connection) -> None:
    """Make one call after the other, until the pipe is closed."""
    threading.Thread(target=_follow_parent, name="parent", daemon=True).start()
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    if _HAS_MASKS:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT,))
    while True:
        try:
            function, arguments, named = connection.recv()
        except EOFError:
            return
        except Exception as error:  # what this process cannot import
            connection.send((False, error))
            continue
        try:
            answer = True, function(*arguments, **named)
        except BaseException as error:
            error.add_note("".join(traceback.format_exception(error)))
            answer = False, error
        try:
            connection.send(answer)
        except Exception as error:  # it cannot be pickled
            connection.send((False, RuntimeError(f"{type(error).__name__}: {error}")))


def _follow_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


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
