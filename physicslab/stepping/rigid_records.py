"""Records of rigid contacts: pairs, with points, impulses and impacts."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.contacts.near_pairs import list_all
from physicslab.kernels import direct_entry
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid.point_records import write_points
from physicslab.state.chain_links import segment_of_link
from physicslab.state.state import State
from physicslab.stepping.rigid_motion import MadeStep

_IMPACT_FIELDS = ("approach_speed", "impact_normal", "impact_tangent")


class RigidRecords:
    """Writes the points that are closed, and the impacts of a step, into the records of their pairs.

    Parameters
    ----------
    pairs : int64 array (n, 3)
        The pairs that may meet.
    chained : bool array (n,)
        Whether one of a pair is a chain: it has a record for each segment that is touched.
    """

    def __init__(self, pairs: NDArray[np.int64], chained: NDArray[np.bool_]) -> None:
        self._pairs = pairs  # rows of joints, which are points as well, come behind them
        self._chained = chained

    def write(self, state: State, made: MadeStep, h: float) -> None:
        """Write the closed points and the impacts of a step of ``h`` seconds."""
        contacts = state.contacts
        contacts.recorded = (
            0  # blank: what soft steps before have left would depend on where a run was parted
        )
        if contacts.wide.filled:
            contacts.wide.reset(len(state.entity_index))
        pairs, number = self._list(state, made)
        list_all(state, pairs, len(pairs))
        contacts.impulse_dt = h / state.simulation.substeps
        contacts.active = direct_entry(write_points)(
            made.points, made.measures, made.forces, number, contacts.impulse_dt,
            state.table(Transform)["position"], contacts.manifolds, contacts.points, contacts.touching,
        )  # fmt: skip
        self._write_impacts(state, made.impacts)
        contacts.stale = True  # for the contact step, should it have to go on

    def _key(self, state: State, made: MadeStep, i: int) -> tuple[int, ...]:
        """Return the pair of a point of a chain and its segment."""
        a, b, _ = self._pairs[made.points[i, F.PAIR]].tolist()
        feature, shapes = int(made.points[i, F.FEATURE]), state.bodies.shapes
        link, row = (F.LINK - feature, F.ONE) if feature < 0 else (int(made.points[i, F.VERTEX]), F.OTHER)
        return a, b, -2 - segment_of_link(shapes, int(made.points[i, row]), link)

    def _list(self, state: State, made: MadeStep) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the pairs to record, in order, with segments of chains that are touched.

        And which of them each closed point (closed,) belongs to, -1 for rows of joints.
        """
        of = made.points[: made.closed, F.PAIR]
        known = of < len(self._pairs)
        if not self._chained.any():
            return self._pairs, np.where(known, of, -1)
        keys = {
            i: self._key(state, made, i) if self._chained[of[i]] else tuple(self._pairs[of[i]].tolist())
            for i in np.flatnonzero(known).tolist()
        }
        touched = {key for key in keys.values() if key[2] < -1}
        entities = state.entity_index.entities
        ends = {
            (int(entities[a]), int(entities[b])): (a, b) for a, b, _ in self._pairs[self._chained].tolist()
        }
        for impact in _last_impacts(state, made.impacts):
            if impact["wall"] < -1:
                touched.add((*ends[int(impact["entity_a"]), int(impact["entity_b"])], int(impact["wall"])))
        listed = sorted([*map(tuple, self._pairs[~self._chained].tolist()), *touched])
        place = {pair: n for n, pair in enumerate(listed)}
        number = np.array([place[keys[i]] if i in keys else -1 for i in range(made.closed)], np.int64)
        return np.array(listed, np.int64).reshape(-1, 3), number

    def _write_impacts(self, state: State, impacts: int) -> None:
        """Write the impacts of the last step into their pairs' records, at their first point."""
        contacts = state.contacts
        if not impacts:
            return
        records, position = contacts.manifolds[: contacts.recorded], state.table(Transform)["position"]
        log = _last_impacts(state, impacts)
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


def _last_impacts(state: State, impacts: int) -> NDArray[Any]:
    """Return the last records (n,) of the log."""
    contacts = state.contacts
    last = np.arange(max(0, contacts.logged - min(impacts, len(contacts.log))), contacts.logged)
    log: NDArray[Any] = contacts.log[last % len(contacts.log)]
    return log


def _pairs_of(records: NDArray[Any]) -> Iterator[tuple[int, int, int]]:
    """Return the entities and the wall of each record."""
    return zip(
        records["entity_a"].tolist(), records["entity_b"].tolist(), records["wall"].tolist(), strict=True
    )
