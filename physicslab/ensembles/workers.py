"""Who makes the runs: this process, threads, processes or any executor; and what is done where they die."""

from __future__ import annotations

import math
import multiprocessing
import os
import queue
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from physicslab.ensembles.task import Block, Task, ready, work
from physicslab.lab.jobs import Processes

KINDS = ("processes", "threads", "serial")
"""Workers that are started here."""
AIM_S = 0.5
"""About how long a piece of work takes [s]: long beside handing it over, short beside what a crash costs."""
MOST_ROWS = 1000
"""Rows of a piece of work."""
_AHEAD = 3
"""Pieces that are handed over for each worker."""
_UNKNOWN = 64
"""Workers that an executor is taken to have that does not say how many."""
_SUSPECT = 2
"""Deaths of processes after which a piece is worked on alone."""
_DEATHS = 3
"""How often a run that is alone must then end its process to be taken for the reason."""
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
    """Rows that are worked on together, and how often a process has ended meanwhile."""

    first: int
    last: int
    deaths: int = 0


class Workers:
    """An executor, made again where its processes die, in a ``with`` block.

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
        self._children: set[Any] = set()

    def __enter__(self) -> Workers:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        for future in [*self._flying]:
            future.cancel()
        if kind is not None and isinstance(self._own, Processes):
            self._own.abandon()
        self._stop(wait=kind is None)

    def blocks(self, task: Task, missing: Iterator[tuple[int, int]]) -> Iterator[Block]:
        """Yield the results of the missing rows, in whatever order they come.

        The first is made alone: kernels that it needs are compiled once, and its time tells how many rows
        are worth a piece. So is a piece during which processes have ended twice, to find the run that does
        it.

        Raises
        ------
        BrokenExecutor
            If the caller's executor does not work any more.
        RuntimeError
            If processes begin by running the script that starts them.
        """
        ahead, waiting = _Ahead(missing), deque[_Piece]()
        while True:
            while len(self._flying) < self._room(waiting):
                piece = waiting.popleft() if waiting else ahead.next()
                if piece is None:
                    break
                self._submit(task, piece)
            if not self._flying:
                return
            piece, future = self._done.get()
            self._flying.discard(future)
            if future.cancelled():  # it waited in a pool that was given up
                if isinstance(self._kind, Executor):
                    raise BrokenExecutor("the executor has given up what was handed to it")
                waiting.appendleft(piece)
                continue
            error = future.exception()
            if error is None:
                self._begun, block = True, future.result()
                ahead.learn(block)
                yield block
            else:
                alone = not self._flying
                self._bury(error)
                again = _after(piece, alone and piece.deaths >= _SUSPECT, isinstance(error, BrokenExecutor))
                waiting.extendleft(reversed(again))
                if not again:
                    yield _failed(task, piece, error)

    def _room(self, waiting: deque[_Piece]) -> int:
        """Return how many pieces may be worked on at once."""
        if not self._begun or any(piece.deaths >= _SUSPECT for piece in waiting):
            return 1
        if self._kind == "serial":
            return 1
        count = self._count or getattr(self._executor, "_max_workers", None)
        return _AHEAD * (count if isinstance(count, int) else _UNKNOWN)

    def _bury(self, error: BaseException) -> None:
        """Make ready for another try, or raise where there is none."""
        if not isinstance(error, BrokenExecutor):
            if not self._begun:
                raise error
        elif isinstance(self._kind, Executor):
            raise error
        elif any(child.exitcode == _UNGUARDED for child in self._children):
            raise RuntimeError(
                "ensemble: each process that it starts runs this script again: call it under if __name__ == "
                '"__main__":, or with executor="threads"'
            ) from None
        else:
            self._stop(wait=True)

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

    def _stop(self, *, wait: bool) -> None:
        own, self._own = self._own, None
        if own is not None:
            own.shutdown(wait=wait, cancel_futures=True)

    def _submit(self, task: Task, piece: _Piece) -> None:
        try:
            future: Future[Block] = self._executor.submit(work, task.payload, piece.first, piece.last)
        except BrokenExecutor as error:  # it broke a moment ago, and its pieces are about to say so
            future = Future()
            future.set_exception(error)
        if not self._begun and self._kind == "processes":
            self._start_all(len(task.space))
        self._flying.add(future)
        future.add_done_callback(lambda done: self._done.put((piece, done)))

    def _start_all(self, rows: int) -> None:
        """Have all processes import what rows need while the first makes the first row."""
        count = min(self._count or os.cpu_count() or 1, rows)
        with suppress(BrokenExecutor):  # the first row is about to say so
            for _ in range(count - 1):
                self._executor.submit(ready)
        self._children.update(multiprocessing.active_children())


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


def _after(piece: _Piece, guilty: bool, died: bool) -> list[_Piece]:
    """Return what is tried again of a piece that came to nothing; nothing where its one run is the reason."""
    count, deaths = piece.last - piece.first, piece.deaths + 1
    if not guilty and died:
        return [replace(piece, deaths=deaths)]
    if count > 1:
        middle = piece.first + count // 2
        return [_Piece(piece.first, middle, _SUSPECT), _Piece(middle, piece.last, _SUSPECT)]
    return [replace(piece, deaths=deaths)] if died and deaths < _SUSPECT + _DEATHS else []


def _failed(task: Task, piece: _Piece, error: BaseException) -> Block:
    """Return the result of a run that no process survives."""
    reason = "the process that made this run ended" if isinstance(error, BrokenExecutor) else str(error)
    count = piece.last - piece.first
    values = np.full((count, len(task.measures)), math.nan)
    return Block(
        piece.first, values, np.full(count, math.nan), dict.fromkeys(range(piece.first, piece.last), reason)
    )
