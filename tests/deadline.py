"""A deadline for each example of a fuzz test: one that does not end fails, and its example is named."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

__all__ = ["SECONDS", "TookTooLong", "deadline"]

SECONDS = 60
"""More than any example takes that comes to an end, compiling included."""


class TookTooLong(AssertionError):
    """An example did not come to an end."""


@contextmanager
def deadline(example: Any, seconds: int = SECONDS) -> Iterator[None]:
    """Fail with :class:`TookTooLong` what takes longer; where there are no such signals, nothing is watched.

    Python raises between its own instructions, so a compiled loop that never ends is not broken off; pytest's
    ``faulthandler_timeout`` then shows where it is.
    """
    if not hasattr(signal, "SIGALRM"):
        yield
        return

    def fail(number: int, frame: FrameType | None) -> None:
        raise TookTooLong(f"not done after {seconds} s: {example!r}")

    before = signal.signal(signal.SIGALRM, fail)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
