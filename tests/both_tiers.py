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
from physicslab.kernels.forces import force_calls
from physicslab.kernels.interpreter import entry_of, fallback_of, interpreted
from physicslab.kernels.warm import load_all

__all__ = ["compared", "name_of", "same_bits"]

_CLOCK = "cost"
"""The argument that takes what parts of a kernel cost: no run is like another in that."""


def name_of(jitted: Any) -> str:
    """Return a kernel's name below the folder of kernels."""
    return f"{jitted.__module__.removeprefix('physicslab.kernels.')}.{jitted.__name__}"


@contextmanager
def compared(calls: Counter[str]) -> Iterator[None]:
    """Compare both tiers in the calls of kernels that are made within a ``with`` block.

    Of each kernel in the first call, the second, the fourth and so on: what is settled late counts too. The
    run goes on with what the compiled kernels give; ``calls`` counts what was compared. Forces that are
    called by address are Python in the one and compiled in the other.
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
            seen[name] += 1
            if seen[name] & (seen[name] - 1):
                return code(*arguments)
            calls[name] += 1
            # Both on the same memory, one after the other: forces reach some of it by its address.
            before = _Copies().of(arguments)
            answer = entry(*arguments)
            by_python = _Copies().of(arguments)
            _put(before, arguments)
            returned = code(*arguments)
            same_bits(f"{name} returns", returned, answer)
            for parameter, one, other in zip(names, arguments, by_python, strict=True):
                if parameter != _CLOCK:
                    same_bits(f"{name}: {parameter}", one, other)
            return returned

        return call

    def noted(force: Any) -> Callable[..., Any]:
        calls[name_of(force)] += 1
        return fallback_of(force)

    called = patch.object(force_calls, "fallback_of", noted)
    with called, patch.object(interpreter, "entry_of", cache(twice)), interpreted():
        yield


def _put(saved: Any, into: Any) -> None:
    """Write copied arrays back to where they came from."""
    if isinstance(into, tuple):
        for one, other in zip(saved, into, strict=True):
            _put(one, other)
    elif isinstance(into, np.ndarray) and into.flags.writeable:
        into[...] = saved


class _Copies:
    """Copies of arguments; what shares memory shares it in the copy."""

    def __init__(self) -> None:
        self._owners: dict[int, NDArray[Any]] = {}

    def of(self, value: Any) -> Any:
        if isinstance(value, tuple):
            copies = [self.of(part) for part in value]
            return type(value)(*copies) if hasattr(value, "_fields") else tuple(copies)
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


def same_bits(what: str, one: Any, other: Any) -> None:
    """Assert that two values have the same types and bits; numbers that are none are alike."""
    assert type(one) is type(other), f"{what}: {type(one)}, {type(other)}"
    if isinstance(one, tuple):
        for place, pair in enumerate(zip(one, other, strict=True)):
            same_bits(f"{what}[{place}]", *pair)
    elif isinstance(one, np.ndarray) and one.dtype.names:
        for name in one.dtype.names:
            same_bits(f"{what}.{name}", one[name], other[name])
    elif isinstance(one, (np.ndarray, float)):
        first, second = np.atleast_1d(one), np.atleast_1d(other)
        if first.dtype == np.float64:
            first, second = (np.where(np.isnan(part), np.nan, part) for part in (first, second))
        odd = first != second
        assert first.tobytes() == second.tobytes(), f"{what}: {first[odd]}, and as Python {second[odd]}"
    else:
        assert one == other, f"{what}: {one!r}, {other!r}"
