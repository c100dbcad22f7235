"""Tools, the actions of the left mouse button in the world, and springs made from a list."""

from collections.abc import Sequence
from functools import partial

from physicslab.components import Pin, Spring, Transform, Velocity
from physicslab.diagnostics.period import gives_way
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.vector import Vector2
from physicslab.history import Command, Group, Remove, RemoveComponent, Spawn
from physicslab.state.joint_rows import KINDS
from physicslab.view.canvas.quantities import quantity
from physicslab.view.controls.measuring import MEASURING_TOOLS, detached, take_instrument
from physicslab.view.controls.picking import body_at, instrument_at, spring_at
from physicslab.view.controls.spawning import CIRCLE, SPAWNS, Spawnable
from physicslab.view.controls.tool import Tool
from physicslab.view.picture.joints import joint_at
from physicslab.view.window.spring_tool import local_point, pin_at, spring_between
from physicslab.view.window.window import Action, Window
from physicslab.world import World


def _nothing(world: World, window: Window) -> None:
    """Do nothing."""


def let_go(world: World, window: Window) -> None:
    """Let go of what is held."""
    window.pins.release(window.edits)
    window.hand.release(world, window.target, window.now, window.pace.paused)


def take_hold(world: World, window: Window) -> bool:
    """Take hold of the body under the cursor, of an instrument, or of the end of a spring, and select it.

    A joint, which lies over bodies, is selected alone, and so is a spring that is not held at its end. Return
    whether there is one.
    """
    joint = joint_at(world, window.camera, window.pointer)
    if joint is not None:
        window.selection.take(joint, add=window.adding)
        return True
    pin = pin_at(world, window.camera, window.pointer)
    entity = body_at(world, window.camera, window.pointer) if pin is None else None
    fixed = entity is None or not world.has(entity, Velocity)
    if pin is None and fixed and take_instrument(world, window):
        return True  # it lies over what is fixed
    if entity is None:
        window.pins.dragged = pin
        spring = spring_at(world, window.camera, window.pointer) if pin is None else pin
        if spring is not None:
            window.selection.take(spring, add=window.adding)
        return spring is not None
    window.selection.take(entity, add=window.adding)
    if not window.hand.take(world, entity, window.place, window.now) and not window.pace.paused:
        window.notify(f"{world.label(entity)} stays where it is: it is fixed")
    return True


def select(world: World, window: Window) -> None:
    """Select and take hold of the body under the cursor; where there is none, begin a rectangle."""
    if take_hold(world, window):
        return
    if not window.adding:
        window.selection.clear()
    window.band = window.place


def end_select(world: World, window: Window) -> None:
    """Let go of what is held, or select all bodies whose middles are in the rectangle."""
    let_go(world, window)
    begin, window.band = window.band, None
    if begin is None:
        return
    low = min(begin.x, window.place.x), min(begin.y, window.place.y)
    high = max(begin.x, window.place.x), max(begin.y, window.place.y)
    batch = world.batch(Transform, Velocity)
    place = world.table(Transform)["position"][batch.rows]
    inside = ((place >= low) & (place <= high)).all(axis=1)
    for entity in batch.entities[inside].tolist():
        if entity not in window.selection.entities:
            window.selection.take(entity, add=True)


def remove(world: World, window: Window) -> None:
    """Remove the joint, the instrument, the body or the spring under the cursor; what ends at a body too."""
    joint = joint_at(world, window.camera, window.pointer)
    if joint is not None:
        remove_joints(world, window, joint)
        return
    entity = instrument_at(world, window.camera, window.pointer, window.measuring.rects)
    entity = body_at(world, window.camera, window.pointer) if entity is None else entity
    spring = spring_at(world, window.camera, window.pointer) if entity is None else None
    if spring is not None and world.has(spring, Transform):  # a body carries it
        window.edits.do(RemoveComponent(spring, Spring.__name__))
        return
    entity = spring if entity is None else entity
    if entity is None:
        window.notify("Nothing to remove: put the cursor on a body or a spring, or select one")
        return
    remove_entities(world, window, (entity,))


def remove_joints(world: World, window: Window, entity: int) -> None:
    """Remove the joints that an entity carries; a body that carries them stays."""
    if not world.has(entity, Transform):
        remove_entities(world, window, (entity,))
        return
    kinds = [kind.__name__ for kind in KINDS if world.has(entity, kind)]
    window.edits.do(Group("removed a joint", [RemoveComponent(entity, kind) for kind in kinds]))


def remove_selected(world: World, window: Window) -> None:
    """Remove the selection; without one, the body under the cursor."""
    if window.selection.entities:
        remove_entities(world, window, window.selection.entities)
    else:
        remove(world, window)


def remove_entities(world: World, window: Window, entities: Sequence[int]) -> None:
    """Remove entities; the springs that end at them go with them."""
    for entity in entities:
        if window.hand.entity == entity:
            window.hand.drop(world)
    removed: list[Command] = [*detached(world, set(entities)), *(Remove(entity) for entity in entities)]
    many = f"removed {len(entities)}" if len(entities) > 1 else ""
    window.edits.do_all(removed, many or ("" if len(removed) == 1 else removed[-1].words(world)))
    window.selection.follow(world)


def begin_spring(world: World, window: Window) -> None:
    """Begin a spring at the body under the cursor."""
    entity = body_at(world, window.camera, window.pointer)
    if entity is not None:
        window.spring_tool.begin(world, entity, window.place)
    elif window.tool == SPRING.name:
        window.notify("A spring begins on a body: press on one, and drag to its end")
    else:
        window.notify("A spring begins on a body: put the cursor on one, hold S, and drag to its end")


def end_spring(world: World, window: Window) -> None:
    """End the spring at the body under the cursor, or at that point of the world."""
    target = body_at(world, window.camera, window.pointer)
    made = window.spring_tool.end(world, target, window.place)
    if not isinstance(made, str):
        window.edits.do(Spawn([made]))
    elif made:
        window.notify(made)


def spawning(spawn: Spawnable) -> Tool:
    """Return the tool that takes hold of bodies, and spawns where there is none."""

    def press(world: World, window: Window) -> None:
        if not take_hold(world, window):
            window.selection.clear()
            spawn.spawn(world, window)

    usage = f"{spawn.title}: click {spawn.place}. Bodies can still be dragged."
    return Tool(spawn.name, spawn.title, usage, press, let_go, spawn=spawn)


HAND = spawning(CIRCLE)
"""The tool at the start: that of a new window."""
SPAWN_TOOLS = (HAND, *(spawning(spawn) for spawn in SPAWNS[1:]))
"""A tool for each thing there is to spawn."""
SPRING = Tool(
    "spring", "Spring", "Spring: press on a body, drag, let go.", begin_spring, end_spring, drags=True
)
REMOVE = Tool(
    "remove", "Erase", "Erase: click a body to remove it with its springs, or a spring.", remove, _nothing
)
_USAGE = "Select: click a body to see its numbers; drag to move or throw it."
SELECT = Tool("select", "Select", _USAGE, select, end_select)
PAN = Tool("pan", "Move view", "Move the view: drag anywhere.", _nothing, _nothing, pans=True, drags=True)
_IN_PALETTE = ("circle", "box", "block", "pendulum", "chain")
_SPAWNING = (tool for tool in SPAWN_TOOLS if tool.name in _IN_PALETTE)
PALETTE = (SELECT, *_SPAWNING, SPRING, *MEASURING_TOOLS, REMOVE, PAN)
"""The tools that are in sight, in their order."""
MORE_TOOLS = tuple(tool for tool in SPAWN_TOOLS if tool.name not in _IN_PALETTE)
"""Those behind one more button."""
TOOLS = {tool.name: tool for tool in (*PALETTE, *MORE_TOOLS)}
"""Every tool, by the name that ``Window.tool`` holds."""


# ---- springs made from a list ------------------------------------------------------------------------------


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
    pin = partial(_pin, bodies=tuple(entities))
    if len(entities) == 2:
        found["Join by a pin"] = "A pin half way between the middles of these two, about which they turn", pin
    else:
        found["Pin"] = "A pin through its middle, about which it turns", pin
    return found


def _pin(world: World, window: Window, bodies: Sequence[int]) -> None:
    places = [world.component(body, Transform).position for body in bodies]
    one, other = (*bodies, None)[:2]
    if not any(world.has(body, Velocity) for body in bodies):
        window.notify("No pin: neither of its ends could move")
        return
    middle = 0.5 * (places[0] + places[-1])
    anchors = [local_point(world, body, middle) for body in (one, other)]
    try:
        window.edits.do(Spawn([Pin(a=one, b=other, anchor_a=anchors[0], anchor_b=anchors[1])]))
    except InvalidValue as error:
        window.notify(f"No pin: {error.field} must be {error.allowed}", 6.0, failed=True)


def _within(world: World, place: Vector2) -> Vector2:
    """Return the point above a place that a body is hung from: not beyond the walls."""
    top, bounds = place.y + _ABOVE, world.physics.bounds
    return Vector2(place.x, top if bounds is None else max(min(top, bounds[3]), place.y))


def _attach(world: World, window: Window, bodies: Sequence[int], stiff: bool) -> None:
    """Put a spring between two bodies, or between one and a point above it."""
    one, other = bodies[0], bodies[1] if len(bodies) > 1 else None
    place = world.component(one, Transform).position
    end = _within(world, place) if other is None else world.component(other, Transform).position
    made = spring_between(world, one, other, (place, end), stiff=stiff)
    if isinstance(made, str):
        window.notify(made)
        return
    (spring,) = window.edits.do(Spawn([made]))
    give = gives_way(world, spring) if stiff else None
    if give is not None:
        window.notify(f"This rod is a stiff spring: weight makes it give way {quantity(1e3 * give, 'mm')}")
