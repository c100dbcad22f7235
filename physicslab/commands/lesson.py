"""Say what a lesson is, check its theories against the engine, or print it for pupils to write on."""

import sys
from argparse import Namespace
from collections.abc import Iterator
from dataclasses import asdict
from functools import partial
from math import isfinite

from physicslab.commands import FAILED, CommandError
from physicslab.commands.output import JsonOutput, Output
from physicslab.commands.progress import Progress
from physicslab.ecs.text import printable
from physicslab.kernels.tiers import Tiers
from physicslab.languages.language import Language, language
from physicslab.lessons.answers import asked
from physicslab.lessons.catalogue import LESSONS, find_lesson, lesson_in
from physicslab.lessons.check import Row, check_lesson
from physicslab.lessons.lesson import Lesson, Prose
from physicslab.lessons.page import lesson_page
from physicslab.lessons.worksheet import worksheet


def execute(arguments: Namespace) -> int:
    """Print what was asked for; exit 1 where a theory does not hold, or holds where it must not."""
    output = JsonOutput(arguments.json)
    option = "--worksheet" if arguments.page is None else "--page"
    path = arguments.worksheet if arguments.page is None else arguments.page
    sheet = None if path is None else Output(option, path)
    both = arguments.worksheet is not None and arguments.page is not None
    if sheet is not None and (arguments.lesson is None or arguments.check or output.is_given or both):
        others = "--check and --json" if not both else "--worksheet, --check and --json"
        raise CommandError(f"{option}: must stand beside one lesson, and without {others}")
    names = LESSONS if arguments.lesson is None else (arguments.lesson,)
    lessons = [lesson_in(name, arguments.language or "") for name in names]
    if sheet is not None:
        if arguments.lesson not in LESSONS:
            sheet.refuse_same(arguments.lesson, "the lesson")
        find = partial(find_lesson, language=lessons[0].language)
        if arguments.page is None:
            sheet.write(worksheet(lessons[0], find).encode())
            return 0
        label = f"lesson {lessons[0].name}"
        with Progress(label, sys.stderr, always=arguments.progress) as progress, Tiers(True):
            content = lesson_page(lessons[0], find, progress.show)
        sheet.write(content)
        if not sheet.to_stdout:
            print(f"{printable(sheet.path)}: {lessons[0].title}, {len(content) / 1000:,.0f} kB")
        return 0
    if arguments.check:
        return _check(lessons, output)
    output.write({"format": "physicslab-lessons/1", "lessons": [*map(_summary, lessons)]})
    if output.leaves_stdout:
        print("\n".join(_line(one) for one in lessons) if arguments.lesson is None else _about(lessons[0]))
    return 0


def _check(lessons: list[Lesson], output: JsonOutput) -> int:
    own = language(lessons[0].language)
    rows: list[Row] = []
    if output.leaves_stdout:
        print(f"| {' | '.join(_heads(own))} |\n|---|---|---|--:|--:|--:|--:|---|")
    with Tiers(True):
        for lesson in lessons:
            list(asked(lesson, find_lesson))  # each question that it recalls is there
            for row in check_lesson(lesson):
                rows.append(row)
                if output.leaves_stdout and row.measured == row.measured:
                    print(f"| {' | '.join(_cells(row, own))} |", flush=True)
    output.write({"format": "physicslab-lesson-check/1", "rows": [*map(_object, rows)]})
    wrong = [row for row in rows if not row.passed]
    if wrong:
        said = "; ".join(f"{one.lesson}, line {one.line}, {one.block}: {one.case}" for one in wrong)
        raise CommandError(f"not as the lesson says: {said}", FAILED)
    return 0


def _object(row: Row) -> dict[str, object]:
    """Return a row for JSON, which has null where there is no number, or none that is finite."""
    infinite = (key for key, value in asdict(row).items() if isinstance(value, float) and not isfinite(value))
    return asdict(row) | dict.fromkeys(infinite)


def _heads(own: Language) -> Iterator[str]:
    yield from (own.say("lesson"), own.say("compared"), own.say("case"), own.say("measured"))
    yield from (own.say("by theory"), own.say("gap"), own.say("tolerance"), "")


def _cells(row: Row, own: Language) -> Iterator[str]:
    """Yield a row of the table; a gap is a share of the theory's value, or has a unit."""
    unit = f" {row.unit}" if row.unit else ""
    of_gap = unit if row.absolute else ""
    yield from (row.lesson, row.quantity, row.case)
    yield from (own.decimal(f"{number:.9g}{unit}") for number in (row.measured, row.theory))
    yield from (own.decimal(f"{row.gap:.1e}{of_gap}"), f"{row.tolerance:.0e}{of_gap}")
    held = own.say("holds") if row.holds else own.say("fails, as it should")
    yield held if row.passed else f"**{own.say('not as it should be')}**"


def _line(lesson: Lesson) -> str:
    level = language(lesson.language).say("level {level}", level=lesson.level)
    return f"{lesson.name:<20}  {level}  {lesson.minutes:>3} min  {lesson.title}"


def _about(lesson: Lesson) -> str:
    """Return what a lesson is: its needs, its steps, what is asked and compared in each."""
    own = language(lesson.language)
    lines = [f"{lesson.title} ({lesson.name}, {lesson.language})"]
    needs = "; " + own.say("needs {what}", what=", ".join(lesson.needs)) if lesson.needs else ""
    lines.append(own.say("level {level}", level=lesson.level) + f", {lesson.minutes} min{needs}")
    for step in lesson.steps:
        lines.append(f"  {step.depth}. {step.heading or own.say('Beginning')}")
        kinds = [getattr(part, "kind", type(part).__name__.lower()) for part in step.parts]
        names = [getattr(part, "name", "") for part in step.parts]
        lines += [
            f"     {kind:<8} {name}" for kind, name, part in zip(kinds, names, step.parts, strict=True)
            if not isinstance(part, Prose)
        ]  # fmt: skip
    return "\n".join(lines)


def _summary(lesson: Lesson) -> dict[str, object]:
    return {
        "name": lesson.name, "title": lesson.title, "language": lesson.language, "level": lesson.level,
        "minutes": lesson.minutes, "needs": list(lesson.needs),
        "checks": [question.name for question in lesson.questions("check")],
        "compares": [compare.name for compare in lesson.compares()],
    }  # fmt: skip
