"""Sums that keep what rounding leaves out, and arithmetic with twice the digits."""

import math

from physicslab.kernels import inlined

type Pair = tuple[float, float]
"""A number and the remainder that it cannot hold: twice the digits."""


@inlined
def add(value: float, low: float, change: float) -> tuple[float, float]:
    """Return ``value + low + change`` as a number and the remainder that it cannot hold.

    Exact whatever the magnitudes (Knuth, The Art of Computer Programming 2, 1998, 4.2.2, theorem B).
    """
    change += low
    total = value + change
    part = total - value
    return total, (value - (total - part)) + (change - part)


@inlined
def add_pair(value: float, low: float, change: float, change_low: float) -> tuple[float, float]:
    """Return the sum of two numbers with remainders as a number and its remainder, to twice the digits.

    Dekker, A floating-point technique for extending the available precision, Numer. Math. 18, 1971.
    """
    total = value + change
    part = total - value
    rest = ((value - (total - part)) + (change - part)) + (low + change_low)
    summed = total + rest
    return summed, rest - (summed - total)


@inlined
def multiply(x: float, y: float) -> tuple[float, float]:
    """Return a product as a number and what rounding leaves out (Dekker, 1971); for factors below 1e150."""
    product = x * y
    split_x, split_y = 134217729.0 * x, 134217729.0 * y  # 2^27 + 1 halves the digits
    high_x, high_y = split_x - (split_x - x), split_y - (split_y - y)
    low_x, low_y = x - high_x, y - high_y
    rest = ((high_x * high_y - product) + high_x * low_y + low_x * high_y) + low_x * low_y
    return product, rest


@inlined
def plus(a: Pair, b: Pair) -> Pair:
    """Return a sum to twice the digits of the larger term."""
    return add_pair(a[0], a[1], b[0], b[1])


@inlined
def times(a: Pair, b: Pair) -> Pair:
    """Return a product to twice the digits."""
    high, low = multiply(a[0], b[0])
    low += a[0] * b[1] + a[1] * b[0]
    total = high + low
    return total, low - (total - high)


@inlined
def scaled(a: Pair, factor: float) -> Pair:
    """Return a number by a power of two, which is exact."""
    return a[0] * factor, a[1] * factor


@inlined
def over(a: Pair, b: Pair) -> Pair:
    """Return a quotient to twice the digits."""
    share = a[0] / b[0]
    high, low = times(b, (share, 0.0))
    rest = ((a[0] - high) - low + a[1]) / b[0]
    total = share + rest
    return total, rest - (total - share)


@inlined
def root(a: Pair) -> Pair:
    """Return the square root of a number above 0 to twice the digits."""
    found = math.sqrt(a[0])
    high, low = multiply(found, found)
    rest = 0.5 * ((a[0] - high) - low + a[1]) / found
    total = found + rest
    return total, rest - (total - found)
