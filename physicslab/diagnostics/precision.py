"""Known errors of a run at its end, in digits, as lines of its advice.

:mod:`physicslab.diagnostics.warnings` finds errors that are visible; those found here are
small, and matter to readers of figures.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from physicslab.diagnostics.energy import Audit
from physicslab.diagnostics.step_warnings import PHASE_LIMIT, ModelWarning, lost_phase
from physicslab.ecs.config import SimulationConfig
from physicslab.world import World

EXACT_PHASE = 1e-9
"""Phase [rad] that oscillations may lose without a warning."""
_EXACT_ENERGY = 1e-11
"""Share of the energy exchanged that may be an error of an adaptive method."""
DIGITS_LIMIT = 6.0
"""Fewer digits than this are reported, if they were counted."""
_CAUSES = {
    "other steps": "it depends on when steps end, so events are not found at their own times",
    "half step": "it changes with the length of the step",
    "eighth of the step": "it changes with the length of the step: events are not found at their own times",
    "stiffer": "contacts give way",
    "rigid": "contacts give way, and rigid ones end elsewhere",
    "tightest": "the method is not exact",
    "mirrored": "its mirror image ends elsewhere: what happens at one moment is not determined",
    "permuted": "the order of the scene decides: what happens at one moment is not determined",
    "awake": "bodies fell asleep that were not at rest",
    "overlap": "bodies overlap by that much",
    "rounding": "one rounding at the start has grown to that",
}
"""Why a result is not right, by the way of computing it that is furthest off."""


def find_imprecise(world: World, audit: Audit) -> tuple[ModelWarning, ...]:
    """Return the known errors of a run that was not computed in other ways."""
    return tuple(warning for rule in _RULES for warning in rule(world, audit))


def words_of_digits(trust: Mapping[str, Any]) -> tuple[ModelWarning, ...]:
    """Return the body with fewer than 6 digits, and why, of what a report has as ``trust``."""
    if trust["digits"] is None or trust["digits"] >= DIGITS_LIMIT:
        return ()
    what = f"has {trust['digits']:.1f} digits of its position (--trust): {_CAUSES[trust['cause']]}"
    return (ModelWarning(trust["worst"], what, setting="a shorter step" if _shorter(trust) else ""),)


def _shorter(trust: Mapping[str, Any]) -> bool:
    return trust["cause"] in ("other steps", "half step", "eighth of the step", "stiffer")


def _oscillation(world: World, audit: Audit) -> Iterator[ModelWarning]:
    """Yield the spring that loses most phase, if it is seen in the last digits alone."""
    each = ((part, *found) for part in world.parts if (found := lost_phase(part)) is not None)
    part, late, lost, rate = max(each, key=lambda found: found[2], default=(world, 0, 0.0, 0.0))
    if EXACT_PHASE < lost <= PHASE_LIMIT:
        what = (
            f"oscillates with omega h = {rate:.2g}, and is out of phase by the error of the method: places "
            "are off by about that share of how far it stretches"
        )
        setting = 'simulation.integrator = "dop853"' if part.plan.smooth else ""
        yield ModelWarning.about(world, late, what, lost, "rad", EXACT_PHASE, setting)


def _passage(world: World, audit: Audit) -> Iterator[ModelWarning]:
    """Yield the error of energy of a method that follows the motion, where it shows that it did not."""
    # Where some parts are not smooth, the error of the sum may be theirs.
    follows = any(plan.integrator.chooses_steps for plan in world.plans)
    if follows and all(plan.smooth for plan in world.plans) and audit.error > _EXACT_ENERGY:
        usual, cause, setting = SimulationConfig().tolerance, "bodies pass closely, or forces jump", ""
        if world.simulation.tolerance > usual:
            cause = f"simulation.tolerance = {world.simulation.tolerance:g} lets each step be off"
            setting = f"simulation.tolerance = {usual:g}"
        what = (
            f"of the energy exchanged is an error of the method: {cause}, and places are off by more "
            "(--trust)"
        )
        yield ModelWarning(None, what, audit.error, "", _EXACT_ENERGY, setting)


_RULES: tuple[Callable[[World, Audit], Iterator[ModelWarning]], ...] = (_oscillation, _passage)
"""All of them. Another is added here, and nowhere else."""
