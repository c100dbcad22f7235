"""Every call of a kernel made twice: as compiled code, and as Python on copies of what it was given."""

from __future__ import annotations

import inspect
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any
from unittest.mock import patch

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels import KERNELS, compile_kernels, interpreter
from physicslab.kernels.interpreter import entry_of, interpreted
from physicslab.kernels.warm import load_all

__all__ = ["compared", "name_of"]

_CLOCK = "cost"
"""The argument that takes what parts of a kernel cost: no run is like another in that."""


def name_of(jitted: Any) -> str:
    """Return a kernel's name below the folder of kernels."""
    return f"{jitted.__module__.removeprefix('physicslab.kernels.')}.{jitted.__name__}"


@contextmanager
def compared(calls: Counter[str], most: int, same: Callable[[str, Any, Any], None]) -> Iterator[None]:
    """Compare both tiers in the first ``most`` calls of each kernel that are made within a ``with`` block.

    The run goes on with what the compiled kernels give; ``calls`` counts what was compared.
    """
    load_all()
    compile_kernels(KERNELS)
    kernels = [jitted for jitted in KERNELS if hasattr(jitted, "add_overload")]
    compiled = {jitted: next(iter(jitted.overloads.values())).entry_point for jitted in kernels}
    seen: Counter[str] = Counter()

    def twice(jitted: Any) -> Callable[..., Any]:
        name, code, entry = name_of(jitted), compiled[jitted], entry_of(jitted)
        names = list(inspect.signature(jitted.py_func).parameters)

        def call(*arguments: Any) -> Any:
            if seen[name] >= most:
                return code(*arguments)
            seen[name] += 1
            calls[name] += 1
            copies = _Copies().of(arguments)
            returned, answer = code(*arguments), entry(*copies)
            same(f"{name} returns", returned, answer)
            for parameter, one, other in zip(names, arguments, copies, strict=True):
                if parameter != _CLOCK:
                    same(f"{name}: {parameter}", one, other)
            return returned

        return call

    with patch.object(interpreter, "entry_of", cache(twice)), interpreted():
        yield


class _Copies:
    """Copies of arguments; what shares memory shares it in the copy."""

    def __init__(self) -> None:
        self._owners: dict[int, NDArray[Any]] = {}

    def of(self, value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(self.of(part) for part in value)
        return self._of_array(value) if isinstance(value, np.ndarray) else value

    def _of_array(self, array: NDArray[Any]) -> NDArray[Any]:
        owner = array
        while isinstance(owner.base, np.ndarray):
            owner = owner.base
        if not owner.flags.c_contiguous or not array.size:
            return array.copy()
        copy = self._owners.get(id(owner))
        if copy is None:
            copy = self._owners[id(owner)] = owner.copy()
        offset = array.ctypes.data - owner.ctypes.data
        flat = copy.reshape(-1).view(np.uint8)
        return np.ndarray(array.shape, array.dtype, flat.data, offset, array.strides)
