"""What is known of a method."""

from __future__ import annotations

from dataclasses import dataclass

from physicslab.schedule import Stage

__all__ = ["Integrator"]


@dataclass(frozen=True, slots=True)
class Integrator:
    """One method: its plan of a substep, and its properties as data for reports.

    Attributes
    ----------
    name, title : str
        For files, and for people.
    order : int
        The error after a fixed time falls with the ``order``-th power of the step, for smooth forces that
        depend on positions. (Dampers of springs see the velocity of the substep's start, and are first
        order.)
    evaluations : int
        Force evaluations a substep.
    stability_limit : float
        Largest omega h at which an undamped oscillation stays bounded.
    symplectic : bool
        Whether phase-space area, and so energy over long times, is kept.
    source : str
        Where the method is described.
    substep : tuple of (Stage, float)
        The stages of one substep in order, each with the share of the substep's time that it stands for.
    window : tuple of two floats
        When the substep begins and ends, seen from the moment at which impacts are resolved, in substeps.
    """

    name: str
    title: str
    order: int
    evaluations: int
    stability_limit: float
    symplectic: bool
    source: str
    substep: tuple[tuple[Stage, float], ...]
    window: tuple[float, float]
