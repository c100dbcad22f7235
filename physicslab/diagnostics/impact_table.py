"""The table of impacts: what each did, derived from the records that the steppers write.

Normal n from A to B, tangent t = n turned counter-clockwise, u = velocity of B's point against A's. With the
arms r from the centres to the point and v, w the velocities at the moment of the impact,

    u = v_b + w_b x r_b - v_a - w_a x r_a,    vn = u . n,    vt = u . t.

An impulse J on B changes v_b by J / m_b and w_b by r_b x J / I_b, and acts as -J on A. Its work on both is
J . (u- + u+) / 2, with u before and after all impulses of the moment: this is exact, as velocities are linear
in the impulses. The sum over the points of a pair, negative, is what the impact took.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from physicslab.contacts.report import ImpactReader
from physicslab.diagnostics.table_rows import TableRows
from physicslab.ecs.text import table_cell
from physicslab.kernels.constraint.impact_law import ENERGETIC, LOWERED, NEWTON
from physicslab.kernels.constraint.pair import ContactFrame, PairVelocity, point_state
from physicslab.kernels.interpreter import fallback_of
from physicslab.kernels.records import IMPACT
from physicslab.state.state import State

WALLS = ("bounds left", "bounds bottom", "bounds right", "bounds top")
"""Names of the world's bounds, by the number of the wall."""
LAWS = {NEWTON: "Newton", ENERGETIC: "Stronge", LOWERED: "Newton, restitution lowered"}
"""The laws of :mod:`physicslab.kernels.constraint.impact_law` in words."""
NO_IMPACTS = np.zeros(0, IMPACT)
"""An empty log, with all its columns."""
_NEITHER = np.zeros(2, IMPACT)
for _name in IMPACT.names or ():
    if IMPACT[_name].kind == "f":
        _NEITHER[_name] = np.nan
_STICKS = 1e-9
"""Share of the speeds of an impact up to which an approach, or the sliding after it, is treated as zero."""

type Floats = NDArray[np.float64]
"""A float64 array, of impacts (n,)."""
type LastTimes = dict[tuple[int, int, int], float]
"""When each pair met last [s], by entities and wall."""


@dataclass(frozen=True, slots=True)
class ImpactColumns:
    """Figures derived from the records of impacts, arrays (n,).

    Speeds are those of B's point against A's, at the point with the larger impulse.

    Attributes
    ----------
    vn_before, vn_after : float64 arrays
        Along the normal [m/s]; negative where they approach.
    vt_before, vt_after : float64 arrays
        Along the tangent [m/s].
    e_found : float64 array
        -vn_after / vn_before; NaN where the point did not approach.
    sticks : bool array
        Whether the surfaces leave without sliding, held by friction: vt_after is zero.
    energy_lost : float64 array
        -J . (u- + u+) / 2 of all points [J]: the kinetic energy of both bodies before minus after, by the
        impulses of this pair alone. The work of a kinematic or held body by its motion is not part of it.
    """

    vn_before: Floats
    vn_after: Floats
    vt_before: Floats
    vt_after: Floats
    e_found: Floats
    sticks: NDArray[np.bool_]
    energy_lost: Floats


def speeds_at(records: NDArray[Any], x: Floats, y: Floats, moment: str) -> tuple[Floats, Floats]:
    """Return the speeds of B against A at points, along normal and tangent.

    Parameters
    ----------
    records : array of IMPACT (n,)
        The impacts.
    x, y : float64 arrays (n,)
        Points [m].
    moment : "before" or "after"
        Which velocities of the bodies.

    Returns
    -------
    vn, vt : float64 arrays (n,)
        [m/s].
    """
    columns: list[Any] = [records[f"{moment}_{part}"] for part in PairVelocity._fields]
    at: list[Any] = [records["normal_x"], records["normal_y"]]
    at += [place - records[f"center_{body}{axis}"] for body in "ab" for axis, place in (("x", x), ("y", y))]
    state = fallback_of(point_state)(ContactFrame(*at), PairVelocity(*columns))
    return state.v, state.sliding


def read_impacts(records: NDArray[Any]) -> ImpactColumns:
    """Return the derived columns of impacts, in the order of the records.

    Parameters
    ----------
    records : array of IMPACT (n,)
        The impacts.

    Returns
    -------
    ImpactColumns
        The columns, each (n,).
    """
    vn_before, vt_before = speeds_at(records, records["x"], records["y"], "before")
    vn_after, vt_after = speeds_at(records, records["x"], records["y"], "after")
    moved = records["normal_impulse"] * (records["inverse_mass_a"] + records["inverse_mass_b"])
    with np.errstate(all="ignore"):
        e_found = np.where(approached(vn_before, moved), -vn_after / vn_before, np.nan)
    none = np.abs(vt_after) <= _STICKS * (np.abs(vn_before) + np.abs(vt_before))
    normal, tangent = records["normal_impulse"], records["tangent_impulse"]
    normal_2, tangent_2 = records["normal_impulse_2"], records["tangent_impulse_2"]
    second = [speeds_at(records, records["x_2"], records["y_2"], moment) for moment in ("before", "after")]
    work = (normal - normal_2) * (vn_before + vn_after) + (tangent - tangent_2) * (vt_before + vt_after)
    work += normal_2 * (second[0][0] + second[1][0]) + tangent_2 * (second[0][1] + second[1][1])
    return ImpactColumns(
        vn_before, vn_after, vt_before, vt_after, e_found, none & (records["friction"] > 0.0),
        0.0 - 0.5 * work,
    )  # fmt: skip


def approached(vn: Any, moved: Any) -> Any:
    """Return whether pairs that parted at vn (n,) [m/s] met, in an impact that ``moved`` them (n,) [m/s].

    A resting pair that an impact of others goes through does so by rounding at most. Numbers or arrays.
    """
    return vn < -_STICKS * moved


def first_and_last(state: State, since: int) -> NDArray[Any]:
    """Return the first impact from number ``since`` on and the last (2,): of NaN if there was no impact.

    So is one whose place in the log others have taken.
    """
    contacts, found = state.contacts, _NEITHER.copy()
    for place, number in enumerate((since, contacts.logged - 1)):
        if max(since, contacts.logged - len(contacts.log)) <= number < contacts.logged:
            found[place] = contacts.log[number % len(contacts.log)]
    return found


def since_last(records: NDArray[Any], last: LastTimes) -> Floats:
    """Return how long since the last impact of the same pair [s] (n,), NaN for the first of each.

    Parameters
    ----------
    records : array of IMPACT (n,)
        The impacts, in the order in which they were logged.
    last : dict
        When each pair met last before them; brought up to date.
    """
    since = np.full(len(records), np.nan)
    a, b, wall, times = (records[name] for name in ("entity_a", "entity_b", "wall", "time"))
    order = np.lexsort((times, wall, b, a))
    if not len(order):
        return since
    same = np.zeros(len(order), np.bool_)
    same[1:] = (a[order][1:] == a[order][:-1]) & (b[order][1:] == b[order][:-1])
    same[1:] &= wall[order][1:] == wall[order][:-1]
    later = np.flatnonzero(same)
    since[order[later]] = times[order[later]] - times[order[later - 1]]
    ends = np.append(np.flatnonzero(~same)[1:], len(order)) - 1
    for begin, end in zip(order[~same].tolist(), order[ends].tolist(), strict=True):
        key = int(a[begin]), int(b[begin]), int(wall[begin])
        if key in last:
            since[begin] = times[begin] - last[key]
        last[key] = float(times[end])
    return since


def names_of(state: State, records: NDArray[Any]) -> tuple[list[str], list[str]]:
    """Return what A and B of impacts (n,) are called in a table; the bounds by their walls."""
    entities = np.unique(np.concatenate((records["entity_a"], records["entity_b"]))).tolist()
    names = {entity: table_cell(state.label(entity)) for entity in entities if entity}
    pairs = zip(records["entity_a"].tolist(), records["wall"].tolist(), strict=True)
    first = [names[entity] if wall < 0 else WALLS[wall] for entity, wall in pairs]
    return first, [names[entity] for entity in records["entity_b"].tolist()]


_HEADER = (
    "time [s]", "A", "B", "x [m]", "y [m]", "normal x", "normal y",
    "normal speed before [m/s]", "normal speed after [m/s]",
    "tangential speed before [m/s]", "tangential speed after [m/s]",
    "normal impulse [N s]", "tangential impulse [N s]", "friction", "restitution asked", "restitution found",
    "kinetic energy lost [J]", "since the pair's last [s]", "law", "points", "other impulses at once",
)  # fmt: skip


def impact_table(state: State, records: NDArray[Any]) -> dict[str, NDArray[Any]]:
    """Return what a person wants to know of impacts, by name; arrays (n,) in SI units.

    Parameters
    ----------
    state : State
        The world of which they are.
    records : array of IMPACT (n,)
        The impacts.
    """
    found, (a, b) = read_impacts(records), names_of(state, records)
    plain = ("x", "y", "normal_x", "normal_y", "normal_impulse", "tangent_impulse")
    return {
        "time": records["time"].copy(), "a": np.array(a, object), "b": np.array(b, object),
        **{name: records[name].copy() for name in plain},
        "speed_before": found.vn_before, "speed_after": found.vn_after,
        "sliding_before": found.vt_before, "sliding_after": found.vt_after,
        "restitution": found.e_found, "sticks": found.sticks, "energy_lost": found.energy_lost,
    }  # fmt: skip


class ImpactTableWriter:
    """Writes every impact of a world to a stream as CSV, from now on: a row each, in the order of the log.

    Numbers keep every bit. A cell is empty where there is nothing to tell: a pair's first impact has no last.

    Parameters
    ----------
    stream : text stream
        Opened with ``newline=""``.
    state : State
        Whose impacts; from now on all of them are logged.
    for_excel : bool
        As :class:`TableRows` has it.

    Attributes
    ----------
    rows : int
        How many impacts were written.
    """

    def __init__(self, stream: TextIO, state: State, *, for_excel: bool = False) -> None:
        state.contacts.read = True
        self._rows = TableRows(stream, for_excel=for_excel)
        self._rows.write([_HEADER])
        self._state, self._reader = state, ImpactReader(state)
        self._last: LastTimes = {}
        self.rows = 0

    @property
    def lost(self) -> int:
        """How many impacts were overwritten in the ring before they could be read."""
        return self._reader.lost

    def write(self) -> None:
        """Write the impacts since the last call."""
        for records in self._reader.blocks(self._state):
            self._rows.write(_rows(self._state, records, self._last))
            self.rows += len(records)


def impact_rows(state: State, records: NDArray[Any]) -> Iterator[tuple[object, ...]]:
    """Yield the rows of :class:`ImpactTableWriter`, its head first, for impacts, an array of IMPACT (n,)."""
    yield _HEADER
    yield from _rows(state, records, {})


def _rows(state: State, records: NDArray[Any], last: LastTimes) -> Iterator[tuple[object, ...]]:
    found, (a, b) = read_impacts(records), names_of(state, records)
    columns = (
        records["time"].tolist(), a, b,
        *(records[name].tolist() for name in ("x", "y", "normal_x", "normal_y")),
        found.vn_before.tolist(), found.vn_after.tolist(),
        found.vt_before.tolist(), found.vt_after.tolist(),
        records["normal_impulse"].tolist(), records["tangent_impulse"].tolist(),
        np.where(found.sticks, "sticks", "slips").tolist(),
        records["restitution"].tolist(), _or_empty(found.e_found), found.energy_lost.tolist(),
        _or_empty(since_last(records, last)), [LAWS[law] for law in records["law"].tolist()],
        records["points"].tolist(), np.where(records["alone"] == 1, "no", "yes").tolist(),
    )  # fmt: skip
    return zip(*columns, strict=True)


def _or_empty(values: Floats) -> list[float | str]:
    """Return numbers as a list, with nothing in the place of NaN."""
    return ["" if value != value else value for value in values.tolist()]
