"""The matrix of joints A = J M^-1 J^T, factorised within its envelope: a chain costs as much as it has links.

In each of its rows the envelope begins at the first row that acts on a body of it, in the order of
:mod:`physicslab.state.ordering`. Rows that depend on those before them, as those of two equal pins, or of a
four-bar linkage that lies flat, get no force: the motion is the same.
"""

import math
from typing import Any

from physicslab.kernels import always_inlined
from physicslab.kernels.joints import layout as L

_DEPENDENT = 1e-12
"""Share of its diagonal below which a pivot is rounding: the row depends on those before it."""
_SMALL = 1e-4
"""Share of its diagonal below which a pivot is looked at again, with bodies of equal masses."""
_FLAT = 1e-8
"""Share of its diagonal below which a pivot with equal masses is that of a linkage which lies flat: its angle
is then below 1e-4, and an error of 1e-16 m in a place one of 1e-8 m/s in a speed. The row gives way there."""


@always_inlined
def _response(numbers: Any, whole: Any, i: int, j: int, even: bool) -> float:
    """Return how a unit force of row j accelerates row i [1/kg]: an element of A; if ``even``, for 1 kg."""
    total, states = 0.0, L.first_state(whole)
    for one in range(L.ENDS):
        x, turn = whole[L.FIRST + L.PLACES * i + 2 * one], whole[L.FIRST + L.PLACES * i + 2 * one + 1]
        if x < 0:
            break
        mass, inertia = L.inverse_of(numbers, whole, x), L.inverse_of(numbers, whole, turn)
        if mass == 0.0 and inertia == 0.0:
            continue
        if even and mass > 0.0:
            mass, inertia = 1.0, inertia / mass
        p = states + L.STATE * i + 3 * one
        for other in range(L.ENDS):
            if whole[L.FIRST + L.PLACES * j + 2 * other] == x:
                k = states + L.STATE * j + 3 * other
                total += mass * (numbers[p] * numbers[k] + numbers[p + 1] * numbers[k + 1])
                total += inertia * numbers[p + 2] * numbers[k + 2]
    return total


@always_inlined
def _factor(numbers: Any, whole: Any, even: bool, yielding: bool) -> float:
    """Write A, unless ``even``, and its factor; return the smallest pivot of any row by its diagonal.

    With ``even`` masses each row takes that share of its own as ``SHARE``; where rows are ``yielding``, those
    of small shares give way.
    """
    n, states, matrix = whole[L.ROWS], L.first_state(whole), L.first_entry(whole)
    factor, rank, smallest = matrix + whole[L.ENTRIES], 0, 1.0
    for i in range(n):
        begin = whole[L.FIRST + L.PLACES * i + L.BEGIN]
        row = whole[L.FIRST + L.PLACES * i + L.AT] - begin
        for j in range(begin, i + 1):
            left = _response(numbers, whole, i, j, even)
            if not even:
                numbers[matrix + row + j] = left
            own, first = left, whole[L.FIRST + L.PLACES * j + L.BEGIN]
            other = whole[L.FIRST + L.PLACES * j + L.AT] - first
            for k in range(max(begin, first), j):
                left -= numbers[factor + row + k] * numbers[factor + other + k]
            if j < i:
                pivot = numbers[factor + other + j]
                numbers[factor + row + j] = left / pivot if pivot > 0.0 else 0.0
                continue
            share = left / own if own > 0.0 else 0.0
            smallest = min(smallest, share)
            if even:
                numbers[states + L.STATE * i + L.SHARE] = share
            elif yielding:
                share = numbers[states + L.STATE * i + L.SHARE]
                flat = _FLAT / share if share > _DEPENDENT else 0.0
                left *= 1.0 + flat * flat if flat > 0.0 else 0.0
            if share > _DEPENDENT and left > 0.0:
                numbers[factor + row + i] = math.sqrt(left)
                rank += 1
            else:
                numbers[factor + row + i] = 0.0
    whole[L.RANK] = rank
    return smallest


@always_inlined
def factorise(numbers: Any, whole: Any) -> None:
    """Write A and its factor L, A = L L^T, from the beginning of each row to the diagonal.

    Pivots are small where light bodies are between heavy ones, which is no reason to leave out a row, and
    where a linkage is about to lie flat, so that it could go on in two ways. Masses tell which it is.
    """
    if _factor(numbers, whole, False, False) < _SMALL:
        _factor(numbers, whole, True, False)
        _factor(numbers, whole, False, True)


@always_inlined
def substitute(numbers: Any, whole: Any) -> None:
    """Find how the forces change from the right side; none for a dependent row."""
    n, states, factor = whole[L.ROWS], L.first_state(whole), L.first_entry(whole) + whole[L.ENTRIES]
    for i in range(n):
        begin = whole[L.FIRST + L.PLACES * i + L.BEGIN]
        row = factor + whole[L.FIRST + L.PLACES * i + L.AT] - begin
        left, pivot = numbers[states + L.STATE * i + L.RIGHT], numbers[row + i]
        for k in range(begin, i):
            left -= numbers[row + k] * numbers[states + L.STATE * k + L.CHANGE]
        numbers[states + L.STATE * i + L.CHANGE] = left / pivot if pivot > 0.0 else 0.0
    for down in range(n):
        i = n - 1 - down
        begin = whole[L.FIRST + L.PLACES * i + L.BEGIN]
        row = factor + whole[L.FIRST + L.PLACES * i + L.AT] - begin
        pivot = numbers[row + i]
        solved = numbers[states + L.STATE * i + L.CHANGE] / pivot if pivot > 0.0 else 0.0
        numbers[states + L.STATE * i + L.CHANGE] = solved
        for k in range(begin, i):
            numbers[states + L.STATE * k + L.CHANGE] -= numbers[row + k] * solved


@always_inlined
def solve(numbers: Any, whole: Any) -> None:
    """Find the forces of all rows from the right side, which is used up; refined once.

    A light body between heavy ones gets the difference of large forces.
    """
    n, states, matrix = whole[L.ROWS], L.first_state(whole), L.first_entry(whole)
    substitute(numbers, whole)
    for i in range(n):
        begin, s = whole[L.FIRST + L.PLACES * i + L.BEGIN], states + L.STATE * i
        row = matrix + whole[L.FIRST + L.PLACES * i + L.AT] - begin
        numbers[s + L.LAMBDA] = numbers[s + L.CHANGE]
        numbers[s + L.RIGHT] -= numbers[row + i] * numbers[s + L.CHANGE]
        for j in range(begin, i):
            numbers[s + L.RIGHT] -= numbers[row + j] * numbers[states + L.STATE * j + L.CHANGE]
            numbers[states + L.STATE * j + L.RIGHT] -= numbers[row + j] * numbers[s + L.CHANGE]
    substitute(numbers, whole)
    for i in range(n):
        numbers[states + L.STATE * i + L.LAMBDA] += numbers[states + L.STATE * i + L.CHANGE]
