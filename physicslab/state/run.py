"""Recorded runs: the motion of a world as columns of numbers, for any library of tables."""

import csv
import importlib
import io
import os
import sys
from collections.abc import Callable, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.text import no_such, table_cell

type Column = NDArray[np.float64]
"""A float64 array (instants,)."""

BODY_COLUMNS = {"x": "m", "y": "m", "angle": "rad", "vx": "m/s", "vy": "m/s", "omega": "rad/s"}
"""Columns of each body that moves, in the order of samples, and their units."""


class Columns[T](dict[str, T]):
    """Columns by name."""

    def __missing__(self, name: str) -> T:
        raise KeyError(no_such("the table", "column", name, self))


class Replay(Protocol):
    """The object that finds parts of a run which take time, when they are first read."""

    def impacts(self) -> dict[str, NDArray[Any]]:
        """Return the table of impacts, by columns."""

    def account(self) -> dict[str, float]:
        """Return the energy given by each cause [J]."""

    def sums(self, run: "Run") -> Mapping[str, Column]:
        """Return the energies of the world at each instant [J]."""

    def page(self, run: "Run") -> bytes:
        """Return the page that plays the run."""


class Run:
    """The motion of a world while :meth:`World.record` advanced it.

    Parameters
    ----------
    times : float64 array (instants,)
        The clock [s].
    motion : float64 array (instants, bodies, 6)
        x, y [m], the angle [rad], and their rates.
    bodies : tuple of str
        The ids of what moves, or what it is and its number.
    found : float, optional
        When ``until`` was reached [s]; ``None`` where it was not, or there was none.
    replay : Replay
        The object that finds what is first read later.

    Examples
    --------
    >>> from physicslab import load_scene
    >>> run = load_scene("drop").record(seconds=3.0, until="ball.y <= 1 m")
    >>> run
    <Run: 48 instants from 0 s to 0.782062 s, bodies: ball>
    >>> round(float(run.columns["ball.vy"][-1]), 6)
    -7.672027
    """

    def __init__(
        self, times: Column, motion: NDArray[np.float64], bodies: tuple[str, ...], found: float | None,
        replay: Replay,
    ) -> None:  # fmt: skip
        self.times, self.motion, self.bodies, self.found = times, motion, bodies, found
        self._replay = replay

    def __repr__(self) -> str:
        span = f"{len(self.times)} instants from {self.times[0]:g} s to {self.times[-1]:g} s"
        return f"<Run: {span}, bodies: {', '.join(self.bodies[:8])}{', ...' * (len(self.bodies) > 8)}>"

    @cached_property
    def columns(self) -> dict[str, Column]:
        """The time and the motion by name, in SI units: ``time``, ``ball.x``, ``ball.vy`` and so on."""
        found = Columns(time=self.times)
        for number, body in enumerate(self.bodies):
            for k, name in enumerate(BODY_COLUMNS):
                found[f"{body}.{name}"] = self.motion[:, number, k]
        return found

    @cached_property
    def energies(self) -> dict[str, Column]:
        """``world.kinetic``, ``world.potential`` and ``world.energy`` [J].

        They are found when they are first read, which takes some 50 us an instant.
        """
        return Columns(self._replay.sums(self))

    @cached_property
    def impacts(self) -> dict[str, NDArray[Any]]:
        """The impacts as columns (impacts,): ``time``, where, of what and how fast, and ``energy_lost`` [J].

        That is the kinetic energy which each took.
        """
        return self._replay.impacts()

    @cached_property
    def account(self) -> dict[str, float]:
        """Energy given by each cause meanwhile [J]; ``numerical`` is the error of the method."""
        return self._replay.account()

    @property
    def table(self) -> dict[str, Column]:
        """The columns, and the energies behind them: what is saved."""
        return self.columns | self.energies

    @property
    def units(self) -> dict[str, str]:
        """The SI unit of each column and energy."""
        known = BODY_COLUMNS | {"time": "s"}
        return {name: known.get(name.rpartition(".")[2], "J") for name in self.table}

    def to_pandas(self) -> Any:
        """Return a ``DataFrame`` of columns and energies, a row an instant, with ``attrs["units"]``."""
        table = library("pandas", "to_pandas").DataFrame(self.table)
        table.attrs["units"] = self.units
        return table

    def to_xarray(self) -> Any:
        """Return a ``Dataset`` over ``time`` and ``body``, of which each variable has its unit."""
        arrays = {
            name: (("time", "body"), self.motion[:, :, k], {"units": unit})
            for k, (name, unit) in enumerate(BODY_COLUMNS.items())
        }
        whole = {
            name.removeprefix("world."): (("time",), values, {"units": "J"})
            for name, values in self.energies.items()
        }
        places = {"time": ("time", self.times, {"units": "s"}), "body": list(self.bodies)}
        return library("xarray", "to_xarray").Dataset({**arrays, **whole}, places)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write columns and energies to a file, by the end of its name: ``.npz``, ``.csv`` or ``.parquet``.

        Raises
        ------
        ValueError
            If it ends otherwise.
        ImportError
            For Parquet without pyarrow.
        """
        target = Path(path)
        write = _FORMATS.get(target.suffix.lower())
        if write is None:
            allowed = ", ".join(_FORMATS)
            raise ValueError(f"save({os.fspath(path)!r}): the name must end with one of {allowed}")
        content = write(self)
        importlib.import_module("physicslab.files.replace").replace_file(target, content)

    def page(self) -> bytes:
        """Return a page of HTML that plays the run without a network, in UTF-8."""
        return self._replay.page(self)

    @cached_property
    def widget(self) -> Any:
        """The player as a widget of a notebook: ``time`` [s] and ``playing`` follow it and can be set.

        It needs anywidget, which comes with the extra ``notebook``.
        """
        return _notebook().widget(self.page(), float(self.times[0]))

    def _repr_html_(self) -> str:
        """Return the player of the run in a frame, for a notebook that is read."""
        shown: str = _notebook().frame(self.page())
        return shown

    def _repr_mimebundle_(self, **_: object) -> tuple[dict[str, Any], dict[str, Any]]:
        """Return the widget, for a notebook that is worked in; the frame is beside it and in its place."""
        if "ipykernel" not in sys.modules:
            return {}, {}  # a terminal shows neither
        try:
            data, about = self.widget._repr_mimebundle_()
        except ImportError:
            return {}, {}
        return {name: shown for name, shown in data.items() if name != "text/plain"}, about


def _notebook() -> Any:
    """Return what makes players for notebooks, which stands above what measures."""
    return importlib.import_module("physicslab.export.notebook")


def library(name: str, needed_by: str) -> Any:
    """Import a library that is no part of the package."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(
            f"{needed_by} needs {name}, which is not installed: pip install {name.partition('.')[0]}"
        ) from error


def _npz(run: Run) -> bytes:
    stream, columns = io.BytesIO(), run.table
    np.savez(stream, allow_pickle=False, **columns)
    return stream.getvalue()


def _csv(run: Run) -> bytes:
    """Return rows with a heading; numbers keep every bit."""
    stream, units = io.StringIO(), run.units
    rows = csv.writer(stream, lineterminator="\n")
    rows.writerow(table_cell(f"{name} [{units[name]}]") for name in run.table)
    rows.writerows(zip(*(column.tolist() for column in run.table.values()), strict=True))
    return stream.getvalue().encode()


def _parquet(run: Run) -> bytes:
    """Return a table whose fields have their units as metadata."""
    arrow, parquet = library("pyarrow", "save"), library("pyarrow.parquet", "save")
    fields = [arrow.field(name, arrow.float64(), metadata={"unit": unit}) for name, unit in run.units.items()]
    stream = io.BytesIO()
    arrays = [arrow.array(column) for column in run.table.values()]
    parquet.write_table(arrow.table(arrays, schema=arrow.schema(fields)), stream)
    return stream.getvalue()


_FORMATS: dict[str, Callable[[Run], bytes]] = {".npz": _npz, ".csv": _csv, ".parquet": _parquet}
"""The writer of a file, by the end of its name."""
