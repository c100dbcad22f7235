"""Signals that end a command: Ctrl+C, ``kill``, a terminal that is closed."""

import _thread
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

_ENDING = ("SIGTERM", "SIGHUP")
"""Signals besides that of Ctrl+C; Windows lacks the second."""
_AGAIN_S = 0.05
"""Time [s] after which what was interrupted is back in Python that passes exceptions on."""


class Ended(KeyboardInterrupt):
    """A signal ended the program that is not that of Ctrl+C; what that one leaves whole is whole here too.

    Parameters
    ----------
    number : int
        The number of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(f"ended by {signal.Signals(number).name}")
        self.number = number


def told(error: KeyboardInterrupt) -> tuple[str, int]:
    """Return in words how a command was ended, with the notes of the error, and its exit status.

    The status is the one that a shell reports for a program that a signal ended: 128 plus its number.
    """
    number = error.number if isinstance(error, Ended) else signal.SIGINT
    return "; ".join([str(error) or "interrupted", *getattr(error, "__notes__", ())]), 128 + number


@contextmanager
def interrupts_kept() -> Iterator[None]:
    """Have signals that end the program interrupt it as Ctrl+C does, in a ``with`` block; a second one kills.

    One that a callback (of an import, say, or of LLVM) could not pass on comes again: it would be told on
    stderr and forgotten. One that is ignored, as by ``nohup``, stays so.
    """
    before = sys.unraisablehook
    handlers: dict[int, Any] = {}

    def hook(unraisable: Any) -> None:
        if issubclass(unraisable.exc_type, KeyboardInterrupt):
            number = getattr(unraisable.exc_value, "number", signal.SIGINT)
            if number in handlers:
                signal.signal(number, end)
            again = threading.Timer(_AGAIN_S, _thread.interrupt_main, (number,))
            again.daemon = True
            again.start()
        else:
            before(unraisable)

    def end(number: int, frame: FrameType | None) -> None:
        signal.signal(number, signal.SIG_DFL)
        raise Ended(number)

    if threading.current_thread() is threading.main_thread():  # no other may set handlers
        for name in _ENDING:
            number = getattr(signal, name, None)
            if number is not None and signal.getsignal(number) == signal.SIG_DFL:
                handlers[number] = signal.signal(number, end)
    sys.unraisablehook = hook
    try:
        yield
    finally:
        sys.unraisablehook = before
        for number, handler in handlers.items():
            signal.signal(number, handler)


def end_at_once() -> None:
    """Have such signals kill the program as they do without it: a compiler cannot be interrupted halfway."""
    for name in _ENDING:
        number = getattr(signal, name, None)
        if number is not None and callable(signal.getsignal(number)):
            signal.signal(number, signal.SIG_DFL)
