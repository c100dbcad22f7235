"""Processes that work for this one, each led by a thread and with a pipe of its own, which ends with it."""

import multiprocessing
import os
import queue
import signal
import threading
import traceback
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from typing import Any

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
        wait([process.sentinel], _PATIENCE_S)
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
