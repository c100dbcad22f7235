"""Items of arrays that are used soon, fetched into the nearest cache before they are.

The records of a crowd's contacts are more than the caches near the processor hold, and the order in which
they are solved is none that it foresees: each would be waited for. No number depends on it.
"""

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

_LINE = 64
"""Bytes of a line of the cache."""
_BYTE, _WHOLE = ir.IntType(8), ir.IntType(32)
_READ, _NEAREST, _DATA = _WHOLE(0), _WHOLE(3), _WHOLE(1)


def _fetch_type(context: Any, array: Any, at: Any) -> Any:
    """Fetch the lines of an item of an array."""

    def generate(context: Any, build: Any, signature: Any, arguments: Any) -> Any:
        kind, address = signature.args[0], _BYTE.as_pointer()
        of_function = ir.FunctionType(ir.VoidType(), [address, _WHOLE, _WHOLE, _WHOLE])
        prefetch = build.module.declare_intrinsic("llvm.prefetch.p0", fnty=of_function)
        data = context.make_array(kind)(context, build, arguments[0]).data
        item = build.bitcast(build.gep(data, [arguments[1]]), address)
        size = context.get_abi_sizeof(context.get_data_type(kind.dtype))
        # Numbers are aligned; a record may end in one more line than it has times the length of one.
        for offset in sorted({*range(0, size, _LINE), size - size % 8 - 8}):
            build.call(prefetch, [build.gep(item, [_WHOLE(offset)]), _READ, _NEAREST, _DATA])
        return context.get_dummy_value()

    return types.void(array, at), generate


_inline: Any = intrinsic
fetch: Callable[[Any, int], None] = _inline(_fetch_type)
