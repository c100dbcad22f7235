"""Springs made from a list: between the bodies that are selected, or from one to a point above it."""

from collections.abc import Sequence
from functools import partial

from physicslab.components import Transform
from physicslab.diagnostics.period import gives_way
from physicslab.ecs.vector import Vector2
from physicslab.history import Spawn
from physicslab.view.canvas.quantities import quantity
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
    if len(entities) == 2:
        return {
            f"Join by a {way}": (
                f"A {way} between these two, its rest length their present distance",
                partial(_join, entities[0], entities[1], stiff),
            )
            for way, stiff in _WAYS.items()
        }
    words = {"spring": "Hang on a spring", "rod": "Hang on a rod"}
    return {
        words[way]: (f"A {way} to a point above it, which can be dragged", partial(_hang, entities[0], stiff))
        for way, stiff in _WAYS.items()
    }


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
