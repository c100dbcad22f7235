"""The figures over the picture."""

from collections.abc import Callable, Mapping

from physicslab.state.state import State
from physicslab.systems.frame.refresh_timer import RefreshTimer
from physicslab.systems.system import Stage, System, at


class HudSystem[W: State](System):
    """Reads figures of the world, each as often as it can be followed, and draws them over the picture.

    Parameters
    ----------
    now : callable
        Returns the time [s] by which readings are due.
    readings : mapping of callable to float
        ``read(world, elapsed)`` takes a reading; after how long [s] it is taken again, 0 for every frame. Of
        the others at most one is taken a frame, and all of them where another world is shown.
    *layers : callable
        ``layer(world, elapsed)`` draws one, the lowest first.
    """

    def __init__(
        self,
        now: Callable[[], float],
        readings: Mapping[Callable[[W, float], None], float],
        *layers: Callable[[W, float], None],
    ) -> None:
        self._now, self._layers = now, layers
        self._always = [read for read, period in readings.items() if not period]
        self._timer = RefreshTimer({read: period for read, period in readings.items() if period})
        self._world: W | None = None

    @at(Stage.HUD)
    def draw(self, world: W, elapsed: float) -> None:
        """Take the readings that are due, and draw every layer."""
        if world is not self._world:
            self._world = world
            due = self._timer.all_due(self._now())
        else:
            due = self._timer.due(self._now())
        for call in (*self._always, *due, *self._layers):
            call(world, elapsed)
