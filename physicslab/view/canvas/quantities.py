"""Numbers with units, as people read them; units of slopes and areas."""

import math
import re
from collections import Counter

from physicslab.ecs.quantity_text import is_known
from physicslab.ecs.vector import Vector2

ROUNDING = 1e-12
"""Share of what a number is a part of below which it is rounding."""
_LEAST_ERROR, _PLAIN = 1e-12, 3
"""Share of a value from which its error is written, and powers of ten that need no exponent."""
_LARGE, _DECIMALS = 1e6, 7
"""Coordinates from so many metres on, or with more decimals, are written with a power of ten."""
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_OF_TEN = re.compile(r"(?<![\w.,])(\d[\d.,]*)e(-?)\+?0*(\d+)(?= ([^\W\d_]+|[%°]))")
"""A power of ten, and the word behind it."""


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
    return f"{_figures(value, 3)} {unit}"


def _figures(value: float, behind: int, *, last: int = 5, most: int = 4, slack: float = 0.0) -> str:
    """Return a number with so many figures ``behind`` its first one, from 10^``last`` on as a power of ten.

    There are at most so many decimals; a number below a power of ten by a share of ``slack`` has that power.
    """
    if value == 0.0:
        return "0"
    power = math.floor(math.log10(abs(value) * (1.0 + slack)))
    if -3 <= power <= last:
        return f"{value:.{min(max(behind - power, 0), most)}f}"
    digits, _, exponent = f"{value:.{behind}e}".partition("e")
    return f"{digits}·10{str(int(exponent)).translate(_RAISED)}"


def with_powers(text: str) -> str:
    """Return a text with powers of ten as people write them, but for numbers without unit, as in settings.

    >>> with_powers("deepest overlap 1.1e-05 m, 2e+07 J"), with_powers("simulation.dt = 1e-05")
    ('deepest overlap 1.1·10⁻⁵ m, 2·10⁷ J', 'simulation.dt = 1e-05')
    >>> with_powers("box2e3 and 2e3 ball have 3e-07 µm, 1e5 N/m")
    'box2e3 and 2e3 ball have 3·10⁻⁷ µm, 1·10⁵ N/m'
    """

    def written(found: re.Match[str]) -> str:
        is_quantity = found[4] == "%" or is_known(found[4])
        return f"{found[1]}·10{(found[2] + found[3]).translate(_RAISED)}" if is_quantity else found[0]

    return _OF_TEN.sub(written, text)


def without_turns(degrees: float) -> float:
    """Return an angle without the whole turns in it [deg]; one of up to half a turn as it is.

    >>> without_turns(-180.0), without_turns(370.0), without_turns(-1048.5)
    (-180.0, 10.0, 31.5)
    """
    return degrees if abs(degrees) <= 180.0 else math.remainder(degrees, 360.0)


def without_rounding(value: float, scale: float) -> float:
    """Return a number, and none where it is rounding beside others as large as ``scale``.

    >>> without_rounding(3e-16, 2.0), without_rounding(3e-9, 2.0)
    (0.0, 3e-09)
    """
    return value if not abs(value) <= ROUNDING * scale or math.isinf(scale) else 0.0


def vector_without_rounding(value: Vector2, scale: float) -> Vector2:
    """Return a vector, each component of which is zero where it is rounding beside ``scale``.

    >>> vector_without_rounding(Vector2(2.0, -3e-16), 2.0)
    Vector2(x=2.0, y=0.0)
    """
    return Vector2(*(without_rounding(part, scale) for part in value))


def rounded_up(at_least: float, slack: float = 0.0) -> float:
    """Return the smallest 1, 2 or 5 times a power of ten that is at least so large, but for a share.

    >>> rounded_up(0.03), rounded_up(7.0), rounded_up(5.001, 1e-3)
    (0.05, 10.0, 5.0)
    """
    power = 10.0 ** math.floor(math.log10(at_least))
    return next(k * power for k in (1.0, 2.0, 5.0, 10.0) if k * power >= at_least * (1.0 - slack))


def round_quantity(value: float, unit: str) -> str:
    """Return a number of one or two figures, as scales have, and its SI unit.

    >>> round_quantity(0.2, "N s")
    '0.2 N s'
    >>> round_quantity(5e-5, "N s")
    '5·10⁻⁵ N s'
    >>> round_quantity(-9.6e-10, "J"), round_quantity(0.0, "m")
    ('-1·10⁻⁹ J', '0 m')
    """
    return f"{_figures(value, 0, slack=1e-12)} {unit}"


def coordinate(value: float, step: float) -> str:
    """Return one of numbers that lie a step apart, with the digits that neighbours differ by.

    >>> coordinate(-0.0, 2.0), coordinate(6.44, 0.04), coordinate(-1e6, 1e6), coordinate(1234567.2, 0.4)
    ('0', '6.44', '-1·10⁶', '1.2345672·10⁶')
    """
    decimals = max(-math.floor(math.log10(step) + 1e-9), 0)
    if value == 0.0 and decimals > _DECIMALS:
        return "0"
    if abs(value) < _LARGE and decimals <= _DECIMALS:
        return f"{value + 0.0:.{decimals}f}"
    behind = max(math.floor(math.log10(abs(value))) - math.floor(math.log10(step) + 1e-9), 0)
    digits, _, exponent = f"{value:.{behind}e}".partition("e")
    return f"{digits}·10{str(int(exponent)).translate(_RAISED)}"


def vector_quantity(value: Vector2, unit: str) -> str:
    """Return a vector to three figures of its larger component, and its SI unit.

    >>> vector_quantity(Vector2(9.0, -0.25), "kg m/s")
    '(9.00, -0.25) kg m/s'
    >>> vector_quantity(Vector2(1.5e-9, 0.0), "kg m/s")
    '(1.50, 0.00)·10⁻⁹ kg m/s'
    >>> vector_quantity(Vector2(-0.001, -103.0), "kg m/s")
    '(0, -103) kg m/s'
    """
    largest = max(abs(value.x), abs(value.y))
    if not math.isfinite(largest):
        return f"not finite, {unit}"
    if largest == 0.0:
        return f"(0, 0) {unit}"
    power = math.floor(math.log10(largest))
    plain = -2 <= power <= 3
    scale, decimals = (1.0, min(max(2 - power, 0), 4)) if plain else (10.0**power, 2)
    x, y = (f"{component / scale:z.{decimals}f}" for component in value)
    factor = "" if plain else f"·10{str(power).translate(_RAISED)}"
    return f"({x}, {y}){factor} {unit}"


def percentage(share: float) -> str:
    """Return a share to three figures, in percent.

    >>> percentage(0.01234), percentage(2.5e-13), percentage(0.0)
    ('1.23 %', '2.50·10⁻¹¹ %', '0 %')
    """
    if not math.isfinite(share):
        return "not finite"
    return f"{_figures(100.0 * share, 2, last=4, most=5)} %"


_NAMES = {"J/s": "W", "kg m/s^2": "N", "kg m^2/s^2": "N m", "N m/s": "W", "N s/kg": "m/s", "N/kg": "m/s^2"}
"""Shorter names."""


def product(unit: str, other: str) -> str:
    """Return the unit of the area under a line.

    >>> product("m/s", "s"), product("N", "s"), product("N", "m"), product("m/s^2", "s")
    ('m', 'N s', 'J', 'm/s')
    """
    if {unit, other} == {"N", "m"}:
        return "J"  # the work of a force; a torque is no area
    return _written(unit, other, 1)


def with_error(value: float, error: float, unit: str) -> str:
    """Return a number with its standard error, to two figures of that, and its unit.

    >>> with_error(9.8123, 0.0214, "m/s²"), with_error(2.0, 0.0, "s"), with_error(31400.0, 260.0, "m")
    ('(9.812 ± 0.021) m/s²', '2.000 s', '(31400 ± 260) m')
    """
    if not _LEAST_ERROR * abs(value) < error < math.inf:
        return quantity(value, unit).rstrip()
    places = 1 - math.floor(math.log10(error))
    size = math.floor(math.log10(max(abs(value), error)))
    power = size if not -_PLAIN <= size <= _PLAIN + 2 else 0
    shown = max(places + power, 0)
    both = f"{value / 10.0**power:.{shown}f} ± {error / 10.0**power:.{shown}f}"
    raised = f"·10{str(power).translate(_RAISED)}" if power else ""
    return f"({both}){raised} {unit}".rstrip()


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

    >>> written_unit("kg m^2/s"), written_unit("1"), written_unit("deg")
    ('kg m²/s', '', '°')
    """
    if unit == "deg":
        return "°"
    parts = unit.split("^")
    raised = [part[:1].translate(_RAISED) + part[1:] for part in parts[1:]]
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
