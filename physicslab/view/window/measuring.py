"""Instruments that are being placed, dragged or written; they are in the world once that is done."""

from dataclasses import dataclass, field
from typing import Any

from physicslab.components import Note, Transform
from physicslab.ecs.vector import Vector2
from physicslab.history import Command, Group, SetField, Spawn
from physicslab.languages.sentence import Sentence
from physicslab.state.attached import local_point
from physicslab.view.canvas.canvas import Rect
from physicslab.view.overlay.instruments import Instrument, Overrides
from physicslab.view.overlay.labels import Labels
from physicslab.world import World


@dataclass(frozen=True, slots=True)
class Spot:
    """A point of the world [m], and the body whose middle it is, if it is one's."""

    place: Vector2
    body: int | None = None


@dataclass(slots=True)
class Writing:
    """A note that is being written.

    Attributes
    ----------
    spot : Spot
        Where it is.
    entity : int, optional
        The note that is there already; ``None`` for a new one.
    text, refusal : str
        The text, and why it is refused.
    """

    spot: Spot
    entity: int | None = None
    text: str = ""
    refusal: str = ""


@dataclass(slots=True)
class _Drag:
    """A drag: some points of an instrument, their positions before, and the place of the press."""

    one: Instrument
    names: tuple[str, ...]
    begin: Vector2
    spot: Spot
    moved: bool = False

    @property
    def places(self) -> dict[str, Spot]:
        """The present places of the points: one alone goes to the cursor, several move as it does."""
        if len(self.names) == 1 and self.one.kind is not Note:
            return {self.names[0]: self.spot}
        by = self.spot.place - self.begin
        return {name: Spot(self.one.points[name] + by) for name in self.names}


@dataclass(slots=True)
class Measuring:
    """The state of the tools that measure.

    Attributes
    ----------
    kind : component type, optional
        The instrument that is being placed.
    spots : list of Spot
        The points of it that are placed.
    writing : Writing, optional
        The note that is being written.
    rects : dict of int to Rect
        Where the words of instruments were drawn last [px].
    labels : Labels
        Where they stand.
    kept : bool
        Whether the press at hand was beside the field of a note, which it kept.
    hovered : int, optional
        The body that the point at the cursor would go with.
    """

    kind: type[Any] | None = None
    spots: list[Spot] = field(default_factory=list)
    writing: Writing | None = None
    rects: dict[int, Rect] = field(default_factory=dict)
    labels: Labels = field(default_factory=Labels)
    kept: bool = False
    hovered: int | None = None
    _drag: _Drag | None = None

    def cancel(self) -> bool:
        """Forget what was begun; return whether there was anything."""
        begun = bool(self.spots) or self._drag is not None or self.writing is not None
        self.kind, self.spots, self._drag, self.writing, self.hovered = None, [], None, None, None
        return begun

    # ---- placing -------------------------------------------------------------------------------------------

    def place(self, kind: type[Any], spot: Spot) -> bool:
        """Put down the next point of an instrument; return whether it is complete."""
        if self.kind is not kind:
            self.cancel()
        self.kind = kind
        self.spots.append(spot)
        return len(self.spots) == len(kind.POINTS)

    def preview(self, spot: Spot) -> Instrument | None:
        """Return the instrument as it would be if its next points were here."""
        if self.kind is None or not self.spots:
            return None
        spots = [*self.spots, *(spot for _ in self.kind.POINTS)]
        return Instrument(0, self.kind, {n: s.place for n, s in zip(self.kind.POINTS, spots, strict=False)})

    def finished(self, world: World) -> Command | None:
        """Return what makes the instrument whose points are all placed, and begin the next."""
        kind, spots = self.kind, self.spots
        self.cancel()
        return None if kind is None else made(world, kind, spots)

    # ---- dragging ------------------------------------------------------------------------------------------

    @property
    def dragged(self) -> int | None:
        """The instrument that is being dragged, or of which a point is."""
        return None if self._drag is None else self._drag.one.entity

    @property
    def kind_in_hand(self) -> type[Any] | None:
        """The instrument being placed or dragged."""
        return self.kind if self._drag is None else self._drag.one.kind

    @property
    def dragged_points(self) -> tuple[str, ...]:
        """The names of its points that are."""
        return () if self._drag is None else self._drag.names

    def take(self, one: Instrument, names: tuple[str, ...], place: Vector2) -> None:
        """Take points of an instrument, at a place of the world [m]."""
        self._drag = _Drag(one, names, place, Spot(place))

    def drag(self, spot: Spot, cursor: Vector2, slack: float) -> None:
        """Let what was taken follow the cursor, once that is farther than a slack [m] from where it was."""
        if self._drag is not None:
            self._drag.spot = spot
            self._drag.moved |= (cursor - self._drag.begin).magnitude > slack

    @property
    def overrides(self) -> Overrides:
        """The places at which dragged points are drawn."""
        if self._drag is None or not self._drag.moved:
            return {}
        entity = self._drag.one.entity
        return {(entity, name): spot.place for name, spot in self._drag.places.items()}

    def release(self, world: World) -> Command | None:
        """Let go; return what moves the points, ``None`` where nothing was moved."""
        drag, self._drag, self.hovered = self._drag, None, None
        if drag is None or not drag.moved or not world.has(drag.one.entity, drag.one.kind):
            return None
        return moved(world, drag.one, drag.places)


def made(world: World, kind: type[Any], spots: list[Spot], **values: object) -> Spawn:
    """Return what makes an instrument with its points at these spots, under a name of its own."""
    for name, spot in zip(kind.POINTS, (_living(world, spot) for spot in spots), strict=True):
        values[name] = local_point(world, spot.body, spot.place)
        values[f"{name}_body"] = spot.body
    noun, number = kind.__name__.lower(), 1
    taken = {world.label(entity) for entity in world.entities()}
    while f"{noun} {number}" in taken:
        number += 1
    return Spawn([kind(**values)], name=f"{noun} {number}")


def _living(world: World, spot: Spot) -> Spot:
    """Return a spot without its body where that is gone meanwhile, as in the past."""
    return spot if spot.body is None or world.has(spot.body, Transform) else Spot(spot.place)


def moved(world: World, one: Instrument, places: dict[str, Spot]) -> Group:
    """Return what puts points of an instrument elsewhere; several keep the bodies that they go with."""
    part, kind = world.component(one.entity, one.kind), one.kind.__name__
    commands: list[Command] = []
    for name, spot in places.items():
        body = getattr(part, f"{name}_body")
        spot = _living(world, spot)
        wanted = spot.body if len(places) == 1 and one.kind is not Note else body
        if wanted != body:
            commands.append(SetField(one.entity, kind, f"{name}_body", wanted))
        commands.append(SetField(one.entity, kind, name, local_point(world, wanted, spot.place)))
    return Group(Sentence("moved {what}", what=world.label(one.entity)), commands)
