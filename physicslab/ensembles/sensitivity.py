"""Dependence of measures on fields: derivatives, and the shares of a variance that fields explain."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.ensembles.measures import Measure
from physicslab.ensembles.result import EnsembleResult
from physicslab.ensembles.runs import ensemble, task_of
from physicslab.ensembles.space import number_of
from physicslab.files.checks import SceneError, shown
from physicslab.files.places import Place, entity_names, find_place
from physicslab.files.scene import load_scene
from physicslab.state.run import library
from physicslab.world import World

_STEP = 1e-3
"""Share of a field by which it is moved to each side: with the error of order 4 below, rounding and what is
left out are both some 1e-12 of a measure whose higher derivatives are like the first."""
_ROUNDING = 1e-12
"""Share of a measure by which it may differ from run to run and still depend on nothing."""


@dataclass(frozen=True, slots=True)
class Derivative:
    """How fast a measure changes with a field.

    Attributes
    ----------
    value, error : float
        The derivative [SI], and what a halved step changes of it: far more than its error where the measure
        is smooth, and like the value itself where it is not, as where an impact comes or goes.
    """

    value: float
    error: float


@dataclass(frozen=True, slots=True)
class SobolIndices:
    """Shares of a measure's variance.

    Attributes
    ----------
    first : dict of str to float
        Share that each field explains by itself.
    total : dict of str to float
        Share that it explains together with all others: 0 where the measure does not depend on it.
    first_error, total_error : dicts of str to float
        Half the width of the interval in which each is with 95 % confidence.
    """

    first: dict[str, float]
    total: dict[str, float]
    first_error: dict[str, float]
    total_error: dict[str, float]


def sensitivity(
    scene: Any, fields: str | Sequence[str] | Mapping[str, float | str], *,
    measure: Measure | Mapping[str, Measure], seconds: float | None = None, steps: int | None = None,
    until: str | None = None, executor: Any = "serial",
) -> dict[str, dict[str, Derivative]]:  # fmt: skip
    """Return the derivative of each measure by each field, of the scene as it is.

    By central differences of runs of the same bits, with two steps, which leaves an error of order 4. At the
    end of a field's range they are to one side, of order 3.

    Parameters
    ----------
    scene : str, path, dict or World
        The scene to run.
    fields : str, sequence of str, or mapping of str to float or str
        The fields, or the step of each, in SI or as a text with its unit; else it is a thousandth of the
        field, or 1e-3 where that is 0.
    measure, seconds, steps, until, executor
        As for :func:`~physicslab.ensemble`.

    Raises
    ------
    SceneError
        If a field is no number, or a run fails.

    Examples
    --------
    >>> found = sensitivity("drop", ["physics.gravity.y"], measure="ball.y", seconds=0.5)
    >>> round(found["ball.y"]["physics.gravity.y"].value, 10)  # t^2 / 2
    0.125
    """
    world = scene if isinstance(scene, World) else load_scene(scene)
    names, fields = entity_names(world), [fields] if isinstance(fields, str) else fields
    if not fields:
        raise SceneError("fields: must name at least one field")
    places = {path: find_place(world, "fields", path, "", names) for path in fields}
    middle = {}
    for path, place in places.items():
        held = place.value(world)
        if place.spec.kind not in ("number", "vector") or not isinstance(held, int | float):
            raise SceneError(f"{place.words}: must be a number: derivatives are by numbers")
        middle[path] = float(held)
    widths = {path: _STEP * (abs(value) or 1.0) for path, value in middle.items()}
    if isinstance(fields, Mapping):
        widths = {path: _width(places[path], width) for path, width in fields.items()}
    sides = {path: _side(places[path], value, widths[path]) for path, value in middle.items()}
    rows = {path: np.full(4 * len(places), value) for path, value in middle.items()}
    for k, (path, side) in enumerate(sides.items()):
        moves = np.array([0.0, 0.25, 0.5, 1.0]) * side if side else np.array([0.5, -0.5, 1.0, -1.0])
        rows[path][4 * k : 4 * k + 4] += moves * widths[path]
    result = ensemble(
        world, {path: ("rows", values) for path, values in rows.items()}, measure=measure, seconds=seconds,
        steps=steps, until=until, executor=executor,
    )  # fmt: skip
    _whole(result)
    found: dict[str, dict[str, Derivative]] = {}
    for name in result.task.measures:
        seen = result.columns[name].reshape(-1, 4)
        found[name] = {
            path: _derivative(rows[path][4 * k : 4 * k + 4], seen[k], sides[path])
            for k, path in enumerate(rows)
        }
    return found


def _side(place: Place, value: float, width: float) -> float:
    """Return to which side a field can be moved, as 1 or -1; 0 if to both."""
    if place.spec.kind != "number":
        return 0.0
    return float(value - width < place.spec.lowest) - float(value + width > place.spec.highest)


def _derivative(at: NDArray[np.float64], seen: NDArray[np.float64], side: float) -> Derivative:
    """Return the derivative by values (4,) of a measure ``at`` those of a field, by two steps of order 2."""
    if side:
        half = float((4.0 * seen[1] - 3.0 * seen[0] - seen[2]) / (at[2] - at[0]))
        full = float((4.0 * seen[2] - 3.0 * seen[0] - seen[3]) / (at[3] - at[0]))
    else:
        half = float((seen[0] - seen[1]) / (at[0] - at[1]))
        full = float((seen[2] - seen[3]) / (at[2] - at[3]))
    value = half + (half - full) / 3.0
    return Derivative(value, abs(value - half))


def _width(place: Place, given: float | str) -> float:
    width = number_of(place, given)
    if width <= 0.0:
        raise SceneError(f"{place.words} = {shown(given)}: a step must be > 0")
    return width


def sobol_indices(
    scene: Any, space: Mapping[str, tuple[str, float, float]], *, measure: Measure | Mapping[str, Measure],
    seconds: float | None = None, steps: int | None = None, until: str | None = None, samples: int = 256,
    seed: int = 0, executor: Any = "processes", workers: int | None = None,
) -> dict[str, SobolIndices]:  # fmt: skip
    """Return which fields explain how much of the variance of each measure (SALib; extra ``analysis``).

    Parameters
    ----------
    space : mapping of str to tuple
        Fields, each ``("uniform", a, b)`` or ``("normal", mean, deviation)``.
    samples : int
        A power of two; ``samples`` times the number of fields plus 2 runs are made.
    scene, measure, seconds, steps, until, executor, workers
        As for :func:`~physicslab.ensemble`.

    Raises
    ------
    ImportError
        If SALib is not installed.
    SceneError
        If a field is drawn otherwise, or a run fails: indices need all of them.
    """
    library("SALib", "sobol_indices")
    from SALib.analyze import sobol as analyse
    from SALib.sample import sobol as sample

    if samples < 2 or samples & (samples - 1):
        raise SceneError(f"samples = {samples}: must be a power of two")
    if not space:
        raise SceneError("space: must name at least one field")
    laws = {path: law[0] if isinstance(law, tuple) and law else None for path, law in space.items()}
    for path, law in laws.items():
        if law not in ("uniform", "normal"):
            words = 'must be ("uniform", a, b) or ("normal", mean, deviation)'
            raise SceneError(f"space: {path} = {shown(space[path])}: {words}")
    task = task_of(  # is checked
        scene, space, measure=measure, seconds=seconds, steps=steps, until=until, samples=1
    )
    problem = {
        "num_vars": len(space),
        "names": [*space],
        "bounds": [axis.values.tolist() for axis in task.space.axes],
        "dists": ["unif" if law == "uniform" else "norm" for law in laws.values()],
    }
    drawn: NDArray[np.float64] = sample.sample(problem, samples, calc_second_order=False, seed=seed)
    result = ensemble(
        scene, {path: ("rows", drawn[:, k]) for k, path in enumerate(space)}, measure=measure,
        seconds=seconds, steps=steps, until=until, executor=executor, workers=workers,
    )  # fmt: skip
    _whole(result)
    return {name: _indices(analyse, problem, result.columns[name], seed) for name in result.task.measures}


def _indices(analyse: Any, problem: dict[str, Any], column: NDArray[np.float64], seed: int) -> SobolIndices:
    names = problem["names"]
    if np.ptp(column) <= _ROUNDING * np.abs(column).max():  # a variance of rounding has no shares
        none = dict.fromkeys(names, 0.0)
        return SobolIndices(none, none, none, none)
    found = analyse.analyze(problem, column, calc_second_order=False, seed=seed)
    parts = (
        dict(zip(names, map(float, found[key]), strict=True)) for key in ("S1", "ST", "S1_conf", "ST_conf")
    )
    return SobolIndices(*parts)


def _whole(result: EnsembleResult) -> None:
    """Refuse results in which a run has none."""
    for row, why in result.failures.items():
        values = ", ".join(
            f"{axis.name} = {result.columns[axis.name][row]:g}" for axis in result.task.space.axes
        )
        raise SceneError(f"the run of {values}: {why}")
