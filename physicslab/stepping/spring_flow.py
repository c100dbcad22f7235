"""Springs between the middles of bodies, beside contacts: packed for a flow of their own."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.ecs.sentences import sentence
from physicslab.ecs.vector import Vector2
from physicslab.integrators.spring_splitting import DRIFTS, KICKS
from physicslab.kernels.arguments import SpringsTuple
from physicslab.kernels.ode.spring_flow import HEAD, KNOWN, WEIGHT
from physicslab.kernels.wide_layout import WIDE
from physicslab.state.packed import StateLayout, spring_ends, turned_anchors
from physicslab.state.state import State
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.spring import SpringSystem
from physicslab.systems.system import ForceSystem

_SHORTEST = 0.5
"""Share of its rest length below which a spring is not followed: across it, the pull changes faster."""


def why_no_spring_flow(state: State, forces: Sequence[ForceSystem]) -> str | None:
    """Return why the bodies on springs cannot be moved by a :class:`SpringFlow`, or ``None``."""
    spring, physics = state.table(Spring), state.physics
    rows, a, b = spring_ends(state)
    for force in forces:
        if type(force) not in (SpringSystem, GravitySystem):
            return sentence("acts", system=force.name)
    if physics.gravity_mode == "planet":
        return sentence("planets")
    if physics.linear_damping or physics.angular_damping:
        return sentence("motion_damped")
    if (spring["damping"][rows] > 0.0).any():
        return sentence("damper")
    moves = state.table(Velocity).present
    for end, anchors in ((a, "anchor_a"), (b, "anchor_b")):
        if spring[anchors][rows[moves[end]]].any():
            return sentence("beside_middle")
    return None


def _in_blocks(a: NDArray[np.int64], b: NDArray[np.int64], movable: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return the springs in blocks of eight (8 n,), -1 where there is none.

    No two of a block pull at one body that can be moved. Each goes into the first block with room after
    those of the springs before it that do.
    """
    free, can_move = [0] * len(movable), movable.tolist()
    blocks: list[list[int]] = []
    full = 0  # all blocks before this one are
    for spring, ends in enumerate(zip(a.tolist(), b.tolist(), strict=True)):
        held = [end for end in ends if can_move[end]]
        block = max(full, *(free[end] for end in held)) if held else full
        while block < len(blocks) and len(blocks[block]) == WIDE:
            block += 1
        if block == len(blocks):
            blocks.append([])
        blocks[block].append(spring)
        while full < len(blocks) and len(blocks[full]) == WIDE:
            full += 1
        for end in held:
            free[end] = block + 1
    return np.array([[*block, *[-1] * (WIDE - len(block))] for block in blocks], np.int64).ravel()


class SpringFlow:
    """The springs and bodies of a world as :func:`flow_springs` takes them (kernels/ode/spring_flow.py).

    Parameters
    ----------
    state : State
        Of which :func:`why_no_spring_flow` has nothing to say.
    forces : sequence of ForceSystem
        What acts.
    layout : StateLayout
        Of the bodies that are moved.
    steps : int
        Into how many steps of the method half a substep is divided.

    Attributes
    ----------
    arrays : SpringsTuple
        All of it, which the flow goes on from.
    """

    def __init__(self, state: State, forces: Sequence[ForceSystem], layout: StateLayout, steps: int) -> None:
        self._forces, self._moving, inverse = tuple(forces), layout.moving, state.bodies.inverse_mass
        spring, (rows, a, b) = state.table(Spring), spring_ends(state)
        m, moves = len(layout.moving), state.table(Velocity).present
        number_of = np.full(len(moves), -1)
        number_of[layout.moving] = np.arange(m)
        ends_a, ends_b = number_of[a], number_of[b]
        fixed_a, fixed_b = np.flatnonzero(~moves[a]), np.flatnonzero(~moves[b])
        ends_a[fixed_a] = m + np.arange(len(fixed_a))
        ends_b[fixed_b] = m + len(fixed_a) + np.arange(len(fixed_b))
        self._fixed = (a[fixed_a], rows[fixed_a], "anchor_a"), (b[fixed_b], rows[fixed_b], "anchor_b")
        unused = m + len(fixed_a) + len(fixed_b)
        movable = np.zeros(unused + 1, np.bool_)
        movable[:m] = inverse[layout.moving] > 0.0
        order = _in_blocks(ends_a, ends_b, movable)
        used = order >= 0
        rest = np.where(used, spring["rest_length"][rows[order]], 0.0)
        stiffness = np.where(used, spring["stiffness"][rows[order]], 0.0)
        a, b = (np.where(used, end[order], unused) for end in (ends_a, ends_b))
        driven = np.flatnonzero(inverse[layout.moving] == 0.0)
        ends = np.concatenate((driven, np.arange(m, unused)))
        sizes = m, unused + 1, len(order), len(DRIFTS), steps
        whole = np.concatenate((sizes, layout.moving, a, b, ends)).astype(np.int64)
        gain, lengths = np.repeat(inverse[layout.moving], 2), (rest, stiffness, _SHORTEST * rest)
        state_of, pulls = np.zeros(HEAD + 6 * (unused + 1)), np.zeros(4 * m)
        numbers = np.concatenate((state_of, gain, pulls, *lengths, DRIFTS, KICKS))
        self.arrays: SpringsTuple = numbers, whole
        self._place = numbers[HEAD : HEAD + 2 * (unused + 1)].reshape(-1, 2)
        first = len(state_of) + 2 * m
        self._gravity, self._weight = numbers[first : first + 4 * m].reshape(2, -1)
        self._physics: object = None

    def begin(self, state: State) -> None:
        """Take gravity, and where springs are attached to what does not move."""
        if self._physics is not state.physics:
            uniform = (force.uniform_acceleration(state) for force in self._forces)
            gravity = sum((g for g in uniform if g is not None), start=Vector2(0.0, 0.0))
            pulled = state.bodies.inverse_mass[self._moving] > 0.0
            mass = np.where(pulled, state.table(Mass)["mass"][self._moving], 0.0)
            self._gravity[:] = np.outer(pulled, (gravity.x, gravity.y)).ravel()
            self._weight[:] = np.outer(mass, (gravity.x, gravity.y)).ravel()
            self.arrays[0][WEIGHT : WEIGHT + 2] = np.array((gravity.x, gravity.y)) * float(mass.sum())
            self._physics = state.physics
        transform, first = state.table(Transform), len(self._moving)
        for end, springs, anchors in self._fixed:
            if len(end):
                points = transform["position"][end] + turned_anchors(state, end, springs, anchors)
                held = self._place[first : first + len(end)]
                if not np.array_equal(points, held):
                    held[:], self.arrays[0][KNOWN] = points, 0.0
                first += len(end)
