"""Rows of joints as points of rigid contacts: limits, and motors with a largest force."""

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.sentences import sentence
from physicslab.kernels.rigid import joint_points as packing
from physicslab.kernels.rigid.features import JOINT, MOTOR, WALL
from physicslab.state.joint_rows import Measure, Role
from physicslab.state.state import State


class RigidRows:
    """The rows of joints that are points beside contacts, of a world as it is made.

    Attributes
    ----------
    rows : int64 array (n,)
        Which of all rows of joints they are.
    pairs : int64 array (n, 3)
        The bodies that each acts on, and whether it is a limit or a motor.
    coefficients : float64 array (n, k)
        As :mod:`physicslab.kernels.rigid.joint_points` has them.
    """

    def __init__(self, state: State) -> None:
        state.joints.refresh(state.entity_index)
        self.rows: NDArray[np.int64] = np.array(self._acting(state), np.int64)
        n = len(self.rows)
        self.pairs = np.zeros((n, 3), np.int64)
        self.coefficients = np.zeros((n, packing.NUMBERS))
        for number, row in enumerate(self.rows.tolist()):
            self._pack(state, number, row)

    def holds(self, state: State) -> bool:
        """Whether these are the rows that act, as far as that depends on what turns."""
        return self._acting(state) == list(self.rows)

    @classmethod
    def _acting(cls, state: State) -> list[int]:
        """Return the rows: a motor without a force, and a row of what nothing moves or turns, do nothing."""
        joints, bodies = state.joints, state.bodies
        turns = bodies.inverse_inertia > 0.0
        moves = (bodies.inverse_mass > 0.0) | turns
        acting = np.flatnonzero(~joints.solved & (joints.strongest > 0.0)).tolist()
        given = [turns if joints.measure[row] == Measure.ANGLE else moves for row in acting]
        return [row for row, can in zip(acting, given, strict=True) if can[cls._bodies(state, row)].any()]

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
        self.pairs[number] = one, other, (MOTOR if motor else JOINT) - WALL
        own = self.coefficients[number]
        own[:3] = joints.strongest[row] / lever if motor else 0.0, 0.0, size
        own[packing.LEVER], own[packing.TERMS] = lever, len(terms)
        own[packing.OFFSET], own[packing.TARGET] = joints.offset[row], joints.target[row]
        for k, term in enumerate(terms):
            one = own[packing.FIRST_TERM + packing.TERM * k :][: packing.TERM]
            one[packing.MEASURE], one[packing.SCALE] = joints.measure[term], joints.scale[term]
            one[packing.ENDS : packing.SCALE] = joints.a[term], joints.b[term]
            one[packing.ARM : packing.AXIS] = *joints.anchor_a[term], *joints.anchor_b[term]
            one[packing.AXIS :] = joints.axis[term]

    def __len__(self) -> int:
        return len(self.rows)

    def behind(self, contacts: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the coefficients of all pairs, of ``contacts`` (n, 3) and then of these."""
        if not len(self.rows):
            return contacts
        found = np.zeros((len(contacts) + len(self.rows), packing.NUMBERS))
        found[: len(contacts), :3], found[len(contacts) :] = contacts, self.coefficients
        return found

    @property
    def driven(self) -> bool:
        """Whether any is a motor."""
        return bool((self.pairs[:, 2] == MOTOR - WALL).any())

    def force_of(self, number: int, normal: float, tangent: float) -> tuple[int, float]:
        """Return the row of a joint, and its force [N or N m] from those of its point [N]."""
        force = tangent if self.pairs[number, 2] == MOTOR - WALL else normal
        return int(self.rows[number]), float(self.coefficients[number, packing.LEVER]) * force


def why_not_points(state: State) -> str | None:
    """Return which row rigid contacts cannot have as a point, as it acts on more than two bodies."""
    for row in np.flatnonzero(~state.joints.solved).tolist():
        if len(RigidRows._bodies(state, row)) > 2:
            return sentence("three_bodies")
    return None
