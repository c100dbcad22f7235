"""Numbers as people write them into a field: ``2*pi/3``, ``30 deg``, ``5 km/h``, ``1e3 g``."""

import ast
import math
import operator
import re
import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

from physicslab.ecs.text import printable, shortened
from physicslab.ecs.vector import Vector2

type Dimension = tuple[int, ...]
"""Powers of metre, kilogram, second and coulomb; an angle has none."""

_SHOWN_LIMIT = 40
_POWER_LIMIT = 1000.0
"""Larger powers are refused: they would take for ever, and mean nothing."""
_DEPTH_LIMIT = 200
"""Longer texts are refused."""


class InvalidText(ValueError):
    """A text is no number with a unit; the message is one line that shows what is wrong."""


@dataclass(frozen=True, slots=True)
class _Quantity:
    """A value, the powers of its unit, and whether a unit is named: what a function returns has none."""

    value: float
    dimension: Dimension = (0, 0, 0, 0)
    has_unit: bool = False


_L, _M, _T, _Q, _ONE = (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1), (0, 0, 0, 0)
_V, _N, _J, _W = (1, 0, -1, 0), (1, 1, -2, 0), (2, 1, -2, 0), (2, 1, -3, 0)
_PA, _HZ, _VOLT, _TESLA = (-1, 1, -2, 0), (0, 0, -1, 0), (2, 1, -2, -1), (0, 1, -1, -1)
_UNITS: dict[str, _Quantity] = {
    name: _Quantity(value, dimension, has_unit=True)
    for value, dimension, names in (
        (1.0, _L, "m"), (1e3, _L, "km"), (0.1, _L, "dm"), (1e-2, _L, "cm"), (1e-3, _L, "mm"),
        (1e-6, _L, "um µm"), (1e-9, _L, "nm"), (0.0254, _L, "inch"), (0.3048, _L, "ft foot"),
        (0.9144, _L, "yd"), (1609.344, _L, "mile mi"), (149597870700.0, _L, "au"),
        (1.0, _M, "kg"), (1e-3, _M, "g"), (1e-6, _M, "mg"), (1e3, _M, "t"), (0.45359237, _M, "lb"),
        (1.0, _T, "s"), (1e-3, _T, "ms"), (1e-6, _T, "us µs"), (60.0, _T, "min"), (3600.0, _T, "h"),
        (86400.0, _T, "day d"),
        (1.0, _ONE, "rad"), (math.pi / 180.0, _ONE, "deg °"), (2.0 * math.pi, _ONE, "turn rev"),
        (0.01, _ONE, "percent"),
        (1.0, _HZ, "Hz"), (1e3, _HZ, "kHz"), (2.0 * math.pi / 60.0, _HZ, "rpm"),
        (1.0 / 3.6, _V, "kmh kph"), (0.44704, _V, "mph"), (1852.0 / 3600.0, _V, "knot kn"),
        (1.0, _N, "N"), (1e3, _N, "kN"), (1e-3, _N, "mN"),
        (1.0, _J, "J"), (1e3, _J, "kJ"), (1e-3, _J, "mJ"), (3.6e6, _J, "kWh"),
        (1.0, _Q, "C"), (1e-3, _Q, "mC"), (1e-6, _Q, "uC µC"), (1e-9, _Q, "nC"), (1.0, _VOLT, "V"),
        (1e3, _VOLT, "kV"), (1.0, _TESLA, "T"), (1e-3, _TESLA, "mT"),
        (1.0, _W, "W"), (1e3, _W, "kW"), (1.0, _PA, "Pa"), (1e3, _PA, "kPa"), (1e5, _PA, "bar"),
    )
    for name in names.split()
}  # fmt: skip
"""The units there are, in SI."""
_CONSTANTS = {"pi": _Quantity(math.pi), "π": _Quantity(math.pi), "e": _Quantity(math.e)}
_FUNCTIONS: dict[str, Callable[[float], float]] = {
    "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "tan": math.tan,
    "asin": math.asin, "acos": math.acos, "atan": math.atan, "exp": math.exp, "log": math.log, "abs": abs,
}  # fmt: skip
_SUPERSCRIPTS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
_SIGNS = {0x2212: "-", 0xD7: "*"}
"""The signs of print for minus and times."""
_GLUED = re.compile(r"(?<![\w.])(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?|\))\s*(?=[A-Za-zµ°π(])")
_UNCLEAR = (
    (re.compile(r"(?<![\w.,])[1-9]\d{0,2}(?:,\d{3})+(?![\d,])"), "may be thousands or a decimal comma: "
     "write it without the comma, or with a point"),
    (re.compile(r"(?<![\w.])(?:\d+[.,]?\d*|[.,]\d+)[eE](?![\w+-])"), "has an exponent without digits; "
     "2.718... times a number is 2*e"),
)  # fmt: skip
"""Texts that can be read as different numbers."""
_SPACED = re.compile(r"(?<=[A-Za-zµ°π0-9)])[ ·]+(?=[A-Za-zµ°π(])")

_PAIR = re.compile(r"\s*\[(?P<x>[^],]+),(?P<y>[^],]+)\](?P<unit>[^][]*)")
_POINTS = re.compile(r"\s*\[(?P<points>\s*(?:\[[^][]*\]\s*,?\s*)*)\](?P<unit>[^][]*)")


def evaluate(text: str, unit: str = "1") -> float:
    """Return the number that a text stands for, in an SI unit.

    A number without a unit is taken to be in ``unit``. A comma between digits is a decimal point; where it
    could be one between thousands, as in ``1,000``, it is refused.

    Parameters
    ----------
    text : str
        Numbers, units, ``+ - * / ^ ( )``, ``pi``, ``sqrt``, ``sin`` and the like.
    unit : str
        What the result is in, as a field has it: ``"kg m^2"``, ``"m/s"``; ``"1"`` for a pure number.

    Raises
    ------
    InvalidText
        If it is no number, has another dimension than ``unit``, or is not finite.

    Examples
    --------
    >>> evaluate("36 km/h", "m/s"), evaluate("180 deg", "rad"), evaluate("1e3 g", "kg"), evaluate("2,5", "m")
    (10.0, 3.141592653589793, 1.0, 2.5)
    >>> evaluate("1 + 1.5*sin(30 deg)", "m")
    1.75
    >>> evaluate("3 kg", "m")
    Traceback (most recent call last):
        ...
    physicslab.ecs.quantity_text.InvalidText: '3 kg' is in kg; this is in m
    """
    shown = shortened(printable(text.strip()), _SHOWN_LIMIT)
    if not shown:
        raise InvalidText("a number is needed")
    if len(text) > _DEPTH_LIMIT:
        raise InvalidText(f"'{shown}' is too long")
    for pattern, why in _UNCLEAR:
        if pattern.search(text):
            raise InvalidText(f"'{shown}' {why}")
    found = _evaluated(text, shown)
    wanted = _evaluated(unit, unit) if unit not in ("", "1") else _Quantity(1.0)
    if not found.has_unit:
        value = found.value
    elif found.dimension == wanted.dimension:
        value = found.value / wanted.value
    else:
        raise InvalidText(
            f"'{shown}' is in {_in_words(found.dimension)}; this is in {unit if unit != '1' else 'no unit'}"
        )
    if not math.isfinite(value):
        raise InvalidText(f"'{shown}' is not finite")
    return value


def evaluate_pair(text: str, unit: str = "1") -> tuple[float, float]:
    """Return two numbers in an SI unit; a unit behind the brackets is that of both.

    >>> evaluate_pair("[1 + 1, 3] cm", "m"), evaluate_pair("[20 mm, 0.5]", "m")
    ((0.02, 0.03), (0.02, 0.5))
    """
    pair = _PAIR.fullmatch(text)
    if pair is None:
        raise InvalidText(f"'{shortened(printable(text.strip()), _SHOWN_LIMIT)}' is no pair")
    own = pair["unit"].strip()
    x, y = (evaluate(f"({part.strip()}) {own}" if own else part, unit) for part in (pair["x"], pair["y"]))
    return x, y


def evaluate_points(text: str, unit: str = "1") -> list[tuple[float, float]]:
    """Return a list of pairs of numbers in an SI unit; a unit behind the brackets is that of all.

    >>> evaluate_points("[[0, 0], [3, 0], [0, 1/2]] cm", "m")
    [(0.0, 0.0), (0.03, 0.0), (0.0, 0.005)]
    """
    points = _POINTS.fullmatch(text)
    if points is None:
        shown = shortened(printable(text.strip()), _SHOWN_LIMIT)
        raise InvalidText(f"'{shown}' is no list of points [[x, y], ...]")
    own = points["unit"]
    return [evaluate_pair(f"[{one}]{own}", unit) for one in re.findall(r"\[([^][]*)\]", points["points"])]


def points_text(points: Iterable[Vector2]) -> str:
    """Return points as :func:`evaluate_points` takes them, to all figures.

    >>> points_text([Vector2(0.5, -1.0), Vector2(0.1, 2.0)])
    '[[0.5, -1], [0.1, 2]]'
    """
    return repr([[int(x) if x == round(x) and abs(x) < 1e15 else x for x in point] for point in points])


def _evaluated(text: str, shown: str) -> _Quantity:
    prepared = re.sub(r"(?<=\d),(?=\d)", ".", text.strip())
    prepared = re.sub(r"[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+", lambda found: f"^{found.group().translate(_SUPERSCRIPTS)}", prepared)
    prepared = prepared.replace("°", " deg").replace("%", " percent").translate(_SIGNS)
    prepared = _SPACED.sub("*", _GLUED.sub(r"\1*", prepared)).replace("^", "**").replace("·", "*")
    prepared = re.sub(r"\b(\d+\.?\d*|\.\d+)\*[eE](?=[+-]?\d)", r"\1e", prepared)
    try:
        with warnings.catch_warnings(action="ignore"):  # of strange literals, for programmers
            tree = ast.parse(prepared, mode="eval")
        return _value(tree.body, shown)
    except (SyntaxError, RecursionError, MemoryError, ValueError) as error:
        if isinstance(error, InvalidText):
            raise
        raise InvalidText(f"'{shown}' is no number") from None
    except (OverflowError, ZeroDivisionError):
        raise InvalidText(f"'{shown}' is not finite") from None


def _value(node: ast.expr, shown: str) -> _Quantity:
    match node:
        case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
            return _Quantity(float(number))
        case ast.Name(id=name):
            return _named(name, shown)
        case ast.UnaryOp(op=ast.USub() | ast.UAdd() as sign, operand=operand):
            inner = _value(operand, shown)
            return replace(inner, value=-inner.value if isinstance(sign, ast.USub) else inner.value)
        case ast.BinOp(left=left, op=kind, right=right):
            return _combined(kind, _value(left, shown), _value(right, shown), shown)
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in _FUNCTIONS:
            inner = _value(argument, shown)
            if inner.dimension != _ONE:
                raise InvalidText(f"{name} takes a pure number, not one in {_in_words(inner.dimension)}")
            return _Quantity(float(_FUNCTIONS[name](inner.value)))
    raise InvalidText(f"'{shown}' is no number")


def _named(name: str, shown: str) -> _Quantity:
    found = _CONSTANTS.get(name) or _UNITS.get(name)
    if found is None:
        raise InvalidText(f"'{name}' is no unit that is known: m, kg, s, km/h, deg, N, J, ...")
    return found


def _combined(kind: ast.operator, left: _Quantity, right: _Quantity, shown: str) -> _Quantity:
    has_unit = left.has_unit or right.has_unit
    match kind:
        case ast.Mult() | ast.Div():
            sign = 1 if isinstance(kind, ast.Mult) else -1
            deed = operator.mul if sign == 1 else operator.truediv
            powers = tuple(p + sign * q for p, q in zip(left.dimension, right.dimension, strict=True))
            return _Quantity(deed(left.value, right.value), powers, has_unit)
        case ast.Add() | ast.Sub():
            if left.dimension != right.dimension:
                words = f"{_in_words(left.dimension)} and {_in_words(right.dimension)}"
                raise InvalidText(f"'{shown}': {words} cannot be added")
            deed = operator.add if isinstance(kind, ast.Add) else operator.sub
            return _Quantity(deed(left.value, right.value), left.dimension, has_unit)
        case ast.Pow() if right.dimension == _ONE and abs(right.value) <= _POWER_LIMIT:
            raised_to = [p * right.value for p in left.dimension]
            if not all(power.is_integer() for power in raised_to):
                raise InvalidText(f"'{shown}': a unit to a broken power")
            raised = left.value**right.value
            if isinstance(raised, complex):
                raise InvalidText(f"'{shown}' is no real number")
            return _Quantity(raised, tuple(map(int, raised_to)), has_unit)
    raise InvalidText(f"'{shown}' is no number")


def _in_words(dimension: Dimension) -> str:
    if dimension == _ONE:
        return "no unit"
    parts = [
        name if power == 1 else f"{name}^{power}"
        for name, power in zip(("m", "kg", "s", "C"), dimension, strict=True)
        if power
    ]
    return " ".join(parts)
