"""The direct solution of blocks of joint rows: how impulses of some rows change the speeds of all of a block.

A = J M^-1 J^T of a block is factorised as L D L^T, in pieces of 2 x 2. A *node* is one row, or two that hold
the same bodies, as the two of a point; the order of nodes and all places where L is not zero are found once
(:mod:`physicslab.state.joint_order`). Joints that form a tree have no more such places than A: a chain costs
as much as it has links, and a load of 10,000 times its mass is carried as by one link. Nodes that are not
active, as limits that are not reached, are passed over.
"""

from typing import Annotated, NamedTuple

import numpy as np
from numba import int64
from numpy.typing import NDArray

from physicslab.kernels import Numbers, Rows, Vectors, always_inlined, inlined
from physicslab.kernels.arguments import Inverse
from physicslab.kernels.types import unsigned

Tables = Annotated[NDArray[np.int64], int64[:, ::1]]
"""An int64 array (n, k), contiguous."""

_DEPENDENT = 1e-13
"""Share of its diagonal below which a pivot is rounding: the row depends on those before it."""
ROW, WIDTH, TERMS, ENDS, BELOW, UPDATES, NODE = range(7)
"""The numbers of a node: its first row, and how many it has; where its terms, its ends, the entries below its
diagonal and the targets of its updates begin, which end where those of the next node begin."""
TERM, PLACE, END_A, END_B, OF_NODE = range(5)
"""The numbers of a term: which it is, whether of the first or the second row of its node, and the ends that
it acts at, or -1 for what never moves."""
LOWER, SHARED, ENTRY = range(3)
"""The numbers of an entry: the node of its row, and where its pairs of ends begin that are of one body."""
FIRST, BOUNDED, GIVES_WAY, SINGLE, GROUP = range(5)
"""Where the nodes of a block begin, and in the list of those that have bounds its own; whether its rows give
way, because it is solved in turn with others that hold the same bodies; whether each node has one row."""
(
    STATE, INVERSE_1, RATIO, INVERSE_2, D_1, D_12, D_2, ERROR, _, BEFORE, _, NOTED, _, CHANGE, _, GIVES,
    _, DIAGONAL, _, CAP, NODE_STATE,
) = range(21)  # fmt: skip
"""The state of a node: whether it is ``ACTIVE``; its pivots, as they are used and as they are summed up. Of
both rows: the error [m or rad]; the speed before the impulses, and the impulse then [N s]; how the impulse
changes; how soft a dependent row is; how a unit impulse changes its own speed. Last, the bound of the
impulse."""
OFF, ACTIVE = 0.0, 1.0
"""A node that moves nothing, or whose impulse is at its bound; one that is solved."""
_CARRIED = 2.0
"""The sum of a body's shares in the rows of joints that hold it that needs no more softness, as in a
cloth. With 4 a wheel of 80 spokes, solved one by one, gains energy."""
_L = 4
"""Where the numbers of L begin in those of an entry, behind those that are summed up."""


class Joints(NamedTuple):
    """The terms (m,), rows (n,) and joints (j,) as :class:`physicslab.state.joints.Joints` has them.

    Behind the ``largest`` error of each row so far: nodes, and what belongs to them, as
    :class:`physicslab.state.joint_order.Blocks` has it; and the room for what is computed of ends, nodes and
    entries.
    """

    measure: Rows
    a: Rows
    b: Rows
    anchor_a: Vectors
    anchor_b: Vectors
    axis: Vectors
    scale: Numbers
    role: Rows
    offset: Numbers
    target: Numbers
    strongest: Numbers
    impulse: Numbers
    largest: Numbers
    row: Rows
    owner: Rows
    held: Rows
    bears: Vectors
    loads: Vectors
    nodes: Tables
    terms: Tables
    body: Rows
    beside: Rows
    entries: Tables
    shared: Tables
    targets: Rows
    groups: Tables
    bounded: Rows
    gradient: Vectors
    state: Vectors
    matrix: Vectors


@always_inlined
def _assemble(joints: Joints, k: int, inverse: Inverse) -> None:
    """Write the diagonal of A at an active node, and the entries below it."""
    nodes, g, state, body = joints.nodes, joints.gradient, joints.state, joints.body
    d1, d12, d2 = 0.0, 0.0, 0.0
    for e in range(nodes[k, ENDS], nodes[k + 1, ENDS]):
        mass, inertia = inverse.mass[body[e]], inverse.inertia[body[e]]
        d1 += mass * (g[e, 0] * g[e, 0] + g[e, 1] * g[e, 1]) + inertia * g[e, 2] * g[e, 2]
        d12 += mass * (g[e, 0] * g[e, 3] + g[e, 1] * g[e, 4]) + inertia * g[e, 2] * g[e, 5]
        d2 += mass * (g[e, 3] * g[e, 3] + g[e, 4] * g[e, 4]) + inertia * g[e, 5] * g[e, 5]
    state[k, D_1], state[k, D_12], state[k, D_2] = d1, d12, d2
    state[k, DIAGONAL], state[k, DIAGONAL + 1] = d1, d2
    for n in range(nodes[k, BELOW], nodes[k + 1, BELOW]):
        if state[joints.entries[n, LOWER], STATE] != ACTIVE:
            continue
        a11, a12, a21, a22 = 0.0, 0.0, 0.0, 0.0
        for s in range(joints.entries[n, SHARED], joints.entries[n + 1, SHARED]):
            p, q = unsigned(joints.shared[s, 0]), unsigned(joints.shared[s, 1])
            mass, inertia = inverse.mass[body[p]], inverse.inertia[body[p]]
            x, y, turn = mass * g[q, 0], mass * g[q, 1], inertia * g[q, 2]
            a11 += g[p, 0] * x + g[p, 1] * y + g[p, 2] * turn
            a21 += g[p, 3] * x + g[p, 4] * y + g[p, 5] * turn
            x, y, turn = mass * g[q, 3], mass * g[q, 4], inertia * g[q, 5]
            a12 += g[p, 0] * x + g[p, 1] * y + g[p, 2] * turn
            a22 += g[p, 3] * x + g[p, 4] * y + g[p, 5] * turn
        matrix = joints.matrix
        matrix[n, 0], matrix[n, 1], matrix[n, 2], matrix[n, 3] = a11, a12, a21, a22


@always_inlined
def _pivot(state: Vectors, k: int, row: int, left: float, softness: float, gives_way: bool) -> float:
    """Return the inverse of a pivot; a row that depends on those before it, or gives way, gets a spring."""
    diagonal = state[k, DIAGONAL + row]
    state[k, GIVES + row] = 0.0
    if gives_way or left <= _DEPENDENT * diagonal:
        state[k, GIVES + row] = softness * diagonal
        left = max(left, 0.0) + softness * diagonal
    return 1.0 / left if left > 0.0 else 0.0


@always_inlined
def _softened(joints: Joints, k: int, inverse: Inverse) -> float:
    """Return how many times as soft the rows of a node are, so that all that hold one of its bodies carry it.

    Together they are to be as stiff as a few for the mass of that body, like a mass split among them (Tonge,
    Benevolenski & Voroshilov, ACM Trans. Graph. 31, 2012, 105).
    """
    g, largest = joints.gradient, _CARRIED
    whole = joints.state[k, DIAGONAL] + joints.state[k, DIAGONAL + 1]
    for e in range(joints.nodes[k, ENDS], joints.nodes[k + 1, ENDS]):
        mass, inertia = inverse.mass[joints.body[e]], inverse.inertia[joints.body[e]]
        own = mass * (g[e, 0] * g[e, 0] + g[e, 1] * g[e, 1] + g[e, 3] * g[e, 3] + g[e, 4] * g[e, 4])
        own += inertia * (g[e, 2] * g[e, 2] + g[e, 5] * g[e, 5])
        if own > 0.0:
            largest = max(largest, joints.beside[e] * own / whole)
    return largest / _CARRIED


@always_inlined
def _eliminate(joints: Joints, k: int, softness: float, gives_way: bool) -> None:
    """Find the pivots of a node and its column of L; take that from what is below and to the right."""
    nodes, state, matrix, entries = joints.nodes, joints.state, joints.matrix, joints.entries
    d12 = state[k, D_12]
    i1 = _pivot(state, k, 0, state[k, D_1], softness, gives_way)
    ratio, i2 = d12 * i1, 0.0
    if nodes[k, WIDTH] == 2:
        i2 = _pivot(state, k, 1, state[k, D_2] - d12 * ratio, softness, gives_way)
    state[k, INVERSE_1], state[k, RATIO], state[k, INVERSE_2] = i1, ratio, i2
    begin, target = nodes[k, BELOW], nodes[k, UPDATES]
    for n in range(begin, nodes[k + 1, BELOW]):
        i = unsigned(entries[n, LOWER])
        if state[i, STATE] != ACTIVE:
            target += n - begin
            continue
        u11, u12, u21, u22 = matrix[n, 0], matrix[n, 1], matrix[n, 2], matrix[n, 3]
        l12, l22 = (u12 - ratio * u11) * i2, (u22 - ratio * u21) * i2
        l11, l21 = u11 * i1 - ratio * l12, u21 * i1 - ratio * l22
        matrix[n, _L], matrix[n, _L + 1], matrix[n, _L + 2], matrix[n, _L + 3] = l11, l12, l21, l22
        for m in range(begin, n):
            if state[entries[m, LOWER], STATE] == ACTIVE:
                t = joints.targets[target]
                matrix[t, 0] -= l11 * matrix[m, 0] + l12 * matrix[m, 1]
                matrix[t, 1] -= l11 * matrix[m, 2] + l12 * matrix[m, 3]
                matrix[t, 2] -= l21 * matrix[m, 0] + l22 * matrix[m, 1]
                matrix[t, 3] -= l21 * matrix[m, 2] + l22 * matrix[m, 3]
            target += 1
        state[i, D_1] -= l11 * u11 + l12 * u12
        state[i, D_12] -= l11 * u21 + l12 * u22
        state[i, D_2] -= l21 * u21 + l22 * u22


@always_inlined
def _eliminate_single(joints: Joints, k: int, softness: float, gives_way: bool) -> None:
    """Do the same in a block whose nodes have one row each and are all active: a quarter of the work."""
    nodes, state, matrix, entries = joints.nodes, joints.state, joints.matrix, joints.entries
    inverse = _pivot(state, k, 0, state[k, D_1], softness, gives_way)
    state[k, INVERSE_1], state[k, RATIO], state[k, INVERSE_2] = inverse, 0.0, 0.0
    begin, target = nodes[k, BELOW], nodes[k, UPDATES]
    for n in range(begin, nodes[k + 1, BELOW]):
        u, i = matrix[n, 0], unsigned(entries[n, LOWER])
        own = u * inverse
        matrix[n, _L], matrix[n, _L + 1], matrix[n, _L + 2], matrix[n, _L + 3] = own, 0.0, 0.0, 0.0
        for m in range(begin, n):
            matrix[unsigned(joints.targets[target]), 0] -= own * matrix[m, 0]
            target += 1
        state[i, D_1] -= own * u


@inlined
def factorise(joints: Joints, block: int, inverse: Inverse, softness: float) -> None:
    """Factorise A of the active nodes of a block.

    A row that depends on those before it gets a spring of its own, ``softness`` times its diagonal; so does
    each of a block that is solved in turn with others at the same bodies, or impulses would grow in turn.
    """
    first, end = joints.groups[block, FIRST], joints.groups[block + 1, FIRST]
    gives_way, single = joints.groups[block, GIVES_WAY] != 0, joints.groups[block, SINGLE] != 0
    for k in range(first, end):
        if joints.state[k, STATE] == ACTIVE:
            _assemble(joints, k, inverse)
        else:
            single = False
            joints.state[k, GIVES] = joints.state[k, GIVES + 1] = 0.0
    for k in range(first, end):
        if joints.state[k, STATE] == ACTIVE:
            own = softness * _softened(joints, k, inverse) if gives_way else softness
            if single:
                _eliminate_single(joints, k, own, gives_way)
            else:
                _eliminate(joints, k, own, gives_way)


@inlined
def substitute_forward(joints: Joints, first: int, end: int) -> float:
    """Turn changes of speeds b that are wanted into D^-1 L^-1 b, in place; return b^T A^-1 b."""
    nodes, state, matrix, total = joints.nodes, joints.state, joints.matrix, 0.0
    for k in range(first, end):
        if state[k, STATE] != ACTIVE:
            continue
        x, y = state[k, CHANGE], state[k, CHANGE + 1]
        for n in range(nodes[k, BELOW], nodes[k + 1, BELOW]):
            i = unsigned(joints.entries[n, LOWER])
            if state[i, STATE] == ACTIVE:
                state[i, CHANGE] -= matrix[n, _L] * x + matrix[n, _L + 1] * y
                state[i, CHANGE + 1] -= matrix[n, _L + 2] * x + matrix[n, _L + 3] * y
        second = (y - state[k, RATIO] * x) * state[k, INVERSE_2]
        first_part = x * state[k, INVERSE_1] - state[k, RATIO] * second
        state[k, CHANGE], state[k, CHANGE + 1] = first_part, second
        total += x * first_part + y * second
    return total


@inlined
def substitute_back(joints: Joints, first: int, end: int) -> None:
    """Turn D^-1 L^-1 b into the changes of impulses A^-1 b, in place."""
    nodes, state, matrix = joints.nodes, joints.state, joints.matrix
    for back in range(end - first):
        k = end - 1 - back
        if state[k, STATE] != ACTIVE:
            continue
        x, y = state[k, CHANGE], state[k, CHANGE + 1]
        for n in range(nodes[k, BELOW], nodes[k + 1, BELOW]):
            i = unsigned(joints.entries[n, LOWER])
            if state[i, STATE] == ACTIVE:
                x -= matrix[n, _L] * state[i, CHANGE] + matrix[n, _L + 2] * state[i, CHANGE + 1]
                y -= matrix[n, _L + 1] * state[i, CHANGE] + matrix[n, _L + 3] * state[i, CHANGE + 1]
        state[k, CHANGE], state[k, CHANGE + 1] = x, y


@always_inlined
def can_move(joints: Joints, k: int, inverse: Inverse) -> bool:
    """Whether a node acts on any body that moves: not on fixed ones alone, or such as sleep."""
    total = 0.0
    for e in range(joints.nodes[k, ENDS], joints.nodes[k + 1, ENDS]):
        total += inverse.mass[joints.body[e]]
    return total > 0.0
