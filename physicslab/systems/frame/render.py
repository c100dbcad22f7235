"""The picture of the world."""

from collections.abc import Callable
from typing import Any

from numpy.typing import NDArray

from physicslab.contacts.report import ImpactReader
from physicslab.state.state import State
from physicslab.systems.system import Stage, System, at


class RenderSystem[W: State](System):
    """Draws the world once a frame, one layer over the other, and changes nothing of it.

    Parameters
    ----------
    *layers : callable
        ``layer(world, impacts)`` draws one, the lowest first. ``impacts`` are those since the last picture,
        oldest first: an array of IMPACT (n,).
    """

    def __init__(self, *layers: Callable[[W, NDArray[Any]], None]) -> None:
        self._layers = layers
        self._impacts = ImpactReader()

    def attach(self, state: State) -> None:
        """Begin with the next impact of a world that was not shown before."""
        self._impacts.follow(state)

    @at(Stage.RENDER)
    def draw(self, world: W, elapsed: float) -> None:
        """Draw every layer."""
        impacts = self._impacts.new(world)
        for layer in self._layers:
            layer(world, impacts)
