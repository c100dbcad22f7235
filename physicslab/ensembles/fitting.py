"""Fields of a scene fitted to what was measured, by least squares, with the covariance of their values."""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from physicslab.diagnostics.fits import covariance_of
from physicslab.diagnostics.recorder import record
from physicslab.diagnostics.samples import Record, unit_of
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.quantity_text import InvalidText
from physicslab.ensembles.runs import check_condition
from physicslab.ensembles.space import number_of
from physicslab.files.assignments import put
from physicslab.files.checks import SceneError, shown
from physicslab.files.places import Place, entity_names, find_place
from physicslab.files.replace import reason_of
from physicslab.files.scene import load_scene
from physicslab.files.writer import write_scene
from physicslab.state.masses import Diverged
from physicslab.state.run import library
from physicslab.world import World

type Numbers = NDArray[np.float64]
"""A float64 array (n,)."""

_STEP = 1e-6
"""Share of a field by which it is moved to find derivatives, to both sides."""
_ENDLESS = 1e100
"""How many times the size of a field a bound may be: SciPy computes with squares of what is left to it."""


@dataclass(frozen=True)
class FieldFit:
    """Fields of a scene that were fitted to data.

    Attributes
    ----------
    values, errors : dicts of str to float
        Each field and its standard error [SI]; infinite where the data leave it open, as with no more
        numbers than fields.
    covariance : float64 array (fields, fields)
        That of the values, in the order of ``values``; it takes what the fit leaves for noise that is
        independent from sample to sample and alike in all columns.
    rest : float
        Root of the mean square of what the fit leaves.
    runs : int
        How many runs of the scene it took.
    model : dict of str to float64 array (n,)
        The columns of the data as the fitted scene has them.
    """

    values: dict[str, float]
    errors: dict[str, float]
    covariance: NDArray[np.float64]
    rest: float
    runs: int
    model: dict[str, Numbers]


def fit(
    scene: Any, start: Mapping[str, float | str], data: str | os.PathLike[str] | Mapping[str, ArrayLike], *,
    seconds: float | None = None, until: str | None = None,
) -> FieldFit:  # fmt: skip
    """Find the values of fields with which a scene moves as was measured (SciPy; extra ``analysis``).

    Parameters
    ----------
    scene : str, path, dict or World
        The scene of the measurement.
    start : mapping of str to float or str
        The fields that are found (``pendulum.Rod.length``), and where the search begins: in SI or as texts
        with units. Their values stay in the range that each field has.
    data : path or mapping of str to array
        A CSV file with a head, or its columns: ``time`` [s] after the start, ascending, and quantities in SI
        as ``ball.x``. A value that is NaN or empty was not measured.
    until : str, optional
        A condition, as of :meth:`World.record`: the rows of the data are then the moments at which it begins
        to hold after the start, one after the other; and ``time`` is measured as all else is, by a stopwatch
        or a light gate.
    seconds : float, optional
        With ``until``: within which time all of them are.

    Raises
    ------
    ImportError
        If SciPy is not installed.
    SceneError
        If a field or a column is unknown, there are fewer numbers than fields, or the scene cannot be run.

    Examples
    --------
    >>> seen = {"time": [0.2, 0.4, 0.6], "ball.y": [3.8038, 3.2152, 2.2342]}  # rounded to 0.1 mm
    >>> found = fit("drop", {"physics.gravity.y": -9.0}, seen)  # doctest: +SKIP
    >>> round(found.values["physics.gravity.y"], 3)  # doctest: +SKIP
    -9.81
    >>> gate, start = {"time": [0.4515]}, {"physics.gravity.y": -9.0}  # when it has fallen by a metre
    >>> found = fit("drop", start, gate, until="ball.y <= 3", seconds=2)  # doctest: +SKIP
    >>> round(found.values["physics.gravity.y"], 2)  # doctest: +SKIP
    -9.81
    """
    library("scipy", "fit")
    from scipy.optimize import least_squares

    world = scene if isinstance(scene, World) else load_scene(scene)
    if (until is None) != (seconds is None):
        raise SceneError("until, seconds: must be given together: without them the times of the data hold")
    if until is not None:
        check_condition(load_scene(write_scene(world)), until)
    model = _Model(world, start, _columns(data, until), until, seconds)
    first = model.start / model.scale
    low, high = model.bounds
    found = least_squares(
        model.rests, np.clip(first, low, high), bounds=(low, high), jac="3-point", diff_step=_STEP,
        xtol=1e-12, ftol=1e-12, gtol=1e-12,
    )  # fmt: skip
    covariance = covariance_of(found.jac, found.fun) * np.outer(model.scale, model.scale)
    unfixed = _unfixed(found.jac)
    covariance[unfixed, unfixed] = math.inf
    if len(found.fun) == len(found.x):  # nothing is left that could tell the noise
        covariance[:] = math.inf
    values = found.x * model.scale
    return FieldFit(
        dict(zip(model.places, values.tolist(), strict=True)),
        dict(zip(model.places, np.sqrt(np.diag(covariance)).tolist(), strict=True)),
        covariance, math.sqrt(float(np.mean(found.fun**2))), model.runs, model.columns_of(found.x),
    )  # fmt: skip


def _unfixed(jacobian: Numbers) -> NDArray[np.bool_]:
    """Return which fields (n,) the data leave open, alone or together with others, by derivatives (m, n)."""
    _, sizes, directions = np.linalg.svd(jacobian)
    kept = int((sizes > max(jacobian.shape) * _STEP**2 * sizes[0]).sum())
    return (np.abs(directions[kept:]) > _STEP).any(axis=0)


class _Model:
    """Runs of a scene beside data, by values of fields in units of their own size."""

    def __init__(
        self, world: World, start: Mapping[str, float | str], data: dict[str, Numbers], until: str | None,
        seconds: float | None,
    ) -> None:  # fmt: skip
        self._scene, names = write_scene(world), entity_names(world)
        if not isinstance(start, Mapping) or not start:
            raise SceneError(
                f"start {shown(start)}: must be a dict of fields, at least one, and their values"
            )
        self.places = {path: find_place(world, "start", path, str(start[path]), names) for path in start}
        self.start = np.array([_number(self.places[path], start[path]) for path in start])
        self.scale = np.array([abs(value) or 1.0 for value in self.start.tolist()])
        self._until, self._seconds = until, seconds
        self._times = data["time"].tolist() if until is None else []
        self._rows = len(next(iter(data.values())))
        self._data = {name: column for name, column in data.items() if until or name != "time"}
        self.runs = 0
        try:
            self.run(self.start)
        except InvalidText as error:
            raise SceneError(f"data: column {error}") from error
        self._there = {name: np.isfinite(column) for name, column in self._data.items()}
        count = sum(int(there.sum()) for there in self._there.values())
        if count < len(self.places):
            raise SceneError(f"data: has {count} numbers for {len(self.places)} fields; must have as many")

    @property
    def bounds(self) -> tuple[Numbers, Numbers]:
        """The ranges of the fields, in units of their size."""
        limits = [
            (place.spec.lowest, place.spec.highest) if place.spec.kind == "number" else (-math.inf, math.inf)
            for place in self.places.values()
        ]
        with np.errstate(over="ignore"):  # the largest number, in units of what is small
            low, high = np.array(limits).T / self.scale
        return np.where(low < -_ENDLESS, -math.inf, low), np.where(high > _ENDLESS, math.inf, high)

    def run(self, values: Numbers) -> dict[str, Numbers]:
        """Run the scene with these values [SI]; return the columns of the data."""
        world = load_scene(self._scene)
        words = ", ".join(f"{path} = {value:g}" for path, value in zip(self.places, values, strict=True))
        try:
            put(world, dict(zip(self.places.values(), values.tolist(), strict=True)))
            seen = Record(world, (name for name in self._data if name != "time"))
            for _ in self._moments(world):
                seen.add()
        except (Diverged, InvalidValue) as error:
            raise SceneError(f"the run of {words}: {error}") from error
        self.runs += 1
        columns = {"time": seen.times, **seen.columns}
        return {name: np.array(columns[name]) for name in self._data}

    def _moments(self, world: World) -> Iterator[None]:
        """Advance a world from one moment of the data to the next."""
        for moment in self._times:
            if moment > world.time:
                world.run(seconds=moment - world.time)
            yield
        if self._until is None or self._seconds is None:
            return
        for row in range(self._rows):
            found = record(world, self._seconds - world.time, None, self._until, again=True).found
            if found is None:
                begun = f"begins to hold {row} times" if row else "does not begin to hold"
                raise SceneError(f"until {shown(self._until)}: {begun} within {self._seconds:g} s")
            yield

    def columns_of(self, values: Numbers) -> dict[str, Numbers]:
        return self.run(values * self.scale)

    def rests(self, values: Numbers) -> Numbers:
        """Return what the scene leaves of the data (n,)."""
        found = self.columns_of(values)
        return np.concatenate([
            found[name][there] - self._data[name][there] for name, there in self._there.items()
        ])  # fmt: skip


def _number(place: Place, value: float | str) -> float:
    if place.spec.kind != "number" and not place.part:
        raise SceneError(f"{place.words}: must be a number, or a part of a vector")
    return number_of(place, value)


def _columns(data: str | os.PathLike[str] | Mapping[str, ArrayLike], until: str | None) -> dict[str, Numbers]:
    """Return the columns of data, all as long, with times that ascend."""
    if not isinstance(data, str | os.PathLike | Mapping):
        raise SceneError(f"data {shown(data)}: must be the path of a CSV file, or a dict of columns")
    named = data if isinstance(data, Mapping) else _read(Path(data))
    columns = {name: _numbers(name, column) for name, column in named.items()}
    if until is not None and not columns:
        raise SceneError("data: must have a column of a quantity, as time or ball.x")
    if until is None and ("time" not in columns or len(columns) < 2):
        raise SceneError("data: must have a column time [s], and at least one of a quantity, as ball.x")
    if len({column.shape for column in columns.values()}) > 1 or next(iter(columns.values())).ndim != 1:
        raise SceneError("data: all columns must have as many numbers")
    if until is not None:
        return columns
    times = columns["time"]
    if not (len(times) and np.isfinite(times).all() and times[0] >= 0.0 and (np.diff(times) > 0.0).all()):
        raise SceneError("data: time must begin at 0 s or later and ascend")
    return columns


def _numbers(name: str, column: ArrayLike) -> Numbers:
    try:
        return np.asarray(column, np.float64)
    except (TypeError, ValueError):
        raise SceneError(f"data: column {shown(name)}: must be numbers, in SI") from None


def _read(path: Path) -> dict[str, list[float]]:
    """Return the columns of a CSV file by its head."""
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            head, *rows = csv.reader(file)
    except (OSError, ValueError, csv.Error) as error:
        raise SceneError(f"data {path}: cannot be read: {reason_of(error)}") from error
    found: dict[str, list[float]] = {_quantity(path, name): [] for name in head}
    for number, row in enumerate(rows, 2):
        if len(row) != len(head):
            raise SceneError(f"data {path}: line {number}: has {len(row)} cells; must have {len(head)}")
        for column, cell in zip(found.values(), row, strict=True):
            column.append(_cell(path, number, cell))
    return found


def _quantity(path: Path, heading: str) -> str:
    """Return the quantity of a column, without the unit that ``Run.save`` writes behind it."""
    name, unit = heading.strip().removeprefix("'"), ""
    if name.endswith("]"):
        name, _, unit = name.rpartition(" [")
    try:
        usual = "s" if name == "time" else unit_of(name)
    except KeyError:  # what is no quantity is refused later, with the names that there are
        return heading.strip()
    if unit and unit != f"{usual}]":
        raise SceneError(f"data {path}: column {shown(heading)}: must be in {usual}")
    return name


def _cell(path: Path, number: int, cell: str) -> float:
    try:
        return float(cell) if cell.strip() else math.nan
    except ValueError:
        raise SceneError(f"data {path}: line {number}: {shown(cell)} must be a number") from None
