"""The record of a warning; warnings of forces that are too fast for a step, and of lost phases."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from physicslab.components import Spring
from physicslab.ecs.sentences import sentence
from physicslab.integrators import Integrator
from physicslab.languages.sentence import Sentence
from physicslab.state.joint_rows import Role
from physicslab.state.packed import spring_rates
from physicslab.systems.joint_forces import JointForces
from physicslab.systems.system import ForceSystem
from physicslab.world import World


@dataclass(frozen=True, slots=True)
class ModelWarning:
    """One thing in which a simulated world cannot be trusted. ``run --json`` has them as ``advice``.

    Attributes
    ----------
    entity : str, optional
        The body or spring, by its id; ``None`` where it concerns all of the world.
    what : str
        The fault in words that hold for any value: they name the kind of warning.
    value, limit : float, optional
        The figure, and the largest that can be trusted.
    unit : str
        Unit of both; empty for a plain number.
    setting : str
        A setting that helps, with its value; empty where none does.
    number : int, optional
        The entity itself.
    because : str
        The latest cause, which may be another at each step; it is no part of the kind.
    """

    entity: str | None
    what: str
    value: float | None = None
    unit: str = ""
    limit: float | None = None
    setting: str = ""
    number: int | None = None
    because: str = ""

    @classmethod
    def about(
        cls, world: World, entity: int | None, what: str, value: float | None = None, unit: str = "",
        limit: float | None = None, setting: str = "",
    ) -> ModelWarning:  # fmt: skip
        """Return a warning about an entity of a world; about all of it where that is ``None``."""
        name = None if entity is None else world.label(entity)
        return cls(name, what, value, unit, limit, setting, entity)

    @property
    def excess(self) -> tuple[float, float]:
        """The value in units of the limit, infinite without one; two such are compared by their values."""
        value = 0.0 if self.value is None else self.value
        return value / self.limit if self.limit and self.value is not None else math.inf, value

    @property
    def told(self) -> str:
        """A warning: the entity, the fault and its size."""
        words = sentence("about", entity=self.entity, what=self.what) if self.entity else self.what
        if self.value is None or self.limit is None:
            return words
        figure = f"{self.value:.3g} {self.unit}".rstrip()
        if not self.limit:
            return sentence("figure", what=words, figure=figure)
        return sentence("figure_and_limit", what=words, figure=figure, limit=f"{self.limit:.3g}")

    @property
    def words(self) -> Sentence:
        """All of it, for people."""
        words = sentence("because", what=self.told, because=self.because) if self.because else self.told
        if not self.setting:
            return sentence("no_help", what=words)
        return sentence("would_help", what=words, setting=self.setting)

    def __str__(self) -> str:
        return str(self.words)


class WorstWarnings:
    """The worst warning of each kind over a run."""

    def __init__(self) -> None:
        self._worst: dict[str, ModelWarning] = {}

    def add(self, found: Iterable[ModelWarning]) -> None:
        """Add the warnings of one moment; of each kind the worst is kept."""
        for warning in found:
            known = self._worst.get(warning.what)
            if known is None or warning.excess > known.excess:
                self._worst[warning.what] = warning

    @property
    def all(self) -> tuple[ModelWarning, ...]:
        """One of each kind, in the order in which they first came."""
        return tuple(self._worst.values())


EXPLICIT_RATE_LIMIT = 0.3
"""omega h of a fixed step, as a share of the method's limit: with leapfrog the energy of such an oscillation
swings by a tenth."""
IMPLICIT_RATE_LIMIT = 1.0
"""omega h of the implicit rule, which is stable beyond: the phase is 8 % off there."""
PHASE_LIMIT = 0.05
"""Phase that oscillations may have lost by now [rad]: places are then wrong by 5 % of the amplitude."""
_AUTO_RATE_LIMIT = 500.0
"""omega dt up to which ``auto`` divides a step until it follows an oscillation."""
EVALUATIONS_LIMIT = 20_000
"""Force evaluations in a step, as a mean over the run: of two bodies they take longer than a step lasts."""
_DAMPED_LIMIT = 50.0
"""Rate times the step from which on what is followed is a fast decay or oscillation."""
SUBSTEPS_LIMIT = 10_000
"""From a scene's configuration."""


def step_warnings(world: World) -> Iterator[ModelWarning]:
    """Yield what is wrong with the length of steps, or with the method that makes them.

    Parameters
    ----------
    world : World
        In its present state; nothing is changed.
    """
    followed = _fixed_steps(world)
    if followed is not None:
        beyond = world.plan.beyond
        whole = 0.5 * world.simulation.dt / world.plan.substeps
        yield from _rates(world, *(followed if beyond is None else (beyond, whole)))
        yield from _phase(world, followed[0])
    yield from _order(world)
    yield from _cost(world)


def _cost(world: World) -> Iterator[ModelWarning]:
    """Yield how many force evaluations a step takes, if that is slower than the motion."""
    made = world.force_evaluations / max(world.steps, 1)
    if made <= EVALUATIONS_LIMIT:
        return
    rate, system = fastest_force(world)
    stiff = system is not None and rate * world.simulation.dt > _DAMPED_LIMIT
    setting = f"simulation.tolerance = {max(1e-12, 1e3 * world.simulation.tolerance):.0e}"
    if stiff:
        setting = 'simulation.integrator = "implicit_midpoint"'
    yield ModelWarning(None, sentence("many_evaluations"), made, "", EVALUATIONS_LIMIT, setting)


def _rates(world: World, integrator: Integrator, h: float) -> Iterator[ModelWarning]:
    """Yield the fastest force, if it is too fast for the steps that are made."""
    rate, system = fastest_force(world)
    if system is None or not math.isfinite(rate):
        return
    value, bounded = rate * h, math.isinf(integrator.stability_limit)
    limit = IMPLICIT_RATE_LIMIT if bounded else EXPLICIT_RATE_LIMIT * integrator.stability_limit
    if value <= limit:
        return
    entity = _stiffest(world) if Spring in system.needs else None
    source = "" if entity is not None else f"{system.name.removesuffix('System')}"
    if bounded:
        what = sentence("not_followed")
    elif value > integrator.stability_limit:
        what = sentence("flies_apart")
    else:
        what = sentence("coarse")
    setting = _shorter(world, rate, limit, followed=bounded)
    if system.attractors > 1 and world.simulation.integrator != "auto":
        setting = 'simulation.integrator = "auto"'  # with the steps of a passage, others are still long
    what = sentence("about", entity=source, what=what) if source else what
    yield ModelWarning.about(world, entity, what, value, "", limit, setting)


def fastest_force(world: World) -> tuple[float, ForceSystem | None]:
    """Return the fastest rate of any force [rad/s] and which; 0 and ``None`` if there is none.

    It is the one of the present state, or the fastest within steps since the motion was last edited, where
    the force measures that: a close passage between two looks counts.
    """
    met = world.fastest_rates
    with world.active():
        rates = [
            (max(system.strongest_rate(world), met.get(system.name, 0.0)), system)
            for system in world.schedule.forces
        ]
    return max(rates, key=lambda pair: pair[0], default=(0.0, None))


def lost_phase(world: World) -> tuple[int, float, float] | None:
    """Return the spring whose oscillation has lost most phase by the method, how much [rad], and its omega h.

    A method loses a share of omega t that depends on omega h alone; what is damped counts while it lasts.
    ``None`` where no method of fixed steps follows springs, or what it loses is not known.
    """
    springs, rate, damping = spring_rates(world)
    followed = _fixed_steps(world)
    if followed is None or not (followed[0].phase_share and len(springs) and math.isfinite(world.time)):
        return None
    integrator, h = followed
    decay = 0.5 * (damping + world.physics.linear_damping)
    lasting = np.where(
        decay > 0.0, -np.expm1(-decay * world.time) / np.where(decay > 0.0, decay, 1.0), world.time
    )
    lost = integrator.phase_share * (rate * h) ** integrator.phase_order * rate * lasting
    worst = int(np.argmax(lost))
    return int(springs[worst]), float(lost[worst]), float(rate[worst] * h)


def _fixed_steps(world: World) -> tuple[Integrator, float] | None:
    """Return what follows forces in steps of one length, and that length [s]; ``None`` where nothing does."""
    method = world.plan
    one = method.smooth or method.contacts == "rigid"  # which moves bodies between events by one method
    integrator = method.integrator if one else method.split_forces or method.stages
    if method.collisions == "exact" or integrator.chooses_steps or math.isinf(integrator.order):
        return None
    parts = method.substeps * (2 * method.split_steps if method.split_forces else 1)
    return integrator, world.simulation.dt / parts


def _phase(world: World, integrator: Integrator) -> Iterator[ModelWarning]:
    """Yield the spring whose oscillation has lost most phase, if that is too much."""
    found = lost_phase(world)
    if found is None or not PHASE_LIMIT < found[1] < math.inf:
        return
    late, lost, _ = found
    needed = math.ceil(world.simulation.substeps * (lost / PHASE_LIMIT) ** (1.0 / integrator.phase_order))
    setting = (
        f"simulation.substeps = {needed}" if needed <= SUBSTEPS_LIMIT else 'simulation.integrator = "auto"'
    )
    if world.simulation.integrator == "auto":
        setting = ""  # it takes other steps of its own
    yield ModelWarning.about(world, late, sentence("lost_phase"), lost, "rad", PHASE_LIMIT, setting)


def _order(world: World) -> Iterator[ModelWarning]:
    """Yield a force that depends on velocities, if the chosen method is made for positions."""
    plan = world.plan
    method = plan.integrator if plan.smooth else plan.stages
    if world.simulation.integrator == "auto" or plan.collisions == "exact" or not method.positions_only:
        return
    turned = any(force.gyration(world) is not None for force in world.schedule.smooth_forces)
    damped = world.physics.linear_damping > 0.0 or world.physics.angular_damping > 0.0
    # Along rows that hold it drifts exactly, if nothing else turns velocities (integrators/along_joints.py).
    along = plan.smooth and not (turned or damped or (world.joints.role != Role.HOLD).any())
    forces = [force for force in world.schedule.smooth_forces if force.gyration(world) is None]
    forces = [force for force in forces if not (along and isinstance(force, JointForces))]
    seeing = next((force for force in forces if force.depends_on_velocity(world)), None)
    if seeing is not None:
        name = seeing.name.removesuffix("System")
        what = sentence("order_one", force=name, method=method.name)
        better = '"dop853"' if plan.smooth else '"auto"'
        yield ModelWarning(None, what, setting=f"simulation.integrator = {better}")


def _shorter(world: World, rate: float, limit: float, *, followed: bool) -> str:
    """Return the setting with which a rate [rad/s] is followed by the present method, or by ``auto``."""
    simulation = world.simulation
    if followed and simulation.integrator == "auto":
        return f"simulation.dt = {_below(_AUTO_RATE_LIMIT / rate):.2g}"
    needed = math.ceil(rate * simulation.dt / limit)
    if needed <= SUBSTEPS_LIMIT:
        return f"simulation.substeps = {needed}"
    return f"simulation.dt = {_below(limit * simulation.substeps / rate):.2g}"


def _below(value: float) -> float:
    """Round down to two digits, so that what is shown still helps."""
    digits = 10.0 ** (math.floor(math.log10(value)) - 1)
    return math.floor(value / digits) * digits


def _stiffest(world: World) -> int | None:
    """Return the spring with the fastest oscillation or decay."""
    springs, rate, damping = spring_rates(world)
    return int(springs[np.argmax(np.maximum(rate, damping))]) if len(springs) else None
