"""Rows of joints as points of rigid contacts: limits, and motors with a largest force."""

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels.rigid import joint_points as packing
from physicslab.kernels.rigid.features import FIRST_ROW
from physicslab.state.joint_rows import Measure, Role
from physicslab.state.state import State


class RigidRows:
    """The rows of joints that are points beside contacts, of a world as it is made.

    Attributes
    ----------
    rows : int64 array (n,)
        Which of all rows of joints they are.
    pairs : int64 array (n, 3)
        The bodies that each acts on, and its number from that on which marks a row.
    coefficients : float64 array (n, 3)
        The largest force of a motor [N], a restitution of 0, and a size [m]: of what its length or lever is.
    numbers, ends : float64 and int64 arrays (n, k)
        As :mod:`physicslab.kernels.rigid.joint_points` has them.
    """

    def __init__(self, state: State) -> None:
        joints, bodies = state.joints, state.bodies
        joints.refresh(state.entity_index)
        # A motor without a force, and a row of what nothing moves, do nothing.
        moves = (bodies.inverse_mass > 0.0) | (bodies.inverse_inertia > 0.0)
        acting = np.flatnonzero(~joints.solved & (joints.strongest > 0.0)).tolist()
        rows = [row for row in acting if moves[self._bodies(state, row)].any()]
        self.rows: NDArray[np.int64] = np.array(rows, np.int64)
        n = len(self.rows)
        self.pairs = np.zeros((n, 3), np.int64)
        self.coefficients = np.zeros((n, 3))
        self.numbers = np.zeros((n, packing.NUMBERS))
        self.ends = np.zeros((n, packing.WHOLE), np.int64)
        for number, row in enumerate(self.rows.tolist()):
            self._pack(state, number, row)

    @staticmethod
    def _terms(state: State, row: int) -> list[int]:
        second = int(state.joints.second[row])
        return [row] if second < 0 else [row, second]

    @classmethod
    def _bodies(cls, state: State, row: int) -> list[int]:
        """Return the bodies that a row acts on, one or two."""
        joints = state.joints
        ends = [int(end) for term in cls._terms(state, row) for end in (joints.a[term], joints.b[term])]
        return list(dict.fromkeys(end for end in ends if end))

    def _pack(self, state: State, number: int, row: int) -> None:
        joints, reach = state.joints, state.bodies.shapes.reach
        terms, bodies = self._terms(state, row), self._bodies(state, row)
        arms = [
            float(np.hypot(*anchor[term]))
            for term in terms
            for end, anchor in ((joints.a, joints.anchor_a), (joints.b, joints.anchor_b))
            if end[term]
        ]
        size = max(*arms, *reach[bodies].tolist(), 0.0)
        turns = joints.measure[row] == Measure.ANGLE
        if not turns:
            size = max(size, abs(float(joints.offset[row])))
        size = size if size > 0.0 else 1.0
        lever, motor = size if turns else 1.0, joints.role[row] == Role.MOTOR
        one, other = bodies if len(bodies) > 1 else (0, *bodies)
        self.pairs[number] = one, other, FIRST_ROW + number
        self.coefficients[number] = joints.strongest[row] / lever if motor else 0.0, 0.0, size
        numbers, ends = self.numbers[number], self.ends[number]
        numbers[packing.LEVER] = lever
        numbers[packing.OFFSET], numbers[packing.TARGET] = joints.offset[row], joints.target[row]
        ends[packing.ROLE], ends[packing.TERMS] = joints.role[row], len(terms)
        for k, term in enumerate(terms):
            own = numbers[packing.FIRST_TERM + packing.TERM * k :]
            own[0], own[1:3], own[3:5] = joints.scale[term], joints.anchor_a[term], joints.anchor_b[term]
            own[5:7] = joints.axis[term]
            first = packing.FIRST_ENDS + packing.TERM_ENDS * k
            ends[first : first + 3] = joints.measure[term], joints.a[term], joints.b[term]

    def __len__(self) -> int:
        return len(self.rows)

    @property
    def driven(self) -> bool:
        """Whether any is a motor."""
        return bool((self.ends[:, packing.ROLE] == Role.MOTOR).any())

    def force_of(self, number: int, normal: float, tangent: float) -> tuple[int, float]:
        """Return the row of a joint, and its force [N or N m] from those of its point [N]."""
        force = tangent if self.ends[number, packing.ROLE] == Role.MOTOR else normal
        return int(self.rows[number]), float(self.numbers[number, packing.LEVER]) * force


def why_not_points(state: State) -> str | None:
    """Return which row rigid contacts cannot have as a point, as it acts on more than two bodies."""
    for row in np.flatnonzero(~state.joints.solved).tolist():
        if len(RigidRows._bodies(state, row)) > 2:
            return "a limit or a motor acts on more than two bodies"
    return None
