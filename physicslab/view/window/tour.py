"""Where the tour is, and what is searched for among all commands."""

from dataclasses import dataclass

from physicslab.world import World


@dataclass(frozen=True, slots=True, eq=False)
class Tour:
    """Where the tour is.

    Attributes
    ----------
    number : int
        The step that is shown, from 0.
    world : World, optional
        The world in which it waits for its act.
    read : object
        The number that the act changes, as it was.
    """

    number: int = 0
    world: World | None = None
    read: object = None


@dataclass(frozen=True, slots=True)
class Search:
    """A search among all commands, and the marked line of its results, from 0."""

    text: str = ""
    row: int = 0
