"""How many digits of a result can be relied on, and until when any prediction means anything.

Digits come from runs that compute the same in another way: the twins of
:mod:`physicslab.lab.accuracy.estimate`, and more starts that are moved by one rounding, as the rounding of
every operation is most of the error of a method that is exact otherwise. The horizon comes from a start that
is moved by far more: the rate at which both runs part is that at which any error grows.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Iterable, Sequence
from dataclasses import asdict, dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.files.reader import read_scene
from physicslab.files.writer import write_scene
from physicslab.lab.accuracy.estimate import Estimate, estimate_error
from physicslab.lab.accuracy.horizon import find_horizon, scaled, sizes_of
from physicslab.lab.accuracy.nudges import NUDGE_SHARE, NUDGES, ROUNDING, error_of_tolerance, nudged
from physicslab.lab.accuracy.paths import Path, run_path
from physicslab.lab.accuracy.twins import Document, finer, with_ids
from physicslab.lab.case import Job, attempt
from physicslab.lab.document import finite
from physicslab.world import World

__all__ = ["Look", "Trust", "assess", "moments_of", "trust_report"]

_TWINS, _NUDGED = 0.6, 0.85
"""Shares of the work after which the twins are run, and after which the starts are that are moved."""

type _Errors = NDArray[np.float64]
type _Compare = Callable[[Path], _Errors]
"""Returns how far a path is from that of the scene, at each moment."""


@dataclass(frozen=True, slots=True)
class Look:
    """What can be relied on from the start to one moment of a run.

    Attributes
    ----------
    seconds : float
        When, after the start [s].
    digits, energy, momentum : float
        The fewest digits until then of any position, of the energy and of the momentum.
    bodies : list of floats
        Those of each body's position, in the order of the scene.
    """

    seconds: float
    digits: float
    energy: float
    momentum: float
    bodies: list[float]


@dataclass(slots=True)
class Trust:
    """What can be relied on at the end of a run.

    Attributes
    ----------
    digits : float
        Of the position of the worst body; ``nan`` where nothing moves or the run failed.
    worst : str
        That body.
    energy, momentum : float
        Digits of the total energy, as a share of the largest of it and its parts since the start, and of the
        momentum, as a share of the largest sum of those of all bodies.
    entities : dict of str to float
        How many digits of the position of each body agree in all ways to compute it.
    horizon_s : float, optional
        The time from the start [s] at which an error of one rounding has grown to a tenth of a body's size;
        ``None`` where errors do not grow like that within the run.
    ways : list of str
        Which twins were compared.
    failure : str
        Why there are no figures.
    looks : list of Look
        How digits became fewer, if moments were chosen; the last is that of the end.
    """

    digits: float = math.nan
    worst: str = ""
    energy: float = math.nan
    momentum: float = math.nan
    entities: dict[str, float] = field(default_factory=dict)
    horizon_s: float | None = None
    ways: list[str] = field(default_factory=list)
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


def assess(load: Callable[[], World], seconds: float, moments: Sequence[float] = ()) -> Job[Trust]:
    """Compute a scene in all ways there are; yield the share of the work that is done, then the result.

    Parameters
    ----------
    load : callable
        Returns the scene's world, a new one each time.
    seconds : float
        How long it is run [s].
    moments : sequence of floats
        Before which other moments digits are counted as well, after the start [s], in order.
    """
    estimate = Estimate()
    for found in estimate_error(load, seconds, moments):
        if isinstance(found, Estimate):
            estimate = found
        else:
            yield _TWINS * found
    if estimate.path is None or not estimate.bodies:
        yield Trust(failure=estimate.failure or "nothing moves")
        return
    document, world = with_ids(write_scene(load())), load()
    world.synchronise()
    run = partial(run_path, bodies=estimate.bodies, moments=(*moments, seconds))
    looser = None
    if world.plan.integrator.chooses_steps:
        looser, _ = attempt(partial(run, finer(document, 4)))
    own = estimate.path
    nudges = yield from scaled(_nudges(document, run), _TWINS, _NUDGED)

    def digits(compare: _Compare, scale: _Errors) -> _Errors:
        """Return the digits of a quantity at each moment."""
        errors = _errors(compare, estimate.paths, looser, nudges)
        shares = np.maximum(errors / np.where(scale > 0.0, scale, 1.0), ROUNDING)
        found: _Errors = np.maximum(-np.log10(shares), 0.0)
        return found

    reach = np.maximum(np.hypot(*np.moveaxis(own.places, 2, 0)), sizes_of(world, estimate.bodies))
    places = digits(lambda path: np.hypot(*np.moveaxis(path.places - own.places, 2, 0)), reach)
    energy = digits(lambda path: np.abs(path.energy - own.energy), own.energy_scale)
    momentum = digits(lambda path: np.hypot(*(path.momentum - own.momentum).T), own.momentum_scale)
    horizon = yield from scaled(find_horizon(document, estimate.bodies, seconds), _NUDGED, 1.0)
    worst = int(places[-1].argmin())
    yield Trust(
        float(places[-1, worst]), estimate.bodies[worst], float(energy[-1]), float(momentum[-1]),
        dict(zip(estimate.bodies, places[-1].tolist(), strict=True)), horizon, [*estimate.paths],
        looks=_looks((*moments, seconds), places, energy, momentum) if moments else [],
    )  # fmt: skip


def _nudges(document: Document, run: Callable[[World], Path]) -> Generator[float, None, list[Path]]:
    """Run starts that are moved by one rounding, and return the paths of those that do not fail."""
    paths = []
    for n in range(NUDGES):
        path, _ = attempt(partial(run, read_scene(nudged(document, n))))
        if path is not None:
            paths.append(path)
        yield (n + 1) / NUDGES
    return paths


def _errors(
    compare: _Compare, twins: dict[str, Path], looser: Path | None, nudges: Iterable[Path]
) -> _Errors:
    """Return the estimate of an error at each moment: the largest difference in any way to compute it.

    Where the method chooses its steps, ``looser`` is the path with steps four times as long.
    """
    apart = {name: compare(path) for name, path in twins.items() if name != "nudged"}  # done in other ways
    if looser is not None and "half step" in apart:
        apart["half step"] = error_of_tolerance(apart["half step"], compare(looser))
    squares = [compare(path) ** 2 for path in nudges]
    rounding = [NUDGE_SHARE * np.sqrt(np.mean(squares, axis=0))] if squares else []
    found: _Errors = np.max([*apart.values(), *rounding], axis=0)
    return found


def _looks(moments: Sequence[float], places: _Errors, energy: _Errors, momentum: _Errors) -> list[Look]:
    """Return the fewest digits until each moment."""
    places, energy, momentum = (np.minimum.accumulate(found) for found in (places, energy, momentum))
    rows = zip(moments, places.tolist(), energy.tolist(), momentum.tolist(), strict=True)
    return [Look(seconds, min(bodies), e, p, bodies) for seconds, bodies, e, p in rows]


def trust_report(trust: Trust) -> dict[str, Any]:
    """Return it as ``run --json`` has it: no number that is not finite."""
    found = asdict(trust)
    for name in ("digits", "energy", "momentum"):
        found[name] = finite(found[name])
    if not trust.looks:
        del found["looks"]
    return found
