"""The figures over the picture."""

from collections.abc import Callable, Hashable, Mapping

from physicslab.state.state import State
from physicslab.systems.system import Stage, System, at


class RefreshTimer[J: Hashable]:
    """Returns which job is due, at most one a call: two in one frame would make it slow.

    Parameters
    ----------
    periods : mapping of hashable to float
        How long after a job it is due again [s].

    Examples
    --------
    >>> timer = RefreshTimer({"figures": 0.1, "advice": 0.5})
    >>> [timer.due(0.0), timer.due(0.0), timer.due(0.0), timer.due(0.2)]
    [['figures'], ['advice'], [], ['figures']]
    """

    def __init__(self, periods: Mapping[J, float]) -> None:
        self._periods = dict(periods)
        self._next = dict.fromkeys(periods, 0.0)

    def due(self, now: float) -> list[J]:
        """Return the job that has been due for longest, which is to be done now, if there is one."""
        job = min(self._next, key=self._next.__getitem__, default=None)
        if job is None or self._next[job] > now:
            return []
        self._next[job] = now + self._periods[job]
        return [job]

    def all_due(self, now: float) -> list[J]:
        """Return all of them, which are to be done now."""
        self._next = {job: now + period for job, period in self._periods.items()}
        return list(self._periods)


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
