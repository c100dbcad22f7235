"""Numbers with units, as people read them."""

from __future__ import annotations

import math

from physicslab.ecs.vector import Vector2

__all__ = [
    "ROUNDING", "length_of", "percentage", "power_of_ten", "quantity", "round_quantity", "vector_quantity",
    "without_rounding",
]  # fmt: skip

ROUNDING = 1e-12
"""Share of what a number is a part of below which it is rounding."""
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def power_of_ten(power: int) -> str:
    """Return a power of ten as people write it.

    >>> power_of_ten(-2), power_of_ten(-12)
    ('0.01', '10⁻¹²')
    """
    return f"{10.0**power:g}" if -2 <= power <= 3 else f"10{str(power).translate(_RAISED)}"


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


def without_rounding(value: float, scale: float) -> float:
    """Return a number, and none where it is rounding beside others as large as ``scale``.

    >>> without_rounding(3e-16, 2.0), without_rounding(3e-9, 2.0)
    (0.0, 3e-09)
    """
    return value if not abs(value) <= ROUNDING * scale or math.isinf(scale) else 0.0


def round_quantity(value: float, unit: str) -> str:
    """Return a number of one or two figures, as scales have, and its SI unit.

    >>> round_quantity(0.2, "N s")
    '0.2 N s'
    >>> round_quantity(5e-5, "N s")
    '5·10⁻⁵ N s'
    >>> round_quantity(-9.6e-10, "J"), round_quantity(0.0, "m")
    ('-1·10⁻⁹ J', '0 m')
    """
    if value == 0.0:
        return f"0 {unit}"
    power = math.floor(math.log10(abs(value) * (1.0 + 1e-12)))
    if -3 <= power <= 5:
        return f"{value:.{max(-power, 0)}f} {unit}"
    digits, _, exponent = f"{value:.0e}".partition("e")
    return f"{digits}·10{str(int(exponent)).translate(_RAISED)} {unit}"


def vector_quantity(value: Vector2, unit: str) -> str:
    """Return a vector to three figures of its larger component, and its SI unit.

    >>> vector_quantity(Vector2(9.0, -0.25), "kg m/s")
    '(9.00, -0.25) kg m/s'
    >>> vector_quantity(Vector2(1.5e-9, 0.0), "kg m/s")
    '(1.50, 0.00)·10⁻⁹ kg m/s'
    """
    largest = max(abs(value.x), abs(value.y))
    if not math.isfinite(largest):
        return f"not finite, {unit}"
    if largest == 0.0:
        return f"(0, 0) {unit}"
    power = math.floor(math.log10(largest))
    plain = -2 <= power <= 3
    scale, decimals = (1.0, min(max(2 - power, 0), 4)) if plain else (10.0**power, 2)
    x, y = (f"{component / scale + 0.0:.{decimals}f}" for component in value)
    factor = "" if plain else f"·10{str(power).translate(_RAISED)}"
    return f"({x}, {y}){factor} {unit}"


def percentage(share: float) -> str:
    """Return a share to three figures, in percent.

    >>> percentage(0.01234), percentage(2.5e-13), percentage(0.0)
    ('1.23 %', '2.50·10⁻¹¹ %', '0 %')
    """
    if not math.isfinite(share):
        return "not finite"
    if share == 0.0:
        return "0 %"
    percent = 100.0 * share
    power = math.floor(math.log10(abs(percent)))
    if -3 <= power <= 4:
        return f"{percent:.{min(max(2 - power, 0), 5)}f} %"
    digits, _, exponent = f"{percent:.2e}".partition("e")
    return f"{digits}·10{str(int(exponent)).translate(_RAISED)} %"


def length_of(metres: float) -> str:
    """Return a round length.

    >>> length_of(0.5), length_of(2000.0), length_of(5e-6)
    ('0.5 m', '2000 m', '5·10⁻⁶ m')
    """
    if 1e-3 <= metres < 1e5:
        return f"{metres:g} m"
    digits, _, exponent = f"{metres:.0e}".partition("e")
    return f"{digits}·10{str(int(exponent)).translate(_RAISED)} m"
