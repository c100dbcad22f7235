"""Commands and lines as JSON values, and back, with every check."""

import base64
import zlib
from array import array
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from physicslab.components import Name
from physicslab.ecs.component import COMPONENTS, Component, InvalidValue
from physicslab.ecs.config import MAX_TIME, MIN_TIME
from physicslab.ecs.vector import Vector2
from physicslab.files.checks import (
    SceneError,
    checked_keys,
    checked_object,
    checked_rows,
    is_number,
    refusal,
    shown,
)
from physicslab.history.commands import (
    AddComponent,
    Command,
    Configure,
    Group,
    Remove,
    RemoveComponent,
    SetField,
    SetPhysics,
    SetSimulation,
    Spawn,
)
from physicslab.history.line import Edit, Line, Run, Steps

type _Numbers = Mapping[int, int]
"""The number in the file of an entity that is there at the beginning."""

_GROUP_DEPTH = 20
"""How deeply groups may be nested."""


def line_document(line: Line, numbers: _Numbers) -> list[dict[str, Any]]:
    """Return the entries of a line; ``numbers`` gives entities of the beginning others."""
    written: list[dict[str, Any]] = []
    for entry in line.entries:
        if isinstance(entry, Edit):
            written.append({"edit": entry.words, "command": _written(entry.command, numbers)})
            continue
        pieces = [
            [piece.dt, piece.count] if isinstance(piece, Steps) else _written(piece, numbers)
            for piece in entry.pieces
        ]
        digests = np.array(entry.digests, "<u4").tobytes()
        packed = base64.b64encode(zlib.compress(digests, 1)).decode("ascii")
        written.append({"run": pieces, "digests": packed})
    return written


def _written(command: Command, numbers: _Numbers) -> dict[str, Any]:
    """Return a command as a JSON object."""

    def number(entity: int | None) -> int | None:
        return numbers.get(entity, entity) if entity is not None else None

    def values(part: Component) -> dict[str, Any]:
        of = {spec.name: spec.kind for spec in part.FIELDS}
        return {
            name: number(value) if of[name] == "entity" else _plain(value)
            for name, value in part.given().items()
        }

    match command:
        case Spawn():
            parts = {type(part).__name__: values(part) for part in command.components}
            return {"do": "spawn", "entity": command.entity, "name": command.name, "components": parts}
        case Remove():
            return {"do": "remove", "entity": number(command.entity)}
        case SetField():
            kind = COMPONENTS[command.component]
            entity = any(spec.name == command.field and spec.kind == "entity" for spec in kind.FIELDS)
            value = number(command.value) if entity else _plain(command.value)
            head = {"do": "set", "entity": number(command.entity), "component": command.component}
            return head | {"field": command.field, "value": value}
        case AddComponent(entity, component):
            named = isinstance(component, Name)
            given = {"id": component.id} if isinstance(component, Name) else values(component)
            kind_name = "Name" if named else type(component).__name__
            return {"do": "add", "entity": number(entity), "component": kind_name, "values": given}
        case RemoveComponent():
            return {"do": "take", "entity": number(command.entity), "component": command.component}
        case Configure(changes):
            changed = {key: _plain(value) for key, value in changes.items()}
            return {"do": command.CONFIG.section, "changes": changed}
        case Group():
            parts_of = [_written(part, numbers) for part in command.commands]
            return {"do": "group", "words": command.text, "commands": parts_of}
        case _:
            raise SceneError(f"{type(command).__name__}: no recording holds such a command")


def _plain(value: Any) -> Any:
    """Return a value as JSON has it."""
    if isinstance(value, Vector2 | tuple | np.ndarray):
        return [_plain(part) for part in value]
    return value.item() if isinstance(value, np.generic) else value


def read_line(value: object, source: str) -> Line:
    """Return the line that :func:`line_document` wrote; the first thing not allowed is a SceneError."""
    line = Line()
    for where, entry in checked_rows(value, f"{source}: entries", "a list of edits and runs"):
        found = checked_object(entry, where, 'an object {"edit": ...} or {"run": ...}')
        if "edit" in found:
            checked_keys(found, f"{where}: ", "key", ("edit", "command"))
            words = _text(found["edit"], f"{where}: edit")
            line.add(Edit(words, _command(found.get("command"), f"{where}: command", 0)))
        else:
            line.add(_read_run(found, where))
    return line


def _read_run(found: Mapping[str, Any], where: str) -> Run:
    checked_keys(found, f"{where}: ", "key", ("run", "digests"))
    pieces = [*checked_rows(found.get("run"), f"{where}: run", "a list of [dt, steps] and of commands")]
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
        raise SceneError(f"{where}: digests are of {len(digests) // 4} steps, and there are {run.steps}")
    run.digests = digests
    return run


def _steps(piece: list[Any], where: str, most: int) -> tuple[float, int]:
    allowed = f"[a dt of {MIN_TIME:g} to {MAX_TIME:g} s, a whole number of steps with digests]"
    dt, count = piece if len(piece) == 2 else (0.0, 0)
    if is_number(dt) and MIN_TIME <= dt <= MAX_TIME and type(count) is int and 1 <= count <= most:
        return float(dt), count
    raise refusal(where, piece, allowed)


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
        raise SceneError(f"{where}: must be 16 bytes a step, compressed, in base64") from error
    return array("I", np.frombuffer(content, "<u4").tolist())


def _command(value: object, where: str, depth: int) -> Command:
    """Return the command of a JSON object."""
    found = checked_object(value, where, 'an object {"do": ...}')
    read = _READERS.get(str(found.get("do")))
    if read is None:
        raise refusal(f"{where}: do", found.get("do"), f"one of {', '.join(_READERS)}")
    try:
        return read(found, where, depth)
    except SceneError:
        raise
    except (InvalidValue, KeyError, TypeError, ValueError) as error:
        message = error.args[0] if isinstance(error, KeyError) else error
        raise SceneError(f"{where}: {message}") from error


def _part(name: object, values: object, where: str) -> Component | Name:
    given = checked_object(values, f"{where}: {name}", "an object of values")
    if name == "Name":
        checked_keys(given, f"{where}: Name: ", "key", ("id",))
        return Name(_text(given.get("id"), f"{where}: Name.id"))
    kind = COMPONENTS.get(name) if isinstance(name, str) else None
    if kind is None:
        raise SceneError(f"{where}: there is no component {shown(name)}")
    return kind(**given)


def _spawn(found: Mapping[str, Any], where: str, depth: int) -> Command:
    name = found.get("name")
    parts = checked_object(found.get("components"), f"{where}: components", "an object of components")
    made = [_part(kind, values, where) for kind, values in parts.items()]
    components = [part for part in made if isinstance(part, Component)]
    named = _text(name, f"{where}: name") if name is not None else None
    return Spawn(components, named, _entity(found, where))


def _set(found: Mapping[str, Any], where: str, depth: int) -> Command:
    name = _text(found.get("field"), f"{where}: field")
    return SetField(_entity(found, where), _component(found, where), name, found.get("value"))


def _add(found: Mapping[str, Any], where: str, depth: int) -> Command:
    return AddComponent(_entity(found, where), _part(found.get("component"), found.get("values"), where))


def _changes(found: Mapping[str, Any], where: str) -> Mapping[str, Any]:
    return checked_object(found.get("changes"), f"{where}: changes", "an object of settings")


def _group(found: Mapping[str, Any], where: str, depth: int) -> Command:
    parts = found.get("commands")
    if not isinstance(parts, list) or depth >= _GROUP_DEPTH:
        raise refusal(f"{where}: commands", parts, f"a list of commands, at most {_GROUP_DEPTH} deep")
    read = [_command(part, f"{where}: commands[{k}]", depth + 1) for k, part in enumerate(parts)]
    return Group(_text(found.get("words"), f"{where}: words"), read)


_READERS: Mapping[str, Callable[[Mapping[str, Any], str, int], Command]] = {
    "spawn": _spawn,
    "remove": lambda found, where, _: Remove(_entity(found, where)),
    "set": _set,
    "add": _add,
    "take": lambda found, where, _: RemoveComponent(_entity(found, where), _component(found, where)),
    "physics": lambda found, where, _: SetPhysics(_changes(found, where)),
    "simulation": lambda found, where, _: SetSimulation(_changes(found, where)),
    "group": _group,
}


def _entity(found: Mapping[str, Any], where: str) -> int:
    entity = found.get("entity")
    if type(entity) is not int or not 1 <= entity < 2**31:
        raise refusal(f"{where}: entity", entity, "the number of an entity")
    return entity


def _component(found: Mapping[str, Any], where: str) -> str:
    name = _text(found.get("component"), f"{where}: component")
    if name not in COMPONENTS and name != "Name":
        raise SceneError(f"{where}: there is no component {shown(name)}")
    return name


def _text(value: object, where: str) -> str:
    if not isinstance(value, str):
        raise refusal(where, value, "a text")
    return value
