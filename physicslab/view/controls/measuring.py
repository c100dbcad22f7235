"""Rulers, protractors, gates, notes and strobes by mouse and keys."""

import math
from collections.abc import Callable
from typing import Any

import pygame

from physicslab.components import Gate, Note, Protractor, Ruler, Strobe, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.history import AddComponent, Command, Group, Remove, RemoveComponent, SetField
from physicslab.languages.sentence import Sentence
from physicslab.state.attached import attached_to, place_of
from physicslab.view.canvas.keyboard import held_keys
from physicslab.view.controls.measure import LENGTH
from physicslab.view.controls.picking import centre_near, directions_near, instrument_at, point_at
from physicslab.view.controls.tool import Tool
from physicslab.view.overlay.instruments import Instrument, instrument_of
from physicslab.view.window.measuring import Spot, Writing, made
from physicslab.view.window.window import Action, Window
from physicslab.world import World

_CLICK = 4.0
"""How far apart a press and a release are at most that are a click [px]."""
_NEARLY = math.radians(1.5)
"""How far from a direction an arm may be drawn to be meant to have it [rad]."""
_SHARE = 0.3
"""Length of an instrument that is put into the middle of the picture, as a share of its smaller side."""


# ---- where the cursor is -----------------------------------------------------------------------------------


def _spot(world: World, window: Window, origin: Vector2 | None = None) -> Spot:
    """Return the point at the cursor: the middle of a body if it is near, with Shift in a round direction."""
    body = centre_near(world, window.camera, window.pointer)
    if body is not None:
        return Spot(world.component(body, Transform).position, body)
    place = window.place
    if origin is not None and place != origin:
        way = place - origin
        if held_keys() & pygame.KMOD_SHIFT:
            place = origin + LENGTH.rounded(way)
        elif window.measuring.kind_in_hand is Protractor:
            place = origin + Vector2.from_angle(
                _straightened(world, window, origin, way.angle), way.magnitude
            )
    return Spot(place)


def _straightened(world: World, window: Window, vertex: Vector2, angle: float) -> float:
    """Return the angle of an arm [rad]: level, upright or along the box at its vertex, if it nearly is so."""
    for along in (*directions_near(world, window.camera, vertex), 0.0):
        off = math.remainder(angle - along, 0.5 * math.pi)
        if abs(off) < _NEARLY:
            return angle - off
    return angle


def _origin(window: Window) -> Vector2 | None:
    """Return from where a direction is measured: the other end, or the vertex."""
    state = window.measuring
    return state.spots[0].place if state.spots else None


def follow_pointer(world: World, window: Window) -> None:
    """Let the point at the cursor follow it, and note which body it would go with."""
    state = window.measuring
    state.hovered = None
    if state.dragged is not None:
        one = instrument_of(world, state.dragged)
        whole = len(state.dragged_points) > 1 or (one is not None and one.kind is Note)
        others = [] if one is None else [p for n, p in one.points.items() if n not in state.dragged_points]
        spot = Spot(window.place) if whole else _spot(world, window, others[0] if others else None)
        state.drag(spot, window.place, _CLICK / window.camera.scale)
        state.hovered = spot.body
    elif any(tool.name == window.tool for tool in MEASURING_TOOLS) and window.tool != NOTE.name:
        state.hovered = _spot(world, window, _origin(window)).body


def spot_of(world: World, window: Window) -> Spot:
    """Return the point that a click would place now."""
    return _spot(world, window, _origin(window))


# ---- placing -----------------------------------------------------------------------------------------------


def _placing(kind: type[Any]) -> Action:
    def press(world: World, window: Window) -> None:
        """Put down a point."""
        if window.measuring.place(kind, spot_of(world, window)):
            _finish(world, window)

    return press


def _end_placing(world: World, window: Window) -> None:
    """Put down a point where a drag ends."""
    state = window.measuring
    if state.kind is None or not state.spots:
        return
    x, y = window.camera.to_screen(state.spots[-1].place)
    if math.hypot(x - window.pointer[0], y - window.pointer[1]) > _CLICK:
        spot = spot_of(world, window)
        if state.place(state.kind, spot):
            _finish(world, window)


def _finish(world: World, window: Window) -> None:
    command = window.measuring.finished(world)
    if command is not None:
        _select(window, window.edits.do(command))


def _select(window: Window, entities: tuple[int, ...]) -> None:
    if not entities:
        return
    window.selection.entities = entities
    if window.edits.world.has(entities[0], Gate):
        window.shows_stopwatch = True


def _begin_note(world: World, window: Window) -> None:
    """Write a note at the cursor, or the one that is there."""
    if window.measuring.kept:
        window.measuring.kept = False
        return
    entity = instrument_at(world, window.camera, window.pointer, window.measuring.rects)
    if entity is not None and world.has(entity, Note):
        write_note(world, window, entity)
    else:
        window.measuring.writing = Writing(Spot(window.place))


def write_note(world: World, window: Window, entity: int) -> None:
    """Write a note that is there once more."""
    place = place_of(world, entity, Note, "place")
    window.measuring.writing = Writing(Spot(place), entity, world.component(entity, Note).text)


RULER = Tool(
    "ruler", "Ruler",
    "Ruler: drag from point to point; an end in the middle of a body moves with it. Shift: round angles.",
    _placing(Ruler), _end_placing, prompts=("Drag from one point to another", "... to where it ends"),
)  # fmt: skip
PROTRACTOR = Tool(
    "protractor", "Angle", "Angle: drag from the vertex along one arm, then click at the end of the other.",
    _placing(Protractor), _end_placing,
    prompts=("Drag from the vertex along one arm", "... to the end of it", "Click: the end of the other arm"),
)  # fmt: skip
GATE = Tool(
    "gate", "Gate", "Gate: drag a line; the stopwatch times bodies that cross it.",
    _placing(Gate), _end_placing, prompts=("Drag a line for bodies to cross", "... to its other end"),
)  # fmt: skip
NOTE = Tool(
    "note", "Note", "Note: click a point, and write. Enter keeps it.", _begin_note,
    prompts=("Click a point for the note",),
)  # fmt: skip
MEASURING_TOOLS = (RULER, PROTRACTOR, GATE, NOTE)
_KINDS: dict[str, Any] = {RULER.name: Ruler, PROTRACTOR.name: Protractor, GATE.name: Gate, NOTE.name: Note}


def key_action(tool: Tool, choose: Callable[[World, Window, Tool], None]) -> Action:
    """Return what the key of a tool does.

    If as many bodies are selected as it has points, it measures between them; else it is taken in hand.
    Where that is so already, an instrument is put into the middle of the picture.
    """
    kind = _KINDS[tool.name]

    def measure(world: World, window: Window) -> None:
        bodies = window.selection.bodies(world)
        places = [Spot(world.component(body, Transform).position, body) for body in bodies]
        if kind is not Note and len(bodies) == len(kind.POINTS):
            _select(window, window.edits.do(made(world, kind, places)))
        elif window.tool != tool.name:
            choose(world, window, tool)
        elif kind is Note:
            window.measuring.writing = Writing(Spot(window.camera.to_world(window.framing.middle)))
        else:
            _select(window, window.edits.do(made(world, kind, _in_the_middle(window, kind))))

    return measure


def _in_the_middle(window: Window, kind: type[Any]) -> list[Spot]:
    middle, room = window.camera.to_world(window.framing.middle), window.framing.room()
    reach = _SHARE * min(room[2:]) / window.camera.scale
    across, up = Vector2(0.5 * reach, 0.0), Vector2(0.0, 0.5 * reach)
    if kind is Protractor:
        return [Spot(middle), Spot(middle + across), Spot(middle + up)]
    way = up if kind is Gate else across
    return [Spot(middle - way), Spot(middle + way)]


# ---- what is there -----------------------------------------------------------------------------------------


def take_end(world: World, window: Window) -> bool:
    """Take the point of the selected instrument that is under the cursor; return whether there is one."""
    chosen = window.selection.entities
    one = instrument_of(world, chosen[0]) if len(chosen) == 1 else None
    name = None if one is None else point_at(one, window.camera, window.pointer)
    if one is None or name is None or window.measuring.spots:
        return False
    if _KINDS.get(window.tool, one.kind) is not one.kind:
        return False  # another kind of instrument may begin there
    window.measuring.take(one, (name,), window.place)
    return True


def take_instrument(world: World, window: Window) -> bool:
    """Select the instrument under the cursor and take it, an end or all of it; return if there is one."""
    entity = instrument_at(world, window.camera, window.pointer, window.measuring.rects)
    one = None if entity is None else instrument_of(world, entity)
    if one is None:
        return False
    window.selection.take(one.entity, add=window.adding)
    name = point_at(one, window.camera, window.pointer)
    names = (name,) if name is not None else _free_points(world, one)
    if names:
        window.measuring.take(one, names, window.place)
    return True


def _free_points(world: World, one: Instrument) -> tuple[str, ...]:
    """Return the points of an instrument that are on no body; of a note its only one."""
    part = world.component(one.entity, one.kind)
    return tuple(
        name for name in one.kind.POINTS if getattr(part, f"{name}_body") is None or one.kind is Note
    )


def let_instrument_go(world: World, window: Window) -> None:
    """Let go of the instrument in hand: where it was dragged to is one edit."""
    command = window.measuring.release(world)
    if command is not None:
        window.edits.do(command)


def nudged(world: World, entity: int, by: Vector2) -> Command | None:
    """Return what moves the free points of an instrument by a way [m]; of a note its only one."""
    one = instrument_of(world, entity)
    if one is None:
        return None
    part, kind = world.component(entity, one.kind), one.kind.__name__
    moved = _free_points(world, one)
    commands = [SetField(entity, kind, name, getattr(part, name) + by) for name in moved]
    return Group(Sentence("moved {what}", what=world.label(entity)), commands) if commands else None


def detached(world: World, removed: set[int]) -> list[Command]:
    """Return what leaves points where they are whose bodies are about to be removed."""
    commands: list[Command] = []
    for entity, kind, name in attached_to(world, removed):
        if entity not in removed:
            place = place_of(world, entity, kind, name)
            commands += [
                SetField(entity, kind.__name__, f"{name}_body", None),
                SetField(entity, kind.__name__, name, place),
            ]
    return commands


# ---- stopwatch and strobe ----------------------------------------------------------------------------------


def toggle_stopwatch(world: World, window: Window) -> None:
    """Show the stopwatch, or no longer."""
    window.shows_stopwatch = not window.shows_stopwatch
    if window.shows_stopwatch and not len(world.batch(Gate)):
        window.notify("Gates start and stop the stopwatch: draw one with the tool 'Gate'", 6.0)


def toggle_strobes(world: World, window: Window) -> None:
    """Give each body that moves a strobe; where any has one, take them all."""
    with_strobe = world.batch(Strobe).entities.tolist()
    commands: list[Command] = [RemoveComponent(entity, "Strobe") for entity in with_strobe]
    words = "no strobe pictures"
    if not commands:
        moving = world.batch(Transform, Velocity).entities.tolist()
        commands, words = (
            [AddComponent(entity, Strobe()) for entity in moving],
            "strobe pictures of all that moves",
        )
    if commands:
        window.edits.do(Group(words, commands))
    else:
        window.notify("Nothing moves here that a strobe could show")


def keep_note(world: World, window: Window, text: str) -> Command | None:
    """Return what keeps a note that was written; ``None`` where nothing is to be done.

    Raises
    ------
    InvalidValue
        If no note can hold the text.
    """
    writing = window.measuring.writing
    if writing is None:
        return None
    there = writing.entity is not None and world.has(writing.entity, Note)
    if there and writing.entity is not None:
        Note(text)
        if text == world.component(writing.entity, Note).text:
            return None
        return SetField(writing.entity, "Note", "text", text) if text else Remove(writing.entity)
    return made(world, Note, [writing.spot], text=text) if text else None
