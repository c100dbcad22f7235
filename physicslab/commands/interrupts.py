"""Ctrl+C that comes while Python runs a callback, where it would be told on stderr and forgotten."""

import _thread
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

INTERRUPTED = 130
"""The exit status that a shell reports for a program that Ctrl+C ended: 128 plus the signal's number."""
_AGAIN_S = 0.05
"""Time [s] after which what was interrupted is back in Python that passes exceptions on."""


@contextmanager
def interrupts_kept() -> Iterator[None]:
    """Have an interrupt come again that a callback (of an import, say, or of LLVM) could not pass on."""
    before = sys.unraisablehook

    def hook(unraisable: Any) -> None:
        if issubclass(unraisable.exc_type, KeyboardInterrupt):
            again = threading.Timer(_AGAIN_S, _thread.interrupt_main)
            again.daemon = True
            again.start()
        else:
            before(unraisable)

    sys.unraisablehook = hook
    try:
        yield
    finally:
        sys.unraisablehook = before
