"""A scene without a known answer: how far its results depend on the method and on the step."""

import math
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Trail, Transform, Velocity
from physicslab.diagnostics.energy import Audit
from physicslab.ecs.config import SimulationConfig
from physicslab.files.writer import write_scene
from physicslab.integrators import INTEGRATORS
from physicslab.integrators.dop853 import DOP853
from physicslab.lab.accuracy.estimate import Estimate, estimate_error, find_order
from physicslab.lab.accuracy.paths import find_horizon
from physicslab.lab.accuracy.variants import GOLDEN, Document, refined, with_ids
from physicslab.lab.case import attempt, cpu_time
from physicslab.lab.jobs import Job, scaled
from physicslab.lab.worlds import steps_not_rigid
from physicslab.stepping.method import tolerance_for
from physicslab.world import World

ESTIMATE = "an estimate: there is no reference, runs are compared with each other"
"""The kind of result that a scene without a known answer has."""
_ESTIMATE_SHARE, _HORIZON_SHARE = 0.3, 0.4
"""Rough shares of the work of a study that are done after the estimate, and after the horizon."""
_HORIZON_TIMES = 6.0
"""How many times as long the horizon is looked for: it is often later than errors are compared."""
_TIGHTEST = 1e-17
_ROUNDINGS = 4.0
"""Roundings of a place that the best of references may be off by."""
_NO_BETTER = 2.0
"""A run that is no further from the reference than so many times what is known of this is as good as it."""
_SUBSTEP_FACTORS = (0.5, 1.0, 2.0, 4.0)
"""The rungs of a ladder of steps: so many times the scene's own substeps."""
_SUBSTEPS_LIMIT = 10_000
"""From a scene's configuration."""
_REPEATS = 4
_REPEATED_BELOW_S = 2.0
"""A run that takes longer is not repeated to be timed."""
_TOLERANCES = (1e-6, 1e-9, 1e-12, 1e-15)
"""The rungs of a ladder of tolerances."""


@dataclass(slots=True)
class SceneRow:
    """A method on a scene.

    Attributes
    ----------
    integrator, reason : str
        The method that ran, and why.
    asked : str
        The method that was chosen.
    step : str
        Its step, or its tolerance; empty for one that has neither.
    substeps : int
        Into how many each step was divided.
    tolerance : float
        The error of a step that was allowed to a method that chooses its steps.
    evaluations : int
        Force evaluations.
    half_step : float, optional
        The largest distance [m] of any body from where it is with steps of half the length, and a tenth of
        the tolerance.
    error : float, optional
        The same from where the finest of all runs has it.
    at_most : bool
        Whether that is no more than is known of the finest: the error is less, by how much is not known.
    is_located : bool
        Whether nothing touches, or all contacts are rigid and found at their own times.
    energy : float, optional
        The error of the energy at the end, as a share of the energy exchanged: what no account explains.
    failure : str
        Why there are no figures.
    cpu_ms : float, optional
        Process time without compiling [ms].
    """

    integrator: str
    reason: str
    asked: str
    step: str
    substeps: int
    tolerance: float
    evaluations: int = 0
    half_step: float | None = None
    error: float | None = None
    at_most: bool = False
    is_located: bool = False
    energy: float | None = None
    failure: str = ""
    cpu_ms: float | None = None


@dataclass(slots=True)
class SceneStudy:
    """The results of a scene.

    Attributes
    ----------
    name : str
        Name of the scene.
    seconds : float
        How long it was run [s].
    reference : str
        The run that all were compared with.
    estimate : Estimate
        The error of the scene as it is configured.
    rows : list of SceneRow
        Its methods.
    horizon_s : float, optional
        The time from the start [s] at which an error of one rounding has grown to another future; ``None``
        where none does within six times that long.
    """

    name: str
    seconds: float
    reference: str
    estimate: Estimate = field(default_factory=Estimate)
    rows: list[SceneRow] = field(default_factory=list)
    horizon_s: float | None = None


def study_scene(name: str, load: Callable[[], World], seconds: float) -> Job[SceneStudy]:
    """Run a scene with every method; yield the share of the work that is done.

    Parameters
    ----------
    load : callable
        Returns the scene's world, a new one each time.
    seconds : float
        How long it is run [s].
    """
    load = _without_trails(load)
    document = with_ids(write_scene(load()))
    plain = replace(load().simulation, sleeping=False)  # so that errors are those of methods
    scene, study = _Scene(load, document, seconds), SceneStudy(name, seconds, "")
    methods = [method for method in INTEGRATORS if scene.is_taken_by(replace(plain, integrator=method))]
    wanted = [replace(plain, integrator="auto"), *(rung for name in methods for rung in _ladder(plain, name))]
    study.estimate = yield from scaled(estimate_error(load, seconds), 0.0, _ESTIMATE_SHARE)
    find_order(study.estimate, load, seconds)
    horizon = find_horizon(document, study.estimate.bodies, _HORIZON_TIMES * seconds)
    study.horizon_s = yield from scaled(horizon, _ESTIMATE_SHARE, _HORIZON_SHARE)
    runs = []
    for i, simulation in enumerate(wanted):
        runs.append(scene.run(simulation))
        study.rows.append(runs[-1].row)
        yield _HORIZON_SHARE + (1.0 - _HORIZON_SHARE) * (i + 1) / len(wanted)
    _compare(study, scene, runs, replace(plain, integrator=DOP853.name, tolerance=_TIGHTEST))
    return study


@dataclass(slots=True)
class _Run:
    """A configuration of a scene, its row, and where bodies end [m] (n, 2) by it and in finer steps."""

    simulation: SimulationConfig
    row: SceneRow
    places: NDArray[np.float64] | None = None
    finer: NDArray[np.float64] | None = None


@dataclass(frozen=True, slots=True)
class _Scene:
    """A scene that is run by several configurations for some time [s]."""

    load: Callable[[], World]
    document: Document
    seconds: float

    def world(self, simulation: SimulationConfig) -> World:
        """Return its world, ready to be stepped."""
        world = self.load()
        world.simulation = simulation
        world.synchronise()
        return world

    def is_taken_by(self, simulation: SimulationConfig) -> bool:
        """Whether the method that a configuration names can compute it."""
        return not self.world(simulation).plan.refused

    def refined_end(self, simulation: SimulationConfig, factor: float) -> NDArray[np.float64]:
        """Return where bodies end [m] (n, 2) in steps shorter by a factor."""
        document = self.document | {"simulation": asdict(simulation)}
        return _end(refined(document, self.world(simulation), factor), self.seconds)

    def run(self, simulation: SimulationConfig, repeats: int = _REPEATS) -> _Run:
        """Run it by a configuration, repeatedly if that is short, and in finer steps."""
        world = self.world(simulation)
        method = world.plan
        step = f"{simulation.dt / method.substeps:.3g} s"
        if method.integrator.chooses_steps:
            tolerance = tolerance_for(world, world.schedule.forces)
            step = "" if method.integrator.name == "exact" else f"tol {tolerance:g}"
        run = _Run(simulation, SceneRow(
            method.integrator.name, method.reason, simulation.integrator, step, simulation.substeps,
            simulation.tolerance,
        ))  # fmt: skip
        _, run.row.failure = attempt(partial(self._fill, run, repeats))
        return run

    def _fill(self, run: _Run, repeats: int) -> bool:
        """Write cost and errors into the row of a run, and where bodies end."""
        row, fastest = run.row, math.inf
        for _ in range(repeats):  # the shortest: the first also compiles, and other programs run as well
            world = self.world(run.simulation)
            audit = Audit(world)
            taken, places = cpu_time(partial(_end, world, self.seconds))
            fastest = min(fastest, taken)
            if taken > _REPEATED_BELOW_S:
                break
        row.evaluations = world.force_evaluations
        audit.sample(world)
        row.energy = audit.error
        soft = any(plan.contacts == "soft" and plan.collisions == "step" for plan in world.plans)
        row.is_located = not soft and not any(steps_not_rigid(world))
        finer = self.refined_end(run.simulation, 2.0)
        row.half_step, row.cpu_ms = _apart(places, finer), 1e3 * fastest
        run.places, run.finer = places, finer
        return True


def _compare(study: SceneStudy, scene: _Scene, runs: list[_Run], tightest: SimulationConfig) -> None:
    """Write into each row how far it is from the finest run: that which changes least in finer steps.

    Soft contacts share a sink and agree on it, so where some run locates its contacts it is one of those.
    """
    others = [scene.run(tightest, repeats=1)] if scene.is_taken_by(tightest) else []
    finest = [
        (run.row.half_step, run, run.finer)
        for run in (*runs, *others)
        if run.finer is not None and run.row.half_step is not None
    ]
    located = [found for found in finest if found[1].row.is_located]
    rigid, nudged = study.estimate.reference, study.estimate.spread_of("nudged")
    floor = 0.0 if nudged is None else nudged.position
    if rigid is not None and not located:
        known, best, study.reference = 0.0, rigid, "rigid contacts"
    elif finest:
        known, run, best = min(located or finest, key=lambda found: found[0])
        # Half the step may meet the same events.
        places, _ = attempt(partial(scene.refined_end, run.simulation, GOLDEN))
        known = max(known, 0.0 if places is None else _apart(places, best) or 0.0)
        step = f", {run.row.step}" if run.row.step else ""
        how = f"auto: {run.row.integrator}" if run.row.asked == "auto" else run.row.integrator
        study.reference = f"the finest of all methods ({how}{step}) in half the step"
    else:
        study.reference = "nothing: every method fails"
        return
    known = max(known, floor, _ROUNDINGS * math.ulp(float(np.abs(best).max(initial=0.0))))
    study.reference += f", which is known to {known:.1g} m"
    for run in runs:
        if run.places is not None and (apart := _apart(run.places, best)) is not None:
            run.row.at_most = apart <= _NO_BETTER * known
            run.row.error = max(apart, known) if run.row.at_most else apart


def _without_trails(load: Callable[[], World]) -> Callable[[], World]:
    """Return the same scene without records of where bodies have been: they cost time at every step."""

    def bare() -> World:
        world = load()
        world.synchronise()
        for entity in world.batch(Trail).entities.tolist():
            world.discard(entity, Trail)
        return world

    return bare


def _ladder(plain: SimulationConfig, method: str) -> Iterator[SimulationConfig]:
    """Return the scene's settings for a method, coarser to finer."""
    own = replace(plain, integrator=method)
    if method == "exact":
        yield own
    elif INTEGRATORS[method].chooses_steps:
        yield from (replace(own, tolerance=tolerance) for tolerance in _TOLERANCES)
    else:
        for factor in _SUBSTEP_FACTORS:
            yield replace(own, substeps=min(_SUBSTEPS_LIMIT, max(1, round(factor * plain.substeps))))


def _end(world: World, seconds: float) -> NDArray[np.float64]:
    """Run a world, and return where its moving bodies are then (n, 2) [m]."""
    world.run(seconds=seconds)
    rows = world.batch(Transform, Velocity).rows
    places: NDArray[np.float64] = world.table(Transform)["position"][rows].copy()
    return places


def _apart(places: NDArray[np.float64], others: NDArray[np.float64]) -> float | None:
    if places.shape != others.shape:
        return None
    return float(np.hypot(*(places - others).T).max(initial=0.0))
