"""How far apart variants of a scene end: an estimate of its error, and of its order in the step."""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray

from physicslab.files.writer import write_scene
from physicslab.lab.accuracy.paths import Path, differences, run_path
from physicslab.lab.accuracy.variants import VARIANTS, Document, Variant, refined, with_ids
from physicslab.lab.case import attempt
from physicslab.lab.jobs import Job
from physicslab.lab.worlds import steps_not_rigid
from physicslab.world import World

_LIMITED_BY_STEP = 0.25
"""Share of the estimate that halving the step must explain for the step to be what limits the results."""
_ORDER_MARGIN = 2.0
"""An observed order that is further from none than the method's own and this is chance."""
_RUNS_AT_LEAST = 3.0
"""How many times as long as the scene itself all other ways to compute it may take, whatever the budget."""
_ROUNDINGS = 1e3
"""A spread of fewer roundings than this has no order."""


@dataclass(frozen=True, slots=True)
class Departure:
    """The largest difference of any body between two runs.

    Attributes
    ----------
    position, angle, velocity, spin : float
        Errors of places [m], angles [rad], velocities [m/s] and angular velocities [rad/s].
    """

    position: float
    angle: float
    velocity: float
    spin: float


@dataclass(frozen=True, slots=True)
class VariantResult:
    """A variant, how it differs from the scene, and how far apart both end.

    Attributes
    ----------
    name, what : str
        The variant.
    spread : Departure, optional
        ``None`` where it failed.
    failure : str
        Why.
    """

    name: str
    what: str
    spread: Departure | None
    failure: str = ""


@dataclass(slots=True)
class Estimate:
    """The estimate of the error of a scene, run as it is configured.

    Attributes
    ----------
    error : Departure, optional
        The largest spread of any variant; ``None`` where the scene or all of its variants fail.
    worst : str
        The variant that is furthest off in place.
    order : float, optional
        The power of the step with which the error falls; ``None`` where it has none.
    order_reason : str
        How the order was found, or why there is none.
    variants : list of VariantResult
        All that the scene has.
    failure : str
        Why the scene itself could not be run.
    reference : array of floats, optional
        Where bodies end [m] with rigid contacts (n, 2), if contacts are soft and no step was left to these.
    bodies : list of str
        The bodies that can move.
    path : Path, optional
        That of the scene itself.
    paths : dict of str to Path
        That of each variant that could be run, by its name; of a mirrored one mirrored back.
    document : Document
        The scene, with ids.
    own_s, left_s : float
        How long the scene itself took, and how much is left for what else is compared [s].
    """

    error: Departure | None = None
    worst: str = ""
    order: float | None = None
    order_reason: str = ""
    variants: list[VariantResult] = field(default_factory=list)
    failure: str = ""
    reference: NDArray[np.float64] | None = None
    bodies: list[str] = field(default_factory=list)
    path: Path | None = None
    paths: dict[str, Path] = field(default_factory=dict)
    document: Document = field(default_factory=dict)
    own_s: float = 0.0
    left_s: float = math.inf

    def spread_of(self, name: str) -> Departure | None:
        """Return how far a variant is off, where there is one that did not fail."""
        return next((variant.spread for variant in self.variants if variant.name == name), None)


def estimate_error(
    load: Callable[[], World], seconds: float, moments: Sequence[float] = (), budget_s: float = math.inf,
    variants: Sequence[Variant] = VARIANTS,
) -> Job[Estimate]:  # fmt: skip
    """Run a scene and its variants; yield the share of the work that is done.

    Parameters
    ----------
    load : callable
        Returns the scene's world, a new one each time.
    seconds : float
        How long it is run [s].
    moments : sequence of floats
        When paths are looked at before the end, after the start [s], in order.
    budget_s : float
        After how much time [s] variants are given up that are not done, compiling left out.
    variants : sequence of Variant
        In which other ways it is computed.
    """
    scene, found = load(), Estimate()
    document = found.document = with_ids(write_scene(scene))
    scene.synchronise()
    found.bodies = [entity["id"] for entity in document["entities"] if "Velocity" in entity]
    looked = (*moments, seconds)

    def run(world: World, budget_s: float = math.inf) -> Path:
        return run_path(world, found.bodies, looked, budget_s)

    began, world = time.perf_counter(), load()
    found.path, found.failure = attempt(partial(run, world))
    found.own_s = time.perf_counter() - began - world.compile_s
    if found.path is None:
        return found
    left = max(budget_s, _RUNS_AT_LEAST * found.own_s)
    soft = not _flies(scene) or _something_rests(load(), seconds)
    for i, variant in enumerate(variants):
        other = variant.make(document, scene) if soft or variant.name != "rigid" else None
        if other is not None:
            began = time.perf_counter()
            found.variants.append(
                _compared(variant, other, partial(run, budget_s=min(left, variant.budget_s)), found)
            )
            left = max(0.0, left - (time.perf_counter() - began - other.compile_s))
            if variant.name == "rigid" and variant.name in found.paths and not any(steps_not_rigid(other)):
                found.reference = found.paths[variant.name].places[-1]
        yield (i + 1) / (len(variants) + 1)
    found.left_s = left
    _summarise(found)
    return found


def find_order(found: Estimate, load: Callable[[], World], seconds: float) -> None:
    """Write into an estimate the power of the step with which its error falls, and how that was found."""
    if found.error is not None:
        scene = load()
        scene.synchronise()
        world = refined(found.document, scene, 4.0)
        quarter = partial(run_path, world, found.bodies, (seconds,))
        found.order, found.order_reason = _order(found, scene, quarter)


def _something_rests(world: World, seconds: float) -> bool:
    """Whether a body ever rests on another: where impacts are located, only such ones move softly."""
    return any(part.contacts.active for _ in world.stepping(seconds=seconds) for part in world.parts)


def _flies(world: World) -> bool:
    """Whether all impacts are located between flights in closed form."""
    return all(part.event_driven for part in world.parts)


def _compared(variant: Variant, world: World, run: Callable[[World], Path], found: Estimate) -> VariantResult:
    """Run a variant, and keep its path."""
    assert found.path is not None
    path, failure = attempt(partial(run, world))
    if path is None:
        return VariantResult(variant.name, variant.what, None, failure)
    found.paths[variant.name] = path = path.mirrored() if variant.mirrored else path
    soft, by_impulses = steps_not_rigid(world)
    what = variant.what
    what += f"; {soft} steps were left to soft ones" if soft else ""
    what += f"; {by_impulses} steps were made by impulses, with an error of order one" if by_impulses else ""
    return VariantResult(variant.name, what, _spread(found.path.end, path.end))


def _spread(own: NDArray[np.float64], other: NDArray[np.float64]) -> Departure:
    position, velocity, angle, spin = (float(apart.max(initial=0.0)) for apart in differences(own, other))
    return Departure(position, angle, velocity, spin)


def _summarise(found: Estimate) -> None:
    spreads = {result.name: result.spread for result in found.variants if result.spread is not None}
    if not spreads:
        return
    found.worst = max(spreads, key=lambda name: spreads[name].position)
    names = ("position", "angle", "velocity", "spin")
    found.error = Departure(*(max(getattr(spread, name) for spread in spreads.values()) for name in names))


def _order(found: Estimate, scene: World, quarter: Callable[[], Path]) -> tuple[float | None, str]:
    """Return the power of the step with which places approach the truth, and how it was found."""
    assert found.error is not None and found.path is not None
    error, own = found.error.position, found.path.end
    if error <= _ROUNDINGS * math.ulp(float(np.abs(own[:, :2]).max(initial=1.0))):
        return None, "the error is that of rounding"
    if found.worst == "nudged":
        return None, "a rounding at the start has grown to this: no step is short enough"
    methods = [plan.integrator for plan in scene.plans]
    if all(method.chooses_steps for method in methods) and not _flies(scene):
        return None, f"{methods[0].name} chooses its steps"
    half_path = found.paths.get("half step")
    if half_path is None:
        return None, "half the step fails"
    half = half_path.end
    coarse = _spread(own, half).position
    if coarse < _LIMITED_BY_STEP * error:
        return math.log2(error / (error - coarse)), f'the step matters less than the variant "{found.worst}"'
    path, failure = attempt(quarter)
    if path is None:
        return None, f"a quarter of the step fails: {failure}"
    fine = _spread(half, path.end).position
    if min(coarse, fine) == 0.0:
        return None, "no difference is left between half and a quarter of the step"
    order = math.log2(coarse / fine)
    if abs(order) > max(method.order for method in methods) + _ORDER_MARGIN:
        return None, "halving the step does not change places regularly"
    return order, "from the step, its half and its quarter"
