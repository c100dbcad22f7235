"""What a world holds: entities, columns, laws, clock and arrays. It depends on no system and no stepper."""

import itertools
import weakref
from collections.abc import Iterable
from typing import Any, Self

import esper

from physicslab.components import Name
from physicslab.components.name import why_no_id
from physicslab.components.naming import plain_name
from physicslab.ecs.component import Component, InvalidValue
from physicslab.ecs.config import PhysicsConfig, SimulationConfig, field_names
from physicslab.ecs.context import Active, create_numbered, next_number, switch
from physicslab.ecs.entity_index import EntityIndex
from physicslab.ecs.table import Batch, Table
from physicslab.ecs.text import printable, shortened, suggestion
from physicslab.kernels import compile_kernels, seconds_waited
from physicslab.state.account import Account
from physicslab.state.bodies import Bodies
from physicslab.state.checkpoint import Checkpoint
from physicslab.state.contacts import Contacts
from physicslab.state.joints import Joints
from physicslab.state.remainders import NO_REMAINDERS, Remainders
from physicslab.state.sleep import Sleep

type View = tuple[float, float, float, float]
"""What a window shows of a world at first: xmin, ymin, xmax, ymax [m]."""

_numbers = itertools.count(1)
_NO_COMPONENTS = ("builtins", "numpy")
"""Where types come from that hold values, and say nothing of an entity."""


class State:
    """Entities with their components, the laws, the clock, and the arrays that systems and steppers share.

    Attributes
    ----------
    name, title, description : str
        Of the scene.
    view : View, optional
        What a window shows of it at first; all of it where there is none.
    time : float
        The clock [s]. Within a step it is that of the state which a force or a stage sees.
    steps : int
        Steps made.
    substeps : int
        Of how many parts the last step was, or each part of one that was divided: more than
        ``simulation.substeps`` where a system found these too few.
    step_divisions : int
        Into how many parts the last step was divided, which was longer than ``simulation.dt``; or 1.
    force_evaluations, collisions : int
        How often forces were evaluated, and how many impacts there were.
    brought_back : int
        How often a body beyond the bounds was put elsewhere, as something fixed held it there.
    has_forces, uniform_forces : bool
        Whether a force system runs; whether those that do, and all else that acts within a step, accelerate
        all bodies alike and turn none.
    event_driven, rigid_contacts : bool
        Whether collisions are located in time, instead of found within steps; whether contacts are rigid.
    window : tuple of two floats
        When a substep begins and ends, relative to the moment at which impacts are resolved, in substeps.
    generation : int
        Grows whenever columns may have been changed from outside, as between steps.
    kick_before_contacts : float
        Which share of a substep's kick comes before contacts are found.
    moment : float
        The time [s] at which impacts of the substep at hand are resolved.
    revision : int
        How often structure, configuration or columns were changed from outside.
    motion_edits : int
        How often that concerned the motion, as a new trail does not: measurements over time from before do
        not apply any more.
    stale : bool
        Whether systems and steppers are to be chosen again before the next step.
    in_step : bool
        Whether a step is being made, or changes of structure are being followed: neither is begun meanwhile.
    entity_index : EntityIndex
        Which entity has which row.
    bodies : Bodies
        Masses and forces, a row an entity.
    contacts : Contacts
        The near pairs.
    joints : Joints
        What holds bodies together, as rows of constraints.
    fastest_rates : dict of str to float
        Of force systems the fastest rate [rad/s] that was met within steps since the motion was last edited.
    remainders : Remainders
        What rounding left out of positions and velocities in the last step.
    checkpoint : Checkpoint
        The state of motion before the step at hand.
    sleep : Sleep
        Which bodies have come to rest, and are not simulated until something wakes them.
    account : Account
        What changed the energy and the momentum, by cause.
    """

    # An attribute that is misspelt, or belongs elsewhere, would be kept and do nothing.
    __slots__ = (
        "__weakref__",
        "_names",
        "_physics",
        "_simulation",
        "_waited_before",
        "account",
        "bodies",
        "brought_back",
        "checkpoint",
        "collisions",
        "contacts",
        "context",
        "description",
        "entity_index",
        "event_driven",
        "fastest_rates",
        "force_evaluations",
        "generation",
        "has_forces",
        "in_step",
        "joints",
        "kick_before_contacts",
        "moment",
        "motion_edits",
        "name",
        "remainders",
        "revision",
        "rigid_contacts",
        "sleep",
        "stale",
        "step_divisions",
        "steps",
        "substeps",
        "time",
        "title",
        "uniform_forces",
        "view",
        "window",
    )  # fmt: skip

    def __init__(
        self, physics: PhysicsConfig | None = None, simulation: SimulationConfig | None = None
    ) -> None:
        self._physics = physics or PhysicsConfig()
        self._simulation = simulation or SimulationConfig()
        self.name: str = ""
        self.title: str = ""
        self.description: str = ""
        self.view: View | None = None
        self.time, self.steps, self.revision, self.motion_edits = 0.0, 0, 0, 0
        self.substeps, self.step_divisions = self._simulation.substeps, 1
        self.force_evaluations = self.collisions = self.brought_back = 0
        self._waited_before = seconds_waited()
        self.generation = 0
        self.has_forces = self.uniform_forces = self.event_driven = self.rigid_contacts = False
        self.window, self.kick_before_contacts, self.moment = (-0.5, 0.5), 0.5, 0.0
        self.entity_index = EntityIndex()
        self.bodies, self.contacts, self.sleep = Bodies(), Contacts(), Sleep()
        self.joints = Joints()
        self.remainders: Remainders = NO_REMAINDERS
        self.fastest_rates: dict[str, float] = {}
        self.checkpoint = Checkpoint()
        self.account = Account()
        # Every id that was ever given here: only one of these can be in use, so a new one costs no search.
        self._names: set[str] = set()
        self.stale, self.in_step = True, False
        self.context = f"physicslab-{next(_numbers)}"
        self.activate()
        weakref.finalize(self, _forget, self.context)

    # ---- contexts ------------------------------------------------------------------------------------------

    def activate(self) -> None:
        """Make this the world that plain esper calls act on, until another is activated.

        Raises
        ------
        RuntimeError
            If a world is active in another thread.
        """
        switch(self.context)

    def active(self) -> Active[Self]:
        """Make this the world that plain esper calls act on, within a ``with`` block.

        Raises
        ------
        RuntimeError
            At the start of the block, if a world is active in another thread.
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
            may still come.
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
            if entity is not None:
                return create_numbered(entity, components)
            for component in components:
                _check_ends(component)
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
            _check_ends(component, entity)
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
            self._follow()
            found: C | None = esper.try_component(entity, _checked(component))
            if found is None:
                raise KeyError(f"{self.label(entity)} has no {component.__name__}")
            return found

    def has(self, entity: int | str, component: type[Any]) -> bool:
        """Whether an entity exists and has a component."""
        with self.active():
            number = self._holder(entity) if isinstance(entity, str) else entity
            if number is None or not esper.entity_exists(number):
                return False
            return esper.has_component(number, _checked(component))

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

    def label(self, entity: int | str) -> str:
        """Return the entity's id if it has one, else what it is and its number: ``circle 3``."""
        with self.active():
            entity = self.entity(entity) if isinstance(entity, str) else entity
            if not esper.entity_exists(entity):
                return f"entity {entity}"
            named = esper.try_component(entity, Name)
            return named.id if named is not None else plain_name(entity, esper.components_for_entity(entity))

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

    def _holder(self, name: str) -> int | None:
        """Return the entity with this id, if there is one."""
        for entity, named in esper.get_component(Name):
            if named.id == name and esper.entity_exists(entity):
                return entity
        return None

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
        return self.entity_index.table(component)

    def batch(self, *components: type[Any]) -> Batch:
        """Return the rows of the entities that have all of ``components``; within a step, at its start."""
        if not self.in_step:
            with self.active():
                self._follow()
        return self.entity_index.batch(*components)

    # ---- configuration -------------------------------------------------------------------------------------

    @property
    def physics(self) -> PhysicsConfig:
        """The laws of this world."""
        return self._physics

    @physics.setter
    def physics(self, physics: PhysicsConfig) -> None:
        self._physics = physics
        self.stale = self.entity_index.motion_edited = True

    @property
    def simulation(self) -> SimulationConfig:
        """How this world is stepped."""
        return self._simulation

    @simulation.setter
    def simulation(self, simulation: SimulationConfig) -> None:
        self._simulation = simulation
        self.stale = self.entity_index.motion_edited = True

    @property
    def counts(self) -> tuple[int, int, int]:
        """Force evaluations, impacts, and impacts logged."""
        return self.force_evaluations, self.collisions, self.contacts.logged

    def compile(self, kernels: Iterable[Any]) -> None:
        """Compile kernels that are about to be called, or load them."""
        compile_kernels(kernels)

    @property
    def compile_s(self) -> float:
        """Seconds that this process has spent on compiling or loading kernels since this world was made."""
        return seconds_waited() - self._waited_before


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


def _check_ends(component: Any, own: int | None = None) -> None:
    """Refuse a component of the motion that refers to an entity that is not there, nor its own (the next)."""
    if not isinstance(component, Component) or not component.physical:
        return
    for spec in component.FIELDS:
        end = getattr(component, spec.name) if spec.kind == "entity" else None
        if end is not None and not esper.entity_exists(end) and end != (own or next_number()):
            raise InvalidValue(spec.owner, spec.name, end, "an entity of this world or null")


class _Elsewhere:
    """Refuses what is a part of the laws or of the settings where it is written to the world itself."""

    def __init__(self, record: str, name: str) -> None:
        self._words = (
            f"is in world.{record}: "
            f"world.{record} = dataclasses.replace(world.{record}, {name}=...) changes it"
        )
        self._name = name

    def __get__(self, state: State | None, owner: type[State]) -> object:
        if state is None:
            return self
        raise AttributeError(f"world.{self._name} {self._words}")

    def __set__(self, state: State, value: object) -> None:
        raise AttributeError(f"world.{self._name} {self._words}")


for _config in (PhysicsConfig, SimulationConfig):
    for _field in field_names(_config):
        if not hasattr(State, _field):
            setattr(State, _field, _Elsewhere(_config.section, _field))


def _forget(context: str) -> None:
    """Drop the esper context of a world that was deleted."""
    if esper.current_world == context:
        esper.switch_world("default")
    if context in esper.list_worlds():
        esper.delete_world(context)
