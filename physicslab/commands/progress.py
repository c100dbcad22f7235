"""One line on the terminal: how far a long run is."""

import math
import time
from collections.abc import Callable
from contextlib import suppress
from datetime import timedelta
from typing import Self, TextIO

_DELAY_S = 1.0
_INTERVAL_S = 0.1


class Progress:
    """Keeps one line of a terminal up to date; writes nothing in the first second, and goes after a ``with``.

    Parameters
    ----------
    label : str
        Name of the work under way.
    stream : text stream or None
        Usually stderr, which a program may be started without.
    always : bool
        Whether it is kept in a file or a pipe as well, for a program that reads it.
    clock : callable, optional
        Returns the time [s].
    foresees : bool
        Whether it says how long the rest takes.
    """

    def __init__(
        self, label: str, stream: TextIO | None, clock: Callable[[], float] = time.monotonic, *,
        always: bool = False, foresees: bool = False,
    ) -> None:  # fmt: skip
        self._label, self._stream, self._clock = label, stream, clock
        seen = stream is not None and (always or stream.isatty())
        self._next = clock() + _DELAY_S if seen else float("inf")
        self._shown, self._foresees = False, foresees
        self._first: tuple[float, float] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.clear()

    def show(self, share: float) -> None:
        """Say that this share of the work, from 0 to 1, is done."""
        now = self._clock()
        begun, done = self._first = self._first or (now, share)
        if now >= self._next:
            self._next, self._shown = now + _INTERVAL_S, True
            left = (1.0 - share) * (now - begun) / (share - done) if self._foresees and share > done else 0.0
            words = f", {timedelta(seconds=math.ceil(left))} left" if left else ""
            self._put(f"\r{self._label}: {100.0 * share:.0f} %{words}\x1b[K")

    def clear(self) -> None:
        """Take the line away again."""
        if self._shown:
            self._shown = False
            self._put("\r\x1b[K")

    def _put(self, text: str) -> None:
        if self._stream is not None:
            with suppress(OSError):  # a terminal that is closed, or a reader that has gone, ends no run
                self._stream.write(text)
                self._stream.flush()
