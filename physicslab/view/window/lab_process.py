"""Commands of the laboratory that run in a process of their own, while the window goes on."""

import json
import os
import re
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from physicslab.files.scene import save_scene
from physicslab.kernels.program import own_command as own_command
from physicslab.world import World

_SHARE = re.compile(r"(\d+) %")
"""How far it is, as ``--progress`` writes it."""


class LabProcess:
    """Runs a command on a scene file that is written for it, and reads the report that it writes.

    Parameters
    ----------
    command : sequence of str
        The command, before the path of the scene.

    Attributes
    ----------
    share : float
        How much of the work is done, from 0 to 1.
    failure : str
        Why nothing was found, after a run that failed.
    """

    option = "--json"
    """The option by which the command writes its report."""
    niceness = 0
    """How much lower its priority is than that of frames, which take what they need of the machine."""

    def __init__(self, command: Sequence[str]) -> None:
        self._command = tuple(command)
        self._process: subprocess.Popen[bytes] | None = None
        self._place: tempfile.TemporaryDirectory[str] | None = None
        self.share = self._begun = 0.0
        self.failure = ""

    @property
    def progress(self) -> str:
        """How far it is, in words: some seconds pass before a process has begun."""
        return f"{self.share:.0%}" if self.share else f"Starting, {time.perf_counter() - self._begun:.0f} s"

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
        scene = self._empty() / "scene.json"
        write(scene)
        self._run(*self._command, str(scene), *arguments, "--progress", self.option, str(self._report))

    def _empty(self) -> Path:
        """Stop what is under way, and return a new folder for what comes."""
        self.stop()
        self._place = tempfile.TemporaryDirectory(prefix="physicslab-")
        return Path(self._place.name)

    def _run(self, *command: str) -> None:
        with self._log.open("wb") as log:
            self._process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=log
            )
        if self.niceness and hasattr(os, "setpriority"):
            with suppress(OSError):  # it has ended already
                os.setpriority(
                    os.PRIO_PROCESS, self._process.pid, os.getpriority(os.PRIO_PROCESS, 0) + self.niceness
                )
        self.share, self.failure = 0.0, ""
        self._begun = time.perf_counter()

    @staticmethod
    def read(report: Path) -> dict[str, Any]:
        """Return what the command has written."""
        found: dict[str, Any] = json.loads(report.read_text("utf-8"))
        return found

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
                return self.read(self._report)
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


# ---- error against run time --------------------------------------------------------------------------------


_COMMAND = own_command("accuracy")


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
        How far the body is off at the end that is off furthest [m].
    at_most : bool
        Whether it is no more than is known of the reference: the error is at most that.
    """

    integrator: str
    asked: str
    step: str
    substeps: int
    tolerance: float
    cpu_ms: float
    error: float
    at_most: bool

    @property
    def words(self) -> str:
        """The error in words."""
        return f"{'at most ' if self.at_most else ''}{self.error:.2g} m"

    @property
    def name(self) -> str:
        """The key of a line of the plot: the chosen method."""
        return f"auto: {self.integrator}" if self.asked == "auto" else self.integrator

    @property
    def settings(self) -> dict[str, object]:
        """The settings of a simulation that is run like this."""
        return {"integrator": self.asked, "substeps": self.substeps, "tolerance": self.tolerance}


class ErrorStudy(LabProcess):
    """Runs ``physicslab accuracy`` on a copy of a world, and reads what it found.

    The window goes on meanwhile: the copy is of the moment at which the study was started.

    Parameters
    ----------
    command : sequence of str
        The command, before the path of the scene.

    Attributes
    ----------
    samples : tuple of Sample
        The last results.
    seconds : float
        How long the scene was run [s].
    reference : str
        The reference of the figures.
    rounding : float
        Growth of a difference of one rounding at the start [m]: errors below have no meaning.
    horizon : float, optional
        After how long one rounding has grown to another future [s]; ``None`` where none does.
    shown : bool
        Whether the plot is to be shown.
    """

    def __init__(self, command: tuple[str, ...] = _COMMAND) -> None:
        super().__init__(command)
        self.samples: tuple[Sample, ...] = ()
        self.seconds = self.rounding = 0.0
        self.horizon: float | None = None
        self.reference = ""
        self.shown = False

    def start(self, world: World) -> None:
        """Begin to measure a copy of a world as it is now."""
        self.begin(partial(save_scene, world))
        self.samples, self.shown = (), False

    def poll(self) -> bool:
        """Return whether it has ended just now; then there are samples, or a failure."""
        report = self.ended()
        if report:
            self._read(report)
        return report is not None

    @property
    def rounding_shows(self) -> bool:
        """Whether one rounding at the start changes as much as the smallest error: then none means much.

        An error that is known to be at most so large does not count: it is of rounding by itself.
        """
        known = [sample.error for sample in self.samples if not sample.at_most]
        return self.rounding > 0.0 and any(self.rounding >= error for error in known)

    @property
    def chaotic(self) -> bool:
        """Whether one rounding grows to another future, or to as much as the smallest error."""
        return self.rounding_shows or self.horizon is not None

    def rows(self) -> Iterator[tuple[object, ...]]:
        """Yield all runs as rows of a table with a head."""
        yield "chosen", "method", "step", "substeps", "tolerance", "time [ms]", "error [m]", "is"
        for s in self.samples:
            limit = "at most" if s.at_most else ""
            yield s.asked, s.integrator, s.step, s.substeps, s.tolerance, s.cpu_ms, s.error, limit

    def _read(self, report: dict[str, Any]) -> None:
        (found,) = report["scenes"]
        self.seconds, self.reference = found["seconds"], found["reference"]
        self.horizon = found.get("horizon_s")
        variants = {variant["name"]: variant["spread"] for variant in found["estimate"]["variants"]}
        nudged = variants.get("nudged")
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
