"""The selection, the properties of the next body, and edits of the world: commands of one history."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from physicslab.components import Transform
from physicslab.components.made_of import SUBSTANCES
from physicslab.ecs.component import COMPONENTS, Component
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

    def bodies(self, world: World) -> list[int]:
        """Return those of them that have a place."""
        return [entity for entity in self.entities if world.has(entity, Transform)]

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
    """The edits of one world. They can be shown before they are done, as while a number is dragged.

    Parameters
    ----------
    history : History
        Where edits and steps go.
    refused : callable
        Called with the reason where an edit is refused.
    loosen : callable
        Called before each edit, with what the hand holds still in it.
    allows : callable
        Returns whether an edit may be made: lessons shut most.

    Attributes
    ----------
    held : bool
        Whether a number is dragged: edits of fields are shown until it is let go, and are one edit then.
    """

    def __init__(
        self, history: History, refused: Callable[[str], None], loosen: Callable[[World], None],
        allows: Callable[[Command], bool] = lambda command: True,
    ) -> None:  # fmt: skip
        self.history = history
        self._refused, self._loosen, self._allows = refused, loosen, allows
        self._shown: dict[Shown, Any] = {}
        self._words, self._at_release = "", Group("")
        self.held = self._in_run = False

    @property
    def world(self) -> World:
        """The world that is edited."""
        return self.history.world

    def do(self, command: Command) -> tuple[int, ...]:
        """Carry out an edit and return the entities that it made; where it is refused, say why.

        The change shown while it is dragged is an edit of its own, and the first of the two.
        """
        self.keep()
        if not self._allows(command):
            self._refused("The lesson has this shut; Esc leaves the lesson")
            return ()
        self._loosen(self.world)
        try:
            return self.history.do(command)
        except (InvalidValue, KeyError, TypeError, ValueError) as error:
            self._refused(str(error).strip("'\""))
            return ()

    def do_all(self, commands: Sequence[Command], words: str = "") -> tuple[int, ...]:
        """Carry out commands as one edit, named by its words or those of the first; return as :meth:`do`."""
        if not commands:
            return ()
        if self.held:
            self._show_all(commands, words)
            return ()
        one = commands[0]
        named = words or one.words(self.world)
        return self.do(one if len(commands) == 1 and not words else Group(named, commands))

    def write(self, command: Command) -> None:
        """Carry out what a hand does while time runs."""
        self.keep()
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
        if before == value:
            return
        try:
            setattr(part, name, value)
            part.validate()
        except InvalidValue:
            setattr(part, name, before)
            raise
        self._shown.setdefault((entity, kind, name), before)

    def keep(self) -> None:
        """Make one edit of all that was shown."""
        changes, words, self._words = self._take_back_shown(), self._words, ""
        if changes:
            self.do(
                changes[0]
                if len(changes) == 1 and not words
                else Group(words or changes[0].words(self.world), changes)
            )

    def keep_for_run(self) -> None:
        """Make what is shown an edit before a step; a part of the run, while a number is dragged."""
        if not self.held:
            self.keep()
        elif changes := [*self._take_back_shown(), *self._at_release.commands]:
            self._at_release = Group("")
            if not self._in_run:
                self.history.divide()  # one undo goes back to where the drag began
            self._in_run = True
            try:
                for change in changes:
                    self.history.write(change)
            except InvalidValue as error:
                self._refused(str(error))

    def hold(self) -> None:
        """Begin to show edits of fields: a number is dragged."""
        self.keep()
        self.held, self._in_run = True, False

    def release(self) -> None:
        """Let the number go that was dragged: all that it did is one edit, or a part of the run."""
        if self._in_run:
            self.keep_for_run()
            self.history.divide()
        self.held = False
        last, self._at_release = self._at_release, Group("")
        self.keep()
        self.do_all(last.commands, last.text)

    def _show_all(self, commands: Sequence[Command], words: str) -> None:
        """Show the fields that commands set; others, as of laws, wait for the next step or the release."""
        fields = [one for one in commands if isinstance(one, SetField)]
        if len(fields) < len(commands):
            self._at_release = Group(words, commands)
            return
        self._words = words
        try:
            for one in fields:
                self.show(one.entity, COMPONENTS[one.component], one.field, one.value)
        except InvalidValue as error:
            self._refused(str(error))

    def _take_back_shown(self) -> list[SetField]:
        """Give fields the values that they had before they were shown; return what gives them the others."""
        changes = []
        for (entity, kind, name), before in self._shown.items():
            if self.world.has(entity, kind):
                part = self.world.component(entity, kind)
                changes.append(SetField(entity, kind.__name__, name, getattr(part, name)))
                setattr(part, name, before)
        self._shown.clear()
        return changes


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
        Coefficients of its surface.
    material, colour : str
        Its material, if that has a name, and its colour, as "#rrggbb".
    angle : float
        How far a box is turned [rad]: it is typed while one is drawn, and not kept.
    """

    size: float = 0.0
    density: float = 5.0
    restitution: float = 0.4
    friction: float = 0.5
    material: str = ""
    colour: str = ""
    angle: float = 0.0

    @property
    def grain(self) -> float:
        """Radius of what is poured [m]."""
        return self.size or 0.12

    def of(self, material: str) -> Recipe:
        """Return the same with density, surface and colour of a material of the table, or of none."""
        known = SUBSTANCES.get(material)
        if known is None:
            return replace(self, material="", colour="")
        return replace(
            self, density=known.areal_density, restitution=known.restitution, friction=known.friction,
            material=material, colour=known.colour,
        )  # fmt: skip

    def given(self, typed: Mapping[str, float]) -> Recipe:
        """Return the same with an angle that was typed, by its unit [deg]."""
        return replace(self, angle=math.radians(typed["deg"])) if "deg" in typed else self

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
