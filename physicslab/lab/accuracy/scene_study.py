"""A scene without a known answer: how far its results depend on the method and on the step."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Trail, Transform, Velocity
from physicslab.diagnostics.audit import Audit
from physicslab.ecs.config import SimulationConfig
from physicslab.files.writer import write_scene
from physicslab.integrators import INTEGRATORS
from physicslab.integrators.dop853 import DOP853
from physicslab.lab.accuracy.estimate import Estimate, estimate_error, find_order
from physicslab.lab.accuracy.horizon import find_horizon
from physicslab.lab.accuracy.twins import GOLDEN, Document, refined, with_ids
from physicslab.lab.case import attempt, cpu_time
from physicslab.lab.jobs import Job, scaled
from physicslab.lab.worlds import steps_not_rigid
from physicslab.stepping.plan import tolerance_for
from physicslab.world import World

__all__ = ["DEFAULT_S", "ESTIMATE", "SceneRow", "SceneStudy", "study_scene"]

type _Ends = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Where bodies end [m] (n, 2) as configured, and in finer steps."""

ESTIMATE = "an estimate: there is no reference, runs are compared with each other"
DEFAULT_S = 5.0
"""How long a scene is run, where nothing else is asked for."""
_ESTIMATE_SHARE, _HORIZON_SHARE = 0.3, 0.4
"""Of the work of a study, roughly, that is done after the estimate, and after the horizon was looked for."""
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
"""Of a scene's configuration."""
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
    cpu_s : float
        Process time without compiling [s].
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
    """

    integrator: str
    reason: str
    asked: str
    step: str
    substeps: int
    tolerance: float
    evaluations: int = 0
    cpu_s: float = 0.0
    half_step: float | None = None
    error: float | None = None
    at_most: bool = False
    is_located: bool = False
    energy: float | None = None
    failure: str = ""


@dataclass(slots=True)
class SceneStudy:
    """What was found of a scene.

    Attributes
    ----------
    name : str
        Of the scene.
    seconds : float
        How long it was run [s].
    reference : str
        What all were compared with.
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


def study_scene(name: str, load: Callable[[], World], seconds: float = DEFAULT_S) -> Job[SceneStudy]:
    """Run a scene with every method; yield the share of the work that is done.

    Parameters
    ----------
    load : callable
        Returns the scene's world, a new one each time.
    seconds : float
        How long it is run [s].
    """
    load = _without_trails(load)
    plain = dataclasses.replace(load().simulation, sleeping=False)  # so that errors are those of methods
    auto = dataclasses.replace(plain, integrator="auto")
    methods = [method for method in INTEGRATORS if _takes(load, plain, method)]
    wanted = [auto, *(rung for method in methods for rung in _ladder(plain, method))]
    study = SceneStudy(name, seconds, "")
    study.estimate = yield from scaled(estimate_error(load, seconds), 0.0, _ESTIMATE_SHARE)
    find_order(study.estimate, load, seconds)
    document = with_ids(write_scene(load()))
    horizon = find_horizon(document, study.estimate.bodies, _HORIZON_TIMES * seconds)
    study.horizon_s = yield from scaled(horizon, _ESTIMATE_SHARE, _HORIZON_SHARE)
    runs = []
    for i, simulation in enumerate(wanted):
        row, ends = _row(load, document, simulation, seconds)
        study.rows.append(row)
        runs.append((row, ends, simulation))
        yield _HORIZON_SHARE + (1.0 - _HORIZON_SHARE) * (i + 1) / len(wanted)
    _compare(study, runs, document, load, plain)
    return study


def _compare(
    study: SceneStudy, runs: list[tuple[SceneRow, _Ends | None, SimulationConfig]], document: Document,
    load: Callable[[], World], plain: SimulationConfig,
) -> None:  # fmt: skip
    """Write into each row how far it is from the finest run: that which changes least in finer steps.

    Soft contacts share a sink and agree on it, so where some run locates its contacts it is one of those.
    """
    others = []
    if _takes(load, plain, DOP853.name):
        tightest = dataclasses.replace(plain, integrator=DOP853.name, tolerance=_TIGHTEST)
        others.append((*_row(load, document, tightest, study.seconds, repeats=1), tightest))
    finest = [
        (row.half_step, row, ends[1], simulation)
        for row, ends, simulation in (*runs, *others)
        if ends and row.half_step is not None
    ]
    located = [found for found in finest if found[1].is_located]
    rigid, nudged = study.estimate.reference, study.estimate.spread_of("nudged")
    floor = 0.0 if nudged is None else nudged.position
    if rigid is not None and not located:
        known, best, study.reference = 0.0, rigid, "rigid contacts"
    elif finest:
        known, row, best, simulation = min(located or finest, key=lambda found: found[0])
        document = document | {"simulation": dataclasses.asdict(simulation)}
        other = refined(
            document, _prepared(load, simulation), GOLDEN
        )  # half the step may meet the same events
        places, failure = attempt(partial(_end, other, study.seconds))
        known = max(known, 0.0 if failure or places is None else _apart(places, best) or 0.0)
        step = f", {row.step}" if row.step else ""
        how = f"auto: {row.integrator}" if row.asked == "auto" else row.integrator
        study.reference = f"the finest of all methods ({how}{step}) in half the step"
    else:
        study.reference = "nothing: every method fails"
        return
    known = max(known, floor, _ROUNDINGS * math.ulp(float(np.abs(best).max(initial=0.0))))
    study.reference += f", which is known to {known:.1g} m"
    for row, ends, _ in runs:
        if ends and (apart := _apart(ends[0], best)) is not None:
            row.at_most = apart <= _NO_BETTER * known
            row.error = max(apart, known) if row.at_most else apart


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
    own = dataclasses.replace(plain, integrator=method)
    if method == "exact":
        yield own
    elif INTEGRATORS[method].chooses_steps:
        for tolerance in _TOLERANCES:
            yield dataclasses.replace(own, tolerance=tolerance)
    else:
        for factor in _SUBSTEP_FACTORS:
            yield dataclasses.replace(own, substeps=_limited(factor * plain.substeps))


def _limited(substeps: float) -> int:
    return min(_SUBSTEPS_LIMIT, max(1, round(substeps)))


def _takes(load: Callable[[], World], plain: SimulationConfig, method: str) -> bool:
    return not _prepared(load, dataclasses.replace(plain, integrator=method)).plan.refused


def _prepared(load: Callable[[], World], simulation: SimulationConfig) -> World:
    """Return the scene's world, ready to be stepped by a configuration."""
    world = load()
    world.simulation = simulation
    world.synchronise()
    return world


def _row(
    load: Callable[[], World], document: Document, simulation: SimulationConfig, seconds: float,
    repeats: int = _REPEATS,
) -> tuple[SceneRow, _Ends | None]:  # fmt: skip
    """Return the row of a configuration, and where bodies end by it and by one in finer steps."""
    world = _prepared(load, simulation)
    method = world.plan
    parts = 1 if method.integrator.chooses_steps else method.substeps
    step = f"{simulation.dt / parts:.3g} s"
    if method.integrator.chooses_steps:
        tolerance = tolerance_for(world, world.schedule.forces)
        step = "" if method.integrator.name == "exact" else f"tol {tolerance:g}"
    row = SceneRow(
        method.integrator.name, method.reason, simulation.integrator, step,
        simulation.substeps, simulation.tolerance,
    )  # fmt: skip
    ends, row.failure = attempt(partial(_fill, row, load, document, simulation, seconds, repeats))
    return row, ends


def _fill(
    row: SceneRow, load: Callable[[], World], document: Document, simulation: SimulationConfig,
    seconds: float, repeats: int,
) -> _Ends:  # fmt: skip
    """Run a scene by a configuration, and write its cost and its errors into a row."""
    for _ in range(repeats):  # the shortest: the first also compiles, and other programs run as well
        world = _prepared(load, simulation)
        audit = Audit(world)
        taken, places = cpu_time(partial(_end, world, seconds))
        row.cpu_s = min(row.cpu_s or taken, taken)
        if taken > _REPEATED_BELOW_S:
            break
    row.evaluations = world.force_evaluations
    audit.sample(world)
    row.energy = audit.error
    contacts = world.plan.contacts if world.plan.collisions == "step" else "rigid"
    row.is_located = contacts == "rigid" and not any(steps_not_rigid(world))
    own = document | {"simulation": dataclasses.asdict(simulation)}
    finer = _end(refined(own, _prepared(load, simulation), 2.0), seconds)
    row.half_step = _apart(places, finer)
    return places, finer


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
