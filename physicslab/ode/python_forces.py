"""Forces in Python within a compiled flow: they act on the world's tables, and are called back from C."""

import ctypes
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.ode.budget import BudgetLayout, book_in_python
from physicslab.state.packed import StateLayout
from physicslab.state.state import State
from physicslab.systems.system import ForceSystem, Stage

_REAL = ctypes.POINTER(ctypes.c_double)
_WHOLE = ctypes.POINTER(ctypes.c_int64)
_CALLBACK = ctypes.CFUNCTYPE(None, _REAL, _REAL, ctypes.c_double, _REAL, _REAL, _WHOLE)


class PythonForces:
    """A C function that lets force systems written in Python act on the world's tables.

    Parameters
    ----------
    state : State
        Whose tables.
    systems : sequence of ForceSystem
        Those that are called, in order.
    layout : StateLayout
        The place of each row.
    book : BudgetLayout
        Where their work is booked.
    size : int
        How many numbers each array has that it is called with.
    write : callable
        Puts coordinates and rates (size,) into the tables.
    """

    def __init__(
        self, state: State, systems: Sequence[ForceSystem], layout: StateLayout, book: BudgetLayout,
        size: int, write: Callable[[State, NDArray[np.float64], NDArray[np.float64]], None],
    ) -> None:  # fmt: skip
        self._error: BaseException | None = None
        methods = [(system, getattr(system, type(system).marked()[Stage.FORCE])) for system in systems]
        bodies, n, d, clock = state.bodies, 2 * len(layout.moving), layout.moving_count, layout.clock

        def call(q: Any, v: Any, _span: float, force: Any, parameters: Any, indices: Any) -> None:
            if self._error is not None:
                return
            start, state.time = state.time, float(q[clock])
            try:
                places, speeds = np.ctypeslib.as_array(q, (size,)), np.ctypeslib.as_array(v, (size,))
                total = np.ctypeslib.as_array(force, (size,))
                write(state, places, speeds)
                bodies.force[:] = 0.0
                bodies.torque[:] = 0.0
                for system, method in methods:
                    before = bodies.force.copy(), bodies.torque.copy()
                    method(state, 0.0)
                    change = bodies.force - before[0], bodies.torque - before[1]
                    book_in_python(state, book, system, change, places, speeds, total)
                # A fixed body stays where it is, be the force on it infinite: no product with zero.
                pulled = bodies.inverse_mass[layout.moving] > 0.0
                total[:n] += np.where(pulled[:, None], bodies.force[layout.moving], 0.0).ravel()
                turned = bodies.inverse_inertia[layout.turning] > 0.0
                total[n:d] += np.where(turned, bodies.torque[layout.turning], 0.0)
            except BaseException as error:  # C code cannot be unwound: it is raised when that has returned
                self._error = error
            finally:
                state.time = start

        self._callback = _CALLBACK(call)
        self.address = ctypes.cast(self._callback, ctypes.c_void_p).value or 0

    def raise_error(self) -> None:
        """Raise the error of one of them, if there was one since this was called last."""
        if self._error is not None:
            error, self._error = self._error, None
            raise error
