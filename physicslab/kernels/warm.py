"""Fills the cache of compiled kernels, and knows whether it is full."""

from __future__ import annotations

import hashlib
import importlib
import os
import pkgutil
import queue
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

import llvmlite.binding

from physicslab import kernels

__all__ = ["Progress", "Warmup", "is_warm", "load_all", "name_of"]

_MOST_WORKERS = 4
_FIRST = (
    "raster",
    "motion",
    "energy",
    "grid",
    "contact",
    "impact",
    "impulse",
    "slots",
    "refresh",
)
"""Modules whose kernels almost every scene needs; they are compiled first."""
_WORKER = (sys.executable, "-m", "physicslab.kernels", "worker")


def _mark() -> Path:
    """Return the file that says that all kernels are in the cache.

    Its name stands for all that numba looks at before it uses what it finds there: when the sources were
    written, the processor, and which Python it is.
    """
    digest = hashlib.sha256(f"{sys.version} {llvmlite.binding.get_host_cpu_name()}".encode())
    for source in sorted(Path(__file__).parent.rglob("*.py")):
        status = source.stat()
        digest.update(f"{source} {status.st_mtime_ns} {status.st_size}".encode())
    return kernels.cache_directory() / f"complete-{digest.hexdigest()[:16]}"


def is_warm() -> bool:
    """Return whether every kernel can be loaded from the cache, so that nothing needs compiling."""
    return _mark().is_file()


def load_all() -> list[str]:
    """Import every module of kernels; return their kernels' full names, in the order of ``KERNELS``."""
    prefix = f"{kernels.__name__}."
    for module in pkgutil.walk_packages(kernels.__path__, prefix):
        if module.name not in (f"{prefix}__main__", __name__):
            importlib.import_module(module.name)
    return [name_of(jitted) for jitted in kernels.KERNELS]


def name_of(jitted: Any) -> str:
    """Return a kernel's full name."""
    return f"{jitted.__module__}.{jitted.__name__}"


def _rank(name: str) -> int:
    """Return how late a kernel is to be compiled, as far as that is known before there is a scene."""
    module = name.split(".")[-2]
    return _FIRST.index(module) if module in _FIRST else len(_FIRST)


@dataclass(frozen=True, slots=True)
class Progress:
    """How far the compiling is: so many kernels of so many, and the name of the last."""

    done: int
    total: int
    name: str = ""


class Warmup:
    """Compiles every kernel into the cache, in processes of their own.

    In a thread of this process it would hold up everything else for tenths of a second, time and again. Used
    in a ``with`` block, at whose end the processes are stopped if they still run. If one fails, nothing is
    lost: what is missing is compiled when it is first needed, and fails then with its reason.

    Parameters
    ----------
    workers : int, optional
        How many processes; one for each processor, up to four, where nothing is said.
    command : sequence of str
        What each runs: it reads names of kernels, a line each, and prints each when it is compiled.

    Attributes
    ----------
    finished : bool
        Whether there is nothing left to wait for.
    """

    def __init__(self, workers: int | None = None, command: tuple[str, ...] = _WORKER) -> None:
        self._command = command
        self._mark = _mark()  # of the sources as they are now, whatever is saved meanwhile
        self._names = load_all()
        self._jobs = deque(sorted(self._names, key=_rank))
        self._lock = threading.Lock()
        self._answers: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._compiled: set[str] = set()
        self._workers = workers or min(os.cpu_count() or 1, _MOST_WORKERS)
        self._processes: list[subprocess.Popen[str]] = []
        self._threads: list[threading.Thread] = []
        self._progress = Progress(0, len(self._names))
        self.finished = False

    def __enter__(self) -> Warmup:
        for _ in range(self._workers):
            process = subprocess.Popen(
                self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1
            )
            thread = threading.Thread(target=self._employ, args=(process,), daemon=True)
            self._processes.append(process)
            self._threads.append(thread)
            thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for process in self._processes:
            process.terminate()
        for thread in self._threads:
            thread.join()

    def _employ(self, process: subprocess.Popen[str]) -> None:
        """Give one process a kernel after the other, until there are none left or it has died."""
        with process:
            assert process.stdin is not None
            assert process.stdout is not None
            try:
                while job := self._next():
                    process.stdin.write(f"{job}\n")
                    name = process.stdout.readline().strip()
                    if not name:
                        break
                    self._answers.put(name)
                process.stdin.close()
            except OSError:
                return

    def _next(self) -> str:
        with self._lock:
            return self._jobs.popleft() if self._jobs else ""

    def hurry(self, names: Iterable[str]) -> None:
        """Let these kernels be compiled before all others, except for those that are being compiled."""
        with self._lock:
            wanted = [name for name in dict.fromkeys(names) if name in self._jobs]  # two may need the same
            for name in wanted:
                self._jobs.remove(name)
            self._jobs.extendleft(reversed(wanted))

    def has(self, names: Iterable[str]) -> bool:
        """Whether these kernels were in the cache at the last :meth:`poll`."""
        return self._compiled.issuperset(names)

    def poll(self) -> Progress:
        """Return how far it is now, without waiting."""
        done, name = self._progress.done, self._progress.name
        ended = not any(thread.is_alive() for thread in self._threads)
        while not self._answers.empty():
            done, name = done + 1, self._answers.get()
            self._compiled.add(name)
        self._progress = Progress(done, len(self._names), name)
        if done == len(self._names) and not self.finished:
            self._mark.touch()
        self.finished = self.finished or ended or done == len(self._names)
        return self._progress
