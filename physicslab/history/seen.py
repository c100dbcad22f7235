"""What is seen of a history: its entries, its branches, and where steps made again gave other bits."""

from __future__ import annotations

from dataclasses import dataclass

from physicslab.history.line import Line

__all__ = ["Branch", "Difference", "HistoryEntry"]


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
class Branch:
    """What once came after a place of the line, where the line now goes on differently.

    Attributes
    ----------
    line : Line
        All of it, from the beginning.
    place : int
        Where it was left [ticks].
    """

    line: Line
    place: int

    @property
    def step(self) -> int:
        """After how many steps it was left."""
        return self.line.steps_before(self.place)

    @property
    def words(self) -> tuple[str, ...]:
        """What the edits and runs after that were."""
        return tuple(entry.words for entry in self.line.entries[self.line.entry_at(self.place) :])


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
