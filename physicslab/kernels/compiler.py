"""The decorators that make kernels, and the inner functions that kernels call.

These lines decide on the machine code: an edit invalidates every compiled kernel.
"""

from collections.abc import Callable
from typing import Any, cast

import numba

from physicslab.kernels.cache import cached
from physicslab.kernels.inner import InnerCompiler, KernelCompiler
from physicslab.kernels.loading import at_first_call, refuse_calls
from physicslab.kernels.types import signature_of

KERNELS: list[Any] = []
"""Every kernel of the modules imported so far, in the order of definition."""

FASTMATH = {"contract", "nsz", "arcp", "reassoc"}
"""What :func:`inlined_loosely` allows. NaN must survive, so that a diverging run is seen."""

_OF_INNER = {
    "error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True,
    "pipeline_class": InnerCompiler,
}  # fmt: skip
_without_constant: Any = numba.types.unliteral
_njit: Any = numba.njit  # its type hints know no option of the target


def _inner[F: Callable[..., Any]](
    function: F, counts: bool = False, fastmath: Any = False, always: bool = False
) -> F:
    """Make a function that kernels alone call: without an entry for Python, and without a cache of its own.

    Entries are machine code too, and a function of a cache of its own is stored with every kernel that calls
    it in any case: both together were a fifth of the time that compiling took. An option that is not given
    is taken over from the function that calls.
    """
    jitted = _njit(_nrt=counts, fastmath=fastmath, forceinline=always, **_OF_INNER)(function)
    _take_constants_as_values(jitted)
    refuse_calls(jitted)
    return cast(F, jitted)


def _take_constants_as_values(jitted: Any) -> None:
    """Let one compiled function serve every call, be an argument a constant or not.

    numba would compile another for each constant, and one more for what it takes for a constant until it has
    seen the loop that changes it. LLVM finds constants by itself where it inlines a call.
    """
    find = jitted.get_call_template

    def find_by_types(arguments: Any, named: dict[str, Any]) -> Any:
        values = [_without_constant(argument) for argument in arguments]
        return find(values, {name: _without_constant(argument) for name, argument in named.items()})

    jitted.get_call_template = find_by_types  # called by numba for a call that a kernel makes


def inlined[F: Callable[..., Any]](function: F) -> F:
    """Make a function that kernels call, and that makes and returns no arrays.

    References to the arrays that it is given are not counted: for five arrays that would take as long as the
    work on eight contacts.
    """
    return _inner(function)


def always_inlined[F: Callable[..., Any]](function: F) -> F:
    """Make an ``@inlined`` function whose machine code LLVM puts wherever it is called.

    For formulas of a few lines, and for what has few callers and is given so many arrays that to pass them
    takes as long as the work on a few contacts.
    """
    return _inner(function, always=True)


def allocating[F: Callable[..., Any]](function: F) -> F:
    """Make a function that kernels call, and that makes or returns arrays."""
    return _inner(function, counts=True)


def inlined_by_numba[F: Callable[..., Any]](function: F) -> F:
    """Make a function that returns arrays, whose body numba itself puts where it is called.

    There references to them are counted, or not, as in what calls it.
    """
    jitted = _njit(inline="always", **_OF_INNER)(function)
    refuse_calls(jitted)
    return cast(F, jitted)


def inlined_loosely[F: Callable[..., Any]](function: F) -> F:
    """Make an ``@inlined`` function in which sums are made in whatever order is fastest.

    Elsewhere every operation is rounded by itself, in the order in which it is written: a formula gives the
    same bits wherever LLVM puts it, be it in a kernel of its own or in a loop of whole steps.
    """
    return _inner(function, fastmath=FASTMATH)


def kernel[F: Callable[..., Any]](function: F) -> F:
    """Make a function that Python calls, and that makes no arrays, for the signature of its annotations.

    numba takes an array in for half the price where references to it are not counted.
    """
    return _listed(function, counts=False)


def allocating_kernel[F: Callable[..., Any]](function: F) -> F:
    """Make a function like ``@kernel`` that makes arrays of its own."""
    return _listed(function, counts=True)


def _listed[F: Callable[..., Any]](function: F, counts: bool) -> F:
    # No wrapper for C: nothing calls one, and compiling them takes four to seven per cent of the time.
    with cached():
        jitted = _njit(
            cache=True, error_model="numpy", fastmath=False, no_cfunc_wrapper=True, _nrt=counts,
            pipeline_class=KernelCompiler,
        )(function)  # fmt: skip
    _take_constants_as_values(jitted)
    jitted.declared_signature = signature_of(function)
    jitted.compiled = False
    at_first_call(jitted)
    KERNELS.append(jitted)
    return cast(F, jitted)
