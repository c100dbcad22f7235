"""Compiled loops over arrays. Nothing here knows a world, an entity or a screen.

A function that Python calls is a ``@kernel`` with an explicit signature, so that a stray int, float32 or strided
column is an error and never a silent recompilation of seconds. A function that only kernels call is ``@inlined``.
"""

from __future__ import annotations

import hashlib
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from numba.core import config as numba_config

__all__ = ["KERNELS", "cache_directory", "compile_kernels", "inlined", "kernel"]

F = TypeVar("F", bound=Callable[..., Any])

KERNELS: list[Any] = []
"""Every kernel of the modules imported so far, in the order of definition."""

# NaN must survive ("nnan" and "ninf" are left out), so that a diverging run is seen.
_FASTMATH = {"contract", "nsz", "arcp", "reassoc"}


def cache_directory() -> Path:
    """Return where compiled kernels are kept between runs.

    numba's cache does not see an edit in another module's callee and would return the old code, so the directory is
    named after a hash of every kernel's source and of numba's version.
    """
    digest = hashlib.sha256(numba.__version__.encode())
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.read_bytes())
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA") or tempfile.gettempdir()
    elif sys.platform == "darwin":
        base = str(Path.home() / "Library" / "Caches")
    else:
        base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    directory = Path(base) / "physicslab" / f"kernels-{digest.hexdigest()[:16]}"
    try:
        directory.mkdir(parents=True, exist_ok=True)
        if not os.access(directory, os.W_OK):
            raise PermissionError(directory)
    except OSError:
        directory = Path(tempfile.gettempdir()) / f"physicslab-{os.getuid() if hasattr(os, 'getuid') else 0}"
        directory = directory / f"kernels-{digest.hexdigest()[:16]}"
        directory.mkdir(parents=True, exist_ok=True)
    return directory


_CACHE = str(cache_directory())


def _jit(function: F, **options: Any) -> F:
    before = numba_config.CACHE_DIR
    numba_config.CACHE_DIR = _CACHE  # read by numba when the function is decorated
    try:
        jitted = numba.njit(cache=True, error_model="numpy", fastmath=_FASTMATH, **options)(function)
    finally:
        numba_config.CACHE_DIR = before
    return cast(F, jitted)


def inlined(function: F) -> F:
    """Make a function that kernels call and LLVM inlines."""
    return _jit(function)


def kernel(signature: Any) -> Callable[[F], F]:
    """Make a function that Python calls, for exactly one signature, compiled by :func:`compile_kernels`."""

    def decorate(function: F) -> F:
        jitted: Any = _jit(function)
        jitted.declared_signature = signature
        KERNELS.append(jitted)
        return cast(F, jitted)

    return decorate


def compile_kernels(kernels: Iterable[Any]) -> float:
    """Compile the given kernels, or load them from the cache; return the seconds it took."""
    start = time.perf_counter()
    for jitted in kernels:
        if not jitted.signatures:
            jitted.compile(jitted.declared_signature)
            jitted.disable_compile()
    return time.perf_counter() - start
