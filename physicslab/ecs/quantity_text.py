"""Numbers as people write them into a field: ``2*pi/3``, ``30 deg``, ``5 km/h``, ``1e3 g``."""

import ast
import math
import operator
import re
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Protocol

from physicslab.ecs.text import printable, shortened

type Dimension = tuple[int, ...]
"""Powers of metre, kilogram, second and coulomb; an angle has none."""

_SHOWN_LIMIT = 40
_POWER_LIMIT = 1000.0
"""Larger powers are refused: they would take for ever, and mean nothing."""
_DEPTH_LIMIT = 200
"""Longer texts are refused."""


class InvalidText(ValueError):
    """A text is no number with a unit; the message is one line that shows what is wrong."""


class Undefined(InvalidText):
    """An expression stands for no number where its names have the values that they have."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """A value in SI, the powers of its unit, and whether a unit is named: a pure number fits any."""

    value: float
    dimension: Dimension = (0, 0, 0, 0)
    has_unit: bool = False


_L, _M, _T, _Q, _ONE = (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1), (0, 0, 0, 0)
_V, _N, _J, _W = (1, 0, -1, 0), (1, 1, -2, 0), (2, 1, -2, 0), (2, 1, -3, 0)
_PA, _HZ, _VOLT, _TESLA = (-1, 1, -2, 0), (0, 0, -1, 0), (2, 1, -2, -1), (0, 1, -1, -1)
_UNITS: dict[str, Quantity] = {
    name: Quantity(value, dimension, has_unit=True)
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
_CONSTANTS = {"pi": Quantity(math.pi), "π": Quantity(math.pi), "e": Quantity(math.e)}
_FUNCTIONS: dict[str, Callable[[float], float]] = {
    "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "tan": math.tan,
    "asin": math.asin, "acos": math.acos, "atan": math.atan, "exp": math.exp, "log": math.log, "abs": abs,
    "tanh": math.tanh, "floor": math.floor,
}  # fmt: skip
_OF_TWO: dict[str, Callable[[float, float], float]] = {
    "min": min, "max": max, "agm": lambda a, b: _arithmetic_geometric_mean(a, b),
}  # fmt: skip
"""Functions of two quantities of one dimension, which their value has."""
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
_QUOTED = re.compile(r'"((?:[^"]|"")*)"')
"""A name that is no plain word, as ``"box 2"`` in ``"box 2".y``; quotation marks within it are doubled."""


def evaluate(text: str, unit: str = "1") -> float:
    """Return the number that a text stands for, in an SI unit.

    A number without a unit is taken to be in ``unit``. A comma between digits is a decimal point; where it
    could be one between thousands, as in ``1,000``, it is refused.

    Parameters
    ----------
    text : str
        Numbers, units, ``+ - * / ^ ( )``, ``pi``, ``sqrt``, ``sin`` and the like.
    unit : str
        Unit of the result, as a field has it: ``"kg m^2"``, ``"m/s"``; ``"1"`` for a pure number.

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
    return in_unit(Expression(text).value(), unit, text)


def in_unit(found: Quantity, unit: str, text: str) -> float:
    """Return the value in an SI unit of what a text stands for, as :func:`evaluate` does."""
    shown = shown_in(text)
    wanted = Expression(unit).value() if unit not in ("", "1") else Quantity(1.0)
    if not found.has_unit:
        value = found.value
    elif found.dimension == wanted.dimension:
        value = found.value / wanted.value
    else:
        raise InvalidText(
            f"'{shown}' is in {in_words(found.dimension)}; this is in {unit if unit != '1' else 'no unit'}"
        )
    if not math.isfinite(value):
        raise InvalidText(f"'{shown}' is not finite")
    return value


def factor_of(unit: str) -> float:
    """Return how many SI units a unit is; ``"1"`` is that of a pure number.

    Raises
    ------
    InvalidText
        If it is no unit, or not above zero.

    >>> factor_of("cm"), factor_of("1")
    (0.01, 1.0)
    """
    factor = Expression(unit).value().value
    if not factor > 0.0:
        raise InvalidText(f"'{shown_in(unit)}' is no unit: must be above zero")
    return factor


class Scope(Protocol):
    """Names that an expression may refer to beside units, constants and functions of numbers."""

    def named(self, name: str) -> Quantity | None:
        """Return what a name stands for, as ``th`` or ``ball.x``; ``None`` for a name of no such thing."""

    def called(self, name: str, arguments: list[ast.expr], whole: "Expression") -> Quantity | None:
        """Return the value of a function of expressions; ``None`` where there is no such function."""


class Expression:
    """A text like ``v0^2 sin(2 th)/gravity``, read once and evaluated for any values of its names.

    Parameters
    ----------
    text : str
        As :func:`evaluate` takes it, with names and functions of a :class:`Scope`.
    node : ast.expr, optional
        The part of the text that it is; all of it where absent.

    Raises
    ------
    InvalidText
        If it is no expression.
    """

    __slots__ = ("node", "text")

    def __init__(self, text: str, node: ast.expr | None = None) -> None:
        self.text = text
        self.node = _parsed(text) if node is None else node

    def value(self, scope: Scope | None = None) -> Quantity:
        """Return what it stands for, or raise :class:`InvalidText`."""
        try:
            found = self._value(self.node, scope)
            if math.isinf(found.value):
                raise OverflowError
            return found
        except (OverflowError, ZeroDivisionError):
            raise Undefined(f"'{shown_in(self.text)}' is not finite") from None
        except ValueError as error:
            no_number = Undefined(f"'{shown_in(self.text)}' is no number")
            raise error if isinstance(error, InvalidText) else no_number from None

    def names(self) -> Iterator[str]:
        """Yield what it refers to that is neither a unit nor a constant: ``th``, ``ball.x``, ``period``."""
        inner: set[ast.AST] = set()
        for node in ast.walk(self.node):
            if isinstance(node, ast.Attribute):
                inner.add(node.value)
            if isinstance(node, ast.Name | ast.Attribute) and node not in inner:
                name = dotted(node)
                if not name:
                    raise self._no_number()
                if not is_known(name):
                    yield name

    def _no_number(self) -> InvalidText:
        return InvalidText(f"'{shown_in(self.text)}' is no number")

    def _value(self, node: ast.expr, scope: Scope | None) -> Quantity:
        match node:
            case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
                return Quantity(float(number))
            case ast.Name() | ast.Attribute():
                return self._named(dotted(node), scope)
            case ast.UnaryOp(op=ast.USub() | ast.UAdd() as sign, operand=operand):
                inner = self._value(operand, scope)
                return replace(inner, value=-inner.value if isinstance(sign, ast.USub) else inner.value)
            case ast.BinOp(left=left, op=kind, right=right):
                return _combined(
                    kind, self._value(left, scope), self._value(right, scope), shown_in(self.text)
                )
            case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
                return self._called(name, arguments, scope)
        raise self._no_number()

    def _called(self, name: str, arguments: list[ast.expr], scope: Scope | None) -> Quantity:
        found = None if scope is None else scope.called(name, arguments, self)
        if found is not None:
            return found
        if name in _OF_TWO and len(arguments) == 2:
            first, second = (self._value(argument, scope) for argument in arguments)
            same_dimension(first, second, self.text)
            value = _OF_TWO[name](first.value, second.value)
            return replace(first if first.has_unit else second, value=value)
        if name not in _FUNCTIONS or len(arguments) != 1:
            raise self._no_number()
        inner = self._value(arguments[0], scope)
        if name == "abs":
            return replace(inner, value=abs(inner.value))
        if name == "sqrt" and not any(power % 2 for power in inner.dimension):
            return Quantity(
                math.sqrt(inner.value), tuple(power // 2 for power in inner.dimension), inner.has_unit
            )
        if inner.dimension != _ONE:
            raise InvalidText(f"{name} takes a pure number, not one in {in_words(inner.dimension)}")
        return Quantity(float(_FUNCTIONS[name](inner.value)))

    def _named(self, name: str, scope: Scope | None) -> Quantity:
        given = None if scope is None else scope.named(name)
        found = given or _CONSTANTS.get(name) or _UNITS.get(name)
        if "." in name and found is None:
            raise self._no_number()
        if name.lower() in ("inf", "infinity", "nan"):
            raise InvalidText(f"'{shown_in(self.text)}' is not finite")
        if found is None:
            raise InvalidText(f"'{name}' is no unit that is known: m, kg, s, km/h, deg, N, J, ...")
        return found


def is_known(name: str) -> bool:
    """Whether a name is a unit, a constant or a function, so that nothing else can have it."""
    return name in _UNITS or name in _CONSTANTS or name in _FUNCTIONS or name in _OF_TWO


def dotted(node: ast.expr) -> str:
    """Return a name with its parts, ``ball.x``; empty for what is none.

    >>> dotted(ast.parse("ball.x", mode="eval").body)
    'ball.x'
    """
    match node:
        case ast.Name(id=name):
            return name
        case ast.Attribute(value=inner, attr=part) if dotted(inner):
            return f"{dotted(inner)}.{part}"
    return ""


def same_dimension(first: Quantity, second: Quantity, text: str) -> None:
    """Refuse two quantities that cannot be compared; a pure number is in the unit of the other."""
    if first.has_unit and second.has_unit and first.dimension != second.dimension:
        words = f"{in_words(first.dimension)} and {in_words(second.dimension)}"
        raise InvalidText(f"'{shown_in(text)}': {words} cannot be compared")


def shown_in(text: str) -> str:
    """Return a text as messages show it."""
    return shortened(printable(text.strip()), _SHOWN_LIMIT)


def _parsed(text: str) -> ast.expr:
    """Return the tree of an expression, with the signs of Python in place of those of print."""
    shown = shown_in(text)
    if not shown:
        raise InvalidText("a number is needed")
    if len(text) > _DEPTH_LIMIT:
        raise InvalidText(f"'{shown}' is too long")
    quoted = (name.replace('""', '"') for name in _QUOTED.findall(text))
    names = {f"quoted{number}_": name for number, name in enumerate(quoted)}
    words = iter(names)
    plain = _QUOTED.sub(lambda _: next(words), text.strip())
    for pattern, why in _UNCLEAR:
        if pattern.search(plain):
            raise InvalidText(f"'{shown}' {why}")
    prepared = re.sub(r"(?<=\d),(?=\d)", ".", plain)
    prepared = re.sub(r"[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+", lambda found: f"^{found.group().translate(_SUPERSCRIPTS)}", prepared)
    prepared = prepared.replace("°", " deg").replace("%", " percent").translate(_SIGNS)
    prepared = _SPACED.sub("*", _GLUED.sub(r"\1*", prepared)).replace("^", "**").replace("·", "*")
    prepared = re.sub(r"\b(\d+\.?\d*|\.\d+)\*[eE](?=[+-]?\d)", r"\1e", prepared)
    try:
        with warnings.catch_warnings(action="ignore"):  # of strange literals, for programmers
            tree = ast.parse(prepared, mode="eval").body
    except (SyntaxError, RecursionError, MemoryError, ValueError):
        unclosed = text.count("(") - text.count(")")
        why = f': a "{")" if unclosed > 0 else "("}" is missing' if unclosed else ""
        raise InvalidText(f"'{shown}' is no number{why}") from None
    for node in ast.walk(tree):
        if isinstance(node, ast.Name):
            node.id = names.get(node.id, node.id)
    return tree


def _arithmetic_geometric_mean(a: float, b: float) -> float:
    """Return the limit of a, b = (a + b)/2, sqrt(a b), which a pendulum's period is given by."""
    for _ in range(64):  # each doubles the number of digits, unless one of them is nearly zero
        a, b = 0.5 * (a + b), math.sqrt(a * b)
    return a


def _combined(kind: ast.operator, left: Quantity, right: Quantity, shown: str) -> Quantity:
    has_unit = left.has_unit or right.has_unit
    match kind:
        case ast.Mult() | ast.Div():
            sign = 1 if isinstance(kind, ast.Mult) else -1
            combine = operator.mul if sign == 1 else operator.truediv
            powers = tuple(p + sign * q for p, q in zip(left.dimension, right.dimension, strict=True))
            return Quantity(combine(left.value, right.value), powers, has_unit)
        case ast.Add() | ast.Sub():
            if left.dimension != right.dimension:
                words = f"{in_words(left.dimension)} and {in_words(right.dimension)}"
                raise InvalidText(f"'{shown}': {words} cannot be added")
            combine = operator.add if isinstance(kind, ast.Add) else operator.sub
            return Quantity(combine(left.value, right.value), left.dimension, has_unit)
        case ast.Pow() if right.dimension == _ONE and abs(right.value) <= _POWER_LIMIT:
            raised_to = [p * right.value for p in left.dimension]
            if not all(power.is_integer() for power in raised_to):
                raise InvalidText(f"'{shown}': a unit to a broken power")
            raised = left.value**right.value
            if isinstance(raised, complex):
                raise Undefined(f"'{shown}' is no real number")
            return Quantity(raised, tuple(map(int, raised_to)), has_unit)
    raise InvalidText(f"'{shown}' is no number")


def in_words(dimension: Dimension) -> str:
    """Return a unit in words: ``"kg m/s^2"``."""
    if dimension == _ONE:
        return "no unit"
    length, mass, *others = dimension
    powers = list(zip(("kg", "m", "s", "C"), (mass, length, *others), strict=True))
    above, below = (
        " ".join(f"{one}^{abs(power)}".removesuffix("^1") for one, power in powers if sign * power > 0)
        for sign in (1, -1)
    )
    return f"{above or 1}/{f'({below})' if ' ' in below else below}" if below else above
