"""Forces that compiled integrators call by address, so that one loop serves any set of forces.

The smooth motion of a world is q' = v, v' = W f(q, v): ``q`` holds two coordinates a body [m] and the angles
[rad] of those that forces can turn, ``v`` their rates, W the inverse masses. Fixed bodies follow at the
end of both arrays and have no inverse mass. A force is a C function that adds to f; it reads what it needs
from two arrays of its own. Behind them is the time [s] of the state (``v`` has nothing there), and behind
that are the accounts (:mod:`physicslab.kernels.forces.budget`).

A force is evaluated at an instant, or over a span of time in which the coordinates change linearly from
q - span/2 v to q + span/2 v. Springs then return a discrete gradient of their energy V, a force f whose work
is all that V loses: f . (span v) = V(start) - V(end) (Gonzalez, J. Nonlinear Sci. 6 (1996) 449). Other forces
return their value at the middle.
"""

import ctypes
from collections.abc import Callable
from functools import cached_property
from typing import Annotated, Any

import numba
import numpy as np
from llvmlite import ir
from numba import float64, int64, void
from numba.core import types
from numba.extending import intrinsic
from numpy.typing import NDArray

from physicslab.kernels import KERNELS, Numbers, cached, inlined, kernel
from physicslab.kernels.python_equivalents import Memory, equivalent_for
from physicslab.kernels.python_fallback import endless, fallback_of

Calls = Annotated[NDArray[np.int64], int64[:, ::1]]
"""An int64 array (n, 3): of each force the address, and those of its numbers and of its whole numbers."""
_pointer: Any = types.CPointer
_REAL, _WHOLE = _pointer(float64), _pointer(int64)
_SIGNATURE = void(_REAL, _REAL, float64, _REAL, _REAL, _WHOLE)
_REALS, _WHOLES = ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_int64)
_C_FUNCTION = ctypes.CFUNCTYPE(None, _REALS, _REALS, ctypes.c_double, _REALS, _REALS, _WHOLES)


class ForceKernel:
    """A force ``f(q, v, span, force, parameters, indices)``: a C function, compiled for its address.

    All but the span [s] are pointers, to float64 and (the last) int64. While ``is_fallback`` is true and
    nothing is compiled, the C function runs the Python body.
    """

    declared_signature = _SIGNATURE

    def __init__(self, function: Callable[..., None]) -> None:
        self.py_func = function
        self.__name__, self.__module__ = function.__name__, function.__module__
        self.__doc__ = function.__doc__
        self.overloads: dict[Any, Any] = {}
        self.compiled = False
        self.is_fallback = False

    def compile(self, signature: Any) -> None:
        """Compile it, or load it from the cache."""
        with cached():
            make = numba.cfunc(signature, cache=True, error_model="numpy")
            self.overloads[signature.args] = make(self.py_func)
        _KERNELS[self.address] = self

    def disable_compile(self) -> None:
        """There is one signature in any case."""

    @property
    def signatures(self) -> list[Any]:
        """The signatures that it has been compiled for: the one, or none."""
        return list(self.overloads)

    def _interpret(self, q: Any, v: Any, span: float, force: Any, numbers: Any, whole: Any) -> None:
        """Run the Python body on the memory behind pointers, or the compiled function if it exists by now."""
        if self.overloads:
            _C_FUNCTION(self.address)(q, v, span, force, numbers, whole)
            return
        with np.errstate(all="ignore"):
            fallback_of(self)(Memory(q), Memory(v), np.float64(span), Memory(force), Memory(numbers), whole)

    @property
    def address(self) -> int:
        """The address of the C function, or of one that runs the Python body while that is used instead."""
        if not self.overloads and self.is_fallback:
            return self._address_of_python
        if not self.overloads:
            self.compile(_SIGNATURE)
        return int(self.overloads[_SIGNATURE.args].address)

    @cached_property
    def _address_of_python(self) -> int:
        # Never deleted: C code that has its address may call it at any time.
        self._c_function = _C_FUNCTION(self._interpret)
        address: int = ctypes.cast(self._c_function, ctypes.c_void_p).value or 0
        _KERNELS[address] = self
        return address


_KERNELS: dict[int, ForceKernel] = {}
"""Forces by the addresses that were given out, of compiled code and of what stands in for it."""


def force_kernel(function: Callable[..., None]) -> ForceKernel:
    """Make a force that compiled integrators can call."""
    made = ForceKernel(function)
    KERNELS.append(made)
    return made


def _call_type(
    context: Any, address: Any, q: Any, v: Any, span: Any, force: Any, parameters: Any, indices: Any
) -> tuple[Any, Callable[..., Any]]:
    """Call the C function at an address with the data of three arrays and two addresses."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        number = ir.DoubleType()
        real, integer = number.as_pointer(), ir.IntType(64).as_pointer()
        function_type = ir.FunctionType(ir.VoidType(), [real, real, number, real, real, integer])
        function = builder.inttoptr(arguments[0], function_type.as_pointer())
        state_q, state_v, total = (
            builder.bitcast(context.make_array(signature.args[i])(context, builder, arguments[i]).data, real)
            for i in (1, 2, 4)
        )
        rest = builder.inttoptr(arguments[5], real), builder.inttoptr(arguments[6], integer)
        builder.call(function, [state_q, state_v, arguments[3], total, *rest])
        return context.get_dummy_value()

    return void(int64, q, v, float64, force, int64, int64), generate


_call: Any = intrinsic(_call_type)


@equivalent_for(_call)
def _call_interpreted(
    address: int, q: Numbers, v: Numbers, span: float, force: Numbers, numbers: int, whole: int
) -> None:
    """Call a force from a method that is interpreted itself."""
    behind = ctypes.cast(int(numbers), _REALS), ctypes.cast(int(whole), _WHOLES)
    known = _KERNELS.get(int(address))
    if known is not None:
        fallback_of(known)(q, v, span, force, Memory(behind[0]), behind[1])
        return
    q_data, v_data, force_data = (ctypes.cast(array.ctypes.data, _REALS) for array in (q, v, force))
    _C_FUNCTION(int(address))(q_data, v_data, span, force_data, *behind)


@kernel
def add_forces(q: Numbers, v: Numbers, force: Numbers, calls: Calls) -> None:
    """Add forces at an instant to those that are there."""
    for k in range(len(calls)):
        _call(calls[k, 0], q, v, 0.0, force, calls[k, 1], calls[k, 2])


@inlined
def add_forces_over(q: Numbers, v: Numbers, span: float, force: Numbers, calls: Calls) -> None:
    """Compute the sum of forces over ``span`` seconds."""
    for i in range(len(force)):
        force[i] = 0.0
    for k in range(len(calls)):
        _call(calls[k, 0], q, v, span, force, calls[k, 1], calls[k, 2])


@inlined
def accelerate(
    q: Numbers, v: Numbers, acceleration: Numbers, inverse_mass: Numbers, damping: Numbers, calls: Calls
) -> None:
    """Compute v' at an instant, as :func:`accelerate_over` does."""
    accelerate_over(q, v, 0.0, acceleration, inverse_mass, damping, calls)


@endless
@inlined
def accelerate_over(
    q: Numbers, v: Numbers, span: float,
    acceleration: Numbers, inverse_mass: Numbers, damping: Numbers, calls: Calls,
) -> None:  # fmt: skip
    """Compute v' about a state, over ``span`` seconds: all forces times the inverse masses, less damping.

    ``acceleration`` is as long as ``q``; only what has an inverse mass is meaningful. ``damping`` (n,) [1/s],
    of v' = -c v, may be empty where nothing is damped.
    """
    add_forces_over(q, v, span, acceleration, calls)
    for i in range(len(inverse_mass)):
        acceleration[i] *= inverse_mass[i]
    for i in range(len(damping)):
        acceleration[i] -= damping[i] * v[i]
