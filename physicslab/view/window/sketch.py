"""A drawing by the mouse: the points that were put down, and the numbers that are typed."""

from dataclasses import dataclass, field
from typing import NamedTuple

from physicslab.components import Transform
from physicslab.ecs.vector import Vector2
from physicslab.state.attached import point_of
from physicslab.world import World


class Grip(NamedTuple):
    """A point that was put down: of a body, in its own frame, or of the world [m]."""

    body: int | None
    anchor: Vector2

    def place(self, world: World) -> Vector2:
        """Return where it is now [m]."""
        return point_of(world, self.body, self.anchor)


@dataclass(slots=True)
class Sketch:
    """A drawing that is not finished.

    Attributes
    ----------
    name : str
        The name of the tool that it was begun with; empty while nothing is drawn.
    grips : list of Grip
        The points that were put down.
    held : int
        The button that is held down, and whose release puts down the next point; 0 for none, or a key.
    begin : tuple of two floats
        Where the last point was put down [px].
    spot : Vector2
        Where a click makes what is drawn [m].
    typed : str
        The numbers typed for the next point.
    stroke : list of Vector2
        Where the cursor went since the last point was put down, of what may be drawn with one stroke [m].
    ways : dict of str to Vector2
        From the first point to the second of what each tool drew last [m].
    """

    name: str = ""
    grips: list[Grip] = field(default_factory=list)
    held: int = 0
    begin: tuple[float, float] = (0.0, 0.0)
    spot: Vector2 = Vector2()
    typed: str = ""
    stroke: list[Vector2] = field(default_factory=list)
    ways: dict[str, Vector2] = field(default_factory=dict)

    def cancel(self) -> bool:
        """Forget what was begun; return whether there was anything."""
        begun = bool(self.grips)
        self.name, self.grips, self.held, self.typed, self.stroke = "", [], 0, "", []
        return begun

    def follow(self, world: World) -> None:
        """Forget what was begun on a body that is gone."""
        if any(grip.body is not None and not world.has(grip.body, Transform) for grip in self.grips):
            self.cancel()

    def write(self, letter: str) -> None:
        """Take a letter that was typed; a backspace takes the last one back, Tab goes to the next number."""
        if letter == "\b":
            self.typed = self.typed[:-1]
        else:
            self.typed += "; " if letter == "\t" else letter
