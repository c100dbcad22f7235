"""Forces that compiled integrators call by address, so that one loop serves any set of forces.

The smooth motion of a world is q' = v, v' = W f(q, v): ``q`` holds two coordinates a body [m] and the angles
[rad] of those that forces can turn, ``v`` their rates, W the inverse masses. What is fixed in place follows
behind in both arrays and has no inverse mass. A force is a C function that adds to f; it reads what it needs
from two arrays of its own.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

import numba
import numpy as np
from llvmlite import ir
from numba import float64, int64, void
from numba.core import types
from numba.extending import intrinsic
from numpy.typing import NDArray

from physicslab.kernels import FASTMATH, KERNELS, Numbers, cached, inlined

__all__ = ["Calls", "ForceKernel", "accelerate", "force_kernel"]

Calls = Annotated[NDArray[np.int64], int64[:, ::1]]
"""An int64 array (n, 3): of each force the address, and those of its numbers and of its whole numbers."""
_pointer: Any = types.CPointer
_REAL, _WHOLE = _pointer(float64), _pointer(int64)
_SIGNATURE = void(_REAL, _REAL, _REAL, _REAL, _WHOLE)


class ForceKernel:
    """A force ``f(q, v, force, numbers, whole)``, compiled to a C function when its address is asked for.

    All five are pointers, to float64 and (the last) int64.
    """

    declared_signature = _SIGNATURE

    def __init__(self, function: Callable[..., None]) -> None:
        self.py_func = function
        self.__name__, self.__module__, self.__doc__ = (
            function.__name__,
            function.__module__,
            function.__doc__,
        )
        self.overloads: dict[Any, Any] = {}
        self.compiled = False

    def compile(self, signature: Any) -> None:
        """Compile it, or load it from the cache."""
        with cached():
            make = numba.cfunc(signature, cache=True, error_model="numpy", fastmath=FASTMATH)
            self.overloads[signature.args] = make(self.py_func)

    def disable_compile(self) -> None:
        """There is one signature in any case."""

    @property
    def signatures(self) -> list[Any]:
        """The signatures that it has been compiled for: the one, or none."""
        return list(self.overloads)

    @property
    def address(self) -> int:
        """Where the C function lies in memory."""
        if not self.overloads:
            self.compile(_SIGNATURE)
        return int(self.overloads[_SIGNATURE.args].address)


def force_kernel(function: Callable[..., None]) -> ForceKernel:
    """Make a force that compiled integrators can call."""
    made = ForceKernel(function)
    KERNELS.append(made)
    return made


def _call_type(
    context: Any, address: Any, q: Any, v: Any, force: Any, numbers: Any, whole: Any
) -> tuple[Any, Callable[..., Any]]:
    """Call the C function at an address with the data of three arrays and two addresses."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        real, integer = ir.DoubleType().as_pointer(), ir.IntType(64).as_pointer()
        function_type = ir.FunctionType(ir.VoidType(), [real, real, real, real, integer])
        function = builder.inttoptr(arguments[0], function_type.as_pointer())
        data = [
            builder.bitcast(context.make_array(kind)(context, builder, value).data, real)
            for kind, value in zip(signature.args[1:4], arguments[1:4], strict=True)
        ]
        rest = builder.inttoptr(arguments[4], real), builder.inttoptr(arguments[5], integer)
        builder.call(function, [*data, *rest])
        return context.get_dummy_value()

    return void(int64, q, v, force, int64, int64), generate


_call: Any = intrinsic(_call_type)


@inlined
def accelerate(
    q: Numbers, v: Numbers, acceleration: Numbers, inverse_mass: Numbers, damping: Numbers, calls: Calls
) -> None:
    """Work out v' at a state: every force called, weighed, and the damping v' = -c v taken off.

    ``acceleration`` is as long as ``q``; only what has an inverse mass is meaningful. ``damping`` (n,) [1/s]
    may be empty where nothing is damped.
    """
    for i in range(len(acceleration)):
        acceleration[i] = 0.0
    for k in range(len(calls)):
        _call(calls[k, 0], q, v, acceleration, calls[k, 1], calls[k, 2])
    for i in range(len(inverse_mass)):
        acceleration[i] *= inverse_mass[i]
    for i in range(len(damping)):
        acceleration[i] -= damping[i] * v[i]
