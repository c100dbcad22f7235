"""Filling the cache of compiled kernels."""

from __future__ import annotations

import gc
import importlib
import os
import pkgutil
import queue
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from types import TracebackType
from typing import Any

from physicslab import kernels
from physicslab.kernels import cache
from physicslab.kernels.interpreter import compile_all_the_same
from physicslab.kernels.keys import current_folders, processor_variables
from physicslab.kernels.loading import compile_kernels, prepare
from physicslab.kernels.program import own_command
from physicslab.kernels.tiers import compile_seconds

_WORKERS_LIMIT = 4
_FIRST = (
    "lone_sweep", "soft", "motion", "fat_boxes", "grid", "near_pairs", "impulse", "slots", "refresh",
    "raster", "triangles", "energy",
)  # fmt: skip
"""Modules whose kernels almost every scene needs, compiled first: what moves it, then its picture."""
WORKER = "--worker"
"""The option of the command ``kernels`` that runs :func:`work`."""
_NICENESS = 10
"""How much higher the priority of a running scene is than that of the workers, as a Unix nice value."""


def is_warm() -> bool:
    """Return whether every kernel can be loaded from the cache, so that nothing needs compiling."""
    try:
        kept = cache.mark().read_text(encoding="utf-8").split()
    except OSError:
        return False
    return all(cache.place_of(folder).is_dir() for folder in kept)


def mark_warm() -> None:
    """Note that every kernel is in the cache, if that is so, and remove what was not used for long."""
    load_all()
    if not all(cache.is_kept(jitted.py_func) for jitted in _own()):
        return
    folders = sorted({current_folders()[jitted.__module__] for jitted in _own()})
    with suppress(OSError):
        cache.mark().write_text("\n".join(folders), encoding="utf-8")
    cache.prune()


def load_all() -> list[str]:
    """Import every module of kernels; return their kernels' full names, in the order of ``KERNELS``."""
    prefix = f"{kernels.__name__}."
    for module in pkgutil.walk_packages(kernels.__path__, prefix):
        if module.name not in (f"{prefix}__main__", __name__):
            importlib.import_module(module.name)
    return [name_of(jitted) for jitted in _own()]


def _own() -> list[Any]:
    """Return the kernels of this package: others, of a test or of a user's program, are compiled there."""
    return [jitted for jitted in kernels.KERNELS if jitted.__module__.startswith(f"{kernels.__name__}.")]


def name_of(jitted: Any) -> str:
    """Return a kernel's full name."""
    return f"{jitted.__module__}.{jitted.__name__}"


def rank_of(name: str) -> int:
    """Return the rank of a kernel in the order of compilation, before the scene is known."""
    module = name.split(".")[-2]
    return _FIRST.index(module) if module in _FIRST else len(_FIRST)


def work() -> int:
    """Compile the kernels whose names come in by stdin, a line each, and print each when it is done."""
    compile_all_the_same()
    names = load_all()
    prepare()
    gc.disable()  # next to nothing of what numba makes is garbage before the process ends
    for line in sys.stdin:
        compile_kernels((kernels.KERNELS[names.index(line.strip())],))
        print(line.strip(), flush=True)
    return 0


@dataclass(frozen=True, slots=True)
class Progress:
    """Progress of compiling: how many kernels of how many, the last one's name, and the share of the work."""

    done: int
    total: int
    name: str = ""
    share: float = 0.0


class Warmup:
    """Compiles every kernel that the cache does not hold, in processes of their own.

    A thread of this process would block everything else for tenths of a second, again and again. Used in a
    ``with`` block, at the end of which the processes are stopped if they still run. If one fails, nothing is
    lost: a missing kernel is compiled when it is first needed, and fails then with its reason.

    The first process has the machine to itself until its first kernel is done, which is what a small scene
    spends most of its time in; the others start then. All yield to what runs beside them.

    Parameters
    ----------
    workers : int, optional
        How many processes; by default one for each processor, up to four.
    command : sequence of str
        The command that each runs in place of :func:`work`.

    Attributes
    ----------
    finished : bool
        Whether there is nothing left to wait for.
    """

    def __init__(self, workers: int | None = None, command: tuple[str, ...] = ()) -> None:
        self._command = command or own_command("kernels", WORKER)
        names = load_all()
        self._compiled = {name_of(jitted) for jitted in _own() if cache.is_kept(jitted.py_func)}
        self._jobs = deque(sorted((name for name in names if name not in self._compiled), key=rank_of))
        self._lock = threading.Lock()
        self._answers: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._workers = min(workers or min(os.cpu_count() or 1, _WORKERS_LIMIT), len(self._jobs))
        self._processes: list[subprocess.Popen[str]] = []
        self._threads: list[threading.Thread] = []
        self._costs = {name_of(jitted): compile_seconds(jitted) for jitted in _own()}
        self._urgent: dict[str, tuple[float, float]] = {}
        self._begun: dict[str, float] = {}
        self._took, self._foreseen = 0.0, 0.0  # what compiling took so far, and should have taken [s]
        self._progress = Progress(len(self._compiled), len(names), share=self._share())
        self.finished = False

    def __enter__(self) -> Warmup:
        if self._workers:
            self._start_worker()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._lock:
            self._workers = 0
        for process in self._processes:
            process.kill()  # one that is still importing would say on stderr what ended it
        for thread in self._threads:
            thread.join()

    def _start_others(self) -> None:
        """Start the other processes, and let all yield to what runs beside them."""
        with self._lock:
            while len(self._processes) < self._workers:
                self._start_worker()
            for process in self._processes if hasattr(os, "setpriority") else ():
                with suppress(OSError):  # it has ended
                    niceness = os.getpriority(os.PRIO_PROCESS, 0) + _NICENESS
                    os.setpriority(os.PRIO_PROCESS, process.pid, niceness)

    def _start_worker(self) -> None:
        environment = {**os.environ, **processor_variables(), cache.VARIABLE: str(cache.cache_directory())}
        process = subprocess.Popen(
            self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1,
            env=environment, start_new_session=True,  # Ctrl+C is for the program, which ends its workers
        )  # fmt: skip
        thread = threading.Thread(target=self._employ, args=(process,), daemon=True)
        self._processes.append(process)
        self._threads.append(thread)
        thread.start()

    def _employ(self, process: subprocess.Popen[str]) -> None:
        """Give one process a kernel after the other, until none is left or the work is stopped."""
        with (
            suppress(OSError),
            process,
        ):  # at the end it is closed, which fails like writing where it has ended
            assert process.stdin is not None
            assert process.stdout is not None
            while job := self._next():
                process.stdin.write(f"{job}\n")
                name = process.stdout.readline().strip()
                if not name:
                    break
                self._took += time.monotonic() - self._begun[name]
                self._foreseen += self._costs[name]
                self._answers.put(name)
                self._start_others()
            process.stdin.close()

    def _next(self) -> str:
        with self._lock:
            name = ""
            if self._jobs:
                urgent = [name for name in self._jobs if name in self._urgent]
                name = max(urgent, key=self._urgent.__getitem__) if urgent else self._jobs[0]
                self._jobs.remove(name)
            self._begun[name] = time.monotonic()
            return name

    def hurry(self, spent: Mapping[str, float]) -> None:
        """Compile these kernels before all others, except for those that are being compiled.

        Parameters
        ----------
        spent : mapping
            How long [s] each was interpreted so far, infinity for what is waited for: what has cost most for
            the time that it takes to compile comes first, of equal ones that which takes longest.
        """
        with self._lock:
            for name in spent.keys() & self._costs.keys():
                self._urgent[name] = spent[name] / self._costs[name], self._costs[name]

    def has(self, names: Iterable[str]) -> bool:
        """Whether these kernels were in the cache at the last :meth:`poll`."""
        return self._compiled.issuperset(names)

    def seconds_left(self, names: Iterable[str]) -> float:
        """Return about how long [s] it takes until these kernels are compiled, if they come first."""
        slowness, now = self._took / self._foreseen if self._foreseen else 1.0, time.monotonic()
        left = [
            max(slowness * self._costs[name] - (now - self._begun.get(name, now)), 1.0)
            for name in names
            if name not in self._compiled
        ]
        return max(max(left, default=0.0), sum(left) / max(self._workers, 1))

    def _share(self) -> float:
        """Return how much of the work is done (0 to 1)."""
        done = sum(self._costs[name] for name in self._compiled)
        return done / max(sum(self._costs.values()), 1e-9)

    def poll(self, wait: float = 0.0) -> Progress:
        """Return how far it is, at once or after the next kernel; after ``wait`` seconds at the latest."""
        done, name, total = self._progress.done, self._progress.name, self._progress.total
        ended = not any(thread.is_alive() for thread in self._threads)
        with suppress(queue.Empty):
            while True:
                name = self._answers.get(timeout=wait) if wait else self._answers.get_nowait()
                done, wait = done + 1, 0.0
                self._compiled.add(name)
        self._progress = Progress(done, total, name, self._share())
        if done == total and not self.finished:
            mark_warm()
        self.finished = self.finished or ended or done == total
        return self._progress
