"""Sums that keep what rounding leaves out."""

from physicslab.kernels import Numbers, inlined, kernel


@inlined
def add(value: float, low: float, change: float) -> tuple[float, float]:
    """Return ``value + low + change`` as a number and the remainder that it cannot hold.

    Exact whatever the magnitudes (Knuth, The Art of Computer Programming 2, 1998, 4.2.2, theorem B).
    """
    change += low
    total = value + change
    part = total - value
    return total, (value - (total - part)) + (change - part)


@kernel
def add_all(value: Numbers, low: Numbers, change: Numbers) -> None:
    """Add changes (n,) to numbers (n,) with remainders (n,), in place."""
    for i in range(len(change)):
        value[i], low[i] = add(value[i], low[i], change[i])


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
