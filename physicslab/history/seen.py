"""What is seen of a history: its entries, and where steps made again gave other bits."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Difference", "HistoryEntry"]


@dataclass(frozen=True, slots=True)
class HistoryEntry:
    """An edit or a run.

    Attributes
    ----------
    words : str
        What it was, in plain English: "made a circle", "mass of ball: 2 kg", "ran 3.2 s".
    done : bool
        Whether it, or the beginning of it, lies before the present place.
    first_step, steps : int
        How many steps the line has before it, and how many it is.
    """

    words: str
    done: bool
    first_step: int
    steps: int


@dataclass(frozen=True, slots=True)
class Difference:
    """Where steps that were made again did not give the bits that they once gave.

    Attributes
    ----------
    step : int
        The first such step of the line, from 1.
    columns : tuple of str
        The columns of motion that differ.
    """

    step: int
    columns: tuple[str, ...]
