"""Values that the command line gives to fields of a scene: ``--set ball.Mass.mass="2 kg"``."""

import re
from argparse import ArgumentParser
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from physicslab.commands import CommandError
from physicslab.ecs.component import COMPONENTS, Component, Field, InvalidValue
from physicslab.ecs.quantity_text import InvalidText, evaluate_as
from physicslab.ecs.text import suggestion, unique_name
from physicslab.files.checks import shown
from physicslab.files.entities import UNSAVED
from physicslab.files.reader import check_scene
from physicslab.files.writer import write_scene
from physicslab.world import World

_FORM = "ID.Component.field=VALUE"
_WORDS = {"true": True, "false": False}


def add_assignments(parser: ArgumentParser) -> None:
    """Declare the option ``--set``, which may be given any number of times."""
    words = (
        "set a field before the run: a number in SI units or with a unit of its own (2 kg, 30 deg, 5 km/h), "
        "[x, y], [[x, y], ...], true, false, null or a word; repeat it for more fields"
    )
    parser.add_argument("--set", metavar=_FORM, action="append", default=[], help=words)


def assign(world: World, texts: Sequence[str]) -> None:
    """Set fields of a world, all at once: those of one component are checked together.

    Parameters
    ----------
    world : World
        Whose fields.
    texts : sequence of str
        Each ``ID.Component.field=VALUE``; of two for one field the later holds. An entity without an id is
        called as in ``run --json``: what it is and its number, ``circle 3``.

    Raises
    ------
    CommandError
        If one of them cannot be set: which entity, component, field and value, and what is allowed.
    SceneError
        If all together make a scene that none may be.
    """
    if not texts:
        return
    names = _names(world)
    given: dict[tuple[str, type[Component]], dict[str, tuple[str, Any]]] = {}
    for text in texts:
        name, kind, spec, value = _assignment(world, names, text)
        fields = given.setdefault((name, kind), {})
        fields[spec.name] = value, _value(spec, value, names, _place(name, kind, spec))
    for (name, kind), fields in given.items():
        _replace(world, name, names[name], kind, fields)
    check_scene(write_scene(world), "--set")
    for (name, kind), fields in given.items():
        _check_held(world.component(names[name], kind), name, fields)


def _names(world: World) -> dict[str, int]:
    """Return every entity by its id, or by what it is and its number."""
    names: dict[str, int] = {}
    for entity in world.entities():
        names[unique_name(world.label(entity), names)] = entity
    return names


@dataclass(frozen=True, slots=True)
class Place:
    """A field of an entity's component, as the command line names it, and how messages begin that name it."""

    name: str
    entity: int
    kind: type[Component]
    spec: Field
    words: str


def find_place(world: World, option: str, path: str, value: str) -> Place:
    """Return the field of a path ``ID.Component.field``, or raise a CommandError with the ``value``."""
    names = _names(world)
    name, kind, spec, _ = _assignment(world, names, f"{path}={value}", option)
    return Place(name, names[name], kind, spec, _place(name, kind, spec, option))


def _assignment(
    world: World, names: Mapping[str, int], text: str, option: str = "--set"
) -> tuple[str, type[Component], Field, str]:
    """Return the entity's name, the component, the field and the text of the value."""
    splits = list(_splits(text))
    if not splits:
        raise CommandError(f"{option} {shown(text)}: must be {_FORM}")
    name, component, field, value = next((split for split in splits if split[0] in names), splits[0])
    where = f"{option}: entity {shown(name)}: {_shown(component)}.{_shown(field)} = {shown(value)}"
    if name not in names:
        raise CommandError(f"{where}: there is no such entity{_known(name, names)}")
    present = {type(part).__name__: type(part) for part in world.components(names[name])}
    kinds = {word: kind for word, kind in present.items() if COMPONENTS.get(word) is kind}
    kinds = {word: kind for word, kind in kinds.items() if kind not in UNSAVED}
    if component not in kinds:
        missing = "the entity has no" if component in COMPONENTS else "unknown component"
        raise CommandError(f"{where}: {missing} {_shown(component)}{_known(component, kinds)}")
    kind: type[Component] = kinds[component]
    specs = {spec.name: spec for spec in kind.FIELDS}
    if field not in specs:
        raise CommandError(f"{where}: unknown field{_known(field, specs)}")
    return name, kind, specs[field], value


def _splits(text: str) -> Iterator[tuple[str, str, str, str]]:
    """Yield how a text may be read: an id may have dots and equals signs in it."""
    for sign in re.finditer("=", text):
        path, value = text[: sign.start()].strip(), text[sign.end() :].strip()
        name, _, rest = path.rpartition(".")
        name, _, component = name.rpartition(".")
        if name and component and rest:
            yield name, component, rest, value


def _value(spec: Field, text: str, names: Mapping[str, int], where: str) -> Any:
    """Return the value that a text stands for, as the field's component takes it."""
    if text == "null" and (spec.derived or spec.kind == "entity"):
        return None
    try:
        match spec.kind:
            case "number" | "whole" | "vector" | "points":
                return evaluate_as(spec.kind, text, spec.unit)
            case "flag":
                return _WORDS.get(text, text)
            case "entity":
                if text not in names:
                    raise InvalidText(f"there is no such entity{_known(text, names)}")
                return names[text]
    except InvalidText as error:
        allowed = "" if spec.kind == "entity" else f"; must be {spec.allowed}"
        raise CommandError(f"{where} = {shown(text)}: {error}{allowed}") from error
    return text


def _replace(
    world: World, name: str, entity: int, kind: type[Component], fields: Mapping[str, tuple[str, Any]]
) -> None:
    """Put a component with these values in the place of the one that the entity has."""
    held: Component = world.component(entity, kind)
    try:
        made = kind(**{**held.given(), **{field: value for field, (_, value) in fields.items()}})
    except InvalidValue as error:
        where, (first, (text, _)) = (
            f"--set: entity {shown(name)}: {error.component}",
            next(iter(fields.items())),
        )
        if error.field in fields:
            what = f"{error.field} = {shown(fields[error.field][0])}:"
        else:
            what = f"{first} = {shown(text)}: with it {error.field} = {shown(error.value)}"
        raise CommandError(f"{where}.{what} must be {error.allowed}") from error
    world.add(entity, made)


def _check_held(held: Component, name: str, fields: Mapping[str, tuple[str, Any]]) -> None:
    """Refuse a value that the world does not keep, as the spin of a body whose rotation is fixed."""
    for spec in held.FIELDS:
        text, value = fields.get(spec.name, ("", None))
        kept = None if value is None else getattr(held, spec.name)
        if kept is not None and spec.check(kept) != spec.check(value):
            where = _place(name, type(held), spec)
            raise CommandError(f"{where} = {shown(text)}: must be {kept} beside the entity's other fields")


def _place(name: str, kind: type[Component], spec: Field, option: str = "--set") -> str:
    return f"{option}: entity {shown(name)}: {kind.__name__}.{spec.name}"


def _known(word: str, known: Mapping[str, object]) -> str:
    """Return the known names in place of a word, as the end of a message."""
    listed = list(known)
    first = ", ".join(map(_shown, listed[:20])) + (", ..." if len(listed) > 20 else "")
    return f"; must be one of {first or 'none'}{suggestion(word, known)}"


def _shown(word: str) -> str:
    return word if word.isidentifier() else shown(word)
