"""Short numbers that stand for many: whether columns hold the same bits."""

from physicslab.kernels import Rows, inlined, kernel

__all__ = ["digest_motion"]

_FACTOR = 0x2545F4914F6CDD1D
"""Odd, and without a pattern: each word's bits reach the upper bits of the product."""


@inlined
def _mixed(value: int, word: int) -> int:
    """Return a number that depends on each bit of both."""
    mixed = (value ^ word) * _FACTOR
    return mixed ^ (mixed >> 29)


@inlined
def _digest(words: Rows) -> int:
    """Return 32 bits that depend on each bit of the words, and on their order.

    Four numbers take turns: a processor multiplies the next while the last is on its way.
    """
    one, two, three, four = 1, 2, 3, 4
    n = len(words)
    for i in range(0, n - 3, 4):
        one, two = _mixed(one, words[i]), _mixed(two, words[i + 1])
        three, four = _mixed(three, words[i + 2]), _mixed(four, words[i + 3])
    for i in range(n - n % 4, n):
        one = _mixed(one, words[i])
    mixed = _mixed(_mixed(one, two), _mixed(three, four))
    return (mixed ^ (mixed >> 32)) & 0xFFFFFFFF


@kernel
def digest_motion(position: Rows, angle: Rows, linear: Rows, angular: Rows) -> tuple[int, int, int, int]:
    """Return 32 bits for each of four columns, whose numbers are given as the integers of their bits."""
    return _digest(position), _digest(angle), _digest(linear), _digest(angular)
