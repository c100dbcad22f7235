"""The types of what kernels compute, each found once.

numba finds the type of every ``a * b`` by going through all that ``*`` could mean, arrays and dates included.
"""

from typing import Any

from numba.core import types as _types
from numba.core.typeinfer import TypeInferer

types: Any = _types  # its type hints know few of the classes
_SIMPLE = (types.Number, types.Boolean)
_found: dict[tuple[int, tuple[Any, ...]], tuple[Any, Any]] = {}


def signature_of_call(context: Any, function: Any, arguments: tuple[Any, ...]) -> Any:
    """Return the signature by which one of numba's functions is called with arguments of some types."""
    key = id(function), arguments
    if key not in _found:
        _found[key] = function, function.get_call_type(context, arguments, {})  # so that no other has its id
    return _found[key][1]


def _is_simple(kind: Any) -> bool:
    """Whether a type is that of a number, of several, or of an array."""
    if isinstance(kind, types.BaseTuple):
        return all(isinstance(part, _SIMPLE) for part in kind.types)
    return isinstance(kind, _SIMPLE) or type(kind) is types.Array


class KernelInferer(TypeInferer):  # type: ignore[misc]
    """Finds the types of all variables of a function."""

    def resolve_call(self, fnty: Any, pos_args: Any, kw_args: Any) -> Any:
        """Return the signature of a call."""
        arguments = tuple(pos_args)
        if isinstance(fnty, types.Function) and not kw_args and all(map(_is_simple, arguments)):
            return signature_of_call(self.context, fnty, arguments)
        return super().resolve_call(fnty, pos_args, kw_args)
