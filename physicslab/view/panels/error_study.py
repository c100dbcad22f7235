"""Error against run time of the scene in the window, measured by another process."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import partial
from typing import Any

from physicslab.files.scene import save_scene
from physicslab.view.panels.lab_process import LabProcess
from physicslab.world import World

__all__ = ["ErrorStudy", "Sample"]

_COMMAND = (sys.executable, "-m", "physicslab.cli", "accuracy")


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

    def csv(self) -> str:
        """Return all runs as a table."""
        rows = [
            f"{s.asked},{s.integrator},{s.step},{s.substeps},{s.tolerance!r},{s.cpu_ms!r},{s.error!r},"
            f"{'at most' if s.at_most else ''}"
            for s in self.samples
        ]
        head = "chosen,method,step,substeps,tolerance,time [ms],error [m],is"
        return "\n".join([head, *rows]) + "\n"

    def _read(self, report: dict[str, Any]) -> None:
        (found,) = report["scenes"]
        self.seconds, self.reference = found["seconds"], found["reference"]
        self.horizon = found.get("horizon_s")
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
