"""Compiled loops over arrays. Nothing here knows a world, an entity or a screen.

A function that Python calls is a ``@kernel``, or an ``@allocating_kernel`` if it makes arrays. Its
annotations are its one signature: :data:`Numbers`, :data:`Vectors`, :data:`Rows`, :data:`Flags`, ``float``,
``int`` and ``bool``. A stray int, float32 or strided column is an error and never a silent recompilation of
seconds. A function that only kernels call is ``@inlined``.
"""

from __future__ import annotations

import hashlib
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any, cast, get_args, get_origin, get_type_hints

import numba
import numba.core.config
import numpy as np
from numba import boolean, float64, int64, void
from numba.core.registry import cpu_target
from numpy.typing import NDArray

__all__ = [
    "FASTMATH", "KERNELS", "Flags", "Numbers", "Rows", "Vectors",
    "allocating", "allocating_kernel", "ask_before_compiling", "cache_directory", "cached", "compile_kernels",
    "fused", "inlined", "inlined_loosely", "kernel", "load", "prepare",
]  # fmt: skip

Numbers = Annotated[NDArray[np.float64], float64[::1]]
"""A float64 array (n,)."""
Vectors = Annotated[NDArray[np.float64], float64[:, ::1]]
"""A float64 array (n, k), contiguous: a vector a row."""
Rows = Annotated[NDArray[np.int64], int64[::1]]
"""An int64 array (n,): row numbers, or codes."""
Flags = Annotated[NDArray[np.bool_], boolean[::1]]
"""A bool array (n,)."""

KERNELS: list[Any] = []
"""Every kernel of the modules imported so far, in the order of definition."""

FASTMATH = {"contract", "nsz", "arcp", "reassoc"}
"""What :func:`inlined_loosely` allows. NaN must survive, so that a diverging run is seen."""


def cache_directory() -> Path:
    """Return where compiled kernels are kept between runs.

    numba's cache does not see an edit in another module's callee and would return the old code, so the
    directory is named after a hash of every kernel's source and of numba's version.
    """
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sorted(Path(__file__).parent.rglob("*.py")):
        digest.update(source.read_bytes())
    name = f"kernels-{digest.hexdigest()[:16]}"
    try:
        directory = _user_cache() / "physicslab" / name
        directory.mkdir(parents=True, exist_ok=True)
        if not os.access(directory, os.W_OK):
            raise PermissionError(directory)
    except (OSError, RuntimeError):  # no home, or one that cannot be written to
        user = os.getuid() if hasattr(os, "getuid") else 0
        directory = Path(tempfile.gettempdir()) / f"physicslab-{user}" / name
        directory.mkdir(parents=True, exist_ok=True)
    return directory


def _user_cache() -> Path:
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or tempfile.gettempdir())
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")


_CACHE = str(cache_directory())


@contextmanager
def cached() -> Iterator[None]:
    """Let what numba is given within a ``with`` block keep its code in the cache."""
    settings: Any = numba.core.config
    before = settings.CACHE_DIR
    settings.CACHE_DIR = _CACHE  # read by numba when a function is decorated
    try:
        yield
    finally:
        settings.CACHE_DIR = before


def _jit[F: Callable[..., Any]](function: F, counts: bool = True, fastmath: Any = False) -> F:
    njit: Any = numba.njit  # its types know no option of the target
    # No wrapper for C: nothing calls one, and compiling them takes four to seven per cent of the time.
    make = njit(cache=True, error_model="numpy", fastmath=fastmath, no_cfunc_wrapper=True, _nrt=counts)
    with cached():
        return cast(F, make(function))


def inlined[F: Callable[..., Any]](function: F) -> F:
    """Make a function that kernels call, and that makes and returns no arrays.

    Nobody counts who refers to those it is given: for five arrays that takes as long as the work on eight
    contacts.
    """
    return _jit(function, counts=False)


def allocating[F: Callable[..., Any]](function: F) -> F:
    """Make a function that kernels call, and that makes or returns arrays."""
    return _jit(function)


def fused[F: Callable[..., Any]](function: F) -> F:
    """Make a function whose body numba itself puts where it is called.

    For what is called for every eight contacts: a call that LLVM leaves standing, with its thirty arguments,
    takes as long as a third of the work.
    """
    with cached():
        make = numba.njit(cache=True, error_model="numpy", inline="always")
        return cast(F, make(function))


def inlined_loosely[F: Callable[..., Any]](function: F) -> F:
    """Make an ``@inlined`` function in which sums are made in whatever order is fastest.

    Elsewhere every operation is rounded by itself, in the order in which it is written: a formula gives the
    same bits wherever LLVM puts it, be it in a kernel of its own or in a loop of whole steps.
    """
    return _jit(function, counts=False, fastmath=FASTMATH)


def kernel[F: Callable[..., Any]](function: F) -> F:
    """Make a function that Python calls, and that makes no arrays, for the signature of its annotations.

    numba takes an array in for half the price where nobody counts who refers to it.
    """
    return _listed(function, counts=False)


def allocating_kernel[F: Callable[..., Any]](function: F) -> F:
    """Make a function like ``@kernel`` that makes arrays of its own."""
    return _listed(function, counts=True)


def _listed[F: Callable[..., Any]](function: F, counts: bool) -> F:
    jitted: Any = _jit(function, counts)
    jitted.declared_signature = _signature(function)
    jitted.compiled = False
    KERNELS.append(jitted)
    return cast(F, jitted)


def _signature(function: Callable[..., Any]) -> Any:
    hints = get_type_hints(function, include_extras=True)
    returned = _numba_type(hints.pop("return"))
    return returned(*(_numba_type(hint) for hint in hints.values()))


def _numba_type(hint: Any) -> Any:
    """Return what numba calls a type: the one that an alias carries, or that of a plain Python type."""
    if get_origin(hint) is Annotated:
        return hint.__metadata__[0]
    if isinstance(hint, type) and issubclass(hint, tuple) and hasattr(hint, "_fields"):
        fields = get_type_hints(hint, include_extras=True)
        make_named: Any = numba.types.BaseTuple.from_types
        return make_named([_numba_type(part) for part in fields.values()], hint)
    if get_origin(hint) is tuple:
        make_tuple: Any = numba.types.Tuple
        return make_tuple([_numba_type(part) for part in get_args(hint)])
    return {float: float64, int: int64, bool: boolean, type(None): void}[hint]


def ask_before_compiling(ask: Callable[[Sequence[Any]], None] | None) -> None:
    """Have ``ask`` called with kernels that are needed and not there, before they are compiled; or nothing.

    When it returns they are compiled, or loaded: so a window can wait for other processes, and stay awake.
    """
    global _ask
    _ask = ask


_ask: Callable[[Sequence[Any]], None] | None = None


def compile_kernels(kernels: Iterable[Any]) -> float:
    """Compile the given kernels, or load them from the cache; return the seconds it took."""
    start = time.perf_counter()
    missing = [jitted for jitted in kernels if not jitted.compiled]
    if missing and _ask is not None:
        _ask(missing)
    for jitted in missing:
        load(jitted)
    return time.perf_counter() - start


def load(jitted: Any) -> None:
    """Load one kernel from the cache, or compile it here and now."""
    if not jitted.compiled:
        jitted.compile(jitted.declared_signature)
        jitted.disable_compile()
        jitted.compiled = True  # asking numba takes longer than many a kernel runs


def prepare() -> None:
    """Let numba learn what it knows of types, as it would before the first kernel: 0.2 s and more.

    Where SciPy is installed numba imports its linear algebra, only to see whether matrix products could be
    compiled: half as long again, at every start. No kernel has any, so it is told that there is none.
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
