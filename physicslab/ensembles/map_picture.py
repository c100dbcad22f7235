"""A measure over two fields as a picture."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from physicslab.ensembles.space import Axis, Space, Values
from physicslab.files.checks import SceneError
from physicslab.lab.report import new_figure, png


def map_picture(space: Space, name: str, column: Values, units: Mapping[str, str]) -> bytes:
    """Return a PNG of a measure by colour over the two grids of a space (extra ``plot``).

    Runs without a result are left blank; of samples and replicas the mean is shown.

    Parameters
    ----------
    name, column : str, float64 array (rows,)
        The measure, and its values [SI].
    units : mapping of str to str
        The units of fields and measures, where they have one.

    Raises
    ------
    ImportError
        If matplotlib is not installed.
    SceneError
        If the space has not two grids of numbers.
    """
    across, up = map_grids(space)
    cells = column.reshape(len(across.values), len(up.values), -1)
    there = np.isfinite(cells)
    sums, counts = np.where(there, cells, 0.0).sum(axis=2), there.sum(axis=2)
    means = np.divide(sums, counts, out=np.full(sums.shape, np.nan), where=counts > 0)
    order = np.argsort(across.values), np.argsort(up.values)
    figure = new_figure(7.2, 5.6)
    axes = figure.subplots()
    picture = axes.pcolormesh(
        across.values[order[0]],
        up.values[order[1]],
        means[np.ix_(*order)].T,
        cmap="viridis",
        shading="nearest",
    )  # fmt: skip
    axes.set_xlabel(labelled(across.name, units.get(across.name, "")))
    axes.set_ylabel(labelled(up.name, units.get(up.name, "")))
    figure.colorbar(picture, label=labelled(name, units.get(name, "")))
    return png(figure)


def map_grids(space: Space) -> list[Axis]:
    """Return the two lists of a space, or refuse another space."""
    grids = [axis for axis in space.axes if axis.law == "grid"]
    if len(grids) != 2 or any(axis.kind not in ("number", "vector", "whole") for axis in grids):
        raise SceneError("map: must have two lists of numbers, one for each direction")
    return grids


def labelled(name: str, unit: str) -> str:
    """Return the name of a column with its unit.

    >>> labelled("ball.Mass.mass", "kg"), labelled("count", "1")
    ('ball.Mass.mass [kg]', 'count')
    """
    return name if unit in ("", "1") else f"{name} [{unit}]"
