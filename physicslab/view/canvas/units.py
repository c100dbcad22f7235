"""Units of slopes and areas: products and quotients of units, in words."""

from __future__ import annotations

from collections import Counter

__all__ = ["product", "quotient", "written_unit"]

_NAMES = {"J/s": "W", "kg m/s^2": "N", "kg m^2/s^2": "N m", "N m/s": "W", "N s/kg": "m/s", "N/kg": "m/s^2"}
"""Shorter names."""
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def product(unit: str, other: str) -> str:
    """Return the unit of the area under a line.

    >>> product("m/s", "s"), product("N", "s"), product("N", "m"), product("m/s^2", "s")
    ('m', 'N s', 'J', 'm/s')
    """
    if {unit, other} == {"N", "m"}:
        return "J"  # the work of a force; a torque is no area
    return _written(unit, other, 1)


def quotient(unit: str, other: str) -> str:
    """Return the unit of a slope.

    >>> quotient("m", "s"), quotient("m/s", "s"), quotient("J", "s"), quotient("kg m/s", "s")
    ('m/s', 'm/s^2', 'W', 'N')
    >>> quotient("kg m^2/s", "s"), quotient("m/s", "m"), quotient("rad", "rad/s")
    ('N m', '1/s', 's')
    """
    return _written(unit, other, -1)


def written_unit(unit: str) -> str:
    """Return a unit as people write it.

    >>> written_unit("kg m^2/s"), written_unit("1")
    ('kg m²/s', '')
    """
    parts = unit.split("^")
    raised = [part[:1].translate(_SUPERSCRIPTS) + part[1:] for part in parts[1:]]
    return "" if unit == "1" else "".join((parts[0], *raised))


def _powers(unit: str) -> Counter[str]:
    """Return the power of each part of a unit: ``"kg m^2/s"`` has kg 1, m 2, s -1."""
    above, _, below = unit.partition("/")
    powers: Counter[str] = Counter()
    for words, sign in ((above, 1), (below, -1)):
        for word in words.split():
            name, _, power = word.partition("^")
            if name != "1":
                powers[name] += sign * int(power or 1)
    return powers


def _written(unit: str, other: str, sign: int) -> str:
    """Return a unit times another, or over it for a ``sign`` of -1."""
    powers = _powers(unit)
    for name, power in _powers(other).items():
        powers[name] += sign * power
    above = " ".join(_raised(name, power) for name, power in powers.items() if power > 0)
    below = " ".join(_raised(name, -power) for name, power in powers.items() if power < 0)
    words = f"{above or '1'}/{below}" if below else above or "1"
    return _NAMES.get(words, words)


def _raised(name: str, power: int) -> str:
    return name if power == 1 else f"{name}^{power}"
