"""Graphs, meters and sliders as a window shows them, and what it records for them."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from weakref import WeakKeyDictionary

from physicslab.components import Graph, GraphLine, Meter, Name, Slider, Transform
from physicslab.components.graph import TIME
from physicslab.diagnostics.fits import Fit
from physicslab.diagnostics.quantities import Reading
from physicslab.ecs.component import Component
from physicslab.history import History
from physicslab.languages.sentence import Sentence
from physicslab.state.attached import INSTRUMENTS
from physicslab.view.window.fitting import Fitting
from physicslab.view.window.record import Key, PastSamples, Record
from physicslab.world import World

PANELS: tuple[type[Component], ...] = (Graph, GraphLine, Meter, Slider)
"""The components that are panels of the window."""
_CARRIED: tuple[type[Component], ...] = (*PANELS, *INSTRUMENTS)
"""The components of what measures, and is there again where a scene is started again."""


@dataclass(frozen=True, slots=True)
class LineShown:
    """A line of a graph: the entity that has it, and what it shows."""

    entity: int
    key: Key


@dataclass(frozen=True, slots=True)
class GraphShown:
    """A graph as it was in the world.

    Attributes
    ----------
    entity, number : int
        That of its entity, and its place among the graphs, from 1.
    across : Key, optional
        Quantity on the horizontal axis; ``None`` for the time.
    side : str
        Where in the window it is.
    lines : tuple of LineShown
        In the order in which they were made.
    """

    entity: int
    number: int
    across: Key | None
    side: str
    lines: tuple[LineShown, ...]

    @property
    def keys(self) -> tuple[Key, ...]:
        """All that is to be recorded for it."""
        return (*((self.across,) if self.across else ()), *(line.key for line in self.lines))


@dataclass(frozen=True, slots=True)
class MeterShown:
    """A meter as it was in the world, its number among the meters, and what it shows."""

    entity: int
    number: int
    key: Key
    corner: str


@dataclass(frozen=True, slots=True)
class SliderShown:
    """A slider as it was in the world, its number among the sliders, and what it changes."""

    entity: int
    number: int
    changes: str
    target: int | None
    low: float
    high: float
    unit: str
    corner: str


class Dashboard:
    """Measurements in a window: the instruments of its world, and the samples for their lines.

    Samples belong to the window: they are in no scene file, and no undo takes them back. While the place of
    the history lies in the past, the instruments stay that were there at its end.

    Attributes
    ----------
    graphs, meters, sliders : tuples
        Instruments that are shown.
    record, before : Record
        Measurements of this run, and of the run of the same scene before it.
    pointed : float, optional
        The time under the cursor in a graph [s].
    marks : list of two floats or None
        The times of the cursors A and B [s].
    free_axes : set of int
        Graphs whose axes were moved by hand, and do not follow what is recorded.
    picture_of : int, optional
        The graph of which a picture is to be written.
    past : PastSamples, optional
        Measurements that are made again for the time before there was such a line.
    fitting : Fitting
        The curves that graphs show beside their lines.
    labels : dict of int to str
        Names of measured bodies, those that are gone among them.
    """

    def __init__(self) -> None:
        self.graphs: tuple[GraphShown, ...] = ()
        self.meters: tuple[MeterShown, ...] = ()
        self.sliders: tuple[SliderShown, ...] = ()
        self.record, self.before = Record(), Record()
        self.pointed: float | None = None
        self.marks: list[float | None] = [None, None]
        self.free_axes: set[int] = set()
        self.picture_of: int | None = None
        self.past: PastSamples | None = None
        self.fitting = Fitting()
        self.labels: dict[int, str] = {}
        self._known: set[Key] = set()
        self._own: WeakKeyDictionary[World, frozenset[int]] = WeakKeyDictionary()
        self._sampled: object = None
        self._structure: object = None

    @property
    def state(self) -> tuple[object, ...]:
        """The state that panels are built from, but for the samples."""
        panels = self.graphs, self.meters, self.sliders
        filled = None if self.past is None else round(self.past.share, 2)
        return *panels, self.pointed, *self.marks, len(self.free_axes), filled, self.fitting.state

    def begin(self, world: World, before: World | None, *, is_new: bool) -> None:
        """Follow another world; ``before`` is the one that showed the same scene until now, if one did.

        Its samples stay as the run before. In a world that is new the instruments are made again
        that were added to the one before.
        """
        if is_new:
            self._own[world] = frozenset(_instruments(world))
        bodies: dict[int, int] = {}
        if before is not None:
            own = self._own.get(before, frozenset())
            added = [entity for entity in _instruments(before) if entity not in own] if is_new else []
            bodies = carried_over(before, world, added)
        self.before = self.record.renamed(bodies) if before is not None else Record()
        self.record = Record()
        self.free_axes.clear()
        self.fitting.spans.clear()
        self.labels.clear()
        self.marks, self.pointed = [None, None], None
        self._sampled = self._structure = self.past = None
        self._known.clear()

    def keep(self, world: World) -> None:
        """Take the instruments of a world for its own from now on: they are in its file."""
        self._own[world] = frozenset(_instruments(world))

    def fill(self, history: History) -> None:
        """Measure a part of what lines were before they were made, where there are such lines."""
        keys = {key for graph in self.graphs for key in graph.keys}
        if not history.steps_range[1]:
            self._known |= keys
        if self.past is not None and not self.past.is_of(history):
            self.past = None
        if self.past is None and not keys <= self._known:
            self.past = PastSamples(history, tuple(keys.union(self.record.keys)))
        if self.past is not None and self.past.go_on():
            self._known |= set(self.past.keys)
            self.record, self.past = self.record.after(self.past.record), None

    def follow(self, world: World, history: History) -> None:
        """Find the instruments of the world, and record what they show, where the history is at its end."""
        if history.step_count != history.steps_range[1]:
            return
        index = world.entity_index
        structure = world, index.changes, world.motion_edits
        if structure != self._structure:
            self._structure = structure
            self._find(world)
        keys = dict.fromkeys(key for graph in self.graphs for key in graph.keys)
        sampled = world, world.time, world.motion_edits, tuple(keys)
        if not keys or sampled == self._sampled:
            return
        self._sampled = sampled
        reading = Reading(world)
        values = {key: reading.value(key[1], key[0]) for key in keys}
        self.record.add(world.time, history.step_count, values)

    def _find(self, world: World) -> None:
        lines: dict[int, list[LineShown]] = {}
        for entity, line in _all(world, GraphLine):
            if line.graph is not None:
                shown = LineShown(entity, (line.body, line.quantity))
                lines.setdefault(line.graph, []).append(shown)
        graphs = []
        for number, (entity, graph) in enumerate(_all(world, Graph), start=1):
            across = None if graph.across == TIME else (graph.body, graph.across)
            graphs.append(GraphShown(entity, number, across, graph.side, tuple(lines.get(entity, ()))))
        self.graphs = tuple(graphs)
        self.meters = tuple(
            MeterShown(entity, number, (meter.body, meter.quantity), meter.corner)
            for number, (entity, meter) in enumerate(_all(world, Meter), start=1)
        )
        self.sliders = tuple(
            SliderShown(entity, number, one.changes, one.entity, one.low, one.high, one.unit, one.corner)
            for number, (entity, one) in enumerate(_all(world, Slider), start=1)
        )
        there = {graph.entity for graph in self.graphs}
        self.free_axes &= there
        self.fitting.keep(there)
        bodies = {key[0] for graph in self.graphs for key in graph.keys}
        bodies |= {meter.key[0] for meter in self.meters} | {slider.target for slider in self.sliders}
        for body in bodies:
            if body is not None and body in world.entity_index.row_of:
                self.labels[body] = world.label(body)

    def fitted(self, graph: GraphShown, key: Key) -> Fit | None:
        """Return the curve that is fitted to a line of a graph, ``None`` if there is none."""
        return self.fitting.of(graph.entity, graph.across, key, self.record, self.marks)

    def label(self, body: int | None) -> str:
        """Return what is written for a body, or for the world."""
        return Sentence("World") if body is None else self.labels.get(body, f"entity {body}")

    def step_at(self, time: float) -> int | None:
        """Return the step of the history after which it was a recorded moment, the nearest to a time."""
        row = self.record.nearest(time)
        return None if row is None else int(self.record.steps[row])


def _all[C: Component](world: World, kind: type[C]) -> list[tuple[int, C]]:
    """Return the entities that have a component, in the order of their numbers, with it."""
    entities = sorted(world.batch(kind).entities.tolist())
    return [(entity, world.component(entity, kind)) for entity in entities]


def _instruments(world: World) -> list[int]:
    found = {int(entity) for kind in _CARRIED for entity in world.batch(kind).entities}
    return sorted(entity for entity in found if not world.has(entity, Transform))


def carried_over(before: World, world: World, instruments: Iterable[int]) -> dict[int, int]:
    """Copy instruments from one world to another of the same scene.

    Returns
    -------
    dict of int to int
        Which entity of the other world each of the first is: the one of its id, or else of its number.
    """
    known = _same_entities(before, world)
    for entity in instruments:
        parts = [before.component(entity, kind) for kind in _CARRIED if before.has(entity, kind)]
        made = [_referring(part, known) for part in parts]
        if all(part is not None for part in made):
            named = before.has(entity, Name) and entity not in known
            known[entity] = world.spawn(*made, name=before.label(entity) if named else None)
    return known


def _same_entities(before: World, world: World) -> dict[int, int]:
    named = {world.label(entity): entity for entity in world.entities() if world.has(entity, Name)}
    living = set(world.entities())
    known: dict[int, int] = {}
    for entity in before.entities():
        if before.has(entity, Name):
            if before.label(entity) in named:
                known[entity] = named[before.label(entity)]
        elif entity in living and world.has(entity, Transform) == before.has(entity, Transform):
            known[entity] = entity
    return known


def _referring(part: Component, known: Mapping[int, int]) -> Component | None:
    """Return a copy that refers to the entities of another world; ``None`` where one is not there."""
    given = part.given()
    for spec in part.FIELDS:
        if spec.kind == "entity" and given[spec.name] is not None:
            if given[spec.name] not in known:
                return None
            given[spec.name] = known[given[spec.name]]
    return type(part)(**given)
