"""The time that parts of a kernel take."""

import time
from typing import Any

from llvmlite import ir
from numba import int64
from numba.extending import intrinsic

from physicslab.kernels import Rows, inlined
from physicslab.kernels.python_equivalents import equivalent_for
from physicslab.kernels.python_fallback import endless


def _read_clock(_typing: Any) -> Any:

    def read(_context: Any, builder: Any, _signature: Any, _arguments: Any) -> Any:
        counter = ir.FunctionType(ir.IntType(64), [])
        return builder.call(builder.module.declare_intrinsic("llvm.readcyclecounter", fnty=counter), [])

    return int64(), read


ticks: Any = intrinsic(_read_clock)
"""Returns the processor's cycle counter, in a kernel; 0 on a processor without one."""
equivalent_for(ticks)(time.perf_counter_ns)


@endless
@inlined
def charge(cost: Rows, system: int, since: int) -> int:
    """Add the ticks since ``since`` to the cost of a ``system``; return the clock.

    Where ``since`` is negative nothing is timed.
    """
    if since < 0:
        return since
    now: int = ticks()
    cost[system] += now - since
    return now
