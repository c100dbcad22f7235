"""Springs and pins made from a list: between two bodies that are selected, or from one to a fixed point."""

from collections.abc import Sequence
from functools import partial

from physicslab.components import Pin, Transform, Velocity
from physicslab.diagnostics.period import gives_way
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.vector import Vector2
from physicslab.history import Spawn
from physicslab.view.canvas.quantities import quantity
from physicslab.view.window.points import local_point
from physicslab.view.window.spring_tool import spring_between
from physicslab.view.window.window import Action, Window
from physicslab.world import World

_ABOVE = 1.5
"""How far above a body the point is that it is hung from [m]."""
_WAYS = {"spring": False, "rod": True}
"""Ways to join two ends, and whether each is stiff."""


def attachments(world: World, entities: Sequence[int]) -> dict[str, tuple[str, Action]]:
    """Return how the selection can be attached: the words on a button, its tip, and what it does."""
    if not entities or len(entities) > 2 or not all(world.has(entity, Transform) for entity in entities):
        return {}
    joins = len(entities) == 2
    found: dict[str, tuple[str, Action]] = {}
    for way, stiff in _WAYS.items():
        if joins:
            tip = f"A {way} between these two, its rest length their present distance"
            found[f"Join by a {way}"] = tip, partial(_join, entities[0], entities[1], stiff)
        else:
            tip = f"A {way} to a point above it, which can be dragged"
            found[f"Hang on a {way}"] = tip, partial(_hang, entities[0], stiff)
    if joins:
        tip = "A pin half way between the middles of these two, about which they turn"
        found["Join by a pin"] = tip, partial(_pin, entities[0], entities[1])
    else:
        tip = "A pin through its middle, about which it turns"
        found["Pin in place"] = tip, partial(_pin, entities[0], None)
    return found


def _pin(one: int, other: int | None, world: World, window: Window) -> None:
    place = world.component(one, Transform).position
    if other is not None:
        place = 0.5 * (place + world.component(other, Transform).position)
    if not any(world.has(entity, Velocity) for entity in (one, other) if entity is not None):
        window.notify("No pin: neither of its ends could move")
        return
    anchors = [local_point(world, entity, place) for entity in (one, other)]
    try:
        window.edits.do(Spawn([Pin(a=one, b=other, anchor_a=anchors[0], anchor_b=anchors[1])]))
    except InvalidValue as error:
        window.notify(f"No pin: {error.field} must be {error.allowed}", 6.0, failed=True)


def _join(one: int, other: int, stiff: bool, world: World, window: Window) -> None:
    places = [world.component(entity, Transform).position for entity in (one, other)]
    _attach(world, window, one, other, (places[0], places[1]), stiff)


def _hang(entity: int, stiff: bool, world: World, window: Window) -> None:
    place = world.component(entity, Transform).position
    _attach(world, window, entity, None, (place, _within(world, place)), stiff)


def _within(world: World, place: Vector2) -> Vector2:
    """Return the point above a place that a body is hung from: not beyond the walls."""
    top, bounds = place.y + _ABOVE, world.physics.bounds
    return Vector2(place.x, top if bounds is None else max(min(top, bounds[3]), place.y))


def _attach(
    world: World, window: Window, one: int, other: int | None, places: tuple[Vector2, Vector2], stiff: bool
) -> None:
    made = spring_between(world, one, other, places, stiff=stiff)
    if isinstance(made, str):
        window.notify(made)
        return
    (spring,) = window.edits.do(Spawn([made]))
    give = gives_way(world, spring) if stiff else None
    if give is not None:
        window.notify(f"This rod is a stiff spring: weight makes it give way {quantity(1e3 * give, 'mm')}")
