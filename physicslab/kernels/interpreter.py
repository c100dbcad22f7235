"""Runs kernels as the plain Python that they are written in, until they are compiled or for a debugger.

Every kernel has a twin: the same code, in which every kernel and inner function that it calls is a twin too,
literals are np.float64, and what Python has not is stood in for (:mod:`physicslab.kernels.stand_ins`). Each
operation is rounded as in compiled code, so both give the same bits, but for what ``@inlined_loosely`` sums
in whatever order is fastest: gravity of more bodies than :data:`physicslab.kernels.forces.gravity.FEW`.

With the environment variable ``PHYSICSLAB_INTERPRET=1`` nothing is compiled, and breakpoints in kernels hold;
:func:`interpreted` does the same within a ``with`` block.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from types import FunctionType
from typing import Any

import numpy as np
from numba import types
from numba.core.extending import _Intrinsic
from numba.extending import is_jitted
from numba.np.numpy_support import as_dtype

from physicslab import kernels
from physicslab.kernels.stand_ins import Records, arithmetic, math_functions, stand_in_of

__all__ = ["compile_all_the_same", "entry_of", "interpreted", "is_forced", "stand_in", "twin_of"]

_VECTORS = "physicslab.kernels.wide.interpreted"
"""Where the stand-ins of vectors are: they are imported when the first kernel is interpreted."""

_forced = os.environ.get("PHYSICSLAB_INTERPRET", "0") not in ("", "0")


def is_forced() -> bool:
    """Whether kernels are to be interpreted, be they compiled or not."""
    return _forced


def compile_all_the_same() -> None:
    """Let kernels be compiled in this process whatever the environment says: it is there for that."""
    global _forced
    _forced = False


def stand_in(jitted: Any) -> None:
    """Let a kernel's twin run wherever it is called, until it is compiled.

    The kernel's whole tree is Python then, and native code once :func:`physicslab.kernels.load` has loaded
    it; a call that is under way ends as it began. It costs a compiled kernel nothing.

    Parameters
    ----------
    jitted : kernel
        One that is not compiled; of one that is, nothing changes.
    """
    if _is_dispatcher(jitted):
        # What numba's dispatcher calls where no compiled signature fits; it then calls what is returned.
        entry = entry_of(jitted)
        jitted._compile_for_args = lambda *arguments: entry
    else:
        jitted.stand_in()


@contextmanager
def interpreted() -> Iterator[None]:
    """Let every kernel that is called within a ``with`` block run as Python: a debugger can step into it.

    Kernels that are compiled are set aside, and are there again at the end.

    Examples
    --------
    >>> from physicslab import load_scene
    >>> with interpreted():
    ...     load_scene("drop").step()
    """
    global _forced
    before, _forced = _forced, True
    aside = {jitted: dict(jitted.overloads) for jitted in kernels.KERNELS if jitted.compiled}
    for jitted in aside:
        _set_aside(jitted)
    for jitted in kernels.KERNELS:
        stand_in(jitted)
    try:
        yield
    finally:
        _forced = before
        for jitted, overloads in aside.items():
            _take_back(jitted, overloads)


def _is_dispatcher(value: Any) -> bool:
    """Whether something is what numba makes of a function, and not a force that is called by its address."""
    return bool(is_jitted(value))


def _set_aside(jitted: Any) -> None:
    """Let a kernel have no compiled code."""
    jitted.compiled = False
    jitted.overloads.clear()
    if _is_dispatcher(jitted):
        jitted._reset_overloads()
        jitted._can_compile = True


def _take_back(jitted: Any, overloads: dict[Any, Any]) -> None:
    """Let a kernel have its compiled code again."""
    for arguments, code in overloads.items():
        if _is_dispatcher(jitted):
            jitted.add_overload(code)
        else:
            jitted.overloads[arguments] = code
    jitted.disable_compile()
    jitted.compiled = True


# ---- twins -------------------------------------------------------------------------------------------------


@cache
def twin_of(jitted: Any) -> Callable[..., Any]:
    """Return a kernel, or an inner function, as plain Python that calls nothing compiled.

    It takes what kernels give each other: records as :class:`physicslab.kernels.stand_ins.Records`, numbers
    as np.float64, eight numbers as an array (8,); warnings of NumPy's are the caller's to silence.
    """
    import_module(_VECTORS)
    function = jitted.py_func
    code = function.__code__
    constants = tuple(_of_float64(constant) for constant in code.co_consts)
    names = _names_of(function.__globals__)
    return FunctionType(
        code.replace(co_consts=constants),
        names,
        function.__name__,
        function.__defaults__,
        function.__closure__,
    )


_modules: dict[int, dict[str, Any]] = {}
"""What the twins of each module know, by where the module's own names are."""


def _names_of(module: dict[str, Any]) -> dict[str, Any]:
    """Return the names of a module as its functions' twins know them."""
    names = _modules.get(id(module))
    if names is None:
        names = _modules[id(module)] = {**module, **arithmetic}
        for name, value in module.items():
            names[name] = _counterpart(value)
    return names


def _counterpart(value: Any) -> Any:
    """Return what a twin sees in place of something that a kernel knows by name."""
    if value is math:
        return math_functions
    if _is_dispatcher(value):
        return twin_of(value)
    if isinstance(value, _Intrinsic):
        return stand_in_of(value)
    return _of_float64(value)


def _of_float64(value: Any) -> Any:
    """Return a constant with np.float64 in place of every float: unlike that it divides by zero."""
    if type(value) is float:
        return np.float64(value)
    if type(value) is tuple:
        return tuple(_of_float64(part) for part in value)
    return value


# ---- from Python into a twin and back ----------------------------------------------------------------------


@cache
def entry_of(jitted: Any) -> Callable[..., Any]:
    """Return what Python calls in place of a kernel: its twin, among values of Python's."""
    signature = jitted.declared_signature
    ways_in = [_way_in(kind) for kind in signature.args]
    way_out = _way_out(signature.return_type)

    def enter(*arguments: Any) -> Any:
        try:
            taken = [take(argument) for take, argument in zip(ways_in, arguments, strict=True)]
        except (TypeError, ValueError) as error:
            raise TypeError(f"No matching definition of {jitted.__name__}: {error}") from error
        with np.errstate(all="ignore"):
            return way_out(twin_of(jitted)(*taken))

    return enter


def _way_in(kind: Any) -> Callable[[Any], Any]:
    """Return what makes of an argument what a twin takes, and refuses what is of another type."""
    if isinstance(kind, types.Array):
        return _way_of_arrays(kind)
    if isinstance(kind, types.BaseTuple):
        ways = [_way_in(part) for part in _parts(kind)]
        return lambda parts: tuple([take(part) for take, part in zip(ways, parts, strict=True)])
    if isinstance(kind, types.Float):
        return _checked(float, np.float64)
    if isinstance(kind, types.Boolean):
        return _checked((bool, np.bool_), bool)
    return _checked((int, np.integer), int)


def _parts(kind: Any) -> tuple[Any, ...]:
    return tuple(kind)


def _checked(allowed: Any, make: Callable[[Any], Any]) -> Callable[[Any], Any]:
    def take(number: Any) -> Any:
        if not isinstance(number, allowed):
            raise TypeError(f"{number!r} is no {make.__name__}")
        return make(number)

    return take


def _way_of_arrays(kind: Any) -> Callable[[Any], Any]:
    """Return what lets arrays of one type pass, those of records as :class:`Records`."""
    dtype, dimensions = as_dtype(kind.dtype), kind.ndim
    wrap = Records if dtype.names else None

    def take(array: Any) -> Any:
        right = isinstance(array, np.ndarray) and array.dtype == dtype and array.ndim == dimensions
        if not right or not array.flags.c_contiguous:
            raise TypeError(f"an array is no {kind}")
        return array if wrap is None else wrap(array)

    return take


def _way_out(kind: Any) -> Callable[[Any], Any]:
    """Return what makes of a twin's answer what the compiled kernel returns."""
    if isinstance(kind, types.BaseTuple):
        ways = [_way_out(part) for part in _parts(kind)]
        return lambda parts: tuple([give(part) for give, part in zip(ways, parts, strict=True)])
    if isinstance(kind, types.NoneType):
        return lambda _: None
    return float if isinstance(kind, types.Float) else bool if isinstance(kind, types.Boolean) else int
