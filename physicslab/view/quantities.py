"""Numbers with units, as people read them."""

from __future__ import annotations

import math

__all__ = ["quantity"]

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def quantity(value: float, unit: str) -> str:
    """Return a number to four figures, and its SI unit.

    >>> quantity(12.3456, "J")
    '12.35 J'
    >>> quantity(0.0, "kg m/s")
    '0 kg m/s'
    >>> quantity(-2.5e-7, "J")
    '-2.500·10⁻⁷ J'
    """
    if not math.isfinite(value):
        return f"not finite, {unit}"
    if value == 0.0:
        return f"0 {unit}"
    power = math.floor(math.log10(abs(value)))
    if -3 <= power <= 5:
        return f"{value:.{min(max(3 - power, 0), 4)}f} {unit}"
    digits, _, exponent = f"{value:.3e}".partition("e")
    return f"{digits}·10{str(int(exponent)).translate(_RAISED)} {unit}"
