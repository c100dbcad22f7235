"""Runs kernels as the plain Python that they are written in, until they are compiled or for a debugger.

Every kernel has a fallback: the same code, in which all that it calls is a fallback too, literals are
np.float64, and what Python has not has its equivalent (:mod:`physicslab.kernels.python_equivalents`). Each
operation is rounded as in compiled code, so both give the same bits, but for what ``@inlined_loosely`` sums
in any order: gravity of more bodies than :data:`physicslab.kernels.forces.inverse_square.PLAIN_LIMIT`.

With the environment variable ``PHYSICSLAB_INTERPRET=1`` nothing is compiled, and breakpoints in kernels hold;
:func:`interpreted` does the same within a ``with`` block.
"""

import math
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

import numpy as np
from numba import types
from numba.extending import is_jitted
from numba.np.numpy_support import as_dtype
from numpy.typing import NDArray

from physicslab.kernels import compiler, loading
from physicslab.kernels.python_equivalents import Records
from physicslab.kernels.python_fallback import Overdue, patience
from physicslab.kernels.python_fallback import fallback_of as fallback_of
from physicslab.kernels.records import IMPACT

_forced = os.environ.get("PHYSICSLAB_INTERPRET", "0") not in ("", "0")


def is_forced() -> bool:
    """Whether kernels are to be interpreted, be they compiled or not."""
    return _forced


def limit(seconds: Callable[[Any], float], compile_now: Callable[[Any], None]) -> None:
    """Let no kernel be interpreted for much longer than so many seconds at a time, until :func:`unlimited`.

    One that is gets back what its arguments held, ``compile_now`` is called with it and must load it, and it
    is called again: so a method that chooses its steps, or a thousand impacts within one, stop no window.

    Parameters
    ----------
    seconds : callable
        Called with a kernel before each call of it; returns how long that may take [s].
    compile_now : callable
        Called with a kernel that may not be interpreted, or not for as long as its call takes.
    """
    global _limit, _compile_now
    _limit, _compile_now = seconds, compile_now
    _spent.clear()


def unlimited() -> None:
    """Let every kernel that is interpreted run for as long as it takes."""
    limit(_endlessly, _load)


def spent_on(jitted: Any) -> float:
    """Return the processor time [s] for which a kernel has been interpreted since :func:`limit`."""
    return _spent.get(jitted, 0.0)


def spent() -> float:
    """Return the processor time [s] for which kernels have been interpreted since :func:`limit`."""
    return sum(_spent.values())


def _endlessly(_: Any) -> float:
    """Return the longest time: where nothing is limited."""
    return math.inf


def _load(jitted: Any) -> None:
    """Load a kernel that has been interpreted for too long, where nothing else is to be done about it."""
    loading.load(jitted)


_limit: Callable[[Any], float] = _endlessly
_compile_now: Callable[[Any], None] = _load
_spent: dict[Any, float] = {}
"""How long [s] each kernel has been interpreted."""


def compile_all_the_same() -> None:
    """Let kernels be compiled in this process whatever the environment says: it is there for that."""
    global _forced
    _forced = False


def install(jitted: Any) -> None:
    """Let a kernel's fallback run wherever it is called, until it is compiled.

    The kernel's whole tree is Python then, and native code once :func:`physicslab.kernels.load` has loaded
    it; a call that is under way ends as it began. It costs a compiled kernel nothing.

    Parameters
    ----------
    jitted : kernel
        One that is not compiled; of one that is, nothing changes.
    """
    if _is_dispatcher(jitted):
        # numba's dispatcher calls this where no compiled signature fits, and then calls its result.
        entry = entry_of(jitted)
        jitted._compile_for_args = lambda *arguments: entry
    else:
        jitted.is_fallback = True


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
    aside = {jitted: dict(jitted.overloads) for jitted in compiler.KERNELS if jitted.compiled}
    for jitted in aside:
        _set_aside(jitted)
    for jitted in compiler.KERNELS:
        install(jitted)
    try:
        yield
    finally:
        _forced = before
        for jitted in compiler.KERNELS:
            uninstall(jitted)
        for jitted, overloads in aside.items():
            _take_back(jitted, overloads)


def _is_dispatcher(value: Any) -> bool:
    """Whether something is what numba makes of a function, and not a force that is called by its address."""
    return bool(is_jitted(value))


def uninstall(jitted: Any) -> None:
    """Let a kernel be compiled where it is called, as it was before :func:`install`."""
    if _is_dispatcher(jitted):
        loading.at_first_call(jitted)
    else:
        jitted.is_fallback = False


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


def prepare() -> None:
    """Make the fallbacks of all kernels there are, which the first that is called would else wait for."""
    for jitted in compiler.KERNELS:
        fallback_of(jitted)


@cache
def entry_of(jitted: Any) -> Callable[..., Any]:
    """Return what Python calls in place of a kernel: its fallback, among values of Python's."""
    signature = jitted.declared_signature
    ways_in = [_way_in(kind) for kind in signature.args]
    way_out = _way_out(signature.return_type)

    def enter(*arguments: Any) -> Any:
        try:
            taken = [take(argument) for take, argument in zip(ways_in, arguments, strict=True)]
        except (TypeError, ValueError) as error:
            raise TypeError(f"No matching definition of {jitted.__name__}: {error}") from error
        with np.errstate(all="ignore"):
            if _limit is _endlessly or _forced:
                return way_out(fallback_of(jitted)(*taken))
            if (longest := _limit(jitted)) > 0.0:
                kept = [(array, array.copy()) for array in _arrays(arguments)]
                try:
                    return way_out(_in_time(jitted, taken, longest))
                except Overdue:
                    for array, copy in kept:
                        array[...] = copy
        _compile_now(jitted)
        return jitted(*arguments)

    return enter


def _in_time(jitted: Any, taken: list[Any], longest: float) -> Any:
    """Call a kernel's fallback, which raises Overdue if that takes longer than it may; note what it took."""
    fallback, start = fallback_of(jitted), time.thread_time()
    before, patience.until = patience.until, time.perf_counter() + longest
    try:
        return fallback(*taken)
    finally:
        patience.until = before
        _spent[jitted] = spent_on(jitted) + time.thread_time() - start


def _arrays(arguments: tuple[Any, ...]) -> Iterator[NDArray[Any]]:
    """Yield the arrays that kernels read among arguments, and within tuples of them.

    Impacts are only written, by a call that is made once more in the same places: to copy their table took
    longer than a step.
    """
    for argument in arguments:
        if isinstance(argument, np.ndarray):
            if argument.dtype is not IMPACT:
                yield argument
        elif isinstance(argument, tuple):
            yield from _arrays(argument)


def _way_in(kind: Any) -> Callable[[Any], Any]:
    """Return what makes of an argument what a fallback takes, and refuses what is of another type."""
    if isinstance(kind, types.Array):
        return _way_of_arrays(kind)
    if isinstance(kind, types.BaseTuple):
        ways, make = [_way_in(part) for part in _parts(kind)], _maker(kind)
        return lambda parts: make([take(part) for take, part in zip(ways, parts, strict=True)])
    if isinstance(kind, types.Float):
        return _checked(float, np.float64)
    if isinstance(kind, types.Boolean):
        return _checked((bool, np.bool_), bool)
    return _checked((int, np.integer), int)


def _parts(kind: Any) -> tuple[Any, ...]:
    return tuple(kind)


def _maker(kind: Any) -> Callable[[list[Any]], Any]:
    """Return what makes a tuple of a type, with names where it has them."""
    named = getattr(kind, "instance_class", None)
    return tuple if named is None else named._make


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
    """Return what makes of a fallback's answer what the compiled kernel returns."""
    if isinstance(kind, types.BaseTuple):
        ways, make = [_way_out(part) for part in _parts(kind)], _maker(kind)
        return lambda parts: make([give(part) for give, part in zip(ways, parts, strict=True)])
    if isinstance(kind, types.NoneType):
        return lambda _: None
    return float if isinstance(kind, types.Float) else bool if isinstance(kind, types.Boolean) else int
