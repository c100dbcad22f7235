"""The matrix of joints A = J M^-1 J^T, factorised within its envelope: a chain costs as much as it has links.

In each of its rows the envelope begins at the first row that acts on a body of it, in the order of
:mod:`physicslab.state.ordering`. Rows that depend on those before them, as those of two equal pins, or of a
four-bar linkage that lies flat, get no force: the motion is the same.
"""

import math
from typing import Any

from physicslab.kernels import always_inlined
from physicslab.kernels.joints.layout import (
    AT, BEGIN, CHANGE, DIAGONAL, ENDS, ENTRIES, FIRST, LAMBDA, PLACES, RANK, RIGHT, ROWS, STATE, first_entry,
    first_state, inverse_of,
)  # fmt: skip

_DEPENDENT = 1e-12
"""Share of its diagonal below which a pivot of A is rounding: the row depends on those before it."""


@always_inlined
def _response(numbers: Any, whole: Any, i: int, j: int) -> float:
    """Return how a unit force of row j accelerates row i [1/kg]: an element of A."""
    total, states = 0.0, first_state(whole)
    for one in range(ENDS):
        x, turn = whole[FIRST + PLACES * i + 2 * one], whole[FIRST + PLACES * i + 2 * one + 1]
        if x < 0:
            break
        mass, inertia = inverse_of(numbers, whole, x), inverse_of(numbers, whole, turn)
        if mass == 0.0 and inertia == 0.0:
            continue
        p = states + STATE * i + 3 * one
        for other in range(ENDS):
            if whole[FIRST + PLACES * j + 2 * other] == x:
                k = states + STATE * j + 3 * other
                total += mass * (numbers[p] * numbers[k] + numbers[p + 1] * numbers[k + 1])
                total += inertia * numbers[p + 2] * numbers[k + 2]
    return total


@always_inlined
def factorise(numbers: Any, whole: Any) -> None:
    """Write A and its factor L, A = L L^T, from the beginning of each row to the diagonal."""
    n, matrix, factor, rank = whole[ROWS], first_entry(whole), first_entry(whole) + whole[ENTRIES], 0
    for i in range(n):
        begin = whole[FIRST + PLACES * i + BEGIN]
        row = whole[FIRST + PLACES * i + AT] - begin
        for j in range(begin, i + 1):
            left = _response(numbers, whole, i, j)
            numbers[matrix + row + j] = left
            first, other = whole[FIRST + PLACES * j + BEGIN], whole[FIRST + PLACES * j + AT]
            other -= first
            for k in range(max(begin, first), j):
                left -= numbers[factor + row + k] * numbers[factor + other + k]
            if j < i:
                pivot = numbers[factor + other + j]
                numbers[factor + row + j] = left / pivot if pivot > 0.0 else 0.0
            elif left > _DEPENDENT * numbers[matrix + row + i]:
                numbers[factor + row + i] = math.sqrt(left)
                rank += 1
            else:
                numbers[factor + row + i] = 0.0
    whole[RANK] = rank


@always_inlined
def substitute(numbers: Any, whole: Any) -> None:
    """Find how the forces change from the right side; none for a dependent row."""
    n, states, factor = whole[ROWS], first_state(whole), first_entry(whole) + whole[ENTRIES]
    for i in range(n):
        begin = whole[FIRST + PLACES * i + BEGIN]
        row = factor + whole[FIRST + PLACES * i + AT] - begin
        left, pivot = numbers[states + STATE * i + RIGHT], numbers[row + i]
        for k in range(begin, i):
            left -= numbers[row + k] * numbers[states + STATE * k + CHANGE]
        numbers[states + STATE * i + CHANGE] = left / pivot if pivot > 0.0 else 0.0
    for down in range(n):
        i = n - 1 - down
        begin = whole[FIRST + PLACES * i + BEGIN]
        row = factor + whole[FIRST + PLACES * i + AT] - begin
        pivot = numbers[row + i]
        solved = numbers[states + STATE * i + CHANGE] / pivot if pivot > 0.0 else 0.0
        numbers[states + STATE * i + CHANGE] = solved
        for k in range(begin, i):
            numbers[states + STATE * k + CHANGE] -= numbers[row + k] * solved


@always_inlined
def solve(numbers: Any, whole: Any) -> None:
    """Find the forces of all rows from the right side, which is used up; refined once.

    What is light between heavy bodies gets the difference of large forces.
    """
    n, states, matrix = whole[ROWS], first_state(whole), first_entry(whole)
    substitute(numbers, whole)
    for i in range(n):
        begin, s = whole[FIRST + PLACES * i + BEGIN], states + STATE * i
        row = matrix + whole[FIRST + PLACES * i + AT] - begin
        numbers[s + LAMBDA] = numbers[s + CHANGE]
        numbers[s + RIGHT] -= numbers[row + i] * numbers[s + CHANGE]
        for j in range(begin, i):
            numbers[s + RIGHT] -= numbers[row + j] * numbers[states + STATE * j + CHANGE]
            numbers[states + STATE * j + RIGHT] -= numbers[row + j] * numbers[s + CHANGE]
    substitute(numbers, whole)
    for i in range(n):
        numbers[states + STATE * i + LAMBDA] += numbers[states + STATE * i + CHANGE]
