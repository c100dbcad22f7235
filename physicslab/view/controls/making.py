"""Actions that make a lesson of a scene."""

import time
from pathlib import Path

from physicslab.components import Velocity
from physicslab.diagnostics.samples import columns, unit_of
from physicslab.ecs.quantity_text import InvalidText
from physicslab.ecs.text import printable
from physicslab.export.page import field_words
from physicslab.files.checks import SceneError
from physicslab.files.places import find_place
from physicslab.files.replace import reason_of, replace_file
from physicslab.languages.language import language
from physicslab.languages.sentence import Sentence
from physicslab.lessons.blocks import LessonError
from physicslab.lessons.check import row_of
from physicslab.lessons.lesson import Lesson, Run
from physicslab.lessons.live_run import LiveRun
from physicslab.lessons.reader import parse_lesson
from physicslab.lessons.setup import AS_IT_IS
from physicslab.lessons.writer import Draft, Opened, identifier, lesson_text, name_bodies
from physicslab.state.masses import Diverged
from physicslab.view.canvas.quantities import quantity, written_unit
from physicslab.view.controls.lesson_actions import open_lesson
from physicslab.view.controls.saving import name_of
from physicslab.view.controls.share_actions import gone_back, span_around, usual_beginning
from physicslab.view.window.making import Making
from physicslab.view.window.naming import named_after
from physicslab.view.window.window import Window
from physicslab.world import World

READINGS = {
    "at the end": "{}", "the greatest": "greatest({})", "the least": "least({})", "the mean": "mean({})",
    "its change": "{0} - start({0})", "its period": "period({})",
}  # fmt: skip
"""Measures of a quantity in a run, in words and as an expression."""
_PERIOD = "its period"
_BODIES = 40
"""How many bodies are offered."""
_TRIAL = 1.0
"""How long the run is tried at most before a lesson is written [s of the processor]."""


def toggle_making(world: World, window: Window) -> None:
    """Let a teacher make a lesson of the scene, or no longer."""
    making = window.making
    making.choosing = not making.choosing
    if making.choosing:
        making.naming = named_after(name_of(world, window), ".md")
        making.begins = usual_beginning(window, making.begins)
        if making.quantity not in measurable(world):
            own = language(window.language)
            title = own.reword(world.title or "What happens?")
            making.draft, making.refused = Draft(title, window.language, why=own.say("Why?")), {}
            bodies = [name for name in measurable(world) if name.endswith(".speed")]
            choose_measured(making, (bodies or ["world.kinetic"])[0], next(iter(READINGS)))


def measurable(world: World) -> dict[str, str]:
    """Return the words of each quantity that can be measured, by what expressions call it."""
    found, taken = dict[str, str](), set[str]()
    for entity in world.batch(Velocity).entities.tolist()[:_BODIES]:
        name = identifier(world.label(entity), taken)
        taken.add(name)
        found |= {
            f"{name}.{short}": f"{printable(world.label(entity))}: {long}"
            for short, long in columns(entity).items()
        }
    return found | {f"world.{short}": f"all together: {long}" for short, long in columns(None).items()}


def choose_measured(making: Making, name: str, reading: str) -> None:
    """Measure another quantity, or another reading of it; what is asked follows, unless it was written."""
    draft, before = making.draft, _question(making.draft)
    making.quantity, making.reading = name, reading
    draft.measured = READINGS[reading].format(name)
    draft.unit = "s" if reading == _PERIOD else unit_of(name)
    body, _, short = name.partition(".")
    long = columns(None if body == "world" else 1)[short]
    last = reading == next(iter(READINGS))
    own = language(draft.language)
    draft.quantity = own.reword(long) if body == "world" else f"{own.reword(long)} ({body})"
    if not last:
        draft.quantity = f"{draft.quantity}, {own.reword(reading)}"
    if draft.question in ("", before):
        draft.question = _question(draft)


def _question(draft: Draft) -> str:
    return language(draft.language).say("What comes out in this run: {quantity}?", quantity=draft.quantity)


def choose_opened(world: World, window: Window, opened: Opened, path: str) -> None:
    """Let learners change another number of the scene, at first around the value with which it begins."""
    opened.path = path
    if not path:
        return
    place, making = find_place(world, "", path, ""), window.making
    taken = {one.name for one in making.draft.opened if one is not opened}
    words = field_words(place.spec.name, place.part)
    opened.name = identifier(f"{place.name}_{words}" if place.entity else words, taken)
    low, high, unit = span_around(world, window, making.begins, path)
    ending = "" if unit == "1" else f" {unit}"
    opened.low, opened.high = f"{low:.3g}{ending}", f"{high:.3g}{ending}"


def make_lesson(world: World, window: Window, over: Path | None = None) -> None:
    """Write the lesson that was chosen, and open it; where it cannot be, say why at what cannot be so."""
    making, naming = window.making, window.making.naming
    making.refused = {}
    path = naming.path((".md",), over)
    if path is None:
        return
    window.put_down(world)
    try:
        with gone_back(window, making.begins):
            text = lesson_text(name_bodies(world), making.draft)
        told = _tried(parse_lesson(text, printable(path.name), path))
        replace_file(path, text.encode())
    except LessonError as error:
        making.refused[error.entry] = error.why or str(error)
        return
    except InvalidText as error:
        making.refused["compare", "theory"] = str(error)
        return
    except (SceneError, Diverged, KeyError) as error:
        naming.refused = f"No lesson: {error}"
        return
    except OSError as error:
        naming.refused = f"The lesson could not be saved: {reason_of(error)}"
        return
    making.choosing = False
    if not open_lesson(world, window, str(path)):
        saved = Sentence("Saved {file}", file=printable(path.name))
        window.notify(Sentence("{what}: {figure}", what=saved, figure=told) if told else saved, 8.0)


def _tried(lesson: Lesson) -> str:
    """Return in words how theory and measurement differ in the run; empty if that takes too long.

    Raises
    ------
    InvalidText
        If what is measured, or the theory, has no value in it.
    """
    run = next(part for part in lesson.parts() if isinstance(part, Run))
    live, deadline = LiveRun(lesson.setup, run, lesson.quantities), time.process_time() + _TRIAL
    live.world.step()
    while not live.sample():
        if time.process_time() > deadline:
            return ""
        live.world.step()
    for question in lesson.questions():
        if question.answer is not None:
            question.answer.value(live.figures)
    for compare in lesson.compares():
        row = row_of(lesson, compare, AS_IT_IS, live.figures)
        unit = written_unit(row.unit)
        measured, theory = (quantity(value, unit).strip() for value in (row.measured, row.theory))
        values = {"measured": measured, "theory": theory}
        if row.passed:
            return Sentence("measured {measured}, theory {theory}", **values)
        return Sentence("measured {measured}, theory {theory}: further apart than it says", **values)
    return ""
