"""Conditions of lessons: comparisons of quantities, as ``th < 5 deg and drag = 0``."""

import ast
import math
import operator
import re
from collections.abc import Callable, Iterator

from physicslab.ecs.quantity_text import Expression, InvalidText, Quantity, Scope, same_dimension

_OUTSIDE = r'(?=[^"]*(?:"[^"]*"[^"]*)*$)'
"""Follows what is in no name in quotes."""
_EQUAL = 1e-9
"""Share by which two quantities may differ that are called equal."""
_SIGNS: dict[type[ast.cmpop], Callable[[float, float], bool]] = {
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge,
    ast.Eq: lambda a, b: math.isclose(a, b, rel_tol=_EQUAL),
    ast.NotEq: lambda a, b: not math.isclose(a, b, rel_tol=_EQUAL),
}  # fmt: skip


class Condition:
    """One or more comparisons that all have to hold; ``always`` is none.

    Raises
    ------
    InvalidText
        If a text is no condition.
    """

    __slots__ = ("_parts", "text")

    def __init__(self, text: str) -> None:
        self.text = text
        given = [] if text.strip() == "always" else re.split(rf"\s+and\s+{_OUTSIDE}", text)
        self._parts = [comparison(_python(part)) for part in given]

    def holds(self, scope: Scope) -> bool:
        """Whether all of them hold."""
        return all(_SIGNS[kind](*_values(left, right, scope)) for left, kind, right in self._parts)

    def margin(self, scope: Scope) -> float:
        """Return by how much they hold, of the one that holds least; negative where one does not [SI]."""
        return min((difference(part, scope) for part in self._parts), default=math.inf)

    def names(self) -> Iterator[str]:
        """Yield what they refer to."""
        for left, _, right in self._parts:
            yield from left.names()
            yield from right.names()


type Comparison = tuple[Expression, type[ast.cmpop], Expression]


def comparison(whole: Expression) -> Comparison:
    """Return the two sides of a comparison and its sign."""
    node = whole.node
    if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _SIGNS:
        left, right = (Expression(whole.text, side) for side in (node.left, node.comparators[0]))
        return left, type(node.ops[0]), right
    raise InvalidText(f"'{whole.text}' is no condition: two quantities with <, >, <=, >=, = or !=")


def difference(compared: Comparison, scope: Scope) -> float:
    """Return by how much an inequality holds [SI]; negative where it does not."""
    left, kind, right = compared
    a, b = _values(left, right, scope)
    if kind in (ast.Eq, ast.NotEq):
        raise InvalidText(f"'{left.text}': a moment is found by < or >")
    return b - a if kind in (ast.Lt, ast.LtE) else a - b


def _values(left: Expression, right: Expression, scope: Scope) -> tuple[float, float]:
    a: Quantity = left.value(scope)
    b: Quantity = right.value(scope)
    same_dimension(a, b, left.text)
    return a.value, b.value


def _python(text: str) -> Expression:
    plain = text.replace("≤", "<=").replace("≥", ">=").replace("≠", "!=")
    return Expression(re.sub(rf"(?<![<>!=])=(?!=){_OUTSIDE}", "==", plain))
