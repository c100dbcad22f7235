"""Fields of a scene that differ from run to run: ``--vary ball.Velocity.linear.x=1:5:9``."""

import itertools
from argparse import ArgumentParser
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from physicslab.commands import CommandError
from physicslab.commands.assignments import Place, find_place
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.quantity_text import InvalidText, evaluate
from physicslab.ecs.vector import Vector2
from physicslab.export.page import Varied, field_words
from physicslab.files.checks import shown
from physicslab.world import World

MOST_VALUES = 40
"""How many values a quantity may have."""
_MOST = 2
"""How many quantities may be varied: a page has as many sliders."""
_FORM = "ID.Component.field=START:STOP:COUNT"


def add_variations(parser: ArgumentParser) -> None:
    """Declare the option ``--vary``, which may be given twice."""
    words = (
        "one run for each of COUNT values from START to STOP, between which a slider of the page chooses; of "
        f"a vector field.x or field.y; up to {_MOST} of them, of up to {MOST_VALUES} values each"
    )
    parser.add_argument("--vary", metavar=_FORM, action="append", default=[], help=words)


@dataclass(frozen=True, slots=True)
class Variation:
    """A field, or a part of a vector, and its values."""

    place: Place
    part: str
    values: tuple[float, ...]
    other: Vector2 | None

    @property
    def varied(self) -> Varied:
        """What a slider says."""
        words = field_words(self.place.spec.name, self.part)
        return Varied(f"{self.place.name}: {words}", self.place.spec.unit, self.values)

    def assignment(self, value: float) -> str:
        """Return the text that sets the field to a value, as ``--set`` takes it."""
        text = repr(int(value)) if self.place.spec.kind == "whole" else repr(value)
        if self.other is not None:
            x, y = self.other
            text = f"[{text}, {y!r}]" if self.part == "x" else f"[{x!r}, {text}]"
        return f"{self.place.name}.{self.place.kind.__name__}.{self.place.spec.name}={text}"


def variations(world: World, texts: Sequence[str]) -> list[Variation]:
    """Return what is varied, each text ``ID.Component.field=START:STOP:COUNT``.

    Raises
    ------
    CommandError
        If one of them cannot be: which entity, component, field and value, and what is allowed.
    """
    if len(texts) > _MOST:
        raise CommandError(f"--vary: is given {len(texts)} times; a page has at most {_MOST} sliders")
    varied = [_variation(world, text) for text in texts]
    for one, other in itertools.combinations(varied, 2):
        if (one.place.words, one.part) == (other.place.words, other.part):
            raise CommandError(f"{one.place.words}: is varied twice; two sliders must be of two quantities")
    return varied


def _variation(world: World, text: str) -> Variation:
    path, sign, span = text.rpartition("=")
    if not sign or span.count(":") != 2:
        raise CommandError(f"--vary {shown(text)}: must be {_FORM}")
    path = path.strip()
    part = path[-1] if path[-2:] in (".x", ".y") else ""
    place = find_place(world, "--vary", path[:-2] if part else path, span)
    spec = place.spec
    if spec.kind not in ("number", "whole", "vector") or (spec.kind == "vector") != bool(part):
        allowed = "a part of it, .x or .y" if spec.kind == "vector" else "a number, or a part of a vector"
        raise CommandError(f"{place.words} = {shown(span)}: must be {allowed}")
    held = getattr(world.component(place.entity, place.kind), spec.name)
    values = _values(place, span)
    for value in (values[0], values[-1]):
        try:
            spec.check(((value, held.y) if part == "x" else (held.x, value)) if part else value)
        except InvalidValue as error:
            raise CommandError(
                f"{place.words} = {shown(span)}: {value!r}: must be {error.allowed}"
            ) from error
    return Variation(place, part, values, held if part else None)


def _values(place: Place, span: str) -> tuple[float, ...]:
    start, stop, number = (one.strip() for one in span.split(":"))
    where, whole = f"{place.words} = {shown(span)}", place.spec.kind == "whole"
    try:
        ends = evaluate(start, place.spec.unit), evaluate(stop, place.spec.unit)
    except InvalidText as error:
        raise CommandError(f"{where}: {error}; must be START:STOP:COUNT") from error
    if not number.isdecimal() or not 2 <= int(number) <= MOST_VALUES or ends[0] == ends[1]:
        raise CommandError(f"{where}: must be two numbers that differ, and a count from 2 to {MOST_VALUES}")
    values: list[float] = np.linspace(*ends, int(number)).tolist()
    if whole and not all(value.is_integer() for value in values):
        raise CommandError(f"{where}: must be whole numbers at equal distances")
    return tuple(values)


def combinations(varied: Sequence[Variation]) -> Iterator[list[str]]:
    """Yield the assignments of every run, in the order in which a page has them."""
    for values in itertools.product(*(one.values for one in varied)):
        yield [one.assignment(value) for one, value in zip(varied, values, strict=True)]
