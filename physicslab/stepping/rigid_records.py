"""What rigid contacts leave to be read: records of pairs, with points, impulses and impacts."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.contacts.near_pairs import list_all
from physicslab.kernels.rigid.features import GAP, MU, NX, NY, ONE, PAIR, PX, PY, RESTITUTION
from physicslab.state.state import State
from physicslab.stepping.rigid_motion import MadeStep

_IMPACT_FIELDS = ("approach_speed", "impact_normal", "impact_tangent")


class RigidRecords:
    """Writes the points that are closed, and the impacts of a step, into the records of their pairs.

    Parameters
    ----------
    pairs : int64 array (n, 3)
        The pairs that may meet.
    """

    def __init__(self, pairs: NDArray[np.int64]) -> None:
        self._pairs = pairs  # rows of joints, which are points as well, come behind them

    def write(self, state: State, made: MadeStep, h: float) -> None:
        """Write the closed points and the impacts of a step of ``h`` seconds."""
        contacts = state.contacts
        contacts.recorded = (
            0  # blank: what soft steps before have left would depend on where a run was parted
        )
        contacts.wide.reset(len(state.entity_index))
        list_all(state, self._pairs, len(self._pairs))
        records, points = contacts.manifolds[: contacts.recorded], contacts.points[: 2 * contacts.recorded]
        contacts.impulse_dt = h / state.simulation.substeps
        position = state.table(Transform)["position"]
        of, measures, forces = made.points, made.measures, made.forces
        touching: list[int] = []
        for i in range(made.closed):
            p = int(of[i, PAIR])
            if p >= len(self._pairs):
                continue
            record = records[p]
            a, b = record["a"], record["b"]
            k = int(record["count"])
            if k == 2:
                continue
            if k == 0:
                touching.append(p)
            sign = 1.0 if of[i, ONE] == a else -1.0
            record["count"] = k + 1
            record["normal_x"], record["normal_y"] = (
                0.0 + sign * measures[i, NX],
                0.0 + sign * measures[i, NY],
            )
            record["friction"], record["restitution"] = measures[i, MU], measures[i, RESTITUTION]
            point = points[2 * p + k]
            place = measures[i, PX : PY + 1]
            point["arm_ax"], point["arm_ay"] = place - position[a]
            point["arm_bx"], point["arm_by"] = place - position[b]
            point["separation"] = measures[i, GAP]
            point["normal_impulse"] = forces[2 * i] * contacts.impulse_dt
            point["tangent_impulse"] = forces[2 * i + 1] * contacts.impulse_dt
        self._write_impacts(state, made.impacts)
        contacts.active = len(touching)
        contacts.touching[: len(touching)] = touching
        contacts.stale = True  # for the contact step, should it have to go on

    def _write_impacts(self, state: State, impacts: int) -> None:
        """Write the impacts of the last step into their pairs' records, at their first point."""
        contacts = state.contacts
        if not impacts:
            return
        records, position = contacts.manifolds[: contacts.recorded], state.table(Transform)["position"]
        last = np.arange(max(0, contacts.logged - min(impacts, len(contacts.log))), contacts.logged)
        log = contacts.log[last % len(contacts.log)]
        number = {key: p for p, key in enumerate(_pairs_of(records))}
        pairs = np.array([number[key] for key in _pairs_of(log)])
        np.add.at(records["impact_count"], pairs, 1)
        points = contacts.points[: 2 * len(records) : 2]
        np.maximum.at(points["approach_speed"], pairs, log["approach_speed"])
        np.add.at(points["impact_normal"], pairs, log["normal_impulse"])
        np.add.at(points["impact_tangent"], pairs, log["tangent_impulse"])
        latest = dict(zip(pairs.tolist(), range(len(log)), strict=True))
        for p, n in latest.items():
            record, point, impact = records[p], points[p], log[n]
            if not record["count"]:
                record["normal_x"], record["normal_y"] = impact["normal_x"], impact["normal_y"]
                place = np.array((impact["x"], impact["y"]))
                point["arm_ax"], point["arm_ay"] = place - position[record["a"]]
                point["arm_bx"], point["arm_by"] = place - position[record["b"]]


def _pairs_of(records: NDArray[Any]) -> Iterator[tuple[int, int, int]]:
    """Return the entities and the wall of each record."""
    return zip(
        records["entity_a"].tolist(), records["entity_b"].tolist(), records["wall"].tolist(), strict=True
    )
