"""Fields of a scene that differ from run to run: ``--vary ball.Velocity.linear.x=1:5:9``."""

import itertools
import math
from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from physicslab.commands import CommandError
from physicslab.commands.usage import MOST_SLIDERS, MOST_VALUES, VARY_FORM
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.quantity_text import InvalidText, evaluate
from physicslab.ecs.vector import Vector2
from physicslab.export.page import Varied, field_words
from physicslab.files.checks import SceneError, shown
from physicslab.files.places import SECTIONS, Place, entity_names, find_place, read_path
from physicslab.world import World

_DIGITS = 100
"""More digits than a count has; Python makes no number of thousands of them."""


@dataclass(frozen=True, slots=True)
class Variation:
    """A field, or a part of a vector, and its values."""

    place: Place
    values: tuple[float, ...]
    held: object

    @property
    def varied(self) -> Varied:
        """The text of a slider."""
        words = field_words(self.place.spec.name, self.place.part)
        label = words if self.place.name in SECTIONS else f"{self.place.name}: {words}"
        return Varied(label, self.place.spec.unit, self.values)

    def assignment(self, value: float) -> str:
        """Return the text that sets the field to a value, as ``--set`` takes it."""
        text = repr(value)
        if isinstance(self.held, Vector2):
            x, y = self.held
            text = f"[{text}, {y!r}]" if self.place.part == "x" else f"[{x!r}, {text}]"
        return f"{self.place.field}={text}"


def variations(world: World, texts: Sequence[str], assigned: Sequence[str]) -> list[Variation]:
    """Return what is varied, each text ``ID.Component.field=START:STOP:COUNT``; ``assigned`` is of ``--set``.

    Raises
    ------
    CommandError
        If one of them cannot be: which entity, component, field and value, and what is allowed.
    """
    if len(texts) > MOST_SLIDERS:
        raise CommandError(f"--vary: is given {len(texts)} times; a page has at most {MOST_SLIDERS} sliders")
    varied = [_variation(world, text) for text in texts]
    for one, other in itertools.combinations(varied, 2):
        if one.place.path == other.place.path:
            raise CommandError(f"{one.place.words}: is varied twice; two sliders must be of two quantities")
    refuse_set(world, assigned, [one.place.path for one in varied])
    return varied


def _variation(world: World, text: str) -> Variation:
    place, values = vary(world, text, MOST_VALUES)
    return Variation(place, values, place.read(world))


def vary(world: World, text: str, most: int) -> tuple[Place, tuple[float, ...]]:
    """Return the field of ``ID.Component.field=START:STOP:COUNT`` and its values, ``most`` at most [SI].

    Raises
    ------
    SceneError
        If there is no such field, or it cannot have these values.
    """
    path, sign, span = text.rpartition("=")
    if not sign or span.count(":") != 2:
        raise SceneError(f"--vary {shown(text)}: must be {VARY_FORM}")
    place = find_place(world, "--vary", path, span)
    spec = place.spec
    if spec.kind not in ("number", "whole", "vector") or (spec.kind == "vector") != bool(place.part):
        allowed = "a part of it, .x or .y" if spec.kind == "vector" else "a number, or a part of a vector"
        raise SceneError(f"{place.words} = {shown(span)}: must be {allowed}")
    values = _values(place, span, most)
    for value in (values[0], values[-1]):
        try:
            spec.check(place.whole(place.read(world), value))
        except InvalidValue as error:
            raise SceneError(f"{place.words} = {shown(span)}: {value!r}: must be {error.allowed}") from error
    return place, values


def refuse_set(world: World, texts: Sequence[str], varied: Container[str]) -> None:
    """Refuse what ``--set`` gives to a field that differs from run to run, but the other part of a vector."""
    names = entity_names(world)
    for text in texts:
        name, kind, spec, _ = read_path(world, names, text, "--set", "VALUE")
        place = Place(name, names.get(name, 0), kind, spec, "", "--set")
        if place.field in varied:
            raise CommandError(f"{place.words}: is varied too; a field must be set or varied")


def _values(place: Place, span: str, most: int) -> tuple[float, ...]:
    start, stop, number = (one.strip() for one in span.split(":"))
    where, whole = f"{place.words} = {shown(span)}", place.spec.kind == "whole"
    try:
        ends = evaluate(start, place.spec.unit), evaluate(stop, place.spec.unit)
    except InvalidText as error:
        raise SceneError(f"{where}: {error}; must be START:STOP:COUNT") from error
    count = int(number) if number.isdecimal() and len(number) < _DIGITS else 0
    if not 2 <= count <= most or not 0.0 < abs(ends[1] - ends[0]) < math.inf:
        raise SceneError(f"{where}: must be two numbers that differ, and a count from 2 to {most}")
    values: list[float] = np.linspace(*ends, count).tolist()
    if not whole:
        return tuple(values)
    if not all(value.is_integer() for value in values):
        raise SceneError(f"{where}: must be whole numbers at equal distances")
    return tuple(map(int, values))


def combinations(varied: Sequence[Variation]) -> Iterator[list[str]]:
    """Yield the assignments of every run, in the order in which a page has them."""
    for values in itertools.product(*(one.values for one in varied)):
        yield [one.assignment(value) for one, value in zip(varied, values, strict=True)]
