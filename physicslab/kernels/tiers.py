"""When a run without a window compiles: once that costs less than to go on as plain Python.

Compiling what one bouncing ball needs takes ten times as long as to interpret ten seconds of its motion. So
kernels that are not in the cache are interpreted first (:mod:`physicslab.kernels.interpreter`, with the same
bits), and each is compiled when one of these is reached:

- It was interpreted for as long as compiling it takes: at worst a run then takes twice as long as with the
  better choice, which nothing can foresee ("ski rental").
- What is left of the run would take longer, if it goes on as it has gone. That is looked at once a twentieth
  of the time is spent, so that what would be slow is compiled early.
"""

from __future__ import annotations

import functools
import logging
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from types import ModuleType, TracebackType
from typing import Any

from numba.extending import is_jitted

from physicslab.kernels import cache, interpreter
from physicslab.kernels.loading import ask_before_compiling, asked, load
from physicslab.kernels.python_fallback import natives

_log = logging.getLogger(__name__)
_WORTH_TELLING = 1.0
"""Time [s] of a wait that is announced."""
_PER_BYTE = 2.0e-4
"""Time [s] to compile a byte of Python's bytecode: 41 s for all kernels on an AMD EPYC of 2026."""
_FIRST = 1.0
"""Extra time of the first kernel of a process [s], as numba and LLVM begin."""
_FIRST_PART = 0.05
"""Share of the time to compile a kernel for which it is interpreted before the rest is foreseen."""


def compile_seconds(jitted: Any) -> float:
    """Return about how long it takes to compile a kernel [s], with all inner functions that it calls."""
    seen: set[Any] = set()
    return _PER_BYTE * _size(jitted, seen)


def _size(jitted: Any, seen: set[Any]) -> int:
    """Return the bytes of code of a function and of those that it calls, each once."""
    function = jitted.py_func
    if function in seen:
        return 0
    seen.add(function)
    return len(function.__code__.co_code) + sum(_size(callee, seen) for callee in _callees(function))


@functools.cache
def natives_within(jitted: Any) -> tuple[Any, ...]:
    """Return the kernels that run in place of inner functions of a kernel while that is interpreted."""
    seen: set[Any] = set()
    _size(jitted, seen)
    inner = (function for function in natives if function.py_func in seen)
    return tuple(natives[function] for function in inner if natives[function] is not jitted)


def _callees(function: Any) -> Iterator[Any]:
    """Yield what a kernel's code calls of other kernels and inner functions, by name or from a module."""
    names = function.__code__.co_names
    for name in names:
        value = function.__globals__.get(name)
        found: list[Any] = (
            [getattr(value, part, None) for part in names] if isinstance(value, ModuleType) else [value]
        )
        yield from (callee for callee in found if is_jitted(callee))


class Tiers:
    """Interprets kernels that are not in the cache, each until compiling it costs less, in a ``with`` block.

    Parameters
    ----------
    small : bool
        Whether the first steps may be interpreted; else all is compiled before it is called.
    """

    def __init__(self, small: bool) -> None:
        self._small = small and not interpreter.is_forced()
        self._costs: dict[Any, float] = {}
        self._foreseen = False
        self._compiled_any = False

    def __enter__(self) -> Tiers:
        if self._small:
            interpreter.limit(self._seconds, self._compile_late)
            ask_before_compiling(self._ask)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._small:
            ask_before_compiling(None)
            interpreter.unlimited()
            for jitted in self._pending():
                interpreter.uninstall(jitted)

    @property
    def interpreted_s(self) -> float:
        """How long kernels have been interpreted so far [s]."""
        return interpreter.spent() if self._small else 0.0

    def foresee(self, share: float) -> None:
        """Compile what would cost more to interpret for the rest of a run.

        Parameters
        ----------
        share : float
            How much of the run is done, above 0 and at most 1.
        """
        self._foreseen = True
        left = (1.0 - share) / share
        spent = {jitted: interpreter.spent_on(jitted) for jitted in self._pending()}
        saved = {
            jitted: left * seconds - self._costs[jitted]
            for jitted, seconds in spent.items()
            if seconds >= _FIRST_PART * self._costs[jitted]
        }
        due = [jitted for jitted, seconds in saved.items() if seconds > 0.0]
        if sum(saved[jitted] for jitted in due) > self._beginning:
            self._compile(due)

    def _pending(self) -> list[Any]:
        """Return the kernels that are interpreted and not compiled yet."""
        return [jitted for jitted in self._costs if not jitted.compiled]

    def _ask(self, missing: Sequence[Any]) -> Sequence[Any]:
        """Return which of the missing kernels are interpreted: those that are not in the cache."""
        absent = [jitted for jitted in missing if not cache.is_kept(jitted.py_func)]
        for jitted in absent:
            self._costs.setdefault(jitted, compile_seconds(jitted))
            interpreter.fallback_of(jitted)
        return absent

    def _seconds(self, jitted: Any) -> float:
        """Return how long a call of a kernel may be interpreted [s]."""
        cost = self._costs[jitted] + self._beginning if jitted in self._costs else 0.0
        return (cost if self._foreseen else _FIRST_PART * cost) - interpreter.spent_on(jitted)

    @property
    def _beginning(self) -> float:
        """Extra time that the next kernel takes to compile [s]."""
        return 0.0 if self._compiled_any else _FIRST

    def _compile_late(self, jitted: Any) -> None:
        """Compile a kernel of which the interpreted calls have taken as long as that."""
        self._compile((jitted,))

    def _compile(self, due: Iterable[Any]) -> None:
        """Compile kernels, and the forces that compiled code calls by their addresses."""
        forces = [jitted for jitted in self._costs if not is_jitted(jitted)]
        for jitted in dict.fromkeys((*due, *forces)):
            load(jitted)
            self._compiled_any = True


class FirstRuns(Tiers):
    """The same for a program that uses the library, whose runs are many: from its first run to its end.

    It says once by ``logging`` that scenes are interpreted, and what is compiled, which is worth a wait.
    """

    def __init__(self) -> None:
        super().__init__(True)
        self._told = False
        self.is_small: Callable[[], bool] = lambda: True

    def _ask(self, missing: Sequence[Any]) -> Sequence[Any]:
        if self.is_small():
            absent = super()._ask(missing)
            if absent and not self._told:
                self._told = True
                _log.warning(
                    "kernels are not compiled for this processor yet: they are interpreted, "
                    "until compiling costs less"
                )
            return absent
        self._tell([jitted for jitted in missing if not cache.is_kept(jitted.py_func)])
        return ()

    def _compile(self, due: Iterable[Any]) -> None:
        due = [jitted for jitted in due if not jitted.compiled]
        self._tell(due)
        super()._compile(due)

    def _tell(self, due: Sequence[Any]) -> None:
        """Say what is compiled, and about how long that takes."""
        seconds = sum(map(compile_seconds, due)) + (self._beginning if due else 0.0)
        if seconds >= _WORTH_TELLING:
            _log.warning("compiling %s, once: about %.0f s", ", ".join(one.__name__ for one in due), seconds)

    @property
    def decides(self) -> bool:
        """Whether it is what decides on kernels that are not compiled."""
        return asked() == self._ask


_first_runs: FirstRuns | None = None
_compiles_first = os.environ.get("PHYSICSLAB_INTERPRET") == "0"


def begin_run(is_small: Callable[[], bool]) -> FirstRuns | None:
    """Let what a run needs be interpreted at first, where nothing else has decided on that.

    Parameters
    ----------
    is_small : callable
        Tells whether steps are interpreted in tens of milliseconds.

    Returns
    -------
    FirstRuns or None
        The object that is to be told how far the run is (:meth:`Tiers.foresee`).
    """
    global _first_runs
    if _compiles_first or interpreter.is_forced():
        return None
    if asked() is None:
        _first_runs = FirstRuns()
        _first_runs.__enter__()
    if _first_runs is None or not _first_runs.decides:
        return None
    _first_runs.is_small = is_small
    return _first_runs


def compile_first() -> None:
    """Let all be compiled before it is called, as where many processes share what one has compiled."""
    global _compiles_first
    _compiles_first = True
    if _first_runs is not None and _first_runs.decides:
        _first_runs.__exit__(None, None, None)
