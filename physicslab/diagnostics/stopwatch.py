"""The display of a stopwatch that light gates start and stop."""

from collections.abc import Sequence
from dataclasses import dataclass

from physicslab.systems.gate import Crossing


@dataclass(frozen=True, slots=True)
class Lap:
    """A crossing, and the time since the one that it is measured from.

    Attributes
    ----------
    crossing : Crossing
        The crossing that ends it.
    since : Crossing, optional
        The crossing that began it; ``None`` where none did.
    """

    crossing: Crossing
    since: Crossing | None

    @property
    def seconds(self) -> float | None:
        """How long it took [s]."""
        return None if self.since is None else self.crossing.time - self.since.time


def laps(crossings: Sequence[Crossing], gates: int) -> list[Lap]:
    """Return each crossing with the one that it is measured from, of the same body.

    With one gate that is the last in the same direction: the time between is the period of what goes to and
    fro. With several a body that comes to one starts the time, and stops it at the next other one.

    Parameters
    ----------
    crossings : sequence of Crossing
        In the order of time.
    gates : int
        How many gates there are.
    """
    made: list[Lap] = []
    last: dict[tuple[int, int], Crossing] = {}
    for one in crossings:
        key = (one.body, one.direction if gates == 1 else 0)
        before = last.get(key)
        started = before is not None and (gates == 1 or before.gate != one.gate)
        made.append(Lap(one, before if started else None))
        last[key] = one
    return made
