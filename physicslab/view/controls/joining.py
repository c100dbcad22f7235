"""The joints and springs that are drawn, and those made from a list for what is selected."""

from collections.abc import Sequence
from functools import partial

from physicslab.components import Pin, Transform, Velocity
from physicslab.diagnostics.period import gives_way
from physicslab.ecs.component import Component
from physicslab.ecs.vector import Vector2
from physicslab.state.attached import local_point as in_frame
from physicslab.view.canvas.quantities import quantity
from physicslab.view.controls.drawing import Drawn, join
from physicslab.view.controls.picking import bodies_at
from physicslab.view.window.sketch import Grip
from physicslab.view.window.spring_tool import local_point, spring_between
from physicslab.view.window.window import Action, Window
from physicslab.world import World

type Grips = Sequence[Grip]
"""The points that were put down."""


def _cannot_move(world: World, *bodies: int | None) -> bool:
    """Whether none of the ends of a joint could move."""
    return not any(body is not None and world.has(body, Velocity) for body in bodies)


def _ends(grips: Grips) -> tuple[Grip, Grip]:
    """Return both points, of which the first is on a body if any is."""
    first, second = grips[0], grips[1]
    return (second, first) if first.body is None else (first, second)


def _spring(world: World, window: Window, grips: Grips) -> Component | str:
    one, other = _ends(grips)
    if one.body is None:
        return "A spring holds a body: begin or end it on one"
    if one.body == other.body:
        return ""
    return spring_between(world, one.body, other.body, (one.place(world), other.place(world)))


def _pin(world: World, window: Window, grips: Grips) -> Component | str:
    place = grips[0].place(world)
    bodies = bodies_at(world, window.camera, window.camera.to_screen(place))[:2]
    if not bodies:
        return "A pin holds a body: click one, or where two overlap"
    one, other = (*bodies, None)[:2]
    if _cannot_move(world, one, other):
        return "No pin: neither of its ends could move"
    return Pin(a=one, b=other, anchor_a=in_frame(world, one, place), anchor_b=in_frame(world, other, place))


SPRING = Drawn(
    "spring", "Spring", "drag from a body to another, or to a point", join=_spring,
    prompts=("Drag from a body or a point", "... to the other end"),
)  # fmt: skip
JOINTS = (
    SPRING,
    Drawn("pin", "Pin", "click a body, or where two overlap: they turn about it", 1, join=_pin,
          prompts=("Click where it is to turn",)),
)  # fmt: skip
"""All joints that are drawn, in the order of the tools."""


# ---- joints made from a list -------------------------------------------------------------------------------


_ABOVE = 1.5
"""How far above a body the point is that it is hung from [m]."""
_WAYS = {"spring": False, "rod": True}
"""Ways to join two ends, and whether each is stiff."""


def attachments(world: World, entities: Sequence[int]) -> dict[str, tuple[str, Action]]:
    """Return how the selection can be attached: the words on a button, its tip, and what it does."""
    if not entities or len(entities) > 2 or not all(world.has(entity, Transform) for entity in entities):
        return {}
    if len(entities) == 2:
        words, tip = "Join by a {}", "A {} between these two, its rest length their present distance"
    else:
        words, tip = "Hang on a {}", "A {} to a point above it, which can be dragged"
    found: dict[str, tuple[str, Action]] = {
        words.format(way): (tip.format(way), partial(_attach, bodies=tuple(entities), stiff=stiff))
        for way, stiff in _WAYS.items()
    }
    pin = partial(_pin_selected, bodies=tuple(entities))
    if len(entities) == 2:
        found["Join by a pin"] = "A pin half way between the middles of these two, about which they turn", pin
    else:
        found["Pin"] = "A pin through its middle, about which it turns", pin
    return found


def _pin_selected(world: World, window: Window, bodies: Sequence[int]) -> None:
    def make() -> Component | str:
        places = [world.component(body, Transform).position for body in bodies]
        one, other = (*bodies, None)[:2]
        if _cannot_move(world, *bodies):
            return "No pin: neither of its ends could move"
        middle = 0.5 * (places[0] + places[-1])
        anchors = [local_point(world, body, middle) for body in (one, other)]
        return Pin(a=one, b=other, anchor_a=anchors[0], anchor_b=anchors[1])

    join(world, window, "Pin", make)


def _within(world: World, place: Vector2) -> Vector2:
    """Return the point above a place that a body is hung from: not beyond the walls."""
    top, bounds = place.y + _ABOVE, world.physics.bounds
    return Vector2(place.x, top if bounds is None else max(min(top, bounds[3]), place.y))


def _attach(world: World, window: Window, bodies: Sequence[int], stiff: bool) -> None:
    """Put a spring between two bodies, or between one and a point above it."""
    one, other = bodies[0], bodies[1] if len(bodies) > 1 else None
    place = world.component(one, Transform).position
    end = _within(world, place) if other is None else world.component(other, Transform).position
    made = join(world, window, "Spring", lambda: spring_between(world, one, other, (place, end), stiff=stiff))
    give = gives_way(world, made[0]) if made and stiff else None
    if give is not None:
        window.notify(f"This rod is a stiff spring: weight makes it give way {quantity(1e3 * give, 'mm')}")
