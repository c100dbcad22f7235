"""When kernels are compiled, or loaded from the cache: before they run, at the latest at their first call."""

import functools
import gc
import itertools
import secrets
import sys
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, cast

from numba.core import bytecode
from numba.core.registry import cpu_target

from physicslab.kernels import cache
from physicslab.kernels.interpreter import install, is_forced

type _Ask = Callable[[Sequence[Any]], Collection[Any] | None]

_ask: _Ask | None = None
_waited_ns = 0
"""Time [ns] that was spent on kernels instead of the work that needs them."""
_waits_since = 0
"""When the wait began that is under way [ns]; 0 where none is."""


def ask_before_compiling(ask: _Ask | None) -> None:
    """Set what is called with kernels that are needed and not loaded, in place of compiling them here.

    So a window can wait for other processes, and stay awake.

    Parameters
    ----------
    ask : callable or None
        Called with kernels that are about to be called. When it returns they are compiled here, or loaded;
        but not those that it returns: they are interpreted until they are loaded.
    """
    global _ask
    _ask = ask


def asked() -> _Ask | None:
    """Return what is called with kernels that are needed and not loaded, if anything is."""
    return _ask


def seconds_waited() -> float:
    """Return how long [s] this process has spent on compiling kernels, or on loading them, so far."""
    return _waited_ns / 1e9


def working_ns() -> int:
    """Return the time [ns] of a clock that stands still while kernels are compiled or loaded."""
    return time.perf_counter_ns() - _waited_ns


@contextmanager
def _waiting() -> Iterator[None]:
    """Count the time of a ``with`` block, if it is within no other, as spent on kernels.

    Python searches for no garbage meanwhile: numba makes hundreds of thousands of objects, and few of them
    are garbage before a kernel is done. That alone saves a tenth of the time. Their search is part of it.
    """
    global _waited_ns, _waits_since
    if _waits_since:
        yield
        return
    _waits_since, collects = time.perf_counter_ns(), gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.collect(0)  # it would else come with the first object of the step: 1.5 s after compiling all
        _waited_ns += time.perf_counter_ns() - _waits_since
        _waits_since = 0
        if collects:
            gc.enable()


def compile_kernels(kernels: Iterable[Any]) -> float:
    """Compile the given kernels, or load them from the cache; return the seconds it took.

    Those that are to be interpreted (:mod:`physicslab.kernels.interpreter`) are made ready for that.
    """
    missing = [jitted for jitted in kernels if not jitted.compiled]
    if not missing:
        return 0.0
    before = _waited_ns
    with _waiting():
        asked = None if _ask is None or is_forced() else _ask(missing)
        waiting = tuple(asked or ())
        for jitted in missing:
            if jitted in waiting:
                install(jitted)
            else:
                load(jitted)
    return (_waited_ns - before) / 1e9


def load(jitted: Any) -> None:
    """Load one kernel from the cache, or compile it here and now, unless all are to be interpreted."""
    if jitted.compiled:
        return
    if is_forced():
        install(jitted)
        return
    with _waiting():
        separate_symbols()
        prepare()
        cache.note_use(jitted.py_func)
        jitted.compile(jitted.declared_signature)
        jitted.disable_compile()
        jitted.compiled = True  # looking it up in numba takes longer than many a kernel runs


def direct_entry(jitted: Any) -> Callable[..., Any]:
    """Return what calls a kernel without looking up the types of its arguments, which must be its own.

    For sixty arrays, to look them up takes as long as the work on three bodies. A kernel that is not
    compiled is returned itself.
    """
    entry: Callable[..., Any] = jitted
    if jitted.compiled:
        try:
            entry = jitted.entry
        except AttributeError:
            (overload,) = jitted.overloads.values()
            entry = jitted.entry = overload.entry_point
    return entry


def at_first_call(jitted: Any) -> None:
    """Let a kernel be compiled, or loaded, when it is called and is not loaded: for its one signature.

    numba itself would compile it for whatever it is called with.
    """

    def compile_first(*_: Any) -> Any:
        compile_kernels((jitted,))
        return jitted  # which numba calls then, with the same arguments

    jitted._compile_for_args = compile_first  # called by numba where no signature fits


def refuse_calls(jitted: Any) -> None:
    """Let a function that only kernels call refuse to be called from Python, where it has no entry."""

    def refuse(*_: Any) -> Any:
        raise TypeError(f"{jitted.__name__} is called by kernels alone; Python calls its .py_func")

    jitted._compile_for_args = refuse
    jitted._insert = lambda *_: None  # numba's table of what Python may call stays empty


@functools.cache
def prepare() -> None:
    """Load numba's tables of types, which the first kernel needs, once: 0.2 s and more.

    Where SciPy is installed numba imports its linear algebra, only to see whether matrix products could be
    compiled: half as long again, at every start. No kernel has any, so numba finds that there is none.
    """
    with _without("scipy.linalg"):
        cpu_target.typing_context.refresh()
        cpu_target.target_context.refresh()


@contextmanager
def _without(module: str) -> Iterator[None]:
    """Let a module not be found within a ``with`` block, unless it was imported before."""
    known = module in sys.modules
    if not known:
        sys.modules[module] = cast(Any, None)
    try:
        yield
    finally:
        if not known:
            del sys.modules[module]


_separated = False


def separate_symbols() -> bool:
    """Let no two processes give the same name to different machine code; return whether that could be done.

    numba numbers the functions that it compiles 1, 2, 3 and so on in every process, and symbols are named
    after these numbers. Two cached functions from two processes may then have one symbol, of which LLVM keeps
    either body (numba issue 10486). So each process starts at a random number.
    """
    global _separated
    identity: Any = getattr(bytecode, "FunctionIdentity", None)
    if not _separated and isinstance(getattr(identity, "_unique_ids", None), itertools.count):
        identity._unique_ids = itertools.count(secrets.randbits(63) + 1)
        _separated = True
    return _separated
