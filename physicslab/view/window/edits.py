"""The selection, the properties of the next body, and edits of the world: commands of one history."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from physicslab.ecs.component import Component
from physicslab.ecs.fields import LENGTH_LIMIT, Field, InvalidValue
from physicslab.history import Command, Group, History, SetField
from physicslab.prefabs import BodyOptions
from physicslab.world import World


class Selection:
    """Entities that were clicked, the last one last.

    Attributes
    ----------
    entities : tuple of int
        Those that are selected.
    """

    def __init__(self) -> None:
        self.entities: tuple[int, ...] = ()

    def take(self, entity: int, *, add: bool = False) -> None:
        """Select an entity alone; or add it, or take it out where it was selected already."""
        if not add:
            self.entities = (entity,)
        elif entity in self.entities:
            self.entities = tuple(other for other in self.entities if other != entity)
        else:
            self.entities = (*self.entities, entity)

    def clear(self) -> None:
        """Select nothing."""
        self.entities = ()

    def follow(self, world: World) -> None:
        """Let go of entities that are not there any more."""
        if self.entities:
            living = set(world.entities())
            self.entities = tuple(entity for entity in self.entities if entity in living)


type Shown = tuple[int, type[Component], str]


class Edits:
    """The edits of one world. While time stands still they can be shown before they are done.

    Parameters
    ----------
    history : History
        Where edits and steps go.
    refused : callable
        Called with the reason where an edit is refused.
    """

    def __init__(self, history: History, refused: Callable[[str], None]) -> None:
        self.history = history
        self._refused = refused
        self._shown: dict[Shown, Any] = {}

    @property
    def world(self) -> World:
        """The world that is edited."""
        return self.history.world

    def do(self, command: Command) -> tuple[int, ...]:
        """Carry out an edit and return the entities that it made; where it is refused, say why."""
        self.take_back_shown()
        try:
            return self.history.do(command)
        except (InvalidValue, KeyError, TypeError, ValueError) as error:
            self._refused(str(error).strip("'\""))
            return ()

    def do_all(self, commands: Sequence[Command], words: str = "") -> tuple[int, ...]:
        """Carry out commands as one edit, named by its words or those of the first; return as :meth:`do`."""
        if not commands:
            return ()
        one = commands[0]
        named = words or one.words(self.world)
        return self.do(one if len(commands) == 1 and not words else Group(named, commands))

    def write(self, command: Command) -> None:
        """Carry out what a hand does while time runs."""
        self.take_back_shown()
        self.history.write(command)

    def show(self, entity: int, kind: type[Component], name: str, value: object) -> None:
        """Give a field a value for now, as while something is dragged: :meth:`keep` makes an edit of it.

        Raises
        ------
        InvalidValue
            If the field cannot hold it.
        """
        part = self.world.component(entity, kind)
        before = getattr(part, name)
        try:
            setattr(part, name, value)
            part.validate()
        except InvalidValue:
            setattr(part, name, before)
            raise
        self._shown.setdefault((entity, kind, name), before)

    def keep(self) -> None:
        """Make one edit of all that was shown."""
        changes = [
            SetField(entity, kind.__name__, name, getattr(self.world.component(entity, kind), name))
            for entity, kind, name in self._shown
            if self.world.has(entity, kind)
        ]
        self.take_back_shown()
        self.do_all(changes)

    def take_back_shown(self) -> None:
        """Give all fields the values that they had before they were shown with others."""
        for (entity, kind, name), before in self._shown.items():
            if self.world.has(entity, kind):
                setattr(self.world.component(entity, kind), name, before)
        self._shown.clear()


@dataclass(frozen=True, slots=True)
class Recipe:
    """The properties of the next circle or box.

    Attributes
    ----------
    size : float
        Radius of a circle, half the width of a box [m]; 0 for one of several sizes in turn.
    density : float
        Mass per area [kg/m^2].
    restitution, friction : float
        Of its surface.
    """

    size: float = 0.0
    density: float = 5.0
    restitution: float = 0.4
    friction: float = 0.5

    def body(self, area: float) -> BodyOptions:
        """Return the options of a body of an area [m^2]."""
        return {
            "mass": self.density * area, "restitution": self.restitution, "friction": self.friction,
        }  # fmt: skip

    FIELDS: ClassVar[tuple[Field, ...]] = (
        Field("size", "number", unit="m", minimum=0.0, limit=LENGTH_LIMIT,
              meaning="radius, or half the width; 0 for one of several sizes in turn"),
        Field("density", "number", unit="kg/m^2", above=0.0, limit=1e12, meaning="mass per area"),
        Field("restitution", "number", minimum=0.0, maximum=1.0, meaning="share of the speed given back"),
        Field("friction", "number", minimum=0.0, limit=1e6, meaning="Coulomb friction coefficient"),
    )  # fmt: skip
