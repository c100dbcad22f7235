"""Tools, the actions of the left mouse button in the world."""

import math
from collections.abc import Sequence

import pygame

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.quantity_text import InvalidText
from physicslab.ecs.vector import Vector2
from physicslab.history import Command, Group, Remove, RemoveComponent, SetField
from physicslab.languages.sentence import Sentence
from physicslab.state.joint_rows import KINDS
from physicslab.view.controls import drawing
from physicslab.view.controls.drawn import Drawn
from physicslab.view.controls.joining import JOINTS, SPRING
from physicslab.view.controls.measure import motion_of
from physicslab.view.controls.measuring import MEASURING_TOOLS, detached, take_instrument
from physicslab.view.controls.picking import body_at, instrument_at, link_at, spring_at
from physicslab.view.controls.spawning import BODIES, GROUPS
from physicslab.view.controls.tool import Tool
from physicslab.view.picture.joints import joint_at
from physicslab.view.window.ends import pin_at
from physicslab.view.window.window import Window
from physicslab.world import World


def let_go(world: World, window: Window) -> None:
    """Let go of what is held."""
    window.pins.release(window.edits)
    window.hand.release(world, window.target, window.now, window.pace.paused)


def give_typed(world: World, window: Window) -> None:
    """Let go of the body in the hand with the speed, direction and mass that were typed; one undo is all."""
    entity, typed, window.sketch.typed = window.hand.entity, window.sketch.typed, ""
    if entity is None:
        return
    body = world.label(entity)
    if not (world.has(entity, Velocity) and world.has(entity, Mass)):
        window.notify(Sentence("{body} stays where it is: it is fixed", body=body))
        return
    try:
        given = motion_of(typed)
    except InvalidText:
        words = "{body}: {typed} is no speed, direction or mass, as 2 m/s, 30 deg, 3 kg are"
        window.notify(Sentence(words, body=body, typed=typed), 5.0, failed=True)
        return
    let_go(world, window)
    edits: list[Command] = []
    if "kg" in given:
        edits.append(SetField(entity, Mass.__name__, "mass", given["kg"]))
    if given.keys() & {"m/s", "deg"}:
        speed = given.get("m/s", world.component(entity, Velocity).linear.magnitude)
        way = Vector2.from_angle(math.radians(given.get("deg", 0.0)))
        edits.append(SetField(entity, Velocity.__name__, "linear", way * speed))
    try:
        window.edits.write(Group(f"{body}: {typed}", edits))
    except InvalidValue as error:
        window.notify(str(error), 5.0, failed=True)


def take_hold(world: World, window: Window) -> bool:
    """Take hold of the body under the cursor, of an instrument, or of the end of a spring, and select it.

    A joint, which lies over bodies, is selected alone, and so is a spring that is not held at its end. Return
    whether there is one.
    """
    joint = joint_at(world, window.camera, window.pointer)
    if joint is not None:
        window.selection.take(joint, add=window.adding)
        return True
    lesson = window.lesson
    pin = pin_at(world, window.camera, window.pointer) if lesson is None else None
    entity = body_at(world, window.camera, window.pointer) if pin is None else None
    fixed = entity is None or not world.has(entity, Velocity)
    if pin is None and fixed and take_instrument(world, window):
        return True  # it lies over what is fixed
    if entity is None:
        window.pins.dragged = pin
        if pin is not None:
            window.edits.history.divide()
        spring = link_at(world, window.camera, window.pointer) if pin is None else pin[0]
        if spring is not None:
            window.selection.take(spring, add=window.adding)
        return spring is not None
    window.selection.take(entity, add=window.adding)
    if lesson is not None and not lesson.opens_hand:
        return True
    window.edits.history.divide()  # one undo takes back what the hand does from now on
    paused = window.pace.paused
    if not window.hand.take(world, entity, window.place, window.now, paused=paused) and not paused:
        window.notify(Sentence("{body} stays where it is: it is fixed", body=world.label(entity)))
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
    joint = joint_at(world, window.camera, window.pointer, lines=True) if entity is None else None
    if joint is not None:
        remove_joints(world, window, joint)
        return
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


def drawing_tool(drawn: Drawn) -> Tool:
    """Return the tool that draws something; one that draws bodies takes hold of those that are there."""

    def press(world: World, window: Window) -> None:
        if drawn.build is None or not take_hold(world, window):
            window.selection.clear()
            drawing.press(world, window, drawn, pygame.BUTTON_LEFT)

    def end(world: World, window: Window) -> None:
        let_go(world, window)
        drawing.release(world, window, drawn)

    usage = f"{drawn.title}: {drawn.usage}."
    return Tool(drawn.name, drawn.title, usage, press, end, drags=not drawn.by_click, draws=drawn)


def begin_by_key(world: World, window: Window) -> None:
    """Begin a spring at the cursor."""
    drawing.press(world, window, SPRING)


def end_by_key(world: World, window: Window) -> None:
    """End the spring at the cursor; the key may have been typed for something else that is being drawn."""
    if window.sketch.name == SPRING.name and not window.sketch.held:
        drawing.release(world, window, SPRING)
        window.sketch.cancel()


DRAWING = {drawn.name: drawing_tool(drawn) for drawn in (*BODIES, *JOINTS, *GROUPS)}
"""A tool for each thing that is drawn."""
HAND = DRAWING["circle"]
"""The tool at the start: that of a new window."""
_ERASING = "Erase: click a body, a spring, a rope or a joint; what ends at a body goes with it."
REMOVE = Tool("remove", "Erase", _ERASING, remove)
_USAGE = "Select: click a body to see its numbers; drag to move or throw it."
SELECT = Tool("select", "Select", _USAGE, select, end_select)
PAN = Tool("pan", "Move view", "Move the view: drag anywhere.", pans=True, drags=True)
_MAKING = ("circle", "box", "polygon", "block", "pendulum")
_JOINING = ("spring", "rod", "rope", "pin")
TOOL_GROUPS = (
    (SELECT,), *(tuple(DRAWING[name] for name in names) for names in (_MAKING, _JOINING)), MEASURING_TOOLS,
    (REMOVE, PAN),
)  # fmt: skip
"""The tools that are in sight: those that make, join, measure and edit stand together."""
PALETTE = tuple(tool for group in TOOL_GROUPS for tool in group)
MORE_TOOLS = tuple(tool for tool in DRAWING.values() if tool not in PALETTE)
"""Those behind one more button."""
TOOLS = {tool.name: tool for tool in (*PALETTE, *MORE_TOOLS)}
"""Every tool, by the name that ``Window.tool`` holds."""
_BY_DIGITS = ("circle", "box", "block", "beam", "capsule", "pendulum", "spring", "rod", "rope", "pin")
_WITH_SHIFT = ("motor", "slot", "weld", "pulley", "gear", "polygon", "ramp", "chain", "brush", "dominoes")
DIGITS = {
    held + str((n + 1) % 10): name
    for held, names in (("", _BY_DIGITS), ("shift+", _WITH_SHIFT))
    for n, name in enumerate(names)
}
"""The tools that digits take up, alone and with Shift, by the names of these keys in SDL."""


def key_of(tool: Tool) -> str:
    """Return the key that takes a tool up, as it is shown; empty for none."""
    return next((key.capitalize() for key, name in DIGITS.items() if name == tool.name), "")
