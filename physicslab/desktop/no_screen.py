"""What stops a window from opening where there is no screen."""

from __future__ import annotations

__all__ = ["NoScreen"]


class NoScreen(OSError):
    """There is no screen to open a window on; the message is one line that says what to do."""
