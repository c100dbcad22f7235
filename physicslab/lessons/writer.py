"""From a scene, and what a teacher chose, to the text of a lesson's file."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from physicslab.components import Name, Velocity
from physicslab.diagnostics.figures import FUNCTIONS
from physicslab.ecs.quantity_text import Expression, InvalidText, is_known
from physicslab.ecs.text import printable
from physicslab.files.json_text import json_text
from physicslab.files.places import find_place
from physicslab.files.reader import read_scene
from physicslab.files.scene import write_scene
from physicslab.lessons.reader import FORMAT
from physicslab.world import World

FORMS = ("number", "curve", "choice")
"""How a lesson that is written for a teacher lets its learners predict."""
_GRAVITY = "gravity"
"""The parameter that is the uniform gravity of the scene, if there is any."""
_TAKEN = {*FUNCTIONS, _GRAVITY, "time", "world"}


@dataclass(slots=True)
class Opened:
    """A number of the scene that learners may change.

    Attributes
    ----------
    path : str
        ``ID.Component.field`` of the scene, with ``.x`` or ``.y`` for a part of a vector; empty for none.
    name : str
        Its name in expressions.
    low, high : str
        The least and the greatest value, with units.
    """

    path: str = ""
    name: str = ""
    low: str = ""
    high: str = ""


@dataclass(slots=True)
class Draft:
    """A teacher's choices for a lesson of a scene, each part as the text that was typed.

    Attributes
    ----------
    title, language : str
        Its title, and the code of the language in which it is written.
    seconds : str
        How long the run is [s].
    measured, quantity, unit : str
        The measure predicted and compared: an expression of the run's figures, its words, and its unit.
    question, form : str
        The question before the run, and one of ``FORMS``.
    choices : list of [str, str]
        The answers of a choice, each with what is said to it; the first is right.
    theory, holds, tolerance : str
        The formula beside the measurement, when it holds, and the widest gap; without a theory nothing is
        compared.
    why, answer : str
        The question afterwards, and a model answer; both may be empty.
    opened : list of Opened
        Fields that learners may change.
    """

    title: str
    language: str = "en"
    seconds: str = "10"
    measured: str = ""
    quantity: str = ""
    unit: str = ""
    question: str = ""
    form: str = FORMS[0]
    choices: list[list[str]] = field(default_factory=lambda: [["", ""] for _ in range(3)])
    theory: str = ""
    holds: str = "always"
    tolerance: str = "1 %"
    why: str = "Why?"
    answer: str = ""
    opened: list[Opened] = field(default_factory=lambda: [Opened(), Opened()])


def name_bodies(world: World) -> World:
    """Return a copy of a world in which all have an id; what moves, one that expressions can read."""
    named = read_scene(write_scene(world), "the scene")
    taken: set[str] = set()
    for entity in named.entities():
        label = named.label(entity)
        name = identifier(label, taken) if named.has(entity, Velocity) else label
        taken.add(name)
        if name != label or not named.has(entity, Name):
            named.discard(entity, Name)
            named.add(entity, Name(name))
    return named


def identifier(words: str, taken: Iterable[str] = ()) -> str:
    """Return a name that expressions can read, made of words.

    >>> identifier("red ball: velocity x"), identifier("1/2"), identifier("m", ["m_2"])
    ('red_ball_velocity_x', 'n_1_2', 'm_3')
    """
    plain = re.sub(r"\W+", "_", words).strip("_") or "n"
    plain = plain if plain.isidentifier() else f"n_{plain}"
    name, count = plain, 1
    while is_known(name) or name in _TAKEN or name in taken:
        count += 1
        name = f"{plain}_{count}"
    return name


def lesson_text(world: World, draft: Draft) -> str:
    """Return the text of a lesson about a world as it is now.

    The reader of lessons says whether it can be one: what a teacher typed is not looked at here.

    Parameters
    ----------
    world : World
        As :func:`name_bodies` returns it.

    Raises
    ------
    KeyError
        If what is opened is no number of the world.
    """
    document = _brief(write_scene(world))
    lets = list(_opened(world, document, draft.opened))
    gravity = world.physics.gravity
    if world.physics.gravity_mode == "linear" and not gravity.x and gravity.y < 0.0:
        document["physics"] = {**document.get("physics", {}), "gravity": [0, f"-{_GRAVITY}"]}
        lets.insert(0, ("let", f"{_GRAVITY} = {-gravity.y!r} m/s^2 | field strength"))
    head = (
        ("format", FORMAT), ("title", draft.title), ("language", draft.language), ("level", "1"),
        ("minutes", "20"),
    )  # fmt: skip
    scene = _lines((*lets, ("tools", "hand, stopwatch"))) + json_text(document).rstrip("\n")
    parts = [
        f"---\n{_lines(head)}---", f"```scene\n{scene}\n```", f"## Level 1: {_plain(draft.question)}",
        world.description or "Look at the scene, and think what will happen.",
        _block("predict", "before", _prediction(draft)),
        _block("run", "trial", [("seconds", draft.seconds), *_graphs(draft.measured)]),
    ]  # fmt: skip
    if draft.theory.strip():
        compared = [
            ("quantity", draft.quantity), ("measure", draft.measured), ("theory", draft.theory),
            ("holds", draft.holds), ("tolerance", draft.tolerance),
        ]  # fmt: skip
        parts.append(_block("compare", "theory", compared))
    if draft.answer.strip():
        parts.append(_block("explain", "reason", [("question", draft.why), ("answer", draft.answer)]))
    return "\n\n".join(parts) + "\n"


def _brief(document: dict[str, Any]) -> dict[str, Any]:
    """Return a scene without the laws and settings that every scene has."""
    usual = write_scene(World())
    kept = {
        key: {name: one for name, one in value.items() if one != usual[key][name]}
        if isinstance(value, dict) and isinstance(usual.get(key), dict) else value
        for key, value in document.items() if key != "format"
    }  # fmt: skip
    return {key: value for key, value in kept.items() if value}


def _prediction(draft: Draft) -> Iterator[tuple[str, str]]:
    yield "question", draft.question
    if draft.form == "choice":
        right = draft.choices[0]
        for one in sorted((one for one in draft.choices if one[0].strip()), key=lambda one: one[0]):
            yield "choice", one[0]
            yield "right" if one is right else "wrong", one[1]
        return
    yield draft.form, draft.unit
    yield "answer", draft.measured
    yield "tolerance", "10 %" if draft.form == "curve" else "5 %"


def _graphs(measured: str) -> list[tuple[str, str]]:
    """Return what the run draws: the quantities of what is measured."""
    try:
        names = dict.fromkeys(name for name in Expression(measured).names() if "." in name)
    except InvalidText:  # the reader says why
        return []
    return [("graph", name) for name in names]


def _opened(world: World, document: dict[str, Any], opened: Iterable[Opened]) -> Iterator[tuple[str, str]]:
    """Put the names of what is opened in the places of the numbers, and yield their entries."""
    entities = {one["id"]: one for one in document["entities"] if "id" in one}
    for one in opened:
        if not one.path:
            continue
        place = find_place(world, "", one.path, "")
        value, spec, part, words = place.read(world), place.spec, place.part, place.spec.name
        if place.entity:
            values = entities[place.name].setdefault(place.kind.__name__, {})
            words = f"{printable(place.name)}: {words}"
        else:
            values = document.setdefault(place.name, {})
        if part:
            held = list(values.get(spec.name, [value.x, value.y]))
            held["xy".index(part)] = one.name
            values[spec.name], value = held, getattr(value, part)
        else:
            values[spec.name] = one.name
        unit = "" if spec.unit == "1" else f" {spec.unit}"
        yield "let", f"{one.name} = {value!r}{unit} | {words.replace('_', ' ')} {part}"
        yield "open", f"{one.name} = {one.low} to {one.high}"


def _block(kind: str, name: str, entries: Iterable[tuple[str, str]]) -> str:
    return f"```{kind} {name}\n{_lines(entries)}```"


def _lines(entries: Iterable[tuple[str, str]]) -> str:
    return "".join(f"{key}: {_plain(value)}".rstrip() + "\n" for key, value in entries)


def _plain(text: str) -> str:
    """Return a text in one line."""
    return " ".join(printable(text).split())
