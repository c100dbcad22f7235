"""Error against run time of the scene in the window, measured by another process."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from physicslab.files.scene import save_scene
from physicslab.world import World

__all__ = ["ErrorStudy", "Sample"]

_COMMAND = (sys.executable, "-m", "physicslab.cli", "accuracy")


def _series(row: dict[str, str]) -> str:
    """Return what runs of one line of the plot have in common: the method that was given."""
    return f"auto: {row['integrator']}" if row["asked"] == "auto" else row["integrator"]


@dataclass(frozen=True, slots=True)
class Sample:
    """One run of the scene: by which method, how long it took [ms], how far it is off [m], at what step."""

    integrator: str
    cpu_ms: float
    error: float
    step: str


class ErrorStudy:
    """Runs ``physicslab accuracy`` on a copy of a world, and reads what it found.

    The window goes on meanwhile: the copy is of the moment at which the study was started.

    Parameters
    ----------
    command : sequence of str
        What is run, before the path of the scene.

    Attributes
    ----------
    samples : tuple of Sample
        What was found last.
    remark : str
        What the figures are measured against.
    failure : str
        Why nothing was found, after a run that failed.
    shown : bool
        Whether the plot is to be shown.
    """

    def __init__(self, command: tuple[str, ...] = _COMMAND) -> None:
        self._command = command
        self._process: subprocess.Popen[bytes] | None = None
        self._place: tempfile.TemporaryDirectory[str] | None = None
        self.samples: tuple[Sample, ...] = ()
        self.remark = self.failure = ""
        self.shown = False

    @property
    def running(self) -> bool:
        """Whether it is being measured."""
        return self._process is not None

    def start(self, world: World) -> None:
        """Begin to measure a copy of a world as it is now."""
        self.stop()
        self._place = tempfile.TemporaryDirectory(prefix="physicslab-")
        scene = Path(self._place.name) / "scene.json"
        save_scene(world, scene)
        command = (*self._command, str(scene), "--json", str(self._report))
        with self._log.open("wb") as log:
            self._process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=log
            )
        self.samples, self.remark, self.failure, self.shown = (), "", "", False

    def poll(self) -> bool:
        """Return whether it has ended just now; then there are samples, or a failure."""
        if self._process is None or self._process.poll() is None:
            return False
        try:
            self._read(self._process.returncode)
        finally:
            self.stop()
        return True

    def stop(self) -> None:
        """Stop measuring, and leave nothing behind."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._process = None
        if self._place is not None:
            self._place.cleanup()
            self._place = None

    @property
    def _report(self) -> Path:
        assert self._place is not None
        return Path(self._place.name) / "report.json"

    @property
    def _log(self) -> Path:
        assert self._place is not None
        return Path(self._place.name) / "log.txt"

    def _read(self, status: int) -> None:
        if status != 0:
            lines = self._log.read_text("utf-8", errors="replace").replace("\r", "\n").split("\n")
            written = [line.strip() for line in lines if line.strip()]
            self.failure = written[-1] if written else f"it ended with status {status}"
            return
        (found,) = json.loads(self._report.read_text("utf-8"))["scenes"]
        self.remark = f"{found['kind']}; distances after {found['seconds']:g} s from {found['reference']}"
        self.samples = tuple(
            Sample(_series(row), row["cpu_ms"], row["error"], row["step"])
            for row in found["rows"]
            if row["error"] is not None and row["cpu_ms"] is not None
        )
        self.shown = bool(self.samples)
        if not self.samples:
            failed = [row["failure"] for row in found["rows"] if row["failure"]]
            self.failure = failed[0] if failed else "no method left a figure"
