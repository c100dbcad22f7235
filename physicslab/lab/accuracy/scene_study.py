"""A scene without a known answer: how far its results hang on the method and on the step."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Trail, Transform, Velocity
from physicslab.diagnostics.energy import Drift
from physicslab.ecs.config import SimulationConfig
from physicslab.integrators import INTEGRATORS
from physicslab.lab.accuracy.document import finite
from physicslab.state.masses import Diverged
from physicslab.world import World

__all__ = ["ESTIMATE", "SceneRow", "SceneStudy", "scene_document", "scene_text", "study_scene"]

ESTIMATE = "an estimate: there is no reference, runs are compared with each other"
_SECONDS = 5.0
_TIGHTEST = 1e-17
_FINER = (0.5, 1.0, 2.0, 4.0)
"""The rungs of a ladder of steps: so many times the scene's own substeps."""
_REPEATS = 4
_LONG = 2.0
"""A run that takes longer [s] is not made again to be timed."""
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
        The method that was asked for.
    step : str
        Its step, or its tolerance; empty for one that has neither.
    evaluations : int
        Force evaluations.
    cpu_s : float
        Process time without compiling [s].
    half_step : float, optional
        The largest distance [m] of any body from where it is with steps of half the length; with twice the
        length for a method that chooses its steps, which overstates the error.
    tightest : float, optional
        The same from where the tightest method has it; ``None`` for that itself, and where there is none.
    energy : float, optional
        The relative drift of the energy at the end.
    failure : str
        Why there are no figures.
    """

    integrator: str
    reason: str
    asked: str
    step: str
    evaluations: int = 0
    cpu_s: float = 0.0
    half_step: float | None = None
    tightest: float | None = None
    energy: float | None = None
    failure: str = ""


@dataclass(slots=True)
class SceneStudy:
    """What was found of a scene; ``tightest`` says against what methods were compared."""

    name: str
    seconds: float
    tightest: str
    rows: list[SceneRow] = field(default_factory=list)


def study_scene(name: str, load: Callable[[], World]) -> Iterator[float | SceneStudy]:
    """Run a scene with every method; yield the share of the work that is done, then the result.

    Parameters
    ----------
    load : callable
        Returns the scene's world, a new one each time.
    """
    load = _without_trails(load)
    plain = dataclasses.replace(load().simulation, sleeping=False)  # errors are to be those of methods
    auto = dataclasses.replace(plain, integrator="auto")
    methods = [method for method in INTEGRATORS if _takes(load, plain, method)]
    wanted = [auto, *(rung for method in methods for rung in _ladder(plain, method))]
    best, tight = _tightest(load, plain)
    study = SceneStudy(name, _SECONDS, tight)
    for i, simulation in enumerate(wanted):
        study.rows.append(_row(load, simulation, best))
        yield (i + 1) / len(wanted)
    yield study


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
        for factor in _FINER:
            yield dataclasses.replace(own, substeps=min(10_000, max(1, round(factor * plain.substeps))))


def _takes(load: Callable[[], World], plain: SimulationConfig, method: str) -> bool:
    world = load()
    world.simulation = dataclasses.replace(plain, integrator=method)
    world.synchronise()
    return not world.plan.refused


def _tightest(load: Callable[[], World], plain: SimulationConfig) -> tuple[NDArray[np.float64] | None, str]:
    """Return where bodies end with the tightest method that the scene allows, and what it is called."""
    for method, changes, words in (
        ("exact", {}, "the closed form"),
        ("dop853", {"tolerance": _TIGHTEST}, f"dop853 with a tolerance of {_TIGHTEST:g}"),
        ("leapfrog", {"substeps": min(10_000, 4 * plain.substeps)}, "leapfrog with a quarter of the step"),
    ):
        if _takes(load, plain, method):
            world = load()
            world.simulation = dataclasses.replace(plain, integrator=method, **changes)
            try:
                return _end(world), words
            except (Diverged, ArithmeticError):
                continue
    return None, "nothing: every method fails"


def _row(
    load: Callable[[], World], simulation: SimulationConfig, best: NDArray[np.float64] | None
) -> SceneRow:
    world = load()
    world.simulation = simulation
    world.synchronise()
    method = world.plan
    parts = 1 if method.integrator.chooses_steps else method.substeps
    step = f"{simulation.dt / parts:.3g} s"
    if method.integrator.chooses_steps:
        step = "" if method.integrator.name == "exact" else f"tol {simulation.tolerance:g}"
    row = SceneRow(method.integrator.name, method.reason, simulation.integrator, step)
    drift = Drift(world)
    try:
        for _ in range(_REPEATS):  # the shortest: the first also compiles, and other programs run as well
            world = load()
            world.simulation = simulation
            world.synchronise()
            start = time.process_time()
            places = _end(world)
            taken = time.process_time() - start
            row.cpu_s = min(row.cpu_s or taken, taken)
            if taken > _LONG:
                break
        row.evaluations = world.force_evaluations
        drift.sample(world)
        row.energy = drift.relative
        substep_factor = load()
        substep_factor.simulation = _other_step(simulation)
        row.half_step = _apart(places, _end(substep_factor))
        if best is not None:
            row.tightest = _apart(places, best)
    except (Diverged, ArithmeticError) as error:
        row.failure = str(error)
    return row


def _other_step(simulation: SimulationConfig) -> SimulationConfig:
    """Return the same with steps half as long, and a tolerance that doubles those of order 8.

    A tighter tolerance than the scene's might be more than rounding allows.
    """
    tolerance = min(1e-2, simulation.tolerance * 2.0**8)
    return dataclasses.replace(simulation, dt=0.5 * simulation.dt, tolerance=tolerance)


def _end(world: World) -> NDArray[np.float64]:
    """Run a world, and return where what moves is then (n, 2) [m]."""
    world.synchronise()
    with np.errstate(all="ignore"):
        world.run(seconds=_SECONDS)
    places: NDArray[np.float64] = world.table(Transform)["position"][
        world.batch(Transform, Velocity).rows
    ].copy()
    return places


def _apart(places: NDArray[np.float64], others: NDArray[np.float64]) -> float | None:
    if places.shape != others.shape:
        return None
    return float(np.hypot(*(places - others).T).max(initial=0.0))


def scene_document(study: SceneStudy) -> dict[str, Any]:
    """Return what was found of a scene as a document."""
    rows = []
    for row in study.rows:
        found = dataclasses.asdict(row)
        found["cpu_ms"] = 1e3 * found.pop("cpu_s") if not row.failure else None
        found["error"] = (
            row.tightest or row.half_step
        )  # the tightest is compared with itself at half the step
        rows.append(
            {key: finite(value) if isinstance(value, float) else value for key, value in found.items()}
        )
    return {
        "scene": study.name, "seconds": study.seconds, "kind": ESTIMATE, "reference": study.tightest,
        "rows": rows,
    }  # fmt: skip


def scene_text(study: SceneStudy) -> str:
    """Return what was found of a scene as a table."""
    lines = [
        f"{study.name}: {ESTIMATE}",
        f"  how far bodies are [m] after {study.seconds:g} s from where they are with half the step "
        f"(dop853: twice the step), and with {study.tightest}",
        f"  {'method':<18} {'ran':<18} {'step':>9} {'forces':>9} {'CPU ms':>9} {'half step':>10} "
        f"{'tightest':>10} {'energy':>9}",
    ]
    for row in study.rows:
        half, tight, energy = (
            "-" if number is None else f"{number:.1e}" for number in (row.half_step, row.tightest, row.energy)
        )
        lines.append(
            f"  {row.asked:<18} {row.integrator:<18} {row.step:>9} {row.evaluations:>9} "
            f"{1e3 * row.cpu_s:>9.3g} {half:>10} {tight:>10} {energy:>9}  {row.failure}".rstrip()
        )
    return "\n".join([*lines, f"  auto: {study.rows[0].reason}", ""])
