"""Values that texts give to fields of a scene: ``--set ball.Mass.mass="2 kg"``."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from physicslab.ecs.component import Component, Field, InvalidValue
from physicslab.ecs.quantity_text import InvalidText
from physicslab.ecs.value_text import evaluate_as
from physicslab.files.checks import SceneError, shown
from physicslab.files.places import (
    SECTIONS,
    Place,
    Section,
    entity_names,
    known_words,
    no_part,
    read_path,
    words_of,
)  # fmt: skip
from physicslab.files.reader import check_scene
from physicslab.files.writer import write_scene
from physicslab.world import World

_WORDS = {"true": True, "false": False}
_PART = re.compile(
    rf"(?P<whole>(?:{'|'.join(SECTIONS)}|[^=]+\.[^=.]+)\.[^=.]+)\.(?P<part>[xyz])\s*=(?P<value>.*)", re.DOTALL
)
"""A part of a vector: of one of an entity's components, or of the laws."""


def assign(world: World, texts: Sequence[str]) -> None:
    """Set fields of a world, all at once: those of one component are checked together.

    Parameters
    ----------
    world : World
        Whose fields.
    texts : sequence of str
        Each ``ID.Component.field=VALUE``, or ``physics.field=VALUE`` and ``simulation.field=VALUE``, with
        ``.x`` or ``.y`` behind the field for a part of a vector; of two for one field the later holds. An
        entity without an id is called as in ``run --json``: what it is and its number, ``circle 3``.

    Raises
    ------
    SceneError
        If one of them cannot be set: which entity, component, field and value, and what is allowed; or if
        all together make a scene that none may be.
    """
    if not texts:
        return
    names = entity_names(world)
    given: dict[tuple[str, type[Component] | Section], dict[str, tuple[str, Any]]] = {}
    for text in texts:
        part = _PART.match(text)
        path = text if part is None else f"{part['whole']}={part['value']}"
        name, kind, spec, value = read_path(world, names, path, "--set", "VALUE")
        fields, words = given.setdefault((name, kind), {}), words_of(name, kind, spec)
        if part is None:
            fields[spec.name] = value, _value(spec, value, names, words)
            continue
        place = Place(name, names.get(name, 0), kind, spec, part["part"], "--set")
        if spec.kind != "vector" or place.part == "z":
            raise SceneError(no_part(words, spec, place.part, value))
        number = _value(replace(spec, kind="number"), value, names, f"{words}.{place.part}")
        held = fields[spec.name][1] if spec.name in fields else place.read(world)
        fields[spec.name] = value, place.whole(held, number)
    for (name, kind), fields in given.items():
        _replace(world, name, names.get(name, 0), kind, fields)
    check_scene(write_scene(world), "--set")
    for (name, kind), fields in given.items():
        if name in names and kind not in SECTIONS.values():
            component: Any = kind
            _check_held(world.component(names[name], component), name, fields)


def put(world: World, values: Mapping[Place, Any]) -> None:
    """Set fields, or parts of vectors, to values: those of one component are checked together.

    Raises
    ------
    SceneError
        If one cannot have its value, or if all together make a scene that none may be.
    """
    given: dict[tuple[str, type[Component] | Section], tuple[Place, dict[str, tuple[str, Any]]]] = {}
    for place, value in values.items():
        _, fields = given.setdefault((place.name, place.kind), (place, {}))
        whole = fields[place.spec.name][1] if place.spec.name in fields else place.read(world)
        whole = place.whole(whole, value)
        fields[place.spec.name] = str(whole), whole
    for (name, kind), (place, fields) in given.items():
        _replace(world, name, place.entity, kind, fields, place.option)
    check_scene(write_scene(world), next(iter(values)).option if values else "")


def _value(spec: Field, text: str, names: Mapping[str, int], where: str) -> Any:
    """Return the value that a text stands for, as the field's component takes it."""
    if text == "null" and (spec.derived or spec.kind == "entity"):
        return None
    try:
        match spec.kind:
            case "number" | "whole" | "vector" | "points" | "box":
                return evaluate_as(spec.kind, text, spec.unit)
            case "flag":
                return _WORDS.get(text, text)
            case "entity":
                if text not in names:
                    raise InvalidText(f"there is no such entity{known_words(text, names)}")
                return names[text]
    except InvalidText as error:
        allowed = "" if spec.kind == "entity" else f"; must be {spec.allowed}"
        raise SceneError(f"{where} = {shown(text)}: {error}{allowed}") from error
    return text


def _replace(
    world: World, name: str, entity: int, kind: type[Component] | Section,
    fields: Mapping[str, tuple[str, Any]], option: str = "--set",
) -> None:  # fmt: skip
    """Put a component with these values in the place of the one that the entity has, or such laws."""
    values = {field: value for field, (_, value) in fields.items()}
    try:
        if kind in SECTIONS.values():
            setattr(world, name, replace(getattr(world, name), **values))
            return
        component: Any = kind
        made = component(**{**world.component(entity, component).given(), **values})
    except InvalidValue as error:
        field, (text, _) = next(iter(fields.items()))
        where = words_of(name, kind, next(spec for spec in kind.FIELDS if spec.name == field), option)
        if error.field in fields:
            where = f"{where.removesuffix(field)}{error.field} = {shown(fields[error.field][0])}:"
        else:
            where += f" = {shown(text)}: with it {error.field} = {shown(error.value)}"
        raise SceneError(f"{where} must be {error.allowed}") from error
    world.add(entity, made)


def _check_held(held: Component, name: str, fields: Mapping[str, tuple[str, Any]]) -> None:
    """Refuse a value that the world does not keep, as the spin of a body whose rotation is fixed."""
    for spec in held.FIELDS:
        text, value = fields.get(spec.name, ("", None))
        kept = None if value is None else getattr(held, spec.name)
        if kept is not None and spec.check(kept) != spec.check(value):
            where = words_of(name, type(held), spec)
            raise SceneError(f"{where} = {shown(text)}: must be {kept} beside the entity's other fields")
