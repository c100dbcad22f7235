"""Where results go: memory, or parts of a thousand rows, found again after a crash, and then a file."""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import re
import time
import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from filelock import FileLock, Timeout
from numpy.typing import NDArray

from physicslab.ensembles.result import read_result, write_result
from physicslab.ensembles.space import Values
from physicslab.ensembles.task import Block, Task
from physicslab.files.replace import ENDING, reason_of, replace_file

PART = 1000
"""Rows of a part."""
_PARTS, _KEY = ".parts", ".key"
"""Suffixes beside the file of results: the folder of its parts, and the key by which it is known."""
_LOCK = "sweep.lock"
"""A file in that folder, locked while a sweep is under way: the system lets go of it however that ends."""
_OWN = re.compile(
    rf"{re.escape(_LOCK)}|part-\d{{6,}}\.npz|\.part-\d{{6,}}\.npz\.[0-9a-f]{{16}}{re.escape(ENDING)}"
)
"""How files of that folder are named, and the remains of a process that was killed while it wrote one."""
_WRITE_S = 10.0
"""So long [s] results of a part that is not whole yet may be in memory alone."""


class Part:
    """The results of up to ``PART`` rows: which are there, and their measures, times and failures."""

    def __init__(self, first: int, count: int, measures: int) -> None:
        self.first = first
        self.done = np.zeros(count, np.bool_)
        self.values = np.full((count, measures), np.nan)
        self.wall_s = np.full(count, np.nan)
        self.failures: dict[int, str] = {}
        self.written = time.monotonic()

    def put(self, block: Block) -> None:
        """Take the results of some of the rows."""
        rows = slice(block.first - self.first, block.first - self.first + len(block.values))
        self.done[rows] = True
        self.values[rows], self.wall_s[rows] = block.values, block.wall_s
        self.failures |= block.failures

    def missing(self) -> Iterator[tuple[int, int]]:
        """Yield the rows that are not there, from and up to."""
        edges = np.flatnonzero(np.diff(np.concatenate(([True], self.done, [True])).astype(np.int8)))
        for begin, end in edges.reshape(-1, 2).tolist():
            yield self.first + begin, self.first + end


class Sink:
    """The results of a task: in memory, or in a folder of parts, and then in the file that they become.

    Parameters
    ----------
    task : Task
        Whose results.
    out : Path, optional
        The file; results are in memory alone where absent.

    Attributes
    ----------
    is_whole : bool
        Whether the file held all results of this task already.
    found : int
        How many rows were there already.
    """

    def __init__(self, task: Task, out: Path | None) -> None:
        self._task, self._out = task, out
        self._folder = None if out is None else parts_folder(out)
        self._rows = len(task.space)
        self.is_whole = self._holds_all()
        self._open: dict[int, Part] = {}
        self.found = 0
        self._is_written = False

    @contextlib.contextmanager
    def alone(self) -> Iterator[None]:
        """Keep other sweeps from the file and its parts within a ``with`` block.

        The parts are removed then, once the file holds all results.

        Raises
        ------
        OSError
            If another one is under way, or nothing can be written there.
        """
        if self._folder is None or self.is_whole:
            yield
            return
        with self._named():
            self._folder.mkdir(exist_ok=True)
        lock = FileLock(self._folder / _LOCK, blocking=False, thread_local=False)
        try:
            lock.acquire()
        except Timeout:
            raise OSError(f"out {self._out}: another sweep to this file is under way") from None
        except (OSError, NotImplementedError):
            pass  # a file system without locks
        try:
            yield
        finally:
            lock.release()
            if self._is_written or not any(self._folder.glob("*.npz")):
                _remove_parts(self._folder)

    @property
    def parts(self) -> int:
        """How many parts there are."""
        return -(-self._rows // PART)

    def missing(self) -> Iterator[tuple[int, int]]:
        """Yield the rows to be made, from and up to, none beyond the end of a part."""
        if self.is_whole:
            self.found = self._rows
            return
        for number in range(self.parts):
            part = self._read(number)
            self.found += int(part.done.sum())
            if not part.done.all():
                self._open[number] = part
                yield from part.missing()
            elif self._folder is None:
                self._open[number] = part

    def put(self, block: Block) -> None:
        """Keep the results of some rows."""
        number = block.first // PART
        part = self._open[number]
        part.put(block)
        if self._folder is None:
            return
        whole = bool(part.done.all())
        if whole or time.monotonic() - part.written > _WRITE_S:
            self._write(number, part)
        if whole:
            del self._open[number]

    def flush(self) -> None:
        """Write what is in memory alone."""
        if self._folder is not None:
            for number, part in self._open.items():
                if part.done.any():
                    self._write(number, part)

    def results(self) -> Iterator[Part]:
        """Yield all parts, in order; as one where the file held them.

        Raises
        ------
        OSError
            If rows that were kept are gone.
        """
        if self.is_whole:
            yield self._read_file()
            return
        for number in range(self.parts):
            part = self._open[number] if number in self._open else self._read(number)
            if not part.done.all():
                lost = f"{int((~part.done).sum())} rows that were kept in {self._folder} are gone"
                raise OSError(f"out {self._out}: {lost}; the same sweep once more makes them")
            yield part

    def write(self, columns: Mapping[str, Values], failures: Mapping[int, str]) -> None:
        """Write all results to the file, with the key by which it is known.

        Raises
        ------
        OSError
            If it cannot be written.
        """
        if self._out is None or self._folder is None or self.is_whole:
            return
        with self._named():
            write_result(self._out, columns, failures)
            replace_file(self._key_path(self._out), self._file_key(self._out))
        self._is_written = True

    def _holds_all(self) -> bool:
        """Whether the file holds the results of this task, as they were written."""
        if self._out is None:
            return False
        try:
            return self._key_path(self._out).read_bytes() == self._file_key(self._out)
        except OSError:
            return False

    @staticmethod
    def _key_path(out: Path) -> Path:
        return out.with_name(out.name + _KEY)

    def _file_key(self, out: Path) -> bytes:
        """Return the digest (64 hex digits) of the rows of this task and of the bytes of a file."""
        with open(out, "rb") as file:
            digest = hashlib.file_digest(file, "sha256")
        for number in range(self.parts):
            digest.update(self._keys(number).tobytes())
        return digest.hexdigest().encode()

    def _read_file(self) -> Part:
        assert self._out is not None
        part = Part(0, self._rows, len(self._task.measures))
        columns, part.failures = read_result(self._out, [*self._task.measures, "wall_s"])
        part.done[:] = True
        *values, part.wall_s = columns
        part.values = np.array(values).T
        return part

    def _path(self, number: int) -> Path:
        assert self._folder is not None
        return self._folder / f"part-{number:06d}.npz"

    def _keys(self, number: int) -> NDArray[np.uint8]:
        first = number * PART
        return self._task.keys(self._task.space.columns(first, min(first + PART, self._rows)))

    def _read(self, number: int) -> Part:
        """Return a part with those of its rows that are kept of this task."""
        first = number * PART
        part = Part(first, min(PART, self._rows - first), len(self._task.measures))
        kept = None if self._folder is None else _read(self._path(number))
        if kept is None:
            return part
        keys, own = kept["keys"], self._keys(number)
        count = min(len(keys), len(own))
        same = np.zeros(len(own), np.bool_)
        same[:count] = (keys[:count] == own[:count]).all(axis=1) & kept["done"][:count]
        if same.any() and kept["values"].shape[1:] == part.values.shape[1:]:
            part.done = same
            part.values[same], part.wall_s[same] = (
                kept[name][: len(own)][same[: len(keys)]] for name in ("values", "wall_s")
            )
            failures = json.loads(bytes(kept["failures"]))
            part.failures = {int(row): why for row, why in failures.items() if same[int(row) - first]}
        return part

    def _write(self, number: int, part: Part) -> None:
        assert self._folder is not None
        failures = json.dumps(part.failures, sort_keys=True).encode()
        content = io.BytesIO()
        np.savez(
            content, keys=self._keys(number), done=part.done, values=part.values, wall_s=part.wall_s,
            failures=np.frombuffer(failures, np.uint8),
        )  # fmt: skip
        with self._named():
            self._folder.mkdir(exist_ok=True)
            replace_file(self._path(number), content.getvalue())
        part.written = time.monotonic()

    @contextlib.contextmanager
    def _named(self) -> Iterator[None]:
        """Let an error of what is written in a ``with`` block name the file that was given."""
        try:
            yield
        except OSError as error:
            raise OSError(error.errno, f"out {self._out}: cannot be written: {reason_of(error)}") from error


def parts_folder(out: Path) -> Path:
    """Return the folder that holds the parts of a file until it is whole."""
    return out.with_name(out.name + _PARTS)


def _remove_parts(folder: Path) -> None:
    """Remove a folder of parts, and its own files alone: it stays where anything else is in it."""
    with contextlib.suppress(OSError):
        for path in [*folder.iterdir()]:
            if _OWN.fullmatch(path.name):
                path.unlink()
        folder.rmdir()


def _read(path: Path) -> dict[str, NDArray[Any]] | None:
    """Return the arrays of a part; ``None`` where there is none that can be read."""
    try:
        with open(path, "rb") as file, np.load(file, allow_pickle=False) as kept:
            return {name: kept[name] for name in ("keys", "done", "values", "wall_s", "failures")}
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):  # the last: torn by a crash
        return None
