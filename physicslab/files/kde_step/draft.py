"""The scene that an import makes: entities as a scene file has them, and what of the world they leave out."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from physicslab.ecs.text import is_line, unique_name
from physicslab.files.kde_step.item import Item, Pair

_LABEL_LIMIT = 100
"""Characters of a name that become an id."""

type Box = tuple[float, float, float, float]
"""Left, low, right and high [m]."""
type Entity = dict[str, Any]
"""An entity as a scene file has it."""


@dataclass(slots=True)
class Body:
    """A body of Step, and the entity that it is here.

    Attributes
    ----------
    entity : dict
        The entity as it stands in the scene.
    is_point : bool
        Whether it is a particle: it has no angle, and points of it keep their directions.
    place : pair of floats
        Where Step has its origin [m]: its centre of mass.
    angle : float
        Its angle [rad].
    centre : pair of floats
        The origin of the entity in the frame of Step's body [m].
    """

    entity: Entity
    is_point: bool
    place: Pair
    angle: float = 0.0
    centre: Pair = (0.0, 0.0)

    @property
    def id(self) -> str:
        """The id of the entity."""
        return str(self.entity["id"])

    @property
    def moves(self) -> bool:
        """Whether it is not held by an anchor or by an infinite mass."""
        return "Velocity" in self.entity

    @property
    def box(self) -> Box:
        """The part of the world that it covers [m]."""
        shape, transform = self.entity.get("Shape", {}), self.entity["Transform"]
        half_width, half_height = 0.5 * shape.get("width", 0.0), 0.5 * shape.get("height", 0.0)
        corners = [(half_width, half_height), (half_width, -half_height)]
        vertices = shape.get("vertices") or [*corners, *((-x, -y) for x, y in corners)]
        x, y = zip(*(turned(vertex, transform.get("angle", 0.0)) for vertex in vertices), strict=True)
        (across, up), reach = transform["position"], shape.get("radius", 0.0)
        return across + min(x) - reach, up + min(y) - reach, across + max(x) + reach, up + max(y) + reach

    def anchor(self, point: Pair) -> list[float]:
        """Return a point of Step's body in the frame of the entity [m]."""
        return [point[0] - self.centre[0], point[1] - self.centre[1]]

    def in_world(self, point: Pair) -> Pair:
        """Return where a point of Step's body is [m]."""
        x, y = turned(point, self.angle)
        return self.place[0] + x, self.place[1] + y


@dataclass(slots=True)
class Draft:
    """Findings of an import so far.

    Attributes
    ----------
    world : int
        The number of the world in the file.
    time : float
        Where its clock stands [s].
    physics : dict
        The laws.
    entities : list of dicts
        The entities in order.
    bodies : dict of int to Body
        Those that are bodies, by their number in the file.
    placed : dict of int to dict
        The entity of any item, by its number in the file.
    lines : dict of str to int
        The line in the file of each entity, by its id.
    losses : list of str
        Items that are not taken, a line each.
    texts : list of str
        Notes that are too long for one.
    points : list of pairs
        Places that should be seen at first, beside bodies [m].
    """

    world: int
    time: float = 0.0
    physics: dict[str, Any] = field(default_factory=lambda: {"gravity_mode": "none"})
    entities: list[Entity] = field(default_factory=list)
    bodies: dict[int, Body] = field(default_factory=dict)
    placed: dict[int, Entity] = field(default_factory=dict)
    lines: dict[str, int] = field(default_factory=dict)
    losses: list[str] = field(default_factory=list)
    texts: list[str] = field(default_factory=list)
    points: list[Pair] = field(default_factory=list)

    @property
    def extent(self) -> Box | None:
        """The part of the world that should be seen at first [m]; ``None`` if nothing is there."""
        boxes = [body.box for body in self.bodies.values()] + [(*point, *point) for point in self.points]
        if not boxes:
            return None
        left, low, right, high = zip(*boxes, strict=True)
        return min(left), min(low), max(right), max(high)

    def lose(self, item: Item, why: str) -> None:
        """Name something that is not taken."""
        self.losses.append(f"{item.label}: {why}")

    def place(self, item: Item, components: Mapping[str, Mapping[str, Any]]) -> Entity:
        """Add an entity for an item, under its name or one like it."""
        name = item.text("name").strip()
        if not name or not is_line(name):
            name = f"{item.kind or item.element.tag} {item.number}"
        entity: Entity = {"id": unique_name(name[:_LABEL_LIMIT], self.lines), **components}
        self.lines[entity["id"]] = item.element.line
        self.entities.append(entity)
        self.placed[item.number] = entity
        return entity

    def end(self, item: Item, name: str) -> Body | None:
        """Return the body of a property, ``None`` for the world or what is not a body here."""
        return self.bodies.get(item.whole(name, 0))


def turned(point: Pair, angle: float) -> Pair:
    """Return a vector turned by an angle [rad]; by zero it keeps its bits."""
    if angle == 0.0:
        return point
    cosine, sine = math.cos(angle), math.sin(angle)
    return cosine * point[0] - sine * point[1], sine * point[0] + cosine * point[1]
