"""Work that is done a few times a second, spread over frames."""

from collections.abc import Hashable, Mapping


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
