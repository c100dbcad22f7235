"""How far the twins of a scene end apart: an estimate of its error, and of the order of that in the step."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity
from physicslab.files.writer import write_scene
from physicslab.lab.accuracy.twins import TWINS, Twin, finer, with_ids
from physicslab.lab.case import attempt
from physicslab.lab.worlds import steps_not_rigid
from physicslab.world import World

__all__ = ["Estimate", "Spread", "TwinResult", "estimate_error"]

type _End = NDArray[np.float64]
"""Columns x, y, angle, vx, vy, spin of every body that can move (n, 6)."""

_LIMITED_BY_STEP = 0.25
"""Share of the estimate that halving the step must explain for the step to be what limits the results."""
_MIRROR = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, -1.0])
_ORDER_MARGIN = 2.0
"""An observed order that is further from none than the method's own and this is chance."""
_WHOLE = 10**9
"""A stride that no run is longer than: the steps of a run are made at once."""
_ROUNDINGS = 1e3
"""A spread of fewer roundings than this has no order."""


@dataclass(frozen=True, slots=True)
class Spread:
    """The largest difference of any body between two runs.

    Attributes
    ----------
    position, angle, velocity, spin : float
        Of places [m], angles [rad], velocities [m/s] and angular velocities [rad/s].
    """

    position: float
    angle: float
    velocity: float
    spin: float


@dataclass(frozen=True, slots=True)
class TwinResult:
    """A twin, how it differs from the scene, and how far apart both end.

    Attributes
    ----------
    name, what : str
        The twin.
    spread : Spread, optional
        ``None`` where it failed.
    failure : str
        Why.
    """

    name: str
    what: str
    spread: Spread | None
    failure: str = ""


@dataclass(slots=True)
class Estimate:
    """The estimate of the error of a scene, run as it is configured.

    Attributes
    ----------
    error : Spread, optional
        The largest spread of any twin; ``None`` where the scene or all of its twins fail.
    worst : str
        The twin that is furthest off in place.
    order : float, optional
        The power of the step with which the error falls; ``None`` where it has none.
    order_reason : str
        How the order was found, or why there is none.
    twins : list of TwinResult
        All that the scene has.
    failure : str
        Why the scene itself could not be run.
    reference : array of floats, optional
        Where bodies end [m] with rigid contacts (n, 2), if contacts are soft and no step was left to these.
    bodies : list of str
        The bodies that can move.
    end : array of floats, optional
        Where they end [m] in the scene itself (n, 2).
    distances : dict of str to array of floats
        How far each ends from there [m] in a twin (n,), by the name of the twin.
    """

    error: Spread | None = None
    worst: str = ""
    order: float | None = None
    order_reason: str = ""
    twins: list[TwinResult] = field(default_factory=list)
    failure: str = ""
    reference: NDArray[np.float64] | None = None
    bodies: list[str] = field(default_factory=list)
    end: NDArray[np.float64] | None = None
    distances: dict[str, NDArray[np.float64]] = field(default_factory=dict)


class OutOfTime(ArithmeticError):
    """A twin took longer than it may."""


def estimate_error(load: Callable[[], World], seconds: float) -> Iterator[float | Estimate]:
    """Run a scene and its twins; yield the share of the work that is done, then the estimate.

    Parameters
    ----------
    load : callable
        Returns the scene's world, a new one each time.
    seconds : float
        How long it is run [s].
    """
    scene, found = load(), Estimate()
    document = with_ids(write_scene(scene))
    scene.synchronise()
    found.bodies = [entity["id"] for entity in document["entities"] if "Velocity" in entity]
    run = _Runs(found.bodies, seconds)
    own, found.failure = attempt(partial(run.end, load()))
    if own is None:
        yield found
        return
    found.end = own[:, :2]
    soft = not scene.event_driven or _something_rests(load(), seconds)
    ends: dict[str, _End] = {}
    for i, twin in enumerate(TWINS):
        world = twin.make(document, scene) if soft or twin.name != "rigid" else None
        if world is not None:
            found.twins.append(_compared(twin, world, run, own, ends))
            if twin.name == "rigid" and twin.name in ends and not any(steps_not_rigid(world)):
                found.reference = ends[twin.name][:, :2]
        yield (i + 1) / (len(TWINS) + 1)
    found.distances = {name: np.hypot(*(end - own)[:, :2].T) for name, end in ends.items()}
    _summarise(found)
    if found.error is not None:
        found.order, found.order_reason = _order(
            found, scene, partial(run.end, finer(document, 4)), own, ends
        )
    yield found


def _something_rests(world: World, seconds: float) -> bool:
    """Whether a body ever rests on another: where impacts are located, only such ones move softly."""
    return any(world.contacts.active for _ in world.stepping(seconds=seconds))


class _Runs:
    """Runs worlds for one time, and reads the state of the same bodies at the end."""

    def __init__(self, bodies: list[str], seconds: float) -> None:
        self._bodies, self._seconds = bodies, seconds

    def end(self, world: World, budget_s: float = math.inf) -> _End:
        """Return the state at the end.

        Raises
        ------
        OutOfTime
            If that takes longer than the budget [s].
        """
        rows = {world.label(int(entity)): row for entity, row in self._rows(world)}
        start = time.perf_counter() - world.compile_s  # kernels may have to be compiled first
        for _ in world.stepping(seconds=self._seconds, stride=1 if math.isfinite(budget_s) else _WHOLE):
            if time.perf_counter() - start - world.compile_s > budget_s:
                raise OutOfTime(f"given up after {budget_s:g} s, at t = {world.time:.3g} s")
        kept = [rows[name] for name in self._bodies if name in rows]
        transform, velocity = world.table(Transform), world.table(Velocity)
        columns = (transform["position"], transform["angle"], velocity["linear"], velocity["angular"])
        return np.column_stack([column[kept] for column in columns])

    @staticmethod
    def _rows(world: World) -> Iterator[tuple[int, int]]:
        world.synchronise()
        batch = world.batch(Transform, Velocity)
        return zip(batch.entities.tolist(), batch.rows.tolist(), strict=True)


def _compared(twin: Twin, world: World, run: _Runs, own: _End, ends: dict[str, _End]) -> TwinResult:
    """Run a twin, and keep where it ends."""
    end, failure = attempt(partial(run.end, world, twin.budget_s))
    if end is None:
        return TwinResult(twin.name, twin.what, None, failure)
    ends[twin.name] = end * _MIRROR if twin.mirrored else end
    soft, by_impulses = steps_not_rigid(world)
    what = twin.what
    what += f"; {soft} steps were left to soft ones" if soft else ""
    what += f"; {by_impulses} steps were made by impulses, with an error of order one" if by_impulses else ""
    return TwinResult(twin.name, what, _spread(own, ends[twin.name]))


def _spread(own: _End, other: _End) -> Spread:
    apart = np.abs(own - other)
    places, speeds = np.hypot(apart[:, 0], apart[:, 1]), np.hypot(apart[:, 3], apart[:, 4])
    return Spread(*(float(column.max(initial=0.0)) for column in (places, apart[:, 2], speeds, apart[:, 5])))


def _summarise(found: Estimate) -> None:
    spreads = {result.name: result.spread for result in found.twins if result.spread is not None}
    if not spreads:
        return
    found.worst = max(spreads, key=lambda name: spreads[name].position)
    names = ("position", "angle", "velocity", "spin")
    found.error = Spread(*(max(getattr(spread, name) for spread in spreads.values()) for name in names))


def _order(
    found: Estimate, scene: World, quarter: Callable[[], _End], own: _End, ends: dict[str, _End]
) -> tuple[float | None, str]:
    """Return the power of the step with which places approach the truth, and how it was found."""
    assert found.error is not None
    error = found.error.position
    if error <= _ROUNDINGS * math.ulp(float(np.abs(own[:, :2]).max(initial=1.0))):
        return None, "the error is that of rounding"
    if found.worst == "nudged":
        return None, "a rounding at the start has grown to this: no step is short enough"
    if scene.plan.integrator.chooses_steps and not scene.event_driven:
        return None, f"{scene.plan.integrator.name} chooses its steps"
    half = ends.get("half step")
    if half is None:
        return None, "half the step fails"
    coarse = _spread(own, half).position
    if coarse < _LIMITED_BY_STEP * error:
        return math.log2(error / (error - coarse)), f'the step matters less than the twin "{found.worst}"'
    end, failure = attempt(quarter)
    if end is None:
        return None, f"a quarter of the step fails: {failure}"
    fine = _spread(half, end).position
    if fine == 0.0:
        return None, "no difference is left between half and a quarter of the step"
    order = math.log2(coarse / fine)
    if abs(order) > scene.plan.integrator.order + _ORDER_MARGIN:
        return None, "halving the step does not change places regularly"
    return order, "from the step, its half and its quarter"
