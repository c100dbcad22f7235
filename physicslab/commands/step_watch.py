"""Steps that take long: which, and what takes the time in them."""

from __future__ import annotations

from physicslab.diagnostics.warning_records import ModelWarning
from physicslab.world import World

__all__ = ["StepWatch"]

_SLOW_S = 1.0
"""Time [s] from which on a step is called slow: sixty times what the window has for one."""
_STORM = 100.0
"""Impacts in a step from which on they are the reason; a gas of 2,000 discs has some twenty."""
_EVALUATIONS = 10_000.0
"""Force evaluations in a step from which on the method is the reason: as many as substeps may be set."""


class StepWatch:
    """Notes how long steps take; says where the first slow one is and what takes the time.

    Parameters
    ----------
    world : World
        Whose steps.

    Attributes
    ----------
    warnings : tuple of ModelWarning
        Of the slowest step, if one was slow.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._collisions, self._evaluations = int(world.collisions), world.force_evaluations
        self._worst = 0.0
        self.warnings: tuple[ModelWarning, ...] = ()

    def note(self, steps: int, seconds: float) -> str:
        """Take note of so many steps, which took so many seconds without compiling.

        Returns
        -------
        str
            What there is to say, the first time that one is slow; else empty.
        """
        world, steps = self._world, max(steps, 1)
        impacts = (int(world.collisions) - self._collisions) / steps
        evaluations = (world.force_evaluations - self._evaluations) / steps
        self._collisions, self._evaluations = int(world.collisions), world.force_evaluations
        each = seconds / steps
        if each <= max(_SLOW_S, self._worst):
            return ""
        first, self._worst = not self.warnings, each
        why, setting, figures = self._reason(impacts, evaluations)
        self.warnings = (ModelWarning(None, f"a step takes long: {why}", each, "s", _SLOW_S, setting),)
        line = f"slow: the step to t = {world.time:.9g} s took {each:.3g} s: {why} ({figures})"
        return line if first else ""

    def _reason(self, impacts: float, evaluations: float) -> tuple[str, str, str]:
        """Return in words what takes the time, what would help, and the figures."""
        world = self._world
        method = world.plan.integrator
        if impacts >= _STORM and world.plan.collisions == "exact":
            return "one impact follows another", 'simulation.collisions = "step"', f"{impacts:.3g} impacts"
        if evaluations >= _EVALUATIONS:
            setting = "a shorter dt" if not method.chooses_steps else "a larger simulation.tolerance"
            figures = f"{evaluations:.3g} force evaluations by {method.name}"
            return "forces change so fast that it is divided into many", setting, figures
        bodies = len(world.entity_index) - 1
        pairs = int(world.contacts.candidate_pairs)
        figures = f"{bodies} entities, {pairs} near pairs, {world.substeps} substeps"
        return "there is much to compute", "fewer bodies or substeps", figures
