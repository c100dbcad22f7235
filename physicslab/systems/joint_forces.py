"""The forces of joints in smooth motion, packed for compiled integrators."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.kernels import accounts
from physicslab.kernels.joints import layout as packing
from physicslab.kernels.joints.rows import constrain
from physicslab.kernels.joints.terms import MOTOR
from physicslab.state.joints import Joints
from physicslab.state.ordering import cuthill_mckee
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State
from physicslab.systems.system import ForceSystem


class JointForces(ForceSystem):
    """The forces of all rows that hold, and of motors of any strength: those with which their equations hold.

    They follow from all other forces, and so come after them.

    Parameters
    ----------
    name : str
        That of the system of joints, with which its evaluations are counted.
    """

    account = accounts.JOINTS
    turns = True

    def __init__(self, name: str) -> None:
        self._name = name
        self._steady: tuple[Any, Any, Any] = None, None, None

    @property
    def name(self) -> str:
        """That of the system of joints."""
        return self._name

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        """Return the rows for compiled integrators, behind which is their room."""
        joints, bodies, physics = state.joints, state.bodies, state.physics
        joints.refresh(state.entity_index)
        moving, turning, m = layout.moving, layout.turning, layout.moving_count
        inverse = np.concatenate((np.repeat(bodies.inverse_mass[moving], 2), bodies.inverse_inertia[turning]))
        order, begins = _envelope(joints, layout, inverse)
        n, entries = len(order), np.arange(len(order)) - begins + 1
        count, whole_count = packing.room_of(n, m, int(entries.sum()))
        numbers, whole = np.zeros(count), np.full(whole_count, -1, np.int64)
        rows = numbers[: n * packing.GIVEN].reshape(n, packing.GIVEN)
        places = whole[packing.FIRST :].reshape(n, packing.PLACES)
        angle = state.table(Transform)["angle"]
        for number in range(2):
            term = order if number == 0 else joints.second[order]
            has = term >= 0
            own, t = rows[:, packing.TERM * number :], term[has]
            places[has, packing.MEASURE + number] = joints.measure[t]
            for end, bodies_at, anchors in ((0, joints.a, joints.anchor_a), (1, joints.b, joints.anchor_b)):
                at, place = bodies_at[t], 4 * number + 2 * end
                places[has, place], places[has, place + 1] = layout.place[at], layout.turn[at]
                anchor = packing.ANCHOR_A + 2 * end
                own[has, anchor], own[has, anchor + 1] = anchors[t].T
                own[has, packing.ANGLE_A + end] = angle[at]
            own[has, packing.AXIS], own[has, packing.AXIS + 1] = joints.axis[t].T
            own[has, packing.SCALE] = joints.scale[t]
        rows[:, packing.OFFSET], rows[:, packing.TARGET] = joints.offset[order], joints.target[order]
        places[:, packing.ROLE], places[:, packing.NUMBER] = joints.role[order], order
        places[:, packing.BEGIN], places[:, packing.AT] = begins, np.cumsum(entries) - entries
        rates = np.repeat((physics.linear_damping, physics.angular_damping), (2 * len(moving), len(turning)))
        moved, first = np.concatenate((np.repeat(moving, 2), turning)), n * packing.GIVEN
        numbers[first : first + m] = inverse
        numbers[first + m : first + 2 * m] = rates * (bodies.inverse_mass[moved] > 0.0)
        whole[packing.ROWS], whole[packing.COORDINATES], whole[packing.ENTRIES] = n, m, entries.sum()
        books = [(accounts.JOINTS, packing.HOLDING), (accounts.HAND, packing.DRIVEN)]
        if (joints.role[order] == MOTOR).any():
            books.append((accounts.MOTORS, packing.POWERED))
        return PackedForce(constrain, numbers, whole, work_slots=tuple(books))

    def inputs(self, state: State, layout: StateLayout) -> bytes:
        """Return the numbers of all joints, and the angles of bodies that no force turns."""
        joints = state.joints
        if self._steady[0] is not layout or self._steady[1] is not joints.a:
            ends = np.concatenate((joints.a, joints.b))
            self._steady = layout, joints.a, ends[layout.turn[ends] < 0]
        angles: bytes = state.table(Transform)["angle"][self._steady[2]].tobytes()
        return joints.settings + angles

    def settings(self, state: State) -> bytes:
        """Return the numbers of all joints."""
        return state.joints.settings

    def couples(self, state: State) -> NDArray[np.int64]:
        """Return the bodies that joints hold together (n, 2)."""
        return state.joints.edges

    def turned(self, state: State) -> NDArray[np.int64]:
        """Return the bodies that joints hold."""
        return state.joints.edges.ravel()

    def depends_on_velocity(self, state: State) -> bool:
        """Return that it does: what turns faster about a pin is held with more force."""
        return True


def solved_rows(whole: NDArray[np.int64]) -> tuple[NDArray[np.int64], ...]:
    """Return rows of joints, and places of their forces and pivots (n,), which are 0 for dependent rows."""
    n = int(whole[packing.ROWS])
    places = whole[packing.FIRST : packing.FIRST + packing.PLACES * n].reshape(n, packing.PLACES)
    states = packing.GIVEN * n + 2 * int(whole[packing.COORDINATES])
    forces = states + packing.STATE * np.arange(n) + packing.LAMBDA
    factor = states + packing.STATE * n + int(whole[packing.ENTRIES])
    pivots = factor + places[:, packing.AT] + np.arange(n) - places[:, packing.BEGIN]
    return places[:, packing.NUMBER], forces, pivots


def _envelope(
    joints: Joints, layout: StateLayout, inverse: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the rows (n,) that are solved, in an order in which those that act on one body are near.

    And for each the first one that acts on a body of it (n,), by its place in that order. ``inverse`` (m,)
    are the inverse masses of the coordinates.
    """
    rows = np.flatnonzero(joints.solved)
    acting: dict[int, list[int]] = {}
    bodies: dict[int, set[int]] = {}
    moves = np.zeros(len(layout.place), np.bool_)
    for place in (layout.place, layout.turn):
        inside = (place >= 0) & (place < len(inverse))
        moves[inside] |= inverse[place[inside]] > 0.0
    for row in rows.tolist():
        terms = [row, *(n for n in (int(joints.second[row]),) if n >= 0)]
        bodies[row] = {int(end) for n in terms for end in (joints.a[n], joints.b[n]) if moves[end]}
        for body in bodies[row]:
            acting.setdefault(body, []).append(row)

    def begins(order: list[int]) -> NDArray[np.int64]:
        place = {row: n for n, row in enumerate(order)}
        first = {body: min(place[row] for row in at) for body, at in acting.items()}
        return np.array(
            [min((first[body] for body in bodies[row]), default=n) for n, row in enumerate(order)], np.int64
        )

    given = rows.tolist()
    neighbours = {row: {other for body in bodies[row] for other in acting[body]} - {row} for row in given}
    # A row that depends on those before it gets no force: motors are last, and give way to what holds.
    ordered = (
        sorted(one, key=lambda row: bool(joints.role[row] == MOTOR))
        for one in (given, cuthill_mckee(neighbours)[::-1])
    )
    orders = [(one, begins(one)) for one in ordered]
    order, first = min(orders, key=lambda one: int(((np.arange(len(given)) - one[1]) ** 2).sum()))
    return np.array(order, np.int64), first
