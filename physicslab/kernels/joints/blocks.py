"""The direct solution of blocks of joint rows: how impulses of some rows change the speeds of all of a block.

A = J M^-1 J^T of a block is factorised within its envelope, A = L L^T. Its rows stand in an order in which
rows that share a body are near each other (:mod:`physicslab.state.joint_order`): a chain costs as much as it
has links, and a load of 10,000 times its mass hangs on it as on one link.
"""

import math
from typing import NamedTuple

from physicslab.kernels import Numbers, Rows, Vectors, always_inlined, inlined
from physicslab.kernels.arguments import Inverse

_DEPENDENT = 1e-13
"""Share of its diagonal below which a pivot is rounding: the row depends on those before it."""
A_X, A_Y, A_TURN, B_X, B_Y, B_TURN, ERROR, BEFORE, NOTED, CHANGE, DIAGONAL, GIVES, STATE, MEASURED = range(14)
"""The measures of a term: its gradient by x, y and the angle of A, and of B. Those of a row, beside its first
term: the error [m or rad]; its speed before the impulses and its impulse then [N s]; how the impulse changes;
how a unit impulse changes its own speed; how soft a dependent row is; whether it is ``ACTIVE``."""
OFF, ACTIVE = 0.0, 1.0
"""A row that moves nothing, or whose impulse is at its bound; one that is solved."""


class Joints(NamedTuple):
    """The rows of joints (n,) and their terms (m,), as :class:`physicslab.state.joints.Joints` has them.

    Behind the impulses: the ``order`` of rows in blocks, where each block ``ends``, at which place the
    envelope of a row begins (``low``) and where its numbers in the ``matrix``; the ``largest`` error of each
    row so far, and the room for measures.
    """

    measure: Rows
    a: Rows
    b: Rows
    anchor_a: Vectors
    anchor_b: Vectors
    axis: Vectors
    scale: Numbers
    second: Rows
    role: Rows
    offset: Numbers
    target: Numbers
    strongest: Numbers
    impulse: Numbers
    order: Rows
    ends: Rows
    low: Rows
    start: Rows
    matrix: Numbers
    largest: Numbers
    measured: Vectors


JointsTuple = tuple[
    Rows, Rows, Rows, Vectors, Vectors, Vectors, Numbers, Rows, Rows, Numbers, Numbers, Numbers, Numbers,
    Rows, Rows, Rows, Rows, Numbers, Numbers, Vectors,
]  # fmt: skip
"""The rows without names."""


@always_inlined
def _common(joints: Joints, p: int, q: int, inverse: Inverse) -> float:
    """Return how a unit impulse of term q changes the speed of term p: by bodies that they have in common."""
    total, measured = 0.0, joints.measured
    for one in range(2):
        body = joints.b[p] if one == 1 else joints.a[p]
        for other in range(2):
            if (joints.b[q] if other == 1 else joints.a[q]) == body:
                i, j = 3 * one, 3 * other
                moved = measured[p, i] * measured[q, j] + measured[p, i + 1] * measured[q, j + 1]
                turned = measured[p, i + 2] * measured[q, j + 2]
                total += inverse.mass[body] * moved + inverse.inertia[body] * turned
    return total


@always_inlined
def _response(joints: Joints, i: int, j: int, inverse: Inverse) -> float:
    """Return how a unit impulse of row j changes the speed of row i: an element of A."""
    total, p = 0.0, i
    while p >= 0:
        q = j
        while q >= 0:
            total += _common(joints, p, q, inverse)
            q = joints.second[j] if q == j else -1
        p = joints.second[i] if p == i else -1
    return total


@inlined
def factorise(joints: Joints, first: int, end: int, inverse: Inverse, softness: float) -> None:
    """Factorise A of the active rows of a block, from place ``first`` to before ``end``.

    A row that depends on those before it gets a spring of its own, ``softness`` times its diagonal.
    """
    matrix, low, start, measured = joints.matrix, joints.low, joints.start, joints.measured
    for k in range(first, end):
        i, row = joints.order[k], joints.start[k] - joints.low[k]
        measured[i, GIVES] = 0.0
        if measured[i, STATE] == OFF:
            for n in range(low[k], k + 1):
                matrix[row + n] = 0.0
            continue
        for n in range(low[k], k + 1):
            column = start[n] - low[n]
            diagonal = _response(joints, i, joints.order[n], inverse)
            left = diagonal
            for between in range(max(low[k], low[n]), n):
                left -= matrix[row + between] * matrix[column + between]
            if n < k:
                pivot = matrix[column + n]
                matrix[row + n] = left / pivot if pivot > 0.0 else 0.0
                continue
            measured[i, DIAGONAL] = diagonal
            if left <= _DEPENDENT * diagonal:
                measured[i, GIVES] = softness * diagonal
                left = max(left, 0.0) + softness * diagonal
            matrix[row + k] = math.sqrt(left)


@inlined
def substitute(joints: Joints, first: int, end: int) -> None:
    """Turn the changes of speeds that are wanted into those of impulses: L L^T x = b, in place."""
    matrix, measured = joints.matrix, joints.measured
    for k in range(first, end):
        i, row = joints.order[k], joints.start[k] - joints.low[k]
        left, pivot = measured[i, CHANGE], matrix[row + k]
        for n in range(joints.low[k], k):
            left -= matrix[row + n] * measured[joints.order[n], CHANGE]
        measured[i, CHANGE] = left / pivot if pivot > 0.0 else 0.0
    for back in range(end - first):
        k = end - 1 - back
        i, row = joints.order[k], joints.start[k] - joints.low[k]
        pivot = matrix[row + k]
        solved = measured[i, CHANGE] / pivot if pivot > 0.0 else 0.0
        measured[i, CHANGE] = solved
        for n in range(joints.low[k], k):
            measured[joints.order[n], CHANGE] -= matrix[row + n] * solved


@always_inlined
def can_move(joints: Joints, i: int, inverse: Inverse) -> bool:
    """Whether a row acts on any body that moves: not on fixed ones alone, or such as sleep."""
    total, k = 0.0, i
    while k >= 0:
        total += inverse.mass[joints.a[k]] + inverse.mass[joints.b[k]]
        k = joints.second[i] if k == i else -1
    return total > 0.0
