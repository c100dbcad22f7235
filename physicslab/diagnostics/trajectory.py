"""The motion of every body as a table: one row a step and body."""

from __future__ import annotations

import csv
from typing import TextIO

from physicslab.components import Transform, Velocity
from physicslab.diagnostics.run_report import body_names
from physicslab.world import World

__all__ = ["HEADER", "TrajectoryWriter"]

HEADER = ("time [s]", "entity", "x [m]", "y [m]", "angle [rad]", "vx [m/s]", "vy [m/s]", "omega [rad/s]")
"""The columns of the table."""


class TrajectoryWriter:
    """Writes the state of a world's bodies to a stream as CSV, a row for each body and call.

    Numbers keep every bit; names are those of ``run --json``.

    Parameters
    ----------
    stream : text stream
        Opened with ``newline=""``.
    """

    def __init__(self, stream: TextIO) -> None:
        self._rows = csv.writer(stream, lineterminator="\n")
        self._rows.writerow(HEADER)
        self._names: list[str] = []
        self._batch: object = None

    def write(self, world: World) -> None:
        """Write a row for every entity that has a Transform, as it is now."""
        batch = world.batch(Transform)
        if batch is not self._batch:
            self._batch, self._names = batch, list(body_names(world).values())
        transform, velocity = world.table(Transform), world.table(Velocity)
        bodies = zip(
            self._names, transform["position"][batch.rows].tolist(), transform["angle"][batch.rows].tolist(),
            velocity["linear"][batch.rows].tolist(), velocity["angular"][batch.rows].tolist(), strict=True,
        )  # fmt: skip
        self._rows.writerows(
            (world.time, name, x, y, angle, vx, vy, w) for name, (x, y), angle, (vx, vy), w in bodies
        )
