"""Things drawn beside the bodies of a scene: springs, joints, fields, thrusts, notes, gates, graphs."""

from typing import Any

from physicslab import components
from physicslab.components.graph import TIME
from physicslab.components.quantities import QUANTITIES
from physicslab.systems.gate import GateSystem
from physicslab.world import World

type Key = tuple[int | None, str]
"""A body, or ``None`` for the world, and the name of a quantity."""


def places(world: World) -> dict[int, int]:
    """Return the place of each entity with a Transform among these, by its number."""
    entities = world.batch(components.Transform).entities.tolist()
    return {entity: number for number, entity in enumerate(entities)}


def springs_of(world: World) -> list[dict[str, Any]]:
    """Return every spring: its ends by place among the bodies, and its anchors; no B is a fixed point."""
    place, batch = places(world), world.batch(components.Spring)
    found = []
    for own in batch.entities.tolist():
        spring = world.component(own, components.Spring)
        found.append(
            {
                "a": place[spring.a or own], "b": None if spring.b is None else place.get(spring.b),
                "anchor_a": [*spring.anchor_a], "anchor_b": [*spring.anchor_b], "rest": spring.rest_length,
            }
        )  # fmt: skip
    return found


def joints_of(world: World) -> list[dict[str, Any]]:
    """Return every joint: kind, entity, ends by place among the bodies (none is the world), anchors."""
    place, entities = places(world), world.entity_index.entities
    found: list[dict[str, Any]] = []
    for joint in world.joints.joints:
        n = joint.first
        ends = {
            name: place[int(entities[row])] if row else None for name, row in (("a", joint.a), ("b", joint.b))
        }
        anchors = {name: getattr(world.joints, name)[n].tolist() for name in ("anchor_a", "anchor_b")}
        one: dict[str, Any] = {"kind": joint.kind.__name__, "entity": joint.entity} | ends | anchors
        if joint.kind in (components.Rod, components.Rope, components.Pulley, components.Slot):
            part = world.component(joint.entity, joint.kind)
            if isinstance(part, components.Rope):
                one["length"] = part.length
            elif isinstance(part, components.Pulley):
                one["anchor_a"], one["anchor_b"] = [*part.anchor_a], [*part.anchor_b]
                one["wheels"] = [[*part.wheel_a], [*part.wheel_b]]
            elif isinstance(part, components.Slot):
                one |= {"axis": [*part.axis], "lower": part.lower, "upper": part.upper}
        found.append(one)
    return found


def fields_of(world: World) -> dict[str, Any] | None:
    """Return the fields that act on charges; ``None`` where none does."""
    physics = world.physics
    if not len(world.batch(components.Charge)) or not (physics.magnetic_field or physics.electric_field):
        return None
    return {"magnetic": physics.magnetic_field, "electric": [*physics.electric_field]}


def thrusts_of(world: World) -> list[dict[str, Any]]:
    """Return every thrust: its body by place, and what it is."""
    place = places(world)
    return [
        {
            "body": place[entity], "force": [*part.force], "at": [*part.at], "turns": part.frame == "body",
            "frequency": part.frequency, "phase": part.phase,
        }
        for entity in world.batch(components.Thrust, components.Transform).entities.tolist()
        for part in (world.component(entity, components.Thrust),)
    ]  # fmt: skip


def notes_of(world: World) -> list[dict[str, Any]]:
    """Return every note: its text, and where it stands."""
    place = places(world)
    return [
        {"text": note.text, "at": [*note.place], "body": _of(place, note.place_body)}
        for entity in world.batch(components.Note).entities.tolist()
        for note in (world.component(entity, components.Note),)
    ]


def gates_of(world: World, start: float) -> list[dict[str, Any]]:
    """Return every gate: its ends, and what crossed it since ``start`` [s]."""
    place, system = places(world), world.schedule.find(GateSystem)
    crossings = () if system is None else system.crossings
    return [
        {
            "name": world.label(entity),
            "ends": [[*gate.start], [*gate.end]],
            "bodies": [_of(place, gate.start_body), _of(place, gate.end_body)],
            "crossings": [
                [one.time - start, world.label(one.body), one.speed]
                for one in crossings
                if one.gate == entity and one.time >= start
            ],
        }
        for entity in sorted(world.batch(components.Gate).entities.tolist())
        for gate in (world.component(entity, components.Gate),)
    ]


def _of(place: dict[int, int], body: int | None) -> int | None:
    return None if body is None else place.get(body)


def graphs_of(world: World) -> list[tuple[Key | None, list[Key]]]:
    """Return of every graph what stands across, ``None`` for the time, and its lines."""
    lines: dict[int, list[Key]] = {}
    for entity in sorted(world.batch(components.GraphLine).entities.tolist()):
        line = world.component(entity, components.GraphLine)
        if line.graph is not None:
            lines.setdefault(line.graph, []).append((line.body, line.quantity))
    found: list[tuple[Key | None, list[Key]]] = []
    for entity in sorted(world.batch(components.Graph).entities.tolist()):
        graph = world.component(entity, components.Graph)
        across = None if graph.across == TIME else (graph.body, graph.across)
        if entity in lines:
            found.append((across, lines[entity]))
    return found


def quantity_words(world: World, key: Key) -> dict[str, Any]:
    """Return what a quantity is called, its unit, and the number of its body."""
    body, name = key
    label = "" if body is None else world.label(body)
    return {"name": f"{label}: {name}" if label else name, "unit": QUANTITIES[name].unit, "body": body}
