"""The joints and springs that are drawn, and those made from a list for what is selected."""

from collections.abc import Callable, Sequence
from functools import partial

from physicslab.components import Gear, Pin, Pulley, Rod, Rope, Shape, Slot, Transform, Velocity, Weld
from physicslab.diagnostics.period import gives_way
from physicslab.ecs.component import Component
from physicslab.ecs.vector import Vector2
from physicslab.history import Group, Spawn
from physicslab.state.attached import local_point as in_frame
from physicslab.state.joints import Joint
from physicslab.view.canvas.quantities import quantity
from physicslab.view.controls.drawing import join
from physicslab.view.controls.drawn import Drawn
from physicslab.view.controls.picking import bodies_at
from physicslab.view.window.ends import STUCK, local_point, spring_between
from physicslab.view.window.placing import meetings
from physicslab.view.window.sketch import Grip
from physicslab.view.window.window import Action, Window
from physicslab.world import World

_MOTOR = 3.0
"""Speed of a new motor [rad/s]."""
_ABOVE = 1.5
"""How far above a body the point is that it is hung from [m]."""
_BESIDE = 8.0
"""How near a body must be for a weld to hold it [px]."""
_ROUND = 1e-3
"""The steps of the ratio of a new gear: wheels that are drawn by hand mesh in numbers that can be read."""

type Grips = Sequence[Grip]
"""The points that were put down."""
type Made = Component | str
"""A joint, or why there is none."""


def _stuck(world: World, name: str, *bodies: int | None) -> str:
    """Return why a joint between bodies is of no use: none of its ends could move; empty where one can."""
    moves = any(body is not None and world.has(body, Velocity) for body in bodies)
    return "" if moves else f"No {name}: {STUCK}"


# ---- two ends: springs, rods, ropes ------------------------------------------------------------------------


def _ends(grips: Grips) -> tuple[Grip, Grip]:
    """Return both points, of which the first is on a body if any is."""
    first, second = grips[0], grips[1]
    return (second, first) if first.body is None else (first, second)


def _spring(world: World, window: Window, grips: Grips) -> Made:
    one, other = _ends(grips)
    if one.body is None:
        return "A spring holds a body: begin or end it on one"
    if one.body == other.body:
        return ""
    return spring_between(world, one.body, other.body, (one.place(world), other.place(world)))


def _link(world: World, window: Window, grips: Grips, kind: type[Rod | Rope]) -> Made:
    one, other = _ends(grips)
    name = kind.__name__.lower()
    if one.body is None:
        return f"A {name} holds a body: begin or end it on one"
    if one.body == other.body:
        return ""
    if one.place(world) == other.place(world):
        return f"No {name}: its ends are at one place"
    made = kind(a=one.body, b=other.body, anchor_a=one.anchor, anchor_b=other.anchor)
    return _stuck(world, name, one.body, other.body) or made


# ---- one point: pins, motors, welds ------------------------------------------------------------------------


def _held(world: World, window: Window, place: Vector2, reach: float = 0.0) -> list[int | None]:
    """Return the upper body at a place and the one below it, or the world."""
    found = bodies_at(world, window.camera, window.camera.to_screen(place), reach)
    return [*found, None][:2] if found else []


def _point(
    world: World, window: Window, grips: Grips, make: Callable[..., Component], name: str, reach: float = 0.0
) -> Made:
    """Return what holds two bodies at a point: B is the upper one."""
    place = grips[0].place(world)
    bodies = _held(world, window, place, reach)
    if not bodies:
        return f"A {name} holds a body: click one, or where two overlap"
    b, a = bodies
    made = make(a=a, b=b, anchor_a=in_frame(world, a, place), anchor_b=in_frame(world, b, place))
    return _stuck(world, name, a, b) or made


# ---- more points: slots, pulleys, gears --------------------------------------------------------------------


def _slot(world: World, window: Window, grips: Grips) -> Made:
    place, end = grips[0].place(world), grips[1].place(world)
    bodies = _held(world, window, place)
    if not bodies:
        return "A slot holds a body: begin on the one that is to slide"
    if end == place:
        return "No slot: its way has no length"
    b, a = bodies
    turn = 0.0 if a is None else world.component(a, Transform).angle
    axis = (end - place).normalized.rotated(-turn)
    anchors = in_frame(world, a, place), in_frame(world, b, place)
    return _stuck(world, "slot", a, b) or Slot(a, b, anchor_a=anchors[0], anchor_b=anchors[1], axis=axis)


def _pulley(world: World, window: Window, grips: Grips) -> Made:
    one, wheel_a, other, wheel_b = grips if grips[0].body is not None else (*grips[2:], *grips[:2])
    if one.body is None or one.body == other.body:
        return "A pulley holds two bodies, or a body and a point: begin on a body"
    made = Pulley(
        one.body, other.body, one.anchor, other.anchor,
        wheel_a=wheel_a.place(world), wheel_b=wheel_b.place(world),
    )  # fmt: skip
    return _stuck(world, "pulley", one.body, other.body) or made


def _gear(world: World, window: Window, grips: Grips, name: str = "gear", sense: float = -1.0) -> Made:
    """Return what couples two joints: a gear, whose wheels turn against each other, or a belt (sense 1)."""
    first, second = (_turning(world, grip) for grip in grips)
    if first is None or second is None:
        return _uncoupled(world, *grips, name=name)
    if first.entity == second.entity:
        return f"A {name} couples two different joints"
    return Gear(first.entity, second.entity, ratio=sense * _ratio(world, first, second, grips))


def _uncoupled(world: World, *grips: Grip, name: str) -> str:
    """Return why bodies cannot be coupled; empty where they turn or slide."""
    turning = all(_turning(world, grip) is not None for grip in grips)
    return (
        ""
        if turning
        else f"A {name} couples two bodies that turn about pins, or slide in slots: pin them first"
    )


def _turning(world: World, grip: Grip) -> Joint | None:
    """Return the pin or the slot that holds a body."""
    world.synchronise()
    row = world.entity_index.row_of.get(grip.body or 0, 0)
    found = (one for one in world.joints.joints if one.kind in (Pin, Slot) and row in (one.a, one.b))
    return next(found, None) if row else None


def _ratio(world: World, first: Joint, second: Joint, grips: Grips) -> float:
    """Return the ratio of a belt around two wheels, that of their radii; 1 for others."""
    sign, radii = 1.0, []
    for joint, grip in zip((first, second), grips, strict=True):
        body = grip.body or 0
        is_disc = world.has(body, Shape) and world.component(body, Shape).kind == "circle"
        radii.append(world.component(body, Shape).radius if is_disc else 1.0)
        sign *= 1.0 if world.entity_index.row_of[body] == joint.b else -1.0
    return sign * max(round(radii[0] / radii[1] / _ROUND), 1) * _ROUND


# ---- the table ---------------------------------------------------------------------------------------------


def _motor(**ends: object) -> Pin:
    return Pin(motor_speed=_MOTOR, **ends)  # type: ignore[arg-type]


_TO_END = ("Drag from a body or a point", "... to the other end")
SPRING = Drawn(
    "spring", "Spring", "drag from a body to another, or to a point", join=_spring, prompts=_TO_END
)
JOINTS = (
    SPRING,
    Drawn("rod", "Rod", "drag from a body to another, or to a point: it keeps their distance",
          join=partial(_link, kind=Rod), prompts=_TO_END),
    Drawn("rope", "Rope", "drag from a body to another, or to a point: they cannot part farther",
          join=partial(_link, kind=Rope), prompts=_TO_END),
    Drawn("pin", "Pin", "click a body, or where two overlap: they turn about it", 1,
          join=partial(_point, make=Pin, name="pin"), prompts=("Click where it is to turn",)),
    Drawn("motor", "Motor", "click a body, or where two overlap: a pin that turns the upper one", 1,
          join=partial(_point, make=_motor, name="motor"), prompts=("Click where it is to turn",)),
    Drawn("slot", "Slot", "drag from a body along the way on which it is to slide", join=_slot,
          prompts=("Drag from the body that is to slide", "... along its way")),
    Drawn("weld", "Weld", "click where two bodies meet: they become rigid; or one, to hold it", 1,
          join=partial(_point, make=Weld, name="weld", reach=_BESIDE),
          prompts=("Click where two bodies meet",)),
    Drawn("pulley", "Pulley", "drag from a body to its wheel, then from the other to its wheel", 4,
          join=_pulley, prompts=("Drag from a body to its wheel", "... to the wheel, a point of the world",
                                 "Drag from the other body to its wheel", "... to its wheel")),
    Drawn("gear", "Gear", "click a body on a pin, then another: they turn against each other",
          join=_gear, refuses=partial(_uncoupled, name="gear"),
          prompts=("Click a body on a pin", "... and another")),
    Drawn("belt", "Belt", "click a body on a pin, then another: they turn the same way",
          join=partial(_gear, name="belt", sense=1.0), refuses=partial(_uncoupled, name="belt"),
          prompts=("Click a body on a pin", "... and another")),
)  # fmt: skip
"""All joints that are drawn, in the order of the tools."""
_DRAWN = {drawn.name: drawn for drawn in JOINTS}


# ---- joints made from a list -------------------------------------------------------------------------------


_LISTED = {
    "rod": ("Hang on a rod", "Join by a rod", "It keeps their distance"),
    "rope": ("Hang on a rope", "Join by a rope", "They cannot part farther"),
    "spring": ("Hang from a spring", "Join by a spring", "At rest at its present length"),
    "pin": ("Pin", "Join by a pin", "They turn about it"),
    "motor": ("Motor", "Join by a motor", "A pin that turns the last one"),
    "weld": ("Fix to the world", "Weld together", "They become rigid"),
    "gear": ("", "Couple by a gear", "Their pins turn against each other"),
}
"""Joints for one body and for two: the words of their lines, and a tip."""


def attachments(world: World, entities: Sequence[int]) -> dict[str, tuple[str, Action]]:
    """Return how the selection can be joined: the words of a line, its tip, and what it does.

    Nothing of it is joined if none of it can move; more than two are welded where they meet.
    """
    can_move = any(world.has(entity, Velocity) for entity in entities)
    if not can_move or not all(world.has(entity, Transform) for entity in entities):
        return {}
    chosen = tuple(entities)
    if len(chosen) > 2:
        _, words, tip = _LISTED["weld"]
        return {words: (tip, partial(_weld_all, bodies=chosen))}
    return {
        words[len(chosen) - 1]: (words[2], partial(_join_selected, bodies=chosen, name=name))
        for name, words in _LISTED.items()
        if words[len(chosen) - 1]
    }


def _weld_all(world: World, window: Window, bodies: Sequence[int]) -> None:
    """Weld bodies where two of them meet, as one edit."""
    shaped = [body for body in bodies if world.has(body, Shape)]
    welds = [
        Spawn([made])
        for (a, b), place in meetings(world, shaped, _BESIDE / window.camera.scale).items()
        for made in (Weld(a, b, anchor_a=in_frame(world, a, place), anchor_b=in_frame(world, b, place)),)
        if not _stuck(world, "weld", a, b)
    ]
    if welds:
        window.edits.do(Group(f"made {len(welds)} welds", welds))
    else:
        window.notify("No weld: none of them meets another", 5.0, failed=True)


def _join_selected(world: World, window: Window, bodies: Sequence[int], name: str) -> None:
    """Join two bodies, or one and the world: by their middles, or at the point half way between these."""
    made = join(world, window, _DRAWN[name].title, lambda: _of_selected(world, window, bodies, name))
    give = gives_way(world, made[0]) if made else None
    if give is not None and len(bodies) == 1:
        window.notify(f"Its weight lengthens this spring by {quantity(give, 'm')}", 5.0)


def _of_selected(world: World, window: Window, bodies: Sequence[int], name: str) -> Made:
    places = [world.component(body, Transform).position for body in bodies]
    grips = [Grip(body, Vector2()) for body in bodies]
    kinds: dict[str, Callable[..., Component]] = {"pin": Pin, "motor": _motor, "weld": Weld}
    make = kinds.get(name)
    if make is None:
        if len(bodies) == 1:
            grips.append(Grip(None, _within(world, places[0])))
        drawn = _DRAWN[name].join
        return "" if drawn is None else drawn(world, window, grips)
    b, a = (*reversed(bodies), None)[:2]
    middle = 0.5 * (places[0] + places[-1])
    point = local_point if name != "weld" else in_frame
    made = make(a=a, b=b, anchor_a=point(world, a, middle), anchor_b=point(world, b, middle))
    return _stuck(world, name, *bodies) or made


def _within(world: World, place: Vector2) -> Vector2:
    """Return the point above a place that a body is hung from: not beyond the walls."""
    top, bounds = place.y + _ABOVE, world.physics.bounds
    return Vector2(place.x, top if bounds is None else max(min(top, bounds[3]), place.y))
