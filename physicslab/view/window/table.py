"""A graph as a table of text."""

from __future__ import annotations

import csv
import io

import numpy as np

from physicslab.components.quantities import QUANTITIES
from physicslab.ecs.text import table_cell
from physicslab.view.window.dashboard import Dashboard, GraphShown
from physicslab.view.window.record import Key

__all__ = ["table_of"]


def table_of(graph: GraphShown, dashboard: Dashboard) -> str:
    """Return what a graph shows as CSV: the time, then a column for each quantity, in full figures.

    Moments at which nothing of it was measured are left out.
    """
    record, keys = dashboard.record, list(dict.fromkeys(graph.keys))
    columns = np.array([record.values(key) for key in keys]).reshape(len(keys), len(record))
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["time [s]", *(_heading(key, dashboard) for key in keys)])
    for n in np.flatnonzero(~np.isnan(columns).all(axis=0)).tolist():
        values = ("" if np.isnan(value) else repr(float(value)) for value in columns[:, n])
        rows.writerow([repr(float(record.times[n])), *values])
    return text.getvalue()


def _heading(key: Key, dashboard: Dashboard) -> str:
    body, name = key
    heading = f"{name} [{QUANTITIES[name].unit}]"
    return heading if body is None else table_cell(f"{dashboard.label(body)}: {heading}")
