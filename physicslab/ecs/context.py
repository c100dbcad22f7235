"""esper's contexts: which is active and in which thread, and the numbers of its entities."""

import itertools
import threading
from collections.abc import Iterable
from types import TracebackType
from typing import Any

import esper

_turn = threading.RLock()
"""Held by the thread in which a context is active, which may take it any number of times; others wait.

esper's context is one for the whole process, so threads work with worlds in turn.
"""


class Active[W]:
    """Makes a context esper's active one within a ``with`` block, and the one before after it.

    A class, and not a generator: every call of a world's method enters one, and this takes half the time.

    Parameters
    ----------
    value : object
        The object that the ``with`` statement gives.
    context : str
        The name of the context.
    """

    __slots__ = ("_before", "_context", "_value")

    def __init__(self, value: W, context: str) -> None:
        self._value, self._context = value, context
        self._before = ""

    def __enter__(self) -> W:
        """Switch to the context, once none is active in another thread."""
        _turn.acquire()
        self._before = before = esper.current_world
        if before != self._context:
            try:
                esper.switch_world(self._context)
            except BaseException:
                _turn.release()
                raise
        return self._value

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            before = self._before
            if esper.current_world != before:
                # The context that was active before may have been forgotten meanwhile.
                esper.switch_world(before if before in esper.list_worlds() else "default")
        finally:
            _turn.release()


def switch(context: str) -> None:
    """Make a context esper's active one from here on, once none is active in another thread."""
    with _turn:
        esper.switch_world(context)


def next_number() -> int:
    """Return the number that the next entity of the active context gets."""
    number = next(esper._entity_count)
    esper._entity_count = itertools.count(number)
    return number


def create_numbered(number: int, components: Iterable[Any]) -> int:
    """Make an entity of the active context with a number of choice, as one that was removed had it.

    Entities made later get higher numbers than any there has been.

    Raises
    ------
    ValueError
        If an entity has the number, or it is below 1.
    """
    if number < 1 or number in esper._entities:
        raise ValueError(f"entity {number}: must be a number from 1 on that no entity has")
    following = max(next_number(), number + 1)
    esper._entity_count = itertools.count(number)
    esper.create_entity(*components)
    esper._entity_count = itertools.count(following)
    return number
