"""Edits as data: what can be done to a world by hand, and recorded, and done again."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any, ClassVar, Protocol, Self, runtime_checkable

from physicslab.components import Name, Trail, Transform
from physicslab.ecs.component import COMPONENTS, Component, Field
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.text import shortened
from physicslab.ecs.vector import Vector2
from physicslab.files.reader import checked_scene_text
from physicslab.languages.sentence import Sentence
from physicslab.world import World


@runtime_checkable
class Command(Protocol):
    """An edit. It holds values and entity numbers and nothing of a world, so it can be carried out again."""

    def words(self, world: World) -> str:
        """Return what it does, in plain English; called before it is done."""

    def carry_out(self, world: World) -> Command:
        """Edit the world; return the command with which the same edit is made again.

        Raises
        ------
        InvalidValue, KeyError, TypeError, ValueError
            Where the world refuses it; a part of it may be done by then.
        """


@dataclass(frozen=True, slots=True)
class Spawn:
    """Make an entity.

    Parameters
    ----------
    components : sequence of Component
        Its parts; they are copied, now and whenever the entity is made.
    name : str, optional
        Its id.
    entity : int, optional
        Its number, which no entity may have now; by default the next that there is
        (:attr:`physicslab.history.History.next_entity`). Entities that a group spawns are numbered in
        order, so that a spring of it can name the bodies at its ends.
    """

    components: Sequence[Component]
    name: str | None = None
    entity: int | None = None

    def __post_init__(self) -> None:
        for part in self.components:
            if not isinstance(part, Component):
                raise TypeError(f"Spawn takes components with columns, and a name; got {part!r}")
        object.__setattr__(self, "components", tuple(map(copy.copy, self.components)))

    def words(self, world: World) -> str:
        """Return what it does, in plain English."""
        kinds = {type(part).__name__: part for part in self.components}
        shape, made = kinds.get("Shape"), next(iter(kinds), "entity").lower()
        made = str(getattr(shape, "kind", made if "Transform" not in kinds else "point"))
        words = Sentence("made an {thing}" if _takes_an(made) else "made a {thing}", thing=Sentence(made))
        return Sentence("{what}, {name}", what=words, name=self.name) if self.name else words

    def carry_out(self, world: World) -> Spawn:
        """Make the entity; return the command with its number."""
        parts = map(copy.copy, self.components)
        return replace(self, entity=world.spawn(*parts, name=self.name, entity=self.entity))


@dataclass(frozen=True, slots=True)
class Remove:
    """Remove an entity."""

    entity: int

    def words(self, world: World) -> str:
        """Return what it does, in plain English."""
        return Sentence("removed {what}", what=world.label(self.entity))

    def carry_out(self, world: World) -> Remove:
        """Remove the entity."""
        world.remove(self.entity)
        return self


def _is_left_out(world: World, entity: int, kind: type[Component]) -> bool:
    """Whether an edit is of a trail that is not there: a window gives and takes them without edits."""
    return kind is Trail and world.has(entity, Transform) and not world.has(entity, Trail)


@dataclass(frozen=True, slots=True)
class SetField:
    """Give a field of an entity's component another value.

    Parameters
    ----------
    entity : int
        The entity.
    component, field : str
        The names of the component, as in scene files, and of its field.
    value : number, pair of numbers, list of pairs, bool, str or None
        As the field takes it, in its unit.
    """

    entity: int
    component: str
    field: str
    value: Any

    def words(self, world: World) -> str:
        """Return what it does, in plain English."""
        spec = _field(_kind(self.component), self.field)
        unit = "" if spec.unit in ("", "1") else f" {spec.unit}"
        owner, value = world.label(self.entity), f"{shown_value(self.value)}{unit}"
        return Sentence("{field} of {body}: {value}", field=Sentence(self.field), body=owner, value=value)

    def carry_out(self, world: World) -> SetField:
        """Set the field."""
        kind = _kind(self.component)
        spec = _field(kind, self.field)
        if _is_left_out(world, self.entity, kind):
            return self
        part = world.component(self.entity, kind)
        setattr(part, self.field, self.value)
        part.validate()
        mutable = spec.kind in ("vector", "points")  # a list that was given may change
        return replace(self, value=getattr(part, self.field)) if mutable else self


@dataclass(frozen=True, slots=True)
class AddComponent:
    """Add a component to an entity, or a ``Name``, in place of the one of that type if it has one."""

    entity: int
    component: Component | Name

    def __post_init__(self) -> None:
        if not isinstance(self.component, Component | Name):
            raise TypeError(f"AddComponent takes a component with columns, or a Name; got {self.component!r}")
        object.__setattr__(self, "component", copy.copy(self.component))

    def words(self, world: World) -> str:
        """Return what it does, in plain English."""
        label = world.label(self.entity)
        if isinstance(self.component, Name):
            return Sentence("named {body}: {name}", body=label, name=self.component.id)
        part = type(self.component).__name__
        words = "gave {body} an {part}" if _takes_an(part) else "gave {body} a {part}"
        return Sentence(words, body=label, part=Sentence(part))

    def carry_out(self, world: World) -> AddComponent:
        """Add the component."""
        world.add(self.entity, copy.copy(self.component))
        return self


@dataclass(frozen=True, slots=True)
class RemoveComponent:
    """Take a component from an entity, by its name; an entity without it is refused with ``KeyError``."""

    entity: int
    component: str

    def words(self, world: World) -> str:
        """Return what it does, in plain English."""
        part = Sentence(self.component)
        return Sentence("took {part} from {body}", part=part, body=world.label(self.entity))

    def carry_out(self, world: World) -> RemoveComponent:
        """Take the component."""
        kind = _kind(self.component)
        if world.discard(self.entity, kind) is None and not _is_left_out(world, self.entity, kind):
            raise KeyError(f"{world.label(self.entity)} has no {self.component}")
        return self


@dataclass(frozen=True, slots=True)
class Configure:
    """Change fields of one of the world's two records, by their names."""

    changes: Mapping[str, Any]
    CONFIG: ClassVar[type[PhysicsConfig | SimulationConfig]]

    def __post_init__(self) -> None:
        object.__setattr__(self, "changes", MappingProxyType(dict(self.changes)))

    def words(self, world: World) -> str:
        """Return what it does, in plain English."""
        units = {spec.name: f" {spec.unit}" for spec in self.CONFIG.FIELDS if spec.unit != "1"}
        shown = (
            (name, shown_value(value) + ("" if value is None else units.get(name, "")))
            for name, value in self.changes.items()
        )
        return ", ".join(f"{name.replace('_', ' ')}: {value}" for name, value in shown)

    def carry_out(self, world: World) -> Self:
        """Change the record."""
        section = self.CONFIG.section
        setattr(world, section, replace(getattr(world, section), **self.changes))
        return self


class SetPhysics(Configure):
    """Change laws of the world: ``SetPhysics({"gravity": (0, -1.62)})``, by names of ``PhysicsConfig``."""

    __slots__ = ()
    CONFIG = PhysicsConfig


class SetSimulation(Configure):
    """Change how the world is stepped: ``SetSimulation({"dt": 0.01})``, by names of ``SimulationConfig``."""

    __slots__ = ()
    CONFIG = SimulationConfig


@dataclass(frozen=True, slots=True)
class SetText:
    """Change what the scene is called or says of itself: its ``name``, ``title`` or ``description``."""

    key: str
    text: str

    def words(self, world: World) -> str:
        """Return what it does, in plain English."""
        return f"{self.key} of the scene: {shown_value(self.text) or 'none'}"

    def carry_out(self, world: World) -> SetText:
        """Set the text."""
        setattr(world, self.key, checked_scene_text(self.key, self.text, ""))
        return self


@dataclass(frozen=True, slots=True)
class Group:
    """Several commands that are one: all of them are done, or none.

    Parameters
    ----------
    text : str
        Their effect together, in plain English.
    commands : sequence of Command
        In order.
    """

    text: str
    commands: Sequence[Command] = field(default=())

    def __post_init__(self) -> None:
        object.__setattr__(self, "commands", tuple(self.commands))

    def words(self, world: World) -> str:
        """Return what they do."""
        return self.text

    def carry_out(self, world: World) -> Group:
        """Carry out each of them."""
        return replace(self, commands=tuple(part.carry_out(world) for part in self.commands))


def _kind(name: str) -> Any:
    """Return the component of a name."""
    kind = Name if name == Name.__name__ else COMPONENTS.get(name)
    if kind is None:
        raise KeyError(f"there is no component {name!r}; there are {', '.join(COMPONENTS)}")
    return kind


def _field(kind: Any, name: str) -> Field:
    """Return the description of a component's field."""
    fields: Iterable[Field] = getattr(kind, "FIELDS", ())
    found = next((spec for spec in fields if spec.name == name), None)
    if found is None:
        names = ", ".join(spec.name for spec in fields)
        raise TypeError(f"{kind.__name__} has no field {name!r}; it has {names or 'none'}")
    return found


def shown_value(value: Any) -> str:
    r"""Return a value as people read it, on one line.

    >>> shown_value(0.1 + 0.2), shown_value((0, -9.81)), shown_value(None), shown_value(True)
    ('0.3', '(0, -9.81)', 'as computed', 'yes')
    >>> shown_value("one\ntwo")
    'one two'
    """
    if value is None:
        return "as computed"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, Vector2 | tuple | list):
        return f"({', '.join(map(shown_value, value))})"
    return f"{value:.6g}" if isinstance(value, float | int) else shortened(" ".join(str(value).split()))


def _takes_an(noun: str) -> bool:
    return noun[:1].lower() in "aeiou"


def changes_motion(command: Command) -> bool:
    """Whether an edit is of what moves: not of instruments, names, colours and texts alone."""
    match command:
        case Group():
            return any(map(changes_motion, command.commands))
        case Spawn():
            return any(part.physical for part in command.components)
        case SetField() | RemoveComponent():
            return getattr(COMPONENTS.get(command.component), "physical", False)
        case AddComponent():
            return getattr(type(command.component), "physical", False)
    return not isinstance(command, SetText)
