"""Error against run time of the scene in the window, measured by another process."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from physicslab.files.scene import save_scene
from physicslab.world import World

__all__ = ["ErrorStudy", "Sample"]

_COMMAND = (sys.executable, "-m", "physicslab.cli", "accuracy")


_SHARE = re.compile(r"(\d+) %")
"""How far it is, as ``physicslab accuracy --progress`` writes it."""


@dataclass(frozen=True, slots=True)
class Sample:
    """One run of the scene.

    Attributes
    ----------
    integrator : str
        The method that ran.
    asked : str
        The method that was chosen, which may be ``"auto"``.
    step : str
        Its step, or its tolerance.
    substeps : int
        Into how many parts each step was divided.
    tolerance : float
        The error of a step that was allowed to a method that chooses its steps.
    cpu_ms : float
        How long it took [ms].
    error : float
        How far a body is off at the end, at most [m].
    """

    integrator: str
    asked: str
    step: str
    substeps: int
    tolerance: float
    cpu_ms: float
    error: float

    @property
    def name(self) -> str:
        """What runs of one line of the plot have in common: the method that was chosen."""
        return f"auto: {self.integrator}" if self.asked == "auto" else self.integrator

    @property
    def settings(self) -> dict[str, object]:
        """The settings of a simulation that is run like this."""
        return {"integrator": self.asked, "substeps": self.substeps, "tolerance": self.tolerance}


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
    seconds : float
        How long the scene was run [s].
    reference : str
        What the figures are measured against.
    rounding : float
        What a difference of one rounding at the start has grown to [m]: errors below have no meaning.
    share : float
        How much of the work is done, from 0 to 1.
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
        self.seconds = self.rounding = self.share = 0.0
        self.reference = self.failure = ""
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
        command = (*self._command, str(scene), "--progress", "--json", str(self._report))
        with self._log.open("wb") as log:
            self._process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=log
            )
        self.samples, self.share, self.failure, self.shown = (), 0.0, "", False

    def poll(self) -> bool:
        """Return whether it has ended just now; then there are samples, or a failure."""
        if self._process is None:
            return False
        if self._process.poll() is None:
            written = _SHARE.findall(self._log.read_text("utf-8", errors="replace"))
            self.share = float(written[-1]) / 100.0 if written else 0.0
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
    def chaotic(self) -> bool:
        """Whether one rounding at the start changes as much as the smallest error: then none means much."""
        return bool(self.samples) and self.rounding >= min(sample.error for sample in self.samples)

    def csv(self) -> str:
        """Return all runs as a table."""
        rows = [
            f"{s.asked},{s.integrator},{s.step},{s.substeps},{s.tolerance!r},{s.cpu_ms!r},{s.error!r}"
            for s in self.samples
        ]
        head = "chosen,method,step,substeps,tolerance,time [ms],error [m]"
        return "\n".join([head, *rows]) + "\n"

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
        self.seconds, self.reference = found["seconds"], found["reference"]
        twins = {twin["name"]: twin["spread"] for twin in found["estimate"]["twins"]}
        nudged = twins.get("nudged")
        self.rounding = nudged["position"] if nudged else 0.0
        self.samples = tuple(
            Sample(*(row[name] for name in Sample.__slots__))
            for row in found["rows"]
            if row["error"] is not None and row["cpu_ms"] is not None
        )
        self.shown = bool(self.samples)
        if not self.samples:
            failed = [row["failure"] for row in found["rows"] if row["failure"]]
            self.failure = failed[0] if failed else "no method left a figure"
