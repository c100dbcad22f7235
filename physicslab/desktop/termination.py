"""Signals that end the program: noted, so that the window closes between two frames with its state kept."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any

_SIGNALS = ("SIGTERM", "SIGHUP", "SIGINT")
"""At a logout or a shutdown, by ``kill``; when the terminal is closed, which Windows lacks; by Ctrl+C."""


class Termination:
    """Notes the signals that end the program, within a ``with`` block, and has the window closed.

    A second Ctrl+C interrupts what the window waits for. SDL would make of SIGTERM what a click on the
    window's cross is: the state would be removed as if the user had left.

    Parameters
    ----------
    close : callable
        Has the window closed; called between two instructions of Python, whatever is under way.

    Attributes
    ----------
    signal : int
        The number of the one that came; 0 if none did.
    """

    def __init__(self, close: Callable[[], None]) -> None:
        self.signal = 0
        self._close = close
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Termination:
        if threading.current_thread() is threading.main_thread():  # no other may set handlers
            for name in _SIGNALS:
                number = getattr(signal, name, None)
                if number is not None:
                    self._before[number] = signal.signal(number, self._note)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, signal.SIG_DFL if handler is None else handler)

    @property
    def status(self) -> int:
        """The exit status: 0, or what a shell reports of a program that a signal ended."""
        return 128 + self.signal if self.signal else 0

    def _note(self, number: int, frame: FrameType | None) -> None:
        if number == self.signal == signal.SIGINT:
            raise KeyboardInterrupt
        self.signal = self.signal or number
        self._close()
