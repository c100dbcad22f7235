"""Branches: what once came after a place of a line that goes on differently."""

from dataclasses import dataclass

from physicslab.history.line import Line

_LIMIT = 8
"""Number of branches that are kept; the oldest go first."""


@dataclass(frozen=True, slots=True)
class Branch:
    """A line that is not gone along at present.

    Attributes
    ----------
    line : Line
        All of it, from the beginning.
    place : int
        Up to where it is the present line too [ticks].
    """

    line: Line
    place: int

    @property
    def step(self) -> int:
        """After how many steps it leaves the present line."""
        return self.line.steps_before(self.place)

    @property
    def seconds(self) -> float:
        """How long after the beginning of the line it leaves the present one [s]."""
        return self.line.seconds_before(self.place)

    @property
    def words(self) -> tuple[str, ...]:
        """The edits and runs after that, in words."""
        return self.line.words_after(self.place)


class Branches:
    """The last few lines that were left in the past, the oldest first."""

    def __init__(self) -> None:
        self.kept: tuple[Branch, ...] = ()

    def leave(self, line: Line, place: int) -> None:
        """Keep what comes after a place of the present line, which ends there from now on."""
        kept = [Branch(branch.line, min(branch.place, place)) for branch in self.kept]
        if place < line.ticks:
            kept.append(Branch(line, place))
        self.kept = tuple(kept[-_LIMIT:])

    def exchange(self, branch: Branch, line: Line) -> Branch:
        """Keep the present line in place of a branch, and return that.

        Raises
        ------
        ValueError
            If it is none that is kept.
        """
        taken = next((one for one in self.kept if one.line is branch.line), None)
        if taken is None:
            raise ValueError("it is no branch of this line, or it is kept no longer")
        lines = [one.line for one in self.kept if one is not taken]
        common = line.common_ticks(taken.line)
        if common < line.ticks:
            lines.append(line)
        self.kept = tuple(Branch(one, taken.line.common_ticks(one)) for one in lines)
        return Branch(taken.line, common)
