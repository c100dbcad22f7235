"""The results of an ensemble: columns, failures, and each row as a world again."""

from __future__ import annotations

import csv
import importlib.util
import io
import json
import math
from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.text import table_cell
from physicslab.ensembles.map_picture import map_picture
from physicslab.ensembles.measures import Measures
from physicslab.ensembles.space import Values
from physicslab.ensembles.task import Task, places_of
from physicslab.files.checks import SceneError, shown
from physicslab.files.replace import replacing
from physicslab.files.scene import load_scene
from physicslab.state.run import library
from physicslab.world import World

FORMATS = (".npz", ".csv", ".parquet")


@dataclass(frozen=True, repr=False)
class EnsembleResult:
    """A row for each run.

    Attributes
    ----------
    columns : dict of str to array (rows,)
        The varied fields, the measures [SI], how long each run took (``wall_s`` [s]) and why it has no
        result (``failure``, empty where it has one).
    failures : dict of int to str
        The rows that have none, or not all of it, and why.
    task : Task
        The task that was run.
    found : int
        How many rows were there already, in the file or in parts of it.
    """

    columns: dict[str, Values]
    failures: dict[int, str]
    task: Task
    found: int = 0

    def __repr__(self) -> str:
        names = ", ".join(self.columns)
        return (
            f"<EnsembleResult: {len(self):,} runs, {len(self.failures):,} with a failure; columns: {names}>"
        )

    def __len__(self) -> int:
        return len(self.task.space)

    def world(self, row: int) -> World:
        """Return the world of a row before its first step.

        Raises
        ------
        IndexError
            If there is no such row.
        SceneError
            If the row's values make no scene.
        """
        if not 0 <= row < len(self):
            raise IndexError(f"row {row}: must be from 0 to {len(self) - 1}")
        return self.task.world(row)

    @cached_property
    def units(self) -> dict[str, str]:
        """The SI unit of each varied field and of each measure that has one."""
        world = load_scene(json.loads(self.task.scene))
        fields = {name: place.spec.unit for name, place in places_of(world, self.task.space).items()}
        return {**fields, **Measures(world, self.task.measures).units}

    def spread(self) -> dict[str, dict[str, float]]:
        """Return how each measure is spread over the runs that have it.

        Returns
        -------
        dict of str to dict
            ``count``, ``mean``, ``deviation`` (of a sample), ``least``, ``low`` (5 % are below it),
            ``median``, ``high`` (5 % are above it) and ``greatest`` of each measure; those of none are NaN.
        """
        return {name: _spread(self.columns[name]) for name in self.task.measures}

    def map(self, measure: str | None = None) -> bytes:
        """Return a PNG of a measure, the first if none is named, over the two lists of a space."""
        measures = list(self.task.measures)
        name = measures[0] if measure is None else measure
        if name not in measures:
            raise SceneError(f"measure {shown(name)}: must be one of {', '.join(measures)}")
        return map_picture(self.task.space, name, self.columns[name], self.units)

    def to_pandas(self) -> Any:
        """Return a ``pandas.DataFrame`` of the columns."""
        return library("pandas", "to_pandas").DataFrame(self.columns)

    def to_xarray(self) -> Any:
        """Return an ``xarray.Dataset`` with a dimension for each grid, for samples and for replicas."""
        xarray, space = library("xarray", "to_xarray"), self.task.space
        grids = {axis.name: axis.values for axis in space.axes if axis.law == "grid" and not axis.jitter}
        names = [axis.name for axis in space.axes if axis.law == "grid"] + ["sample", "replica"]
        shape = space.shape
        kept = [n for n, name in enumerate(names) if name in grids or shape[n] > 1]
        dims = [names[n] for n in kept]
        columns = {
            name: (dims, column.reshape([shape[n] for n in kept]))
            for name, column in self.columns.items()
            if name not in dims
        }
        return xarray.Dataset(columns, coords=grids)


def _spread(column: Values) -> dict[str, float]:
    there = column[np.isfinite(column)]
    if not len(there):
        names = ("mean", "deviation", "least", "low", "median", "high", "greatest")
        return {"count": 0, **dict.fromkeys(names, math.nan)}
    low, median, high = np.quantile(there, (0.05, 0.5, 0.95)).tolist()
    scale = float(np.abs(there).max()) or 1.0  # squares of large numbers are not finite
    deviation = scale * float((there / scale).std(ddof=1)) if len(there) > 1 else math.nan
    return {
        "count": len(there), "mean": float(there.mean()), "deviation": deviation, "least": float(there.min()),
        "low": low, "median": median, "high": high, "greatest": float(there.max()),
    }  # fmt: skip


def write_result(path: Path, columns: Mapping[str, Values], failures: Mapping[int, str]) -> None:
    """Write columns to a file whole, as its ending says.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    with replacing(path) as fresh, open(fresh, "wb") as file:
        if path.suffix == ".npz":
            reasons = ["", *dict.fromkeys(failures.values())]
            codes = np.zeros(len(columns["failure"]), np.int64)
            codes[list(failures)] = [reasons.index(why) for why in failures.values()]
            plain = {
                name: column if column.dtype != object else column.astype(str)
                for name, column in columns.items()
                if name != "failure"
            }
            np.savez(file, **{**plain, "failure": codes, "failures": np.array(reasons)})  # type: ignore[arg-type]
        elif path.suffix == ".csv":
            text = io.TextIOWrapper(file, encoding="utf-8", newline="")
            rows = csv.writer(text, lineterminator="\n")
            rows.writerow(map(table_cell, columns))
            cells = [
                column.tolist() if column.dtype != object else map(table_cell, column)
                for column in columns.values()
            ]
            rows.writerows(zip(*cells, strict=True))
            text.flush()
            text.detach()
        else:
            arrow, parquet = (library(name, ".parquet") for name in ("pyarrow", "pyarrow.parquet"))
            parquet.write_table(arrow.table(dict(columns)), file)


def read_result(path: Path, names: Sequence[str]) -> tuple[list[NDArray[np.float64]], dict[int, str]]:
    """Return columns of numbers (rows,) of a file that :func:`write_result` wrote, and the failures."""
    if path.suffix == ".npz":
        with np.load(path, allow_pickle=False) as kept:
            codes, reasons = kept["failure"], kept["failures"].tolist()
            failures = {row: reasons[codes[row]] for row in np.flatnonzero(codes).tolist()}
            return [kept[name] for name in names], failures
    if path.suffix == ".csv":
        numbers = array("d")
        with open(path, newline="", encoding="utf-8") as file:
            rows = csv.reader(file)
            head = next(rows)
            wanted, last = [head.index(table_cell(name)) for name in names], head.index("failure")
            failures = {}
            for number, row in enumerate(rows):
                numbers.extend(float(row[place]) for place in wanted)
                if row[last]:
                    failures[number] = row[last]
        return list(np.array(numbers).reshape(-1, len(names)).T), failures
    table = library("pyarrow.parquet", ".parquet").read_table(path)
    failures = {row: why for row, why in enumerate(table["failure"].to_pylist()) if why}
    return [table[name].to_numpy() for name in names], failures


def check_format(path: Path) -> None:
    """Refuse a file of which the ending names no format that can be written."""
    if path.suffix not in FORMATS:
        raise SceneError(f"out {path}: must end in {', '.join(FORMATS)}")
    if path.suffix == ".parquet" and importlib.util.find_spec("pyarrow") is None:
        raise SceneError(f"out {path}: needs pyarrow, which is not installed: pip install pyarrow")
