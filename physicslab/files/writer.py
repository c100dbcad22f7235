"""From a world to a scene document, by way of a copy that may be written while the world goes on."""

import copy
import math
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from typing import Any

import esper

from physicslab.components import Name, Shape
from physicslab.components.naming import plain_name
from physicslab.components.vertices import plain
from physicslab.contacts.islands import export_rests
from physicslab.contacts.kept import KeptContacts
from physicslab.contacts.memory import kept_rows
from physicslab.ecs.component import COMPONENTS, Component
from physicslab.ecs.config import PhysicsConfig, SimulationConfig, field_names
from physicslab.ecs.entity_index import EntityIndex
from physicslab.ecs.fields import REQUIRED, Field
from physicslab.ecs.text import unique_name
from physicslab.ecs.vector import Vector2
from physicslab.files.checks import SceneError
from physicslab.files.entities import UNSAVED
from physicslab.files.json_text import json_pieces
from physicslab.files.numbers import export_numbers
from physicslab.files.reader import FORMAT
from physicslab.files.remainders import export_remainders
from physicslab.state.contents import SCENE_TEXTS
from physicslab.state.joint_rows import kinds_of
from physicslab.state.state import State
from physicslab.stepping.accounting import kept_joints
from physicslab.stepping.island import KeptIsland
from physicslab.stepping.planning import outlived
from physicslab.world import World


class WorldSnapshot:
    """The entities, components, contacts and laws of a world at one moment.

    Making one copies columns, 1 to 3 ms for 4,000 bodies in contact; reading components from it is left to
    when there is time.

    Attributes
    ----------
    names : dict of int to str
        The ids of the entities that have one.
    entities : list of int
        All entities, in order.
    living, shaped : set of int
        All of them once more, and those with a Shape.
    contacts : Contacts
        Memory of the contact solver.
    joints : list of (int, str, list of float)
        Entity, kind and impulses [N s] of each joint that has impulses.
    rests : list of lists
        Sleeping entities, and how long the others have rested.
    remainders : list of lists
        Rounding remainders of positions and velocities, where not zero.
    chosen : tuple, optional
        Choices made for the motion as it once was, where others would be made now.
    islands : list of KeptIsland, optional
        The islands, where a loaded world would find others.
    texts : dict of str to str
        Name, title and description of the world.
    view : View, optional
        The part that a window shows at first.
    desk : Desk, optional
        The view beside that.
    time : float
        Time of the world [s].
    """

    def __init__(self, world: World) -> None:
        world.synchronise()
        with world.active():
            self.entities = world.entities()
            self.chosen = outlived(world, world.schedule, world.plan)
            self.islands = world.islands.keep(world)
            named = [(entity, name.id) for entity, name in esper.get_component(Name)]
        self.living = living = set(self.entities)
        self.names = {entity: name for entity, name in named if entity in living}
        self.texts = {key: getattr(world, key) for key in SCENE_TEXTS}
        self.time, self.physics, self.simulation = world.time, world.physics, world.simulation
        self.view, self.desk = world.view, world.desk
        self.shaped = set(world.batch(Shape).entities.tolist())
        members = world.islands.members
        kept = world.islands.contacts(world, rescaled=False) if members else KeptContacts.of(world.contacts)
        self.contacts = kept.as_contacts()
        self.joints = kept_joints(world)
        parts: list[State] = [island.state for island in members] or [world]
        self.rests = [rest for part in parts for rest in export_rests(part)]
        # Driven bodies have others in each island, which keeps them.
        own = {body for island in members for body in island.entities.tolist()} if members else living
        self.remainders = sorted(row for part in parts for row in export_remainders(part) if row[0] in own)
        self._rows = dict(world.entity_index.row_of)
        self._tables = _copied(world.entity_index)

    def component(self, entity: int, kind: type[Any]) -> Component | None:
        """Return a component as it was, or ``None`` where the entity had none."""
        row, held = self._rows[entity], self._tables.get(kind)
        if held is None or not held[0][row]:
            return None
        handle: Component = Component.__new__(kind)
        handle._views, handle._row = held[1], row
        return handle


def _copied(entity_index: EntityIndex) -> dict[type[Any], tuple[list[bool], list[Any]]]:
    """Return of every table which rows are present, and its columns as flat views of copies."""
    return {
        kind: (
            table.present.tolist(),
            [memoryview(copy.copy(column).reshape(-1)) for column in table.columns],
        )
        for kind, table in entity_index.tables.items()
        if table.handles
    }


_FIRST = ("Transform", "Velocity", "Mass", "Shape", "Material", "Spring", "Trail")


def write_scene(world: World) -> dict[str, Any]:
    """Return the scene document of a world, from which :func:`read_scene` makes the same world, bit for bit.

    Fields at their default are left out. An entity that others refer to and that has no id gets one in the
    document, not in the world. A held body is written as if it had been released. Plain esper components, for
    which there are no columns, have no place in a scene.

    Raises
    ------
    SceneError
        If a component refers to an entity that is not there.
    """
    pieces = scene_pieces(WorldSnapshot(world))
    while True:
        try:
            next(pieces)
        except StopIteration as done:
            document: dict[str, Any] = done.value
            return document


class SceneText:
    """A scene file that is written a little at a time, while the world goes on.

    Parameters
    ----------
    snapshot : WorldSnapshot
        The snapshot to write.
    clock : callable
        Returns the time [s].

    Raises
    ------
    SceneError
        As :func:`write_scene`.
    ValueError
        If a number is not finite.
    """

    def __init__(self, snapshot: WorldSnapshot, clock: Callable[[], float] = time.perf_counter) -> None:
        self._pieces, self._clock = _text_pieces(snapshot), clock
        self._content: list[bytes] = []

    def go_on(self, seconds: float = math.inf) -> bytes | None:
        """Write for so many seconds; return the file once it is whole."""
        deadline = self._clock() + seconds
        for piece in self._pieces:
            self._content.append(piece or b"")
            if self._clock() >= deadline:
                return None
        return b"".join(self._content)


def _text_pieces(snapshot: WorldSnapshot) -> Iterator[bytes | None]:
    """Yield a scene file piece by piece, and ``None`` where a pause is possible."""
    document = yield from scene_pieces(snapshot)
    for piece in json_pieces(document):
        yield piece.encode("utf-8")


def scene_pieces(snapshot: WorldSnapshot) -> Generator[None, None, dict[str, Any]]:
    """Write like :func:`write_scene`, stopping after every entity: the world may go on meanwhile.

    The document is what the generator returns.
    """
    entities: dict[int, list[Component]] = {}
    for number in snapshot.entities:
        entities[number] = _saved(snapshot, number)
        yield
    contacts: list[list[Any]] = []
    shaped = {0, *snapshot.shaped}
    for row in kept_rows(snapshot.contacts):
        if row is not None and shaped.issuperset(row[:2]):  # what is still there to touch
            contacts.append(row)
        yield
    ids = dict(snapshot.names)
    referred = {end for row in contacts for end in row[:2]} | {rest[0] for rest in snapshot.rests}
    referred |= {row[0] for row in (*snapshot.remainders, *snapshot.joints)}
    for island in snapshot.islands or ():
        referred |= {*island.bodies, *(int(row[0]) for row in island.driven)}
    ids |= yield from _invented(entities, ids, referred)
    document: dict[str, Any] = {"format": FORMAT} | {
        key: text for key, text in snapshot.texts.items() if text
    }
    if snapshot.view is not None:
        document["view"] = list(snapshot.view)
    if snapshot.desk is not None:
        document["desk"] = {"level": snapshot.desk.level, "shown": sorted(snapshot.desk.shown)}
    if snapshot.time:
        document["time"] = snapshot.time
    document["physics"] = _settings(snapshot.physics)
    document["simulation"] = _settings(snapshot.simulation)
    if numbers := export_numbers(snapshot.entities):
        document["numbers"] = numbers
    document["entities"] = written = []
    for number, components in entities.items():
        label = snapshot.names.get(number) or plain_name(number, components)
        named = {"id": ids[number]} if number in ids else {}
        written.append(named | {type(part).__name__: _fields(part, ids, label) for part in components})
        yield
    for memory in contacts:
        memory[:2] = [ids.get(end) for end in memory[:2]]
        yield
    rests = [[ids[rest[0]], *rest[1:]] for rest in snapshot.rests]
    remainders = [[ids[row[0]], *row[1:]] for row in snapshot.remainders]
    joints = [[ids[entity], kind, *impulses] for entity, kind, impulses in snapshot.joints]
    kept = {
        "contacts": contacts,
        "joints": joints,
        "rests": rests,
        "solver": _solver(snapshot),
        "remainders": remainders,
    }
    islands = {} if snapshot.islands is None else {"islands": _islands(snapshot.islands, ids)}
    return document | {key: value for key, value in kept.items() if value} | islands


def _islands(islands: Sequence[KeptIsland], ids: Mapping[int, str]) -> list[dict[str, Any]]:
    """Return the bodies of each island, and what its world does not begin with."""
    return [
        {"bodies": [ids[body] for body in island.bodies], "span": island.span, "finer": island.finer}
        | ({"chosen": list(island.chosen)} if island.chosen is not None else {})
        | ({"driven": [[ids[int(row[0])], *row[1:]] for row in island.driven]} if island.driven else {})
        for island in islands
    ]


def _solver(snapshot: WorldSnapshot) -> dict[str, Any]:
    """Return the time over which impulses act, how much finer the next step is, and what was chosen before.

    Each only where a world would not start so; islands have each their own time.
    """
    contacts, simulation = snapshot.contacts, snapshot.simulation
    usual = contacts.impulse_dt in (0.0, simulation.dt / simulation.substeps)
    span = {} if usual or snapshot.islands else {"span": contacts.impulse_dt}
    finer = {"finer": contacts.substep_factor} if contacts.substep_factor != 1 else {}
    return span | finer | ({"chosen": list(snapshot.chosen)} if snapshot.chosen is not None else {})


def _saved(snapshot: WorldSnapshot, entity: int) -> list[Component]:
    """Return those of an entity's components that a file holds, the contract's first.

    An instrument is left out whose body is gone: there is nothing that it could measure.
    """
    order = [*_FIRST, *(name for name in COMPONENTS if name not in _FIRST)]
    kinds = [COMPONENTS[name] for name in order if COMPONENTS[name] not in UNSAVED]
    found = (snapshot.component(entity, kind) for kind in kinds)
    return [part for part in found if part is not None and not _is_lost(part, snapshot)]


def _is_lost(component: Component, snapshot: WorldSnapshot) -> bool:
    """Whether an instrument refers to an entity that is gone, or that has not the component it needs."""
    if component.physical:
        return False
    return any(
        (entity := getattr(component, name)) is not None
        and (
            entity not in snapshot.living
            or all(snapshot.component(entity, COMPONENTS[kind]) is None for kind in kinds_of(needed))
        )
        for name, needed in component.references().items()
    )


def _invented(
    entities: Mapping[int, Iterable[Component]], ids: Mapping[int, str], referred: set[int]
) -> Generator[None, None, dict[int, str]]:
    """Return ids for the entities that have none and are referred to, by components or in ``referred``."""
    for components in entities.values():
        yield
        for component in components:
            ends = (getattr(component, spec.name) for spec in component.FIELDS if spec.kind == "entity")
            referred.update(end for end in ends if end is not None)
    invented: dict[int, str] = {}
    taken = set(ids.values())
    for number, components in entities.items():
        if number in referred and number not in ids:
            invented[number] = unique_name(plain_name(number, components), taken)
            taken.add(invented[number])
    return invented


def _fields(component: Component, ids: Mapping[int, str], label: str) -> dict[str, Any]:
    written: dict[str, Any] = {}
    given = component.given()
    for spec in component.FIELDS:
        value = given[spec.name]
        if spec.kind == "entity" and value is not None:
            if value not in ids:
                place = f"{label}: {type(component).__name__}.{spec.name}"
                raise SceneError(f"{place} = {value}: must be an entity of this world")
            written[spec.name] = ids[value]
        elif not _is_default(spec, value):
            written[spec.name] = plain(value)
    return written


def _is_default(spec: Field, value: Any) -> bool:
    """Whether leaving the field out gives the same bits: -0.0 is not 0.0."""
    if spec.default is REQUIRED or spec.default is None:
        return value is None
    if isinstance(value, Vector2):
        return repr(value) == repr(Vector2(*spec.default))
    return repr(value) == repr(float(spec.default) if isinstance(value, float) else spec.default)


def _settings(config: PhysicsConfig | SimulationConfig) -> dict[str, Any]:
    values = {name: getattr(config, name) for name in field_names(type(config))}
    return {name: plain(value) for name, value in values.items()}
