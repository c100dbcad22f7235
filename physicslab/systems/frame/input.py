"""Input of the user to the world and to the window."""

from collections.abc import Callable, Sequence
from typing import Protocol

from physicslab.state.state import State
from physicslab.systems.system import Stage, System, at


class EventHandler[W: State, E](Protocol):
    """Acts on events."""

    def begin(self, world: W, events: Sequence[E], elapsed: float) -> None:
        """Do what comes before the events of a frame, ``elapsed`` seconds after the last."""

    def handle(self, world: W, event: E) -> None:
        """Do what an event calls for."""

    def end(self, world: W) -> None:
        """Do what comes after them."""


class InputSystem[W: State, E](System):
    """Hands what the user did since the last frame to what acts on it, event by event.

    Parameters
    ----------
    events : callable
        Returns the events since it was called last, such as ``pygame.event.get``.
    handler : EventHandler
        The function that acts on them.
    """

    def __init__(self, events: Callable[[], Sequence[E]], handler: EventHandler[W, E]) -> None:
        self._events, self._handler = events, handler

    @at(Stage.INPUT)
    def read(self, world: W, elapsed: float) -> None:
        """Do what the events since the last frame call for."""
        events = self._events()
        self._handler.begin(world, events, elapsed)
        for event in events:
            self._handler.handle(world, event)
        self._handler.end(world)
