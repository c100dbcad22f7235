"""Work that is done a few times a second, spread over frames."""

from __future__ import annotations

from collections.abc import Mapping

__all__ = ["RefreshTimer"]


class RefreshTimer:
    """Returns which job is due, at most one a call: two in one frame would make it slow.

    Parameters
    ----------
    periods : mapping of str to float
        How long after a job it is due again [s], by its name.

    Examples
    --------
    >>> timer = RefreshTimer({"figures": 0.1, "advice": 0.5})
    >>> [timer.due(0.0), timer.due(0.0), timer.due(0.0), timer.due(0.2)]
    ['figures', 'advice', None, 'figures']
    """

    def __init__(self, periods: Mapping[str, float]) -> None:
        self._periods = dict(periods)
        self._next = dict.fromkeys(periods, 0.0)

    def due(self, now: float) -> str | None:
        """Return the job that has been due for longest, which is to be done now, or ``None``."""
        name = min(self._next, key=self._next.__getitem__)
        if self._next[name] > now:
            return None
        self._next[name] = now + self._periods[name]
        return name

    def all_done(self, now: float) -> None:
        """Note that every job was done just now."""
        self._next = {name: now + period for name, period in self._periods.items()}
