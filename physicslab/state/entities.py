"""The entities of a world and their components: esper's, in a context of their own."""

import itertools
import weakref
from collections.abc import Iterator
from typing import Any, Self

import esper

from physicslab.components import Name
from physicslab.components.name import why_no_id
from physicslab.components.naming import plain_name
from physicslab.ecs.component import Component, InvalidValue
from physicslab.ecs.context import Active, create_numbered, next_number, switch
from physicslab.ecs.entity_index import EntityIndex
from physicslab.ecs.table import Batch, Table
from physicslab.ecs.text import printable, shortened, suggestion
from physicslab.languages.sentence import proper

_numbers = itertools.count(1)
_NO_COMPONENTS = ("builtins", "numpy")
"""Where types come from that hold values, and say nothing of an entity."""


def label_in_context(entity: int) -> str:
    """Return the label of an entity that is there, where the context of its world is active."""
    named = esper.try_component(entity, Name)
    return proper(named.id) if named is not None else plain_name(entity, esper.components_for_entity(entity))


class Entities:
    """Entities with components, in an esper context that is this world's own.

    Attributes
    ----------
    context : str
        The name of the context.
    entity_index : EntityIndex
        Which entity has which row.
    in_step : bool
        Whether a step is being made, or changes of structure are being followed: neither is begun meanwhile.
    """

    __slots__ = ("__weakref__", "_behind", "_index", "_names", "context", "in_step")

    def __init__(self) -> None:
        self._index, self.in_step = EntityIndex(), False
        self._behind = False  # whether rows and tables lack what was read, and follow at the next look
        # Every id that was ever given here: only one of these can be in use, so a new one costs no search.
        self._names: set[str] = set()
        self.context = f"physicslab-{next(_numbers)}"
        self.activate()
        weakref.finalize(self, _forget, self.context)

    @property
    def entity_index(self) -> EntityIndex:
        """Rows and tables of the entities, with those whose components were read since the last step."""
        if self._behind and not self.in_step:
            self._behind = False
            with self.active():
                self._follow()
        return self._index

    # ---- contexts ------------------------------------------------------------------------------------------

    def activate(self) -> None:
        """Make this the world that plain esper calls act on, until another is activated."""
        switch(self.context)

    def active(self) -> Active[Self]:
        """Make this the world that plain esper calls act on, within a ``with`` block.

        At its start it waits until no world is active in another thread.
        """
        return Active(self, self.context)

    # ---- entities and components ---------------------------------------------------------------------------

    def spawn(self, *components: Any, name: str | None = None, entity: int | None = None) -> int:
        """Make an entity of these components and return its number.

        Systems see it from the next step on. ``name`` is its id in scene files and reports. ``entity`` is the
        number that it gets, so that one that was removed can be put back; by default one that is new.

        Raises
        ------
        ValueError
            If an entity has the number, or it is below 1.
        TypeError
            If something is no component.
        InvalidValue
            If a body that one refers to, as a spring to its ends, is not there; where ``entity`` is given, it
            may still come. If both ends of one are the same.
        """
        if name is not None:
            components = (*components, Name(name))
        kinds = [_kind(component) for component in components]
        for kind in kinds:
            if kinds.count(kind) > 1:
                raise ValueError(f"an entity has one {kind.__name__}, not {kinds.count(kind)}")
        with self.active():
            for component in components:
                self._check_name(component)
                self._find_ends(component, entity, may_come=entity is not None)
            if entity is not None:
                return create_numbered(entity, components)
            return esper.create_entity(*components)

    @property
    def next_entity(self) -> int:
        """The number that the next new entity gets."""
        with self.active():
            return next_number()

    def remove(self, entity: int | str) -> None:
        """Remove an entity with all its components; handles on them keep their last values."""
        with self.active():
            entity = self._found(entity)
            esper.delete_entity(entity, immediate=True)

    def clear(self) -> None:
        """Remove every entity."""
        with self.active():
            for entity in esper.get_entities():
                esper.delete_entity(entity)
            self.entity_index.flush_deleted()

    def add(self, entity: int | str, component: Any) -> None:
        """Add a component to an entity, in place of the one of that type if it has one.

        Raises
        ------
        TypeError, InvalidValue
            As :meth:`spawn` does.
        """
        with self.active():
            entity = self._found(entity)
            _kind(component)
            self._check_name(component, entity)
            self._find_ends(component, entity)
            esper.add_component(entity, component)

    def discard[C](self, entity: int | str, component: type[C]) -> C | None:
        """Take a component from an entity and return it, or ``None`` if it had none."""
        with self.active():
            taken: C | None = esper.try_remove_component(self._found(entity), _checked(component))
            return taken

    def component[C](self, entity: int | str, component: type[C]) -> C:
        """Return a component of an entity, which is given by its number or its id.

        Raises
        ------
        KeyError
            If there is no such entity, or it has no such component.
        """
        with self.active():
            entity = self._found(entity)
            found: C | None = esper.try_component(entity, _checked(component))
            if found is None:
                raise KeyError(f"{self.label(entity)} has no {component.__name__}")
            if not self._index.has_followed(entity):
                # A component holds what it was given, and only derived values are the world's: following at
                # once would take n^2 where n bodies are read as they are made.
                self._behind = not (isinstance(found, Component) and any(s.derived for s in found.FIELDS))
                if not self._behind:
                    self._follow()
            return found

    def has(self, entity: int | str, component: type[Any]) -> bool:
        """Whether an entity exists and has a component."""
        with self.active():
            number = self._number(entity)
            return number is not None and esper.has_component(number, _checked(component))

    def components(self, entity: int | str) -> tuple[Any, ...]:
        """Return all components of an entity."""
        with self.active():
            entity = self._found(entity)
            self._follow()
            return esper.components_for_entity(entity)

    def entities(self) -> list[int]:
        """Return all entities, in the order of their numbers."""
        with self.active():
            return sorted(filter(esper.entity_exists, esper.get_entities()))

    def entity(self, name: str) -> int:
        """Return the entity with this id, or raise ``KeyError``."""
        with self.active():
            entity = self._holder(name)
        if entity is not None:
            return entity
        with self.active():
            known = [named.id for one, named in esper.get_component(Name) if esper.entity_exists(one)]
        raise KeyError(f"no entity has the id {name!r}{suggestion(str(name), known)}")

    def __getitem__(self, name: str) -> int:
        """Return the entity with this id, or raise ``KeyError``."""
        return self.entity(name)

    def __contains__(self, entity: int | str) -> bool:
        """Whether there is an entity of this number or id."""
        with self.active():
            return self._number(entity) is not None

    def __iter__(self) -> Iterator[int]:
        return iter(self.entities())

    def label(self, entity: int | str) -> str:
        """Return the entity's id if it has one, else what it is and its number: ``circle 3``."""
        with self.active():
            entity = self.entity(entity) if isinstance(entity, str) else entity
            return label_in_context(entity) if esper.entity_exists(entity) else f"entity {entity}"

    def label_of_row(self, row: int) -> str:
        """Return the label of the entity of a row; row 0 is the world itself."""
        return self.label(int(self.entity_index.entities[row])) if row else "the world's bounds"

    def _check_name(self, component: Any, entity: int = 0) -> None:
        """Refuse a Name that no scene file may hold, or that another entity than this one has."""
        if not isinstance(component, Name):
            return
        allowed = why_no_id(component.id)
        if allowed is not None:
            raise InvalidValue("Name", "id", component.id, allowed)
        if component.id in self._names and self._holder(component.id) not in (None, entity):
            allowed = f"an id of its own; entity {self._holder(component.id)} has this one"
            raise InvalidValue("Name", "id", component.id, allowed)
        self._names.add(component.id)

    def _number(self, entity: int | str) -> int | None:
        """Return the number of an entity, if it is there."""
        if isinstance(entity, str):
            return self._holder(entity)
        return entity if esper.entity_exists(entity) else None

    def _holder(self, name: str) -> int | None:
        """Return the entity with this id, if there is one."""
        for entity, named in esper.get_component(Name):
            if named.id == name and esper.entity_exists(entity):
                return entity
        return None

    def _find_ends(self, component: Any, own: int | None = None, *, may_come: bool = False) -> None:
        """Put the numbers of entities in place of ids; refuse what is not there where the motion needs it.

        ``own`` is the number of the entity that gets the component, which it may refer to: the next where
        there is none yet. An entity whose number ``may_come`` is made later.
        """
        if not isinstance(component, Component):
            return
        specs = [spec for spec in component.FIELDS if spec.kind == "entity"]
        for spec in specs:
            end: Any = getattr(component, spec.name)
            if isinstance(end, str):
                try:
                    component.name_entity(spec.name, self.entity(end))
                except KeyError as error:
                    allowed = f"the id of an entity of this world: {error.args[0]}"
                    raise InvalidValue(spec.owner, spec.name, end, allowed) from error
            elif end is None or may_come or not component.physical or esper.entity_exists(end):
                continue
            elif end != (own or next_number()):
                raise InvalidValue(spec.owner, spec.name, end, "an entity of this world or null")
        if component.physical and len(specs) == 2:
            one, other = (getattr(component, spec.name) for spec in specs)
            if other is not None and other == (one or own or next_number()):
                allowed = f"another entity than {specs[0].name}"
                raise InvalidValue(specs[1].owner, specs[1].name, other, allowed)

    def _found(self, entity: int | str) -> int:
        """Return the number of an entity that is given by it, or by its id."""
        if isinstance(entity, str):
            return self.entity(entity)
        if not esper.entity_exists(entity):
            raise KeyError(f"there is no entity {entity} in this world")
        return entity

    def _follow(self) -> None:
        """Follow the present entities and components."""
        self.entity_index.synchronise()

    # ---- columns -------------------------------------------------------------------------------------------

    def table(self, component: type[Any]) -> Table:
        """Return the columns of a component; rows are numbered alike in every table.

        They follow what was spawned or removed where a :meth:`batch` or a component is taken, or a step made.
        """
        index = self.entity_index if self._behind else self._index  # a property takes as long as the rest
        found = index.tables.get(component)
        return index.table(component) if found is None else found

    def batch(self, *components: type[Any]) -> Batch:
        """Return the rows of the entities that have all of ``components``; within a step, at its start."""
        if not self.in_step:
            with self.active():
                self._follow()
        return self.entity_index.batch(*components)


def _kind(component: Any) -> type[Any]:
    """Return a component's type; refuse a type given in its place, and what only holds values."""
    if isinstance(component, type):
        raise TypeError(f"an entity has components, not their types: write {component.__name__}(...)")
    if type(component).__module__ in _NO_COMPONENTS:
        words = shortened(printable(repr(component)))
        raise TypeError(f"an entity has components, as Mass(2.0) is one; {words} is none")
    return type(component)


def _checked(component: Any) -> Any:
    """Return the type of a component; refuse its name, or a component, given in its place."""
    if not isinstance(component, type):
        words = shortened(printable(repr(component)))
        raise TypeError(f"a component is asked for by its type, as Mass is one; {words} is none")
    return component


def _forget(context: str) -> None:
    """Drop the esper context of a world that was deleted."""
    if esper.current_world == context:
        esper.switch_world("default")
    if context in esper.list_worlds():
        esper.delete_world(context)
