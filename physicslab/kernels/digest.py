"""Short numbers that stand for many: whether columns hold the same bits."""

import numpy as np

from physicslab.kernels import Rows, inlined, kernel

_FACTOR = 0x2545F4914F6CDD1D
"""Odd, and without a pattern: each word's bits reach the upper bits of the product."""


@inlined
def _mixed(value: int, word: int) -> int:
    """Return a number that depends on each bit of both."""
    mixed = (np.int64(value) ^ np.int64(word)) * _FACTOR  # or plain Python has no overflow
    return mixed ^ (mixed >> 29)  # type: ignore[return-value]


@inlined
def _joined(one: int, two: int, three: int, four: int) -> int:
    """Return 32 bits that depend on each bit of four numbers."""
    mixed = _mixed(_mixed(one, two), _mixed(three, four))
    return (mixed ^ (mixed >> 32)) & 0xFFFFFFFF


@inlined
def _digest_two(words: Rows, others: Rows) -> tuple[int, int]:
    """Return 32 bits for each of two columns of one length, which depend on each bit and on their order.

    Four numbers of each take turns: a processor multiplies the others while one is on its way. Indices have
    no sign, so that none is tested for counting from the end: that would take as long again.
    """
    a, b, c, d = 1, 2, 3, 4
    e, f, g, h = 1, 2, 3, 4
    n = len(words)
    for k in range(n // 4):
        i = np.uint64(4 * k)
        j, o, m = i + np.uint64(1), i + np.uint64(2), i + np.uint64(3)
        a, e = _mixed(a, words[i]), _mixed(e, others[i])
        b, f = _mixed(b, words[j]), _mixed(f, others[j])
        c, g = _mixed(c, words[o]), _mixed(g, others[o])
        d, h = _mixed(d, words[m]), _mixed(h, others[m])
    for k in range(n - n % 4, n):
        a, e = _mixed(a, words[k]), _mixed(e, others[k])
    return _joined(a, b, c, d), _joined(e, f, g, h)


@kernel
def digest_motion(position: Rows, angle: Rows, linear: Rows, angular: Rows) -> tuple[int, int, int, int]:
    """Return 32 bits for each of four columns, whose numbers are given as the integers of their bits.

    Columns of two numbers a body are as long as each other, and so are those of one.
    """
    first, third = _digest_two(position, linear)
    second, fourth = _digest_two(angle, angular)
    return first, second, third, fourth


@inlined
def _weighed(words: Rows) -> int:
    """Return a sum of numbers by their places, which a processor makes eight at a time."""
    total = 0
    for i in range(len(words)):
        total += words[i] * (2 * i + 1)
    return total


@kernel
def digest_sums(
    position: Rows, angle: Rows, linear: Rows, angular: Rows, mass: Rows, inertia: Rows, inverse_mass: Rows,
    inverse_inertia: Rows,
) -> int:  # fmt: skip
    """Return one number that a change of any of eight columns changes, given as the integers of their bits.

    Different changes may cancel; it takes a fifth of the time of :func:`digest_motion`.
    """
    motion = _weighed(position) + 3 * _weighed(angle) + 5 * _weighed(linear) + 7 * _weighed(angular)
    own = _weighed(mass) + 3 * _weighed(inertia) + 5 * _weighed(inverse_mass) + 7 * _weighed(inverse_inertia)
    return motion + 11 * own
