"""Work that is done now and then, spread over frames."""

from __future__ import annotations

from collections.abc import Mapping

__all__ = ["RefreshTimer"]


class RefreshTimer:
    """Says which job is due, one at a call at the most: two that fall together would make a slow frame.

    Parameters
    ----------
    periods : mapping of str to float
        How long after a job it is due again [s], by its name.

    Examples
    --------
    >>> rota = Rota({"figures": 0.1, "advice": 0.5})
    >>> [rota.due(0.0), rota.due(0.0), rota.due(0.0), rota.due(0.2)]
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
