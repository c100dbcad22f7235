"""Sums that keep what rounding leaves out."""

from physicslab.kernels import inlined_exactly

__all__ = ["add"]


@inlined_exactly
def add(value: float, low: float, change: float) -> tuple[float, float]:
    """Return ``value + low + change`` as a number and the remainder that it cannot hold.

    Exact whatever the magnitudes (Knuth, The Art of Computer Programming 2, 1998, 4.2.2, theorem B).
    """
    change += low
    total = value + change
    part = total - value
    return total, (value - (total - part)) + (change - part)
