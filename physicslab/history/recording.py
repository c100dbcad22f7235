"""A line in a file, with the scene that it began with, and what came of every step.

The file is JSON: ``{"format": "physicslab-recording/1", "scene": {...}, "entries": [...]}``. Entities of the
scene have the numbers that it gives them.
"""

import base64
import os
import zlib
from array import array
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from physicslab.components import Name
from physicslab.ecs.component import COMPONENTS, Component, InvalidValue
from physicslab.ecs.config import MAX_TIME, MIN_TIME
from physicslab.ecs.text import printable
from physicslab.ecs.vector import Vector2
from physicslab.files import checks
from physicslab.files.json_text import json_bytes
from physicslab.files.numbers import LARGEST
from physicslab.files.reader import check_scene, checked_scene_text, read_scene
from physicslab.files.replace import replace_file
from physicslab.files.scene import parse_json, read_text
from physicslab.files.writer import write_scene
from physicslab.history import commands
from physicslab.history.line import Edit, Line, Run, Steps
from physicslab.state.contents import SCENE_TEXTS
from physicslab.world import World

_GROUP_DEPTH = 20
"""How deeply groups may be nested."""


def line_document(line: Line) -> list[dict[str, Any]]:
    """Return the entries of a line."""
    written: list[dict[str, Any]] = []
    for entry in line.entries:
        if isinstance(entry, Edit):
            written.append({"edit": entry.words, "command": _written(entry.command)})
            continue
        pieces = [
            [piece.dt, piece.count] if isinstance(piece, Steps) else _written(piece) for piece in entry.pieces
        ]
        digests = np.array(entry.digests, "<u4").tobytes()
        packed = base64.b64encode(zlib.compress(digests, 1)).decode("ascii")
        written.append({"run": pieces, "digests": packed})
    return written


def _written(command: commands.Command) -> dict[str, Any]:
    """Return a command as a JSON object."""

    def values(part: Component) -> dict[str, Any]:
        return {name: _plain(value) for name, value in part.given().items()}

    match command:
        case commands.Spawn():
            parts = {type(part).__name__: values(part) for part in command.components}
            return {"do": "spawn", "entity": command.entity, "name": command.name, "components": parts}
        case commands.Remove():
            return {"do": "remove", "entity": command.entity}
        case commands.SetField():
            head = {"do": "set", "entity": command.entity, "component": command.component}
            return head | {"field": command.field, "value": _plain(command.value)}
        case commands.AddComponent(entity, component):
            named = isinstance(component, Name)
            given = {"id": component.id} if isinstance(component, Name) else values(component)
            kind_name = "Name" if named else type(component).__name__
            return {"do": "add", "entity": entity, "component": kind_name, "values": given}
        case commands.RemoveComponent():
            return {"do": "take", "entity": command.entity, "component": command.component}
        case commands.Configure(changes):
            changed = {key: _plain(value) for key, value in changes.items()}
            return {"do": command.CONFIG.section, "changes": changed}
        case commands.SetText(key, text):
            return {"do": "text", "key": key, "text": text}
        case commands.Group():
            parts_of = [_written(part) for part in command.commands]
            return {"do": "group", "words": command.text, "commands": parts_of}
        case _:
            raise checks.SceneError(f"{type(command).__name__}: no recording holds such a command")


def _plain(value: Any) -> Any:
    """Return a value as JSON has it."""
    if isinstance(value, Vector2 | tuple | np.ndarray):
        return [_plain(part) for part in value]
    return value.item() if isinstance(value, np.generic) else value


def read_line(value: object, source: str) -> Line:
    """Return the line that :func:`line_document` wrote; the first thing not allowed is a SceneError."""
    line = Line()
    for where, entry in checks.checked_rows(value, f"{source}: entries", "a list of edits and runs"):
        found = checks.checked_object(entry, where, 'an object {"edit": ...} or {"run": ...}')
        if "edit" in found:
            checks.checked_keys(found, f"{where}: ", "key", ("edit", "command"))
            words = _text(found["edit"], f"{where}: edit")
            line.add(Edit(words, _command(found.get("command"), f"{where}: command", 0)))
        else:
            line.add(_read_run(found, where))
    return line


def _read_run(found: Mapping[str, Any], where: str) -> Run:
    checks.checked_keys(found, f"{where}: ", "key", ("run", "digests"))
    pieces = [
        *checks.checked_rows(found.get("run"), f"{where}: run", "a list of [dt, steps] and of commands")
    ]
    digests = _digests(found.get("digests"), f"{where}: digests")
    run, left = Run(), len(digests) // 4
    for place, piece in pieces:
        if isinstance(piece, list):
            dt, count = _steps(piece, place, left)
            run.add_steps(dt, count)
            left -= count
        else:
            run.add_write(_command(piece, place, 0))
    if left:
        raise checks.SceneError(
            f"{where}: digests are of {len(digests) // 4} steps, and there are {run.steps}"
        )
    run.digests = digests
    return run


def _steps(piece: list[Any], where: str, most: int) -> tuple[float, int]:
    allowed = f"[a dt of {MIN_TIME:g} to {MAX_TIME:g} s, a whole number of steps with digests]"
    dt, count = piece if len(piece) == 2 else (0.0, 0)
    if checks.is_number(dt) and MIN_TIME <= dt <= MAX_TIME and type(count) is int and 1 <= count <= most:
        return float(dt), count
    raise checks.refusal(where, piece, allowed)


def _digests(value: object, where: str) -> array[int]:
    try:
        if not isinstance(value, str):
            raise ValueError
        packed = base64.b64decode(value, validate=True)
        unpacker = zlib.decompressobj()
        content = unpacker.decompress(packed, 64 * len(packed) + 1024)  # digests hardly get any shorter
        if not unpacker.eof or len(content) % 16:
            raise ValueError
    except (ValueError, zlib.error) as error:
        raise checks.SceneError(f"{where}: must be 16 bytes a step, compressed, in base64") from error
    return array("I", np.frombuffer(content, "<u4").tolist())


def _command(value: object, where: str, depth: int) -> commands.Command:
    """Return the command of a JSON object."""
    found = checks.checked_object(value, where, 'an object {"do": ...}')
    read = _READERS.get(str(found.get("do")))
    if read is None:
        raise checks.refusal(f"{where}: do", found.get("do"), f"one of {', '.join(_READERS)}")
    try:
        return read(found, where, depth)
    except checks.SceneError:
        raise
    except (InvalidValue, KeyError, TypeError, ValueError) as error:
        message = error.args[0] if isinstance(error, KeyError) else error
        raise checks.SceneError(f"{where}: {message}") from error


def _part(name: object, values: object, where: str) -> Component | Name:
    given = checks.checked_object(values, f"{where}: {name}", "an object of values")
    if name == "Name":
        checks.checked_keys(given, f"{where}: Name: ", "key", ("id",))
        return Name(_text(given.get("id"), f"{where}: Name.id"))
    kind = COMPONENTS.get(name) if isinstance(name, str) else None
    if kind is None:
        raise checks.SceneError(f"{where}: there is no component {checks.shown(name)}")
    return kind(**given)


def _spawn(found: Mapping[str, Any], where: str, depth: int) -> commands.Command:
    name = found.get("name")
    parts = checks.checked_object(found.get("components"), f"{where}: components", "an object of components")
    made = [_part(kind, values, where) for kind, values in parts.items()]
    components = [part for part in made if isinstance(part, Component)]
    named = _text(name, f"{where}: name") if name is not None else None
    return commands.Spawn(components, named, _entity(found, where))


def _set(found: Mapping[str, Any], where: str, depth: int) -> commands.Command:
    name = _text(found.get("field"), f"{where}: field")
    return commands.SetField(_entity(found, where), _component(found, where), name, found.get("value"))


def _add(found: Mapping[str, Any], where: str, depth: int) -> commands.Command:
    return commands.AddComponent(
        _entity(found, where), _part(found.get("component"), found.get("values"), where)
    )


def _changes(found: Mapping[str, Any], where: str) -> Mapping[str, Any]:
    return checks.checked_object(found.get("changes"), f"{where}: changes", "an object of settings")


def _set_text(found: Mapping[str, Any], where: str, depth: int) -> commands.Command:
    key = _text(found.get("key"), f"{where}: key")
    if key not in SCENE_TEXTS:
        raise checks.refusal(f"{where}: key", key, f"one of {', '.join(SCENE_TEXTS)}")
    return commands.SetText(key, checked_scene_text(key, found.get("text"), f"{where}: "))


def _group(found: Mapping[str, Any], where: str, depth: int) -> commands.Command:
    parts = found.get("commands")
    if not isinstance(parts, list) or depth >= _GROUP_DEPTH:
        raise checks.refusal(f"{where}: commands", parts, f"a list of commands, at most {_GROUP_DEPTH} deep")
    read = [_command(part, f"{where}: commands[{k}]", depth + 1) for k, part in enumerate(parts)]
    return commands.Group(_text(found.get("words"), f"{where}: words"), read)


_READERS: Mapping[str, Callable[[Mapping[str, Any], str, int], commands.Command]] = {
    "spawn": _spawn,
    "remove": lambda found, where, _: commands.Remove(_entity(found, where)),
    "set": _set,
    "add": _add,
    "take": lambda found, where, _: commands.RemoveComponent(_entity(found, where), _component(found, where)),
    "physics": lambda found, where, _: commands.SetPhysics(_changes(found, where)),
    "simulation": lambda found, where, _: commands.SetSimulation(_changes(found, where)),
    "text": _set_text,
    "group": _group,
}


def _entity(found: Mapping[str, Any], where: str) -> int:
    entity = found.get("entity")
    if type(entity) is not int or not 1 <= entity < 2**31:
        raise checks.refusal(f"{where}: entity", entity, "the number of an entity")
    return entity


def _component(found: Mapping[str, Any], where: str) -> str:
    name = _text(found.get("component"), f"{where}: component")
    if name not in COMPONENTS and name != "Name":
        raise checks.SceneError(f"{where}: there is no component {checks.shown(name)}")
    return name


def _text(value: object, where: str) -> str:
    if not isinstance(value, str):
        raise checks.refusal(where, value, "a text")
    return value


FORMAT = "physicslab-recording/1"
"""The value of a recording's key ``format``."""


def save(world: World, line: Line, path: str | os.PathLike[str]) -> None:
    """Write a line to a file; ``world`` is as at its beginning.

    Raises
    ------
    SceneError
        If the world holds what no scene may.
    OSError
        If the file cannot be written; one that was there before is as it was.
    """
    scene = write_scene(world)
    check_scene(scene, printable(os.fspath(path)))
    if world.next_entity > LARGEST:
        raise checks.SceneError(f"entity {world.next_entity - 1}: a recording has numbers up to {LARGEST:,}")
    entries = line_document(line)
    replace_file(path, json_bytes({"format": FORMAT, "scene": scene, "entries": entries}))


def load(path: str | os.PathLike[str]) -> tuple[World, Line]:
    """Return the world at the beginning of a recording, and the line.

    Raises
    ------
    SceneError
        If the file cannot be read or is no recording: one line that names the place.
    """
    source = printable(os.fspath(path))
    document = parse_json(read_text(path, source), source)
    found = checks.checked_object(
        document, source, 'a recording {"format": ..., "scene": ..., "entries": [...]}'
    )
    if found.get("format") != FORMAT:
        raise checks.refusal(
            f"{source}: format", found.get("format"), f"{checks.shown(FORMAT)}, for a recording"
        )
    checks.checked_keys(found, f"{source}: ", "key", ("format", "scene", "entries"))
    line = read_line(found.get("entries"), source)
    return read_scene(found.get("scene"), f"{source}: scene"), line
