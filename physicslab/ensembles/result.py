"""The results of an ensemble: columns, failures, and each row as a world again."""

from __future__ import annotations

import csv
import importlib
import importlib.util
import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from physicslab.ecs.text import table_cell
from physicslab.ensembles.space import Values
from physicslab.ensembles.task import Task
from physicslab.files.checks import SceneError
from physicslab.files.replace import replacing
from physicslab.world import World

FORMATS = (".npz", ".csv", ".parquet")


@dataclass(frozen=True)
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
        What was run.
    """

    columns: dict[str, Values] = field(repr=False)
    failures: dict[int, str]
    task: Task = field(repr=False)

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

    def to_pandas(self) -> Any:
        """Return a ``pandas.DataFrame`` of the columns."""
        return _package("pandas", "to_pandas").DataFrame(self.columns)

    def to_xarray(self) -> Any:
        """Return an ``xarray.Dataset`` with a dimension for each grid, for samples and for replicas."""
        xarray, space = _package("xarray", "to_xarray"), self.task.space
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


def _package(name: str, method: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"{method}: needs {name}, which is not installed") from error


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
            rows.writerow(columns)
            cells = [
                column.tolist() if column.dtype != object else map(table_cell, column)
                for column in columns.values()
            ]
            rows.writerows(zip(*cells, strict=True))
            text.flush()
            text.detach()
        else:
            arrow, parquet = (_package(name, ".parquet") for name in ("pyarrow", "pyarrow.parquet"))
            parquet.write_table(arrow.table(dict(columns)), file)


def check_format(path: Path) -> None:
    """Refuse a file of which the ending names no format that can be written."""
    if path.suffix not in FORMATS:
        raise SceneError(f"out {path}: must end in {', '.join(FORMATS)}")
    if path.suffix == ".parquet" and importlib.util.find_spec("pyarrow") is None:
        raise SceneError(f"out {path}: needs pyarrow, which is not installed: pip install pyarrow")
