"""Changes of the energy, in plain words."""

from collections.abc import Mapping

ACCOUNT_WORDS: dict[str, str] = {
    "edits": "edits",
    "hand": "hand and driven bodies",
    "thrust": "thrust",
    "motors": "motors",
    "fields": "other forces",
    "impacts": "impacts",
    "friction": "friction",
    "contact": "resting contacts",
    "overlap": "overlap",
    "damping": "damping",
    "joints": "joints",
    "gravity": "gravity",
    "springs": "springs",
    "numerical": "error",
}
"""The name of each account in plain words."""


def flows(booked: Mapping[str, float]) -> list[tuple[str, float]]:
    """Return the causes that gave energy, then those that took some, the largest first of each [J].

    Parameters
    ----------
    booked : mapping of str to float
        Accounts, without the error.

    Examples
    --------
    >>> flows({"hand": 5.0, "impacts": -1.0, "friction": -2.0, "edits": 0.0})
    [('hand', 5.0), ('friction', -2.0), ('impacts', -1.0)]
    """
    moved = [(name, value) for name, value in booked.items() if value]
    return sorted(moved, key=lambda flow: (not flow[1] > 0.0, -abs(flow[1])))
