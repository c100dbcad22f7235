"""Fields of a world as texts name them: ``ball.Mass.mass``, ``ball.Velocity.linear.x``, ``physics.G``."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from physicslab.ecs.component import COMPONENTS, Component, Field
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.text import suggestion, unique_name
from physicslab.files.checks import SceneError, shown
from physicslab.files.entities import UNSAVED
from physicslab.world import World

type Section = type[PhysicsConfig] | type[SimulationConfig]

SECTIONS: dict[str, Section] = {"physics": PhysicsConfig, "simulation": SimulationConfig}
"""The laws of a world, and how it is stepped, by what scene files call them."""
_FORM = "ID.Component.field"
_PART = re.compile(r"(?P<whole>.+?)(?:\.(?P<letter>[xyz])|\[(?P<number>\d+)\])")


@dataclass(frozen=True, slots=True)
class Place:
    """A field of an entity's component, or of the laws, or a part of a vector.

    Attributes
    ----------
    name, entity : str, int
        Name and number of the entity; 0 for the laws.
    kind : type
        The component, or the laws.
    spec : Field
        The field.
    part : str
        ``"x"`` or ``"y"``; empty for the whole field.
    option : str
        The beginning of messages: where it was given.
    """

    name: str
    entity: int
    kind: type[Component] | Section
    spec: Field
    part: str
    option: str

    @property
    def words(self) -> str:
        """How messages begin that name it."""
        return words_of(self.name, self.kind, self.spec, self.option)

    @property
    def field(self) -> str:
        """Name of the whole field: ``ball.Velocity.linear``, ``physics.gravity``."""
        if self.kind in SECTIONS.values():
            return f"{self.name}.{self.spec.name}"
        return f"{self.name}.{self.kind.__name__}.{self.spec.name}"

    @property
    def path(self) -> str:
        """Its name, with its part."""
        return f"{self.field}.{self.part}" if self.part else self.field

    def read(self, world: World) -> Any:
        """Return the whole field's value, as components and laws have it."""
        return getattr(self._owner(world), self.spec.name)

    def value(self, world: World) -> Any:
        """Return the value of the field, or of its part."""
        held = self.read(world)
        return getattr(held, self.part) if self.part else held

    def whole(self, held: Any, value: Any) -> Any:
        """Return the value of a whole field that is ``held`` where ``value`` is that of the part."""
        if not self.part:
            return value
        x, y = held
        return (value, y) if self.part == "x" else (x, value)

    def write(self, world: World, value: Any) -> None:
        """Give the field, or its part, a value.

        Raises
        ------
        InvalidValue
            If it cannot be that.
        """
        whole = self.whole(self.read(world), value)
        if self.kind in SECTIONS.values():
            setattr(world, self.name, replace(self._owner(world), **{self.spec.name: whole}))
        else:
            setattr(self._owner(world), self.spec.name, whole)

    def _owner(self, world: World) -> Any:
        if self.kind in SECTIONS.values():
            return getattr(world, self.name)
        kind: Any = self.kind
        return world.component(self.entity, kind)


def entity_names(world: World, most: int | None = None) -> dict[str, int]:
    """Return every entity, or the first few, by its id, or by what it is and its number."""
    names: dict[str, int] = {}
    for entity in world.entities()[:most]:
        names[unique_name(world.label(entity), names)] = entity
    return names


def find_place(
    world: World, option: str, path: str, value: str, names: Mapping[str, int] | None = None
) -> Place:
    """Return the field, or the part of a vector, that a path names.

    Parameters
    ----------
    world : World
        Whose field.
    option : str
        The beginning of messages: where the path was given.
    path : str
        ``ID.Component.field`` or ``physics.field``, with ``.x`` or ``[0]`` behind it for a part of a vector.
    value : str
        The value to set, for messages; empty where there is no one value.
    names : mapping of str to int, optional
        The entities, where they are known already.

    Raises
    ------
    SceneError
        If there is no such field.
    """
    part = _PART.fullmatch(path.strip())
    letter = (
        "" if part is None else part["letter"] or {"0": "x", "1": "y"}.get(part["number"], part["number"])
    )
    whole = path if part is None else part["whole"]
    names = entity_names(world) if names is None else names
    name, kind, spec, _ = read_path(world, names, f"{whole}={value}", option, value)
    found = Place(name, names.get(name, 0), kind, spec, letter, option)
    if letter and (spec.kind != "vector" or letter not in "xy"):
        raise SceneError(no_part(found.words, spec, letter, value))
    return found


def no_part(words: str, spec: Field, letter: str, value: str) -> str:
    """Return why a field has not the part that was named."""
    name = spec.name
    allowed = f"{name}.x or {name}.y" if spec.kind == "vector" else "a number, or a part of a vector"
    return f"{words}.{letter}{_given(value)}: must be {allowed}"


def read_path(
    world: World, names: Mapping[str, int], text: str, option: str, form: str
) -> tuple[str, type[Component] | Section, Field, str]:
    """Return what ``ID.Component.field=VALUE`` names: the entity, the component, the field; and the value.

    For a field of the laws, ``physics.field=VALUE``, they are the section and its record.

    Raises
    ------
    SceneError
        If the world has no such entity, component or field; ``form`` is that of a value, for the message.
    """
    splits = list(_splits(text))
    section = next((one for one in splits if one[1] in SECTIONS and not one[0]), None)
    unknown = next((one[1] for one in splits if not one[0]), "")
    splits = [one for one in splits if one[0]]
    known_entity = next((split for split in splits if split[0] in names), None)
    if section is not None and known_entity is None:
        _, name, field, value = section
        return name, SECTIONS[name], _spec(f"{option}: {name}", SECTIONS[name].FIELDS, field, value), value
    if not splits:
        given, wanted = (text, f"{_FORM}={form}") if form else (text.removesuffix("="), _FORM)
        raise SceneError(f"{option} {shown(given)}: must be {wanted}{suggestion(unknown, SECTIONS)}")
    name, component, field, value = known_entity or splits[0]
    where = f"{option}: entity {shown(name)}: {_shown(component)}"
    if name in SECTIONS and name not in names:
        spec = _spec(f"{option}: {name}", SECTIONS[name].FIELDS, component, value)
        raise SceneError(no_part(words_of(name, SECTIONS[name], spec, option), spec, field, value))
    if name not in names:
        raise SceneError(
            f"{where}.{_shown(field)}{_given(value)}: there is no such entity{known_words(name, names)}"
        )
    present = {type(part).__name__: type(part) for part in world.components(names[name])}
    kinds = {word: kind for word, kind in present.items() if COMPONENTS.get(word) is kind}
    kinds = {word: kind for word, kind in kinds.items() if kind not in UNSAVED}
    if component not in kinds:
        missing = "the entity has no" if component in COMPONENTS else "unknown component"
        raise SceneError(
            f"{where}.{_shown(field)}{_given(value)}: {missing} {_shown(component)}"
            f"{known_words(component, kinds)}"
        )
    return name, kinds[component], _spec(where, kinds[component].FIELDS, field, value), value


def _spec(where: str, fields: tuple[Field, ...], field: str, value: str) -> Field:
    specs = {spec.name: spec for spec in fields}
    if field not in specs:
        raise SceneError(f"{where}.{_shown(field)}{_given(value)}: unknown field{known_words(field, specs)}")
    return specs[field]


def _given(value: str) -> str:
    return f" = {shown(value)}" if value else ""


def _splits(text: str) -> Iterator[tuple[str, str, str, str]]:
    """Yield how a text may be read: an id may have dots and equals signs in it, and the laws have no id."""
    for sign in re.finditer("=", text):
        path, value = text[: sign.start()].strip(), text[sign.end() :].strip()
        rest, _, field = path.rpartition(".")
        name, _, component = rest.rpartition(".")
        if component and field:
            yield name, component, field, value


def words_of(name: str, kind: type[Component] | Section, spec: Field, option: str = "--set") -> str:
    """Return how messages begin that name a field."""
    if kind in SECTIONS.values():
        return f"{option}: {name}.{spec.name}"
    return f"{option}: entity {shown(name)}: {kind.__name__}.{spec.name}"


def known_words(word: str, known: Mapping[str, object]) -> str:
    """Return the known names in place of a word, as the end of a message."""
    listed = list(known)
    first = ", ".join(map(_shown, listed[:20])) + (", ..." if len(listed) > 20 else "")
    return f"; must be one of {first or 'none'}{suggestion(word, known)}"


def _shown(word: str) -> str:
    return word if word.isidentifier() else shown(word)
