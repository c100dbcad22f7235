"""Compiled loops over arrays. Nothing here depends on a world, an entity or a screen.

A function that Python calls is a ``@kernel``, or an ``@allocating_kernel`` if it makes arrays. Its
annotations are its one signature: :data:`Numbers`, :data:`Vectors`, :data:`Rows`, :data:`Flags`, ``float``,
``int`` and ``bool``. A stray int, float32 or strided column is an error and never a silent recompilation of
seconds. A function that only kernels call is ``@inlined``; from Python only its ``.py_func`` can be called.

Compiled kernels are kept between runs (:mod:`physicslab.kernels.cache`); they are machine code: the
folder that holds them must be trusted like a program.
"""

from physicslab.kernels.cache import cache_directory, cached
from physicslab.kernels.compiler import (
    FASTMATH,
    KERNELS,
    allocating,
    allocating_kernel,
    always_inlined,
    inlined,
    inlined_by_numba,
    inlined_loosely,
    kernel,
)
from physicslab.kernels.loading import (
    ask_before_compiling,
    compile_kernels,
    direct_entry,
    load,
    prepare,
    seconds_waited,
    working_ns,
)
from physicslab.kernels.types import Flags, Numbers, Plain, Rows, Vectors

__all__ = [
    "FASTMATH", "KERNELS", "Flags", "Numbers", "Plain", "Rows", "Vectors",
    "allocating", "allocating_kernel", "always_inlined", "ask_before_compiling", "cache_directory", "cached",
    "compile_kernels", "direct_entry", "inlined", "inlined_by_numba", "inlined_loosely", "kernel",
    "load", "prepare", "seconds_waited", "working_ns",
]  # fmt: skip
