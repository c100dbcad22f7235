"""How many digits of a result can be relied on, and until when any prediction means anything.

Digits come from runs that compute the same in another way: the variants of
:mod:`physicslab.lab.accuracy.estimate`, and more starts that are moved by one rounding, as the rounding of
every operation is most of the error of a method that is exact otherwise. The horizon comes from a start that
is moved by far more: the rate at which both runs part is that at which any error grows. Where answers are
known, estimates of errors are put beside the true ones.
"""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.config import SimulationConfig
from physicslab.files.reader import read_scene
from physicslab.files.writer import write_scene
from physicslab.lab.accuracy import variants
from physicslab.lab.accuracy.contacts.study import OWN, ContactCase, ContactEngine
from physicslab.lab.accuracy.estimate import Estimate, estimate_error
from physicslab.lab.accuracy.paths import Path, differences, find_horizon, run_path, sizes_of
from physicslab.lab.accuracy.problem import KnownCase, Problem, Setting
from physicslab.lab.accuracy.variants import NUDGE_SHARE, NUDGES, ROUNDING, VARIANTS, Document, nudged
from physicslab.lab.case import attempt
from physicslab.lab.jobs import Job, scaled
from physicslab.lab.report import plain
from physicslab.world import World

_VARIANTS, _NUDGED = 0.6, 0.85
"""Shares of the work after which the variants are run, and after which the starts are that are moved."""
BUDGET_S = 60.0
"""How long all other ways to compute a scene may take [s], or three times as long as the scene itself."""
_STEP_SAFETY = 2.0
"""How many times as far as a variant in other steps a result may be off: both errors may be alike."""
_WAYS = [variant for variant in VARIANTS if variant.name != "nudged"]
"""The variants that are compared: there are more starts that are moved by one rounding."""
_IN_STEPS = {variant.name for variant in VARIANTS if variant.differs_in_step}
_NUDGED_NAME = "rounding"
_OVERLAP_NAME = "overlap"
"""The name of an error that no variant shows: bodies at rest overlap, by the limit of a gap."""

type _Errors = NDArray[np.float64]
type _Compare = Callable[[Path], _Errors]
"""Returns how far a path is from that of the scene, at each moment."""


@dataclass(frozen=True, slots=True)
class Look:
    """The reliable digits from the start to one moment of a run.

    Attributes
    ----------
    seconds : float
        When, after the start [s].
    digits, energy, momentum, angular_momentum : float
        The fewest digits until then of any position, of the energy and of both momenta.
    bodies, velocities, angles, spins : lists of floats
        Those of each body's position, velocity, angle and angular velocity, in the order of the scene.
    """

    seconds: float
    digits: float
    energy: float
    momentum: float
    angular_momentum: float
    bodies: list[float]
    velocities: list[float]
    angles: list[float]
    spins: list[float]


@dataclass(slots=True)
class Trust:
    """The reliable digits at the end of a run.

    Attributes
    ----------
    digits : float
        Right digits of the position of the worst body; ``nan`` where nothing moves or the run failed.
    worst : str
        That body.
    cause : str
        The variant that is furthest from it, ``"rounding"`` or ``"overlap"``.
    energy, momentum, angular_momentum : float
        Digits of the total energy, as a share of the largest of it and its parts since the start, and of the
        momenta, as shares of the largest sums of those of all bodies.
    entities, velocities, angles, spins : dicts of str to float
        How many digits of the position, of the velocity, of the angle and of the angular velocity of each
        body agree in all ways to compute it.
    horizon_s : float, optional
        The time from the start [s] at which an error of one rounding has grown to a tenth of a body's size;
        ``None`` where errors do not grow like that within the run.
    ways : list of str
        Which variants were compared.
    left_out : list of str
        Which were not, and why: they fail, or take too long.
    failure : str
        Why there are no figures.
    looks : list of Look
        How digits became fewer, if moments were chosen; the last is that of the end.
    """

    digits: float = math.nan
    worst: str = ""
    cause: str = ""
    energy: float = math.nan
    momentum: float = math.nan
    angular_momentum: float = math.nan
    entities: dict[str, float] = field(default_factory=dict)
    velocities: dict[str, float] = field(default_factory=dict)
    angles: dict[str, float] = field(default_factory=dict)
    spins: dict[str, float] = field(default_factory=dict)
    horizon_s: float | None = None
    ways: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    failure: str = ""
    looks: list[Look] = field(default_factory=list)


def moments_of(seconds: float, dt: float, count: int) -> list[float]:
    """Return at most so many moments of a run before its end [s], at the ends of steps.

    >>> moments_of(1.0, 0.25, 2), moments_of(0.5, 0.25, 100)
    ([0.5], [0.25])
    """
    steps = math.ceil(seconds / dt) - 1
    ends = {round(k * seconds / (count * dt)) for k in range(1, count)}
    return [n * dt for n in sorted(ends) if 1 <= n <= steps]


def assess(
    load: Callable[[], World], seconds: float, moments: Sequence[float] = (), budget_s: float = BUDGET_S
) -> Job[Trust]:
    """Compute a scene in all ways there are; yield the share of the work that is done.

    Parameters
    ----------
    load : callable
        Returns the scene's world, a new one each time.
    seconds : float
        How long it is run [s].
    moments : sequence of floats
        Before which other moments digits are counted as well, after the start [s], in order.
    budget_s : float
        After how long [s] ways are left out that are not done, where that is more than three runs.
    """
    estimate = yield from scaled(estimate_error(load, seconds, moments, budget_s, _WAYS), 0.0, _VARIANTS)
    if estimate.path is None or not estimate.bodies:
        return Trust(failure=estimate.failure or "nothing moves")
    world, own, bodies, times = load(), estimate.path, estimate.bodies, (*moments, seconds)
    world.synchronise()
    left_out = [
        f"{variant.name}: {variant.failure}" for variant in estimate.variants if variant.spread is None
    ]
    deadline = time.perf_counter() + estimate.left_s
    run = partial(run_path, bodies=bodies, moments=times, budget_s=max(estimate.left_s, estimate.own_s))
    nudges = yield from scaled(_nudges(estimate.document, run, deadline, left_out), _VARIANTS, _NUDGED)
    if not estimate.paths and not nudges:
        return Trust(failure="no other way to compute it ends in time", left_out=left_out)

    def estimates(compare: _Compare) -> _Errors:
        """Return the estimates of a quantity's error at each moment (ways, moments, ...)."""
        departures = {name: compare(path) for name, path in estimate.paths.items()}
        return np.array(error_estimates(departures, [compare(path) for path in nudges]))

    def digits(compare: _Compare, scale: _Errors, least: _Errors | float = 0.0) -> _Errors:
        """Return the digits of a quantity at each moment, whose error is known to be so large at least."""
        errors = np.maximum(estimates(compare).max(axis=0), least)
        shares = np.maximum(errors / np.where(scale > 0.0, scale, 1.0), ROUNDING)
        found: _Errors = np.maximum(-np.log10(shares), 0.0)
        return found

    def apart(number: int, path: Path) -> _Errors:
        return differences(path.states, own.states)[number]

    floors: tuple[_Errors | float, ...] = (own.overlaps, 0.0, 0.0, 0.0)
    each = [
        digits(partial(apart, n), scale, floor)
        for n, (scale, floor) in enumerate(zip(scales(world, own, bodies, times), floors, strict=True))
    ]
    whole = (
        digits(lambda path: np.abs(path.energy - own.energy), own.energy_scale),
        digits(lambda path: np.hypot(*(path.momentum - own.momentum).T), own.momentum_scale),
        digits(lambda path: np.abs(path.angular - own.angular), own.angular_scale),
    )
    horizon = yield from _horizon(estimate, seconds, deadline, left_out)
    places = each[0]
    worst = int(places[-1].argmin())
    ways = estimates(partial(apart, 0))[:, -1, worst]
    cause = int(np.append(ways, own.overlaps[-1, worst]).argmax())
    found = Trust(float(places[-1, worst]), bodies[worst], ways=[*estimate.paths], left_out=left_out)
    found.cause = [*estimate.paths, *([_NUDGED_NAME] if nudges else []), _OVERLAP_NAME][cause]
    found.energy, found.momentum, found.angular_momentum = (float(column[-1]) for column in whole)
    found.entities, found.velocities, found.angles, found.spins = (
        dict(zip(bodies, column[-1].tolist(), strict=True)) for column in each
    )
    found.horizon_s, found.looks = horizon, _looks(times, each, whole) if moments else []
    return found


def _looks(times: Sequence[float], each: Sequence[_Errors], whole: Sequence[_Errors]) -> list[Look]:
    """Return the fewest digits until each moment, of quantities of bodies (k, n) and of the world (k,)."""
    least = [np.minimum.accumulate(column).tolist() for column in (*whole, *each)]
    places = least[len(whole)]
    return [Look(t, min(places[n]), *(column[n] for column in least)) for n, t in enumerate(times)]


def scales(
    world: World, path: Path, bodies: Sequence[str], times: Sequence[float]
) -> tuple[_Errors, _Errors, _Errors, _Errors]:
    """Return the scales of digits, at each moment and of each body (k, n).

    For a position it is that or the size of the body [m], for a velocity the largest since the start or that
    size in the time since then [m/s], for an angle that or a radian, for a spin the largest since the
    start or a radian in that time [rad/s].
    """
    sizes, elapsed = sizes_of(world, bodies), np.array(times)[:, None]
    reach = np.hypot(path.places[..., 0], path.places[..., 1])
    return (
        np.maximum(reach, sizes), np.maximum(path.speeds, sizes / elapsed),
        np.maximum(np.abs(path.states[..., 2]), 1.0), np.maximum(path.spins, 1.0 / elapsed),
    )  # fmt: skip


def _nudges(
    document: Document, run: Callable[[World], Path], deadline: float, left_out: list[str]
) -> Job[list[Path]]:
    """Run starts that are moved by one rounding, and return the paths of those that do not fail."""
    paths = []
    for n in range(NUDGES):
        if time.perf_counter() > deadline:
            left_out.append(f"{NUDGES - n} of {NUDGES} starts moved by one rounding: no time was left")
            break
        path, _ = attempt(partial(run, read_scene(nudged(document, n))))
        if path is not None:
            paths.append(path)
        yield (n + 1) / NUDGES
    return paths


def _horizon(estimate: Estimate, seconds: float, deadline: float, left_out: list[str]) -> Job[float | None]:
    """Look for the horizon, while there is time."""
    job = scaled(find_horizon(estimate.document, estimate.bodies, seconds), _NUDGED, 1.0)
    while True:
        try:
            yield next(job)
        except StopIteration as end:
            found: float | None = end.value
            return found
        if time.perf_counter() > deadline + estimate.own_s:
            left_out.append("horizon: no time was left")
            return None


def error_estimates(departures: Mapping[str, Any], nudges: Sequence[Any]) -> list[Any]:
    """Return the estimate of an error by each way to compute it, and last by rounding, if that was tried.

    Parameters
    ----------
    departures : mapping of str to float or array
        How far each variant is from the scene, by its name, in the unit of the error.
    nudges : sequence of floats or arrays
        How far starts that are moved by one rounding end from the scene.
    """
    found = [_STEP_SAFETY * apart if name in _IN_STEPS else apart for name, apart in departures.items()]
    rounding = [NUDGE_SHARE * np.sqrt(sum(apart**2 for apart in nudges) / len(nudges))] if nudges else []
    return found + rounding


def trust_report(trust: Trust) -> dict[str, Any]:
    """Return it as ``run --json`` has it: no number that is not finite."""
    found: dict[str, Any] = plain(trust)
    if not trust.looks:
        del found["looks"]
    return found


CONTACT_STEP = 1.0 / 60.0
"""With which contact cases are computed [s]."""
_NEAR, _FAR, _SHARE = 10.0, 100.0, 0.95
"""Within what factor of the estimate true errors are to be, how much larger they may ever be, and how often
they are to be as near."""
OF_ROUNDING = 1e-12
"""An estimate up to this is one of what rounding adds up to, and the sum may by chance be far less."""


@dataclass(frozen=True, slots=True)
class TrustRow:
    """A problem with a known answer: how large its error was estimated to be, and how large it is.

    Attributes
    ----------
    case : KnownCase
        Which.
    method : str
        The method that ran, or the model of contacts.
    estimate, error : float, optional
        Both as the case measures errors; ``None`` where the run failed.
    """

    case: KnownCase
    method: str
    estimate: float | None
    error: float | None

    @property
    def ratio(self) -> float | None:
        """The true error over the estimate; both are taken to be a rounding at least."""
        if self.estimate is None or self.error is None:
            return None
        return max(self.error, variants.ROUNDING) / max(self.estimate, variants.ROUNDING)

    @property
    def near(self) -> bool:
        """Whether the error is within a factor of 10 of the estimate, or less where both are of rounding."""
        if self.estimate is None or self.ratio is None:
            return False
        return self.ratio <= _NEAR and (self.ratio >= 1.0 / _NEAR or self.estimate <= OF_ROUNDING)


@dataclass(frozen=True, slots=True)
class TrustSummary:
    """The summary of rows.

    Attributes
    ----------
    known, near : int
        How many have both figures, and in how many the error is within a factor of 10 of the estimate.
    largest : float
        The largest true error over its estimate.
    cautious : int
        How many of those that are near have an estimate of rounding that is more than 10 times too large.
    """

    known: int
    near: int
    largest: float
    cautious: int

    @property
    def holds(self) -> bool:
        """Whether 95 % are near, and no error is more than 100 times its estimate."""
        return self.near >= _SHARE * self.known and self.largest <= _FAR


def summarise(rows: Sequence[TrustRow]) -> TrustSummary:
    """Count the rows whose estimate is good."""
    ratios = [row.ratio for row in rows if row.ratio is not None]
    near = [row.ratio for row in rows if row.near and row.ratio is not None]
    cautious = sum(ratio < 1.0 / _NEAR for ratio in near)
    return TrustSummary(len(ratios), len(near), max(ratios, default=0.0), cautious)


def assess_problem(problem: Problem) -> Job[TrustRow]:
    """Estimate the error of a problem, run as ``auto`` runs it, and measure its true error."""
    simulation = Setting("auto").simulation(problem)
    world = problem.build(simulation)
    world.synchronise()
    return (yield from _assess(problem, world.plan.integrator.name, simulation, {}))


def assess_contacts(case: ContactCase, engine: ContactEngine) -> Job[TrustRow]:
    """Estimate the error of a contact case with one of our models of contacts, and measure its true error.

    With soft contacts, rigid ones are another way to compute it.
    """
    others = {own.name: own.simulation(CONTACT_STEP) for own in OWN if own.name == "rigid" != engine.name}
    return (yield from _assess(case, engine.title, engine.simulation(CONTACT_STEP), others))


def _assess(
    case: KnownCase, method: str, simulation: SimulationConfig, others: Mapping[str, SimulationConfig]
) -> Job[TrustRow]:
    """Estimate an error by how much the case's figure changes where it is computed in other ways."""
    worlds, ready = case.worlds(simulation), case.worlds(simulation)
    documents = [variants.with_ids(write_scene(world)) for world in worlds]
    for world in ready:
        world.synchronise()
    error, _ = attempt(partial(case.finish, worlds))
    if error is None:
        return TrustRow(case, method, None, None)

    def change(other: Sequence[World] | None) -> float:
        """Return how far the figure is from that of other worlds; 0 where there are none."""
        found, _ = (None, "") if other is None else attempt(partial(case.finish, other))
        return 0.0 if found is None else abs(error - found)

    known = {name: change(case.worlds(other)) for name, other in others.items()}
    ways = [variant for variant in variants.VARIANTS if variant.differs_in_step or variant.name == "tightest"]
    whole = len(ways) + variants.NUDGES + 1
    for n, variant in enumerate(ways):
        known[variant.name] = change(_variants(variant, documents, ready))
        yield (n + 1) / whole
    nudges = []
    for n in range(variants.NUDGES):
        nudges.append(change([read_scene(variants.nudged(document, n)) for document in documents]))
        yield (len(ways) + n + 1) / whole
    return TrustRow(case, method, float(max(error_estimates(known, nudges))), error)


def _variants(
    variant: variants.Variant, documents: Sequence[variants.Document], worlds: Sequence[World]
) -> list[World] | None:
    """Return the variants of all worlds, ``None`` where one has no such."""
    made = [variant.make(document, world) for document, world in zip(documents, worlds, strict=True)]
    found = [world for world in made if world is not None]
    return found if len(found) == len(made) else None
