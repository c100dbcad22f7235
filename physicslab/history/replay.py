"""A recording played step by step, each compared with what came of it once."""

from collections.abc import Iterator
from dataclasses import dataclass

from physicslab.ecs.component import InvalidValue
from physicslab.files.checks import SceneError
from physicslab.history.commands import Command
from physicslab.history.digest import Digester, differing
from physicslab.history.line import Edit, Line, Steps
from physicslab.world import World


@dataclass(frozen=True, slots=True)
class Played:
    """A step that was made again.

    Attributes
    ----------
    step : int
        Its number, from 1.
    time : float
        The world's clock after it [s].
    columns : tuple of str
        The columns of motion whose bits are not those of then.
    """

    step: int
    time: float
    columns: tuple[str, ...]


def edit(world: World, command: Command) -> Command:
    """Carry out an edit and book what it changed; what is measured of the world begins again.

    Work of a hand since the last step is booked before.
    """
    world.book_edits()
    done = command.carry_out(world)
    world.edited()
    world.book_edits()
    return done


def write(world: World, command: Command) -> Command:
    """Carry out what a hand does between two steps."""
    done = command.carry_out(world)
    world.synchronise()
    return done


def make_again(world: World, piece: Edit | Command) -> None:
    """Carry out an edit or a write of a line once more."""
    if isinstance(piece, Edit):
        edit(world, piece.command)
    else:
        write(world, piece)


def play(world: World, line: Line, source: str) -> Iterator[Played]:
    """Go along a line from its beginning, yielding after every step.

    Raises
    ------
    SceneError
        If the world refuses an edit or a step, which it cannot have done when the recording was made.
    Diverged
        If a step cannot be made.
    """
    made, place, digester = 0, 0, Digester()
    for piece in line.between(0, line.ticks):
        if isinstance(piece, Steps):
            for _ in range(piece.count):
                try:
                    world.step(piece.dt)
                except InvalidValue as error:
                    raise SceneError(f"{source}: after step {made}: {error}") from error
                made, place = made + 1, place + 1
                yield Played(made, world.time, differing(digester.digest(world), line.digest_before(place)))
            continue
        try:
            make_again(world, piece)
        except (InvalidValue, KeyError, TypeError, ValueError, AttributeError) as error:
            message = error.args[0] if isinstance(error, KeyError) else error
            name = type(piece.command if isinstance(piece, Edit) else piece).__name__
            raise SceneError(f"{source}: after step {made}: {name} is refused: {message}") from error
        place += 1
