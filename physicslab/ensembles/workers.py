"""Who makes the runs: this process, threads, processes or any executor; and what is done where they die."""

from __future__ import annotations

import math
import multiprocessing
import os
import queue
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from physicslab.ensembles.task import Block, Task, ready, work
from physicslab.lab.jobs import ProcessEnded, Processes

KINDS = ("processes", "threads", "serial")
"""Workers that are started here."""
AIM_S = 0.5
"""About how long a piece of work takes [s]: long beside handing it over, short beside what a crash costs."""
MOST_WORKERS = 1000
"""How many may be started here: each process takes some 170 MB."""
MOST_ROWS = 1000
"""Rows of a piece of work."""
_AHEAD = 3
"""Pieces that are handed over for each worker."""
_UNKNOWN = 64
"""Workers that an executor is taken to have that does not say how many."""
_DEATHS = 3
"""How often a run must end its process to be taken for the reason."""
_UNGUARDED = 78
"""Exit status of a process that began by running the script that has started it."""


class Serial(Executor):
    """Works in this process, as soon as something is handed over."""

    _max_workers = 1

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Do it now."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


@dataclass
class _Piece:
    """Rows that are worked on together, and how often that has ended a process."""

    first: int
    last: int
    deaths: int = 0


class Workers:
    """An executor, and what is tried again where its processes die, in a ``with`` block.

    Parameters
    ----------
    kind : str or Executor
        ``"serial"``, ``"threads"``, ``"processes"``, or an executor that stays the caller's.
    count : int, optional
        How many workers there are; by default one for each processor, or as many as the executor says.
    """

    def __init__(self, kind: str | Executor, count: int | None) -> None:
        self._kind, self._count = kind, count
        self._own: Executor | None = None
        self._done: queue.SimpleQueue[tuple[_Piece, Future[Block]]] = queue.SimpleQueue()
        self._flying: set[Future[Block]] = set()
        self._begun = False

    def __enter__(self) -> Workers:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        for future in [*self._flying]:
            future.cancel()
        if kind is not None and isinstance(self._own, Processes):
            self._own.abandon()
        elif self._own is not None:
            self._own.shutdown(wait=kind is None, cancel_futures=True)

    def blocks(self, task: Task, missing: Iterator[tuple[int, int]]) -> Iterator[Block]:
        """Yield the results of the missing rows, in whatever order they come.

        The first is made alone: kernels that it needs are compiled once, and its time tells how many rows
        are worth a piece. A piece that ends its process is halved, to find the run that does it.

        Raises
        ------
        BrokenExecutor
            If the caller's executor does not work any more.
        RuntimeError
            If processes begin by running the script that starts them.
        """
        ahead, waiting = _Ahead(missing), deque[_Piece]()
        while True:
            while len(self._flying) < self._room():
                piece = waiting.popleft() if waiting else ahead.next()
                if piece is None:
                    break
                self._submit(task, piece)
            if not self._flying:
                return
            piece, future = self._done.get()
            self._flying.discard(future)
            if future.cancelled():
                raise BrokenExecutor("the executor has given up what was handed to it")
            error = future.exception()
            if error is None:
                self._begun, block = True, future.result()
                ahead.learn(block)
                yield block
            else:
                self._check(error)
                again = _after(piece, isinstance(error, ProcessEnded))
                waiting.extendleft(reversed(again))
                if not again:
                    yield _failed(task, piece, error)

    def _room(self) -> int:
        """Return how many pieces may be worked on at once."""
        if not self._begun or self._kind == "serial":
            return 1
        count = self._count or getattr(self._executor, "_max_workers", None)
        return _AHEAD * (count if isinstance(count, int) else _UNKNOWN)

    def _check(self, error: BaseException) -> None:
        """Raise an error after which no piece is worth another try."""
        if isinstance(error, ProcessEnded):
            if error.status == _UNGUARDED:
                raise RuntimeError(
                    "ensemble: each process that it starts runs this script again: call it under "
                    'if __name__ == "__main__":, or with executor="threads"'
                ) from None
        elif isinstance(error, BrokenExecutor) or not self._begun:
            raise error

    @property
    def _executor(self) -> Executor:
        if isinstance(self._kind, Executor):
            return self._kind
        if self._own is None:
            count = self._count or os.cpu_count() or 1
            if self._kind == "serial":
                self._own = Serial()
            elif self._kind == "threads":
                self._own = ThreadPoolExecutor(count)
            else:
                if getattr(multiprocessing.current_process(), "_inheriting", False):
                    raise SystemExit(_UNGUARDED)  # the one that has started this process says why
                self._own = Processes(count)
        return self._own

    def _submit(self, task: Task, piece: _Piece) -> None:
        future: Future[Block] = self._executor.submit(work, task.payload, piece.first, piece.last)
        if not self._begun and self._kind == "processes":  # all import while the first makes the first row
            for _ in range(min(self._count or os.cpu_count() or 1, len(task.space)) - 1):
                self._executor.submit(ready)
        self._flying.add(future)
        future.add_done_callback(lambda done: self._done.put((piece, done)))


class _Ahead:
    """Divides the rows that are missing into pieces that each take about as long."""

    def __init__(self, missing: Iterator[tuple[int, int]]) -> None:
        self._missing, self._size = missing, 1
        self._rest = (0, 0)

    def next(self) -> _Piece | None:
        """Return the next piece."""
        while self._rest[0] == self._rest[1]:
            found = next(self._missing, None)
            if found is None:
                return None
            self._rest = found
        first, end = self._rest
        last = min(first + self._size, end)
        self._rest = last, end
        return _Piece(first, last)

    def learn(self, block: Block) -> None:
        """Choose the size by how long runs take; at first it grows tenfold at most."""
        each = float(block.wall_s.mean())
        self._size = max(1, min(int(AIM_S / max(each, 1e-9)), 10 * self._size, MOST_ROWS))


def _after(piece: _Piece, died: bool) -> list[_Piece]:
    """Return what is tried again of a piece that came to nothing; nothing where its one run is the reason."""
    if piece.last - piece.first > 1:
        middle = (piece.first + piece.last) // 2
        return [_Piece(piece.first, middle), _Piece(middle, piece.last)]
    deaths = piece.deaths + 1
    return [replace(piece, deaths=deaths)] if died and deaths < _DEATHS else []


def _failed(task: Task, piece: _Piece, error: BaseException) -> Block:
    """Return the result of a run that no process survives."""
    reason = "the process that made this run ended" if isinstance(error, ProcessEnded) else str(error)
    count = piece.last - piece.first
    values = np.full((count, len(task.measures)), math.nan)
    return Block(
        piece.first, values, np.full(count, math.nan), dict.fromkeys(range(piece.first, piece.last), reason)
    )
