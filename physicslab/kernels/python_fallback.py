"""Kernels as plain Python: the same code, in which all that it calls is Python too."""

import math
import time
from collections.abc import Callable
from functools import cache
from importlib import import_module
from types import FunctionType, ModuleType
from typing import Any

import numpy as np
from numba.core.extending import _Intrinsic
from numba.extending import is_jitted

from physicslab.kernels.python_equivalents import Records, arithmetic, equivalent_of, math_functions

_VECTORS = "physicslab.kernels.float64x8_interpreted"
"""Where the equivalents of vectors are: they are imported when the first kernel is interpreted."""
_endless: set[Any] = set()


def endless[F: Callable[..., Any]](function: F) -> F:
    """Mark what a loop calls each time of which nothing says how often it runs.

    There the time is looked at where a kernel may not be interpreted for long; compiled code is the same.
    """
    _endless.add(function)
    return function


natives: dict[Any, Any] = {}
"""Kernels that do what an inner function does, by that function."""


def native_for[F: Callable[..., Any]](inner: Any) -> Callable[[F], F]:
    """Let fallbacks call a kernel in place of an inner function once it is loaded: the bits are the same.

    So what a scene spends most of its time in is compiled long before the whole that it is a part of.
    """

    def note(jitted: F) -> F:
        natives[inner] = jitted
        return jitted

    return note


def _native_or_fallback(inner: Any, fallback: Callable[..., Any]) -> Callable[..., Any]:
    def call(*arguments: Any) -> Any:
        native = natives[inner]
        if not native.compiled:
            return fallback(*arguments)
        return _of_float64(native(*map(_as_kernels_take, arguments)))

    return call


def _as_kernels_take(value: Any) -> Any:
    """Return an argument of a fallback as Python passes it to a kernel."""
    if isinstance(value, tuple):
        return tuple(map(_as_kernels_take, value))
    return value.array if isinstance(value, Records) else value


class Overdue(Exception):
    """A kernel is interpreted for longer than it may be."""


class _Patience:
    """Until when the kernel that is interpreted may go on, by ``time.perf_counter``."""

    until = math.inf


patience = _Patience()


@cache
def fallback_of(jitted: Any) -> Callable[..., Any]:
    """Return a kernel, or an inner function, as plain Python that calls nothing compiled.

    It takes what kernels give each other: records as
    :class:`physicslab.kernels.python_equivalents.Records`, numbers as np.float64, eight numbers as an array
    (8,); warnings of NumPy's are the caller's to silence.
    """
    import_module(_VECTORS)
    function = jitted.py_func
    code = function.__code__
    constants = tuple(_of_float64(constant) for constant in code.co_consts)
    names = _names_of(function.__globals__)
    code = code.replace(co_consts=constants)
    fallback = FunctionType(code, names, function.__name__, function.__defaults__, function.__closure__)
    return _timed(fallback) if jitted in _endless else fallback


def _timed(fallback: Callable[..., Any]) -> Callable[..., Any]:
    def call(*arguments: Any) -> Any:
        if time.perf_counter() > patience.until:
            raise Overdue
        return fallback(*arguments)

    return call


_modules: dict[int, dict[str, Any]] = {}
"""The names for the fallbacks of each module, by where the module's own names are."""


def _names_of(module: dict[str, Any]) -> dict[str, Any]:
    """Return the names of a module for the fallbacks of its functions."""
    names = _modules.get(id(module))
    if names is None:
        names = _modules[id(module)] = {**module, **arithmetic}
        for name, value in module.items():
            names[name] = _counterpart(value)
    return names


class _FallbackModule:
    """A module of kernels as its fallbacks use it."""

    def __init__(self, names: dict[str, Any]) -> None:
        self.__dict__ = names


def _counterpart(value: Any) -> Any:
    """Return what a fallback uses in place of something that a kernel refers to by name."""
    if value is math:
        return math_functions
    if isinstance(value, ModuleType) and value.__name__.startswith(f"{__package__}."):
        return _FallbackModule(_names_of(vars(value)))
    if is_jitted(value):
        fallback = fallback_of(value)
        return _native_or_fallback(value, fallback) if value in natives else fallback
    if isinstance(value, _Intrinsic):
        return equivalent_of(value)
    return _of_float64(value)


def _of_float64(value: Any) -> Any:
    """Return a constant with np.float64 in place of every float: unlike that it divides by zero."""
    if type(value) is float:
        return np.float64(value)
    if type(value) is tuple:
        return tuple(_of_float64(part) for part in value)
    return value
