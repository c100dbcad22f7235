"""Grade the answers of a learner to a lesson: a report that a teacher can read."""

from argparse import Namespace
from collections.abc import Sequence
from dataclasses import asdict
from functools import partial

from physicslab.commands.output import JsonOutput
from physicslab.ecs.text import printable
from physicslab.kernels.tiers import Tiers
from physicslab.languages.language import language
from physicslab.lessons.answers import Answers, Graded, grade, read_answers
from physicslab.lessons.catalogue import find_lesson, lesson_in
from physicslab.lessons.lesson import Lesson
from physicslab.lessons.words import kind_words, sureness_words


def execute(arguments: Namespace) -> int:
    """Print the report."""
    output = JsonOutput(arguments.json, arguments.answers, "the answers")
    lesson = lesson_in(arguments.lesson, arguments.language or "")
    find = partial(find_lesson, language=lesson.language)
    answers = read_answers(arguments.answers, lesson, find)
    with Tiers(True):
        rows = list(grade(lesson, answers, find))
    output.write({
        "format": "physicslab-grade/1", "lesson": lesson.name, "learner": answers.learner,
        "other_text": answers.other_text, **_counts(rows), "answers": [*map(asdict, rows)],
    })  # fmt: skip
    if output.leaves_stdout:
        print(_report(lesson, answers, rows))
    return 0


def _counts(rows: Sequence[Graded]) -> dict[str, int]:
    """Return how many checks and predictions there are, and how many are right; predictions are no marks."""
    return {
        f"{kind}{what}": sum(row.kind in kinds and (what == "s" or bool(row.right)) for row in rows)
        for kind, kinds in (("check", ("check", "recall")), ("prediction", ("predict",)))
        for what in ("s", "s_right")
    }


def _report(lesson: Lesson, answers: Answers, rows: Sequence[Graded]) -> str:
    """Return the report as Markdown."""
    own, counts = language(lesson.language), _counts(rows)
    marks = {True: own.say("right"), False: own.say("wrong"), None: ""}
    kinds, sureness = kind_words(own), sureness_words(own)
    lines = [
        f"# {lesson.title}", "",
        own.say(
            "{learner}: {right} of {all} questions right.",
            learner=answers.learner or own.say("Without a name"),
            right=counts["checks_right"], all=counts["checks"],
        ),
        own.say_count(
            "{n} of {all} predictions came true; they do not count.",
            "{n} of {all} predictions came true; they do not count.",
            counts["predictions_right"], all=counts["predictions"],
        ), "",
    ]  # fmt: skip
    if answers.other_text:
        lines += [own.say("The lesson has been changed since it was answered."), ""]
    for row in rows:
        answer = printable(row.given) or own.say("no answer")
        mark = f", {marks[row.right]}" if marks[row.right] else ""
        sure = f" ({sureness[row.sure]})" if row.sure else ""
        lines.append(f"- **{row.name}** ({kinds[row.kind]}{mark}): {row.prompt}")
        lines.append("  - " + own.say("given: {answer}", answer=answer) + sure)
        if row.right is not True:
            model = own.say("model answer: {answer}", answer=row.expected)
            right = own.say("right answer: {answer}", answer=row.expected)
            lines.append(f"  - {model if row.kind == 'explain' else right}")
        lines += ["  - " + own.say("feedback: {words}", words=row.feedback)] if row.feedback else []
        lines += ["  - " + own.say("idea behind it: {words}", words=row.idea)] if row.idea else []
    return "\n".join(lines)
