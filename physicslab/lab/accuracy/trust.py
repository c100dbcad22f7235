"""How many digits of a result can be relied on, and until when any prediction means anything.

Digits come from runs that compute the same in another way: the twins of
:mod:`physicslab.lab.accuracy.estimate`, and more starts that are moved by one rounding, as the rounding of
every operation is most of the error of a method that is exact otherwise. The horizon comes from a start that
is moved by far more: the rate at which both runs part is that at which any error grows.
"""

from __future__ import annotations

import copy
import math
import random
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform, Velocity
from physicslab.files.reader import read_scene
from physicslab.files.writer import write_scene
from physicslab.lab.accuracy.estimate import Estimate, estimate_error
from physicslab.lab.accuracy.measure import finish
from physicslab.lab.accuracy.problem import Problem
from physicslab.lab.accuracy.settings import Setting
from physicslab.lab.accuracy.twins import Document, finer_settings, with_ids
from physicslab.lab.case import Job, attempt
from physicslab.lab.document import finite
from physicslab.world import World

__all__ = ["Trust", "TrustRow", "assess", "assess_problem", "trust_report"]

_NUDGES = 6
"""How many starts are moved by one rounding."""
_NUDGE_SHARE = 0.5
"""A number is off by half a rounding where it is rounded, and these are moved by a whole one."""
_LOOSER = 2.0**-8
"""The share of the error of a tolerance 2^8 times as large that is left with the scene's own."""
_ROUNDING = 2.0**-50
"""The smallest error of a result, as a share of its size: that of a few operations."""
_DISPLACED = 1e-10
"""By what share of its size each body is displaced in the twin that shows how errors grow."""
_PARTED = 0.1
"""Two runs in which a body is so many of its sizes apart have parted: they are different futures."""
_LOOKS = 400
"""How often two runs are compared."""


@dataclass(slots=True)
class Trust:
    """What can be relied on at the end of a run.

    Attributes
    ----------
    digits : float
        Of the position of the worst body; ``nan`` where nothing moves or the run failed.
    worst : str
        That body.
    entities : dict of str to float
        How many digits of the position of each body agree in all ways to compute it.
    horizon_s : float, optional
        The time from the start [s] at which an error of one rounding has grown to a tenth of a body's size;
        ``None`` where errors do not grow like that within the run.
    ways : list of str
        Which twins were compared.
    failure : str
        Why there are no figures.
    """

    digits: float = math.nan
    worst: str = ""
    entities: dict[str, float] = field(default_factory=dict)
    horizon_s: float | None = None
    ways: list[str] = field(default_factory=list)
    failure: str = ""


@dataclass(frozen=True, slots=True)
class TrustRow:
    """A problem with a known answer: how large its error was estimated to be, and how large it is.

    Attributes
    ----------
    problem : Problem
        Which.
    integrator : str
        The method that ran.
    estimate, error : float, optional
        Both as the problem measures errors; ``None`` where the run failed.
    """

    problem: Problem
    integrator: str
    estimate: float | None
    error: float | None

    @property
    def ratio(self) -> float | None:
        """The true error over the estimate; both are taken to be a rounding at least."""
        if self.estimate is None or self.error is None:
            return None
        return max(self.error, _ROUNDING) / max(self.estimate, _ROUNDING)


def assess(load: Callable[[], World], seconds: float) -> Job[Trust]:
    """Compute a scene in all ways there are; yield the share of the work that is done, then the result.

    Parameters
    ----------
    load : callable
        Returns the scene's world, a new one each time.
    seconds : float
        How long it is run [s].
    """
    estimate = Estimate()
    for found in estimate_error(load, seconds):
        if isinstance(found, Estimate):
            estimate = found
        else:
            yield 0.7 * found
    if estimate.end is None or not len(estimate.bodies):
        yield Trust(failure=estimate.failure or "nothing moves")
        return
    document, world = with_ids(write_scene(load())), load()
    world.synchronise()
    chooses = world.plan.integrator.chooses_steps
    shares = {"half step": _LOOSER if chooses else 1.0, "nudged": 0.0}  # nudged here in other ways
    scale = np.maximum(np.hypot(*estimate.end.T), _sizes(world, estimate.bodies))
    errors = _ROUNDING * scale
    for name, distances in estimate.distances.items():
        errors = np.maximum(errors, shares.get(name, 1.0) * distances)
    squares = []
    for n in range(_NUDGES):
        twin, _ = attempt(partial(_places, read_scene(_nudged(document, n)), estimate.bodies, seconds))
        if twin is not None:
            squares.append(np.sum((twin - estimate.end) ** 2, axis=1))
        yield 0.7 + 0.2 * n / _NUDGES
    if squares:
        errors = np.maximum(errors, _NUDGE_SHARE * np.sqrt(np.mean(squares, axis=0)))
    digits = np.maximum(-np.log10(errors / scale), 0.0)
    worst = int(digits.argmin())
    yield Trust(
        float(digits[worst]), estimate.bodies[worst],
        dict(zip(estimate.bodies, digits.tolist(), strict=True)),
        _horizon(document, estimate.bodies, seconds), [*estimate.distances],
    )  # fmt: skip


def assess_problem(problem: Problem) -> Job[TrustRow]:
    """Estimate the error of a problem, run as ``auto`` runs it, and measure its true error.

    The estimate is how much the problem's figure changes where it is computed in other ways.
    """
    simulation = Setting("auto").simulation(problem)
    world = problem.build(simulation)
    document = write_scene(world)
    world.synchronise()
    method = world.plan.integrator
    error, _ = attempt(partial(finish, problem, world))
    if error is None:
        yield TrustRow(problem, method.name, None, None)
        return
    finer, _ = attempt(partial(finish, problem, problem.build(finer_settings(simulation, 2))))
    step = 0.0 if finer is None else (_LOOSER if method.chooses_steps else 1.0) * abs(error - finer)
    squares = []
    for n in range(_NUDGES):
        twin, _ = attempt(partial(finish, problem, read_scene(_nudged(document, n))))
        if twin is not None:
            squares.append((error - twin) ** 2)
        yield n / _NUDGES
    rounding = _NUDGE_SHARE * math.sqrt(sum(squares) / len(squares)) if squares else 0.0
    yield TrustRow(problem, method.name, max(step, rounding), error)


def trust_report(trust: Trust) -> dict[str, Any]:
    """Return it as ``run --json`` has it: no number that is not finite."""
    found = asdict(trust)
    found["digits"] = finite(trust.digits)
    return found


def _nudged(document: Document, seed: int) -> Document:
    """Return a scene with places, velocities, masses and gravity moved by one rounding each, up or down.

    What is zero stays: it is not rounded, and with it a symmetry that no rounding breaks.
    """
    twin, order = copy.deepcopy(document), random.Random(seed)

    def move(part: dict[str, Any], *names: str) -> None:
        for name in names:
            value = part.get(name)
            if isinstance(value, list):
                part[name] = [_next(number, order) for number in value]
            elif value is not None:
                part[name] = _next(value, order)

    for entity in twin["entities"]:
        if "Velocity" in entity:
            move(entity.get("Transform", {}), "position", "angle")
            move(entity["Velocity"], "linear", "angular")
            move(entity.get("Mass", {}), "mass")
    move(twin.get("physics", {}), "gravity", "G")
    return twin


def _next(number: float, order: random.Random) -> float:
    """Return the next number up or down; of zero itself."""
    return math.nextafter(number, order.choice((-math.inf, math.inf))) if number else number


def _moving(world: World, bodies: list[str]) -> list[int]:
    """Return the rows of bodies by their names."""
    world.synchronise()
    batch = world.batch(Transform, Velocity)
    entities, rows = batch.entities.tolist(), batch.rows.tolist()
    found = {world.label(entity): row for entity, row in zip(entities, rows, strict=True)}
    return [found[name] for name in bodies]


def _sizes(world: World, bodies: list[str]) -> NDArray[np.float64]:
    """Return half the extent of each body (n,) [m]; of one without a shape that of the whole scene."""
    rows = _moving(world, bodies)
    shape, places = world.table(Shape), world.table(Transform)["position"][rows]
    sizes = np.maximum(shape["radius"][rows], 0.5 * np.hypot(shape["width"][rows], shape["height"][rows]))
    whole = float(np.abs(places - places.mean(axis=0)).max()) or 1.0
    return np.where(sizes > 0.0, sizes, whole)


def _places(world: World, bodies: list[str], seconds: float) -> NDArray[np.float64]:
    """Run a world, and return where bodies are then (n, 2) [m]."""
    rows = _moving(world, bodies)
    world.run(seconds=seconds)
    places: NDArray[np.float64] = world.table(Transform)["position"][rows].copy()
    return places


def _horizon(document: Document, bodies: list[str], seconds: float) -> float | None:
    """Return the time [s] at which one rounding has grown to a different future, if that is found."""
    world, twin = read_scene(document), read_scene(document)
    rows, other = _moving(world, bodies), _moving(twin, bodies)
    sizes = _sizes(world, bodies)
    ways = np.random.default_rng(0).choice((-1.0, 1.0), (len(bodies), 2))
    twin.table(Transform)["position"][other] += _DISPLACED * sizes[:, None] * ways
    steps = max(1, round(seconds / world.simulation.dt))
    stride = max(1, steps // _LOOKS)
    start = world.time
    beside = twin.stepping(seconds=seconds, stride=stride)
    for _ in world.stepping(seconds=seconds, stride=stride):
        next(beside, None)
        apart = world.table(Transform)["position"][rows] - twin.table(Transform)["position"][other]
        if (np.hypot(*apart.T) > _PARTED * sizes).any():
            rate = math.log(_PARTED / _DISPLACED) / (world.time - start)
            return math.log(_PARTED / _ROUNDING) / rate
    return None
