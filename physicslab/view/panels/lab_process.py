"""A command of the laboratory that runs in a process of its own, while the window goes on."""

from __future__ import annotations

import json
import re
import subprocess
import tempfile
import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

__all__ = ["LabProcess"]

_SHARE = re.compile(r"(\d+) %")
"""How far it is, as ``--progress`` writes it."""


class LabProcess:
    """Runs a command on a scene file that is written for it, and reads the report that it writes.

    Parameters
    ----------
    command : sequence of str
        What is run, before the path of the scene.

    Attributes
    ----------
    share : float
        How much of the work is done, from 0 to 1.
    failure : str
        Why nothing was found, after a run that failed.
    """

    def __init__(self, command: Sequence[str]) -> None:
        self._command = tuple(command)
        self._process: subprocess.Popen[bytes] | None = None
        self._place: tempfile.TemporaryDirectory[str] | None = None
        self.share = 0.0
        self.failure = ""

    @property
    def running(self) -> bool:
        """Whether it is under way."""
        return self._process is not None

    def begin(self, write: Callable[[Path], object], *arguments: str) -> None:
        """Begin it on the scene that ``write`` writes to a path; one that is under way is stopped.

        Raises
        ------
        OSError
            If the scene cannot be written or the process not started.
        """
        self.stop()
        self._place = tempfile.TemporaryDirectory(prefix="physicslab-")
        scene = Path(self._place.name) / "scene.json"
        write(scene)
        command = (*self._command, str(scene), *arguments, "--progress", "--json", str(self._report))
        with self._log.open("wb") as log:
            self._process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=log
            )
        self.share, self.failure = 0.0, ""

    def ended(self) -> dict[str, Any] | None:
        """Return the report of a run that has ended just now; empty, with a ``failure``, where it failed."""
        if self._process is None:
            return None
        if self._process.poll() is None:
            written = _SHARE.findall(self._log.read_text("utf-8", errors="replace"))
            self.share = float(written[-1]) / 100.0 if written else 0.0
            return None
        try:
            if self._process.returncode == 0:
                found: dict[str, Any] = json.loads(self._report.read_text("utf-8"))
                return found
            self.failure = self._last_words() or f"it ended with status {self._process.returncode}"
            return {}
        finally:
            self.stop()

    def stop(self) -> None:
        """Stop it, and leave nothing behind."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._process = None
        if self._place is not None:
            self._place.cleanup()
            self._place = None

    def abandon(self) -> None:
        """Stop it without waiting for its end, which takes longer than a frame has."""
        process, place, self._process, self._place = self._process, self._place, None, None
        if process is None or place is None:
            return
        process.kill()

        def clear() -> None:
            process.wait()
            place.cleanup()

        threading.Thread(target=clear, name="lab process", daemon=True).start()

    @property
    def _report(self) -> Path:
        assert self._place is not None
        return Path(self._place.name) / "report.json"

    @property
    def _log(self) -> Path:
        assert self._place is not None
        return Path(self._place.name) / "log.txt"

    def _last_words(self) -> str:
        """Return the last line that it wrote."""
        lines = self._log.read_text("utf-8", errors="replace").replace("\r", "\n").split("\n")
        return next((line.strip() for line in reversed(lines) if line.strip()), "")
