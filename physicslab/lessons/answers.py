"""The answers of one learner to a lesson, read from a file and graded.

A report has the same bits whenever the same answers are graded: runs that answers name are made again.
"""

import itertools
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from physicslab.ecs.quantity_text import InvalidText, evaluate, factor_of
from physicslab.ecs.text import printable, suggestion
from physicslab.files import checks
from physicslab.files.checks import SceneError
from physicslab.files.json_text import json_bytes
from physicslab.files.replace import replace_file
from physicslab.files.scene import parse_json, read_text
from physicslab.lessons.blocks import LessonError
from physicslab.lessons.check import LessonRuns, curve_gap, is_near
from physicslab.lessons.lesson import SURENESS, Explain, Lesson, Question, Recall, Reply, place_of
from physicslab.lessons.setup import Case
from physicslab.lessons.words import formula, measure
from physicslab.state.masses import Diverged

FORMAT = "physicslab-answers/1"
_FAMILY = FORMAT.partition("/")[0]
_KEYS = {"choice": "choice", "number": "value", "curve": "curve", "goal": "values"}
"""Where each form of question has its answer."""
_TEXT_LIMIT = 10_000
_POINTS = 5
"""Parts of the time of a run at the ends of which a report says the right curve."""

type _Asked = Question | Explain


@dataclass(frozen=True, slots=True)
class Answers:
    """A learner's answers: checked JSON objects by the names of questions."""

    learner: str
    given: Mapping[str, Mapping[str, Any]]
    other_text: bool
    """Whether the lesson has another text than when it was answered."""


@dataclass(frozen=True, slots=True)
class Graded:
    """One answer and its grade.

    Attributes
    ----------
    name, kind, prompt : str
        The question; the kind is ``"predict"``, ``"check"``, ``"recall"`` or ``"explain"``.
    given, expected : str
        The answer in words, empty where there is none; and the right one, or the model answer.
    right : bool, optional
        ``None`` for an explanation, which a teacher reads, and where there is no answer.
    sure, feedback, idea : str
        How sure the learner was; what is said to it; the misconception that it stands for.
    """

    name: str
    kind: str
    prompt: str
    given: str
    expected: str
    right: bool | None
    sure: str = ""
    feedback: str = ""
    idea: str = ""


def asked(lesson: Lesson, find: Callable[[str], Lesson]) -> Iterator[tuple[str, str, _Asked, Lesson]]:
    """Yield all questions of a lesson: name, kind, the question, and the lesson that it is of.

    Questions of earlier lessons are named ``LESSON/CHECK``; ``find`` returns such a lesson.
    """
    for part in lesson.parts():
        if isinstance(part, Question | Explain):
            yield part.name, part.kind if isinstance(part, Question) else "explain", part, lesson
        elif isinstance(part, Recall):
            for name, check in part.asks:
                try:
                    other = find(name)
                except LessonError as error:
                    place = f"{lesson.path}: {place_of(part)}: ask = {name}/{check}"
                    raise LessonError(f"{place}: {error}") from error
                question = next((one for one in other.questions("check") if one.name == check), None)
                if question is None:
                    there = ", ".join(one.name for one in other.questions("check")) or "none"
                    why = f"{name} has no check {check}; must be one of {there}"
                    raise LessonError(f"{lesson.path}: {place_of(part)}: {why}")
                yield f"{name}/{check}", "recall", question, other


def read_answers(path: str | os.PathLike[str], lesson: Lesson, find: Callable[[str], Lesson]) -> Answers:
    """Return the answers of a file.

    Raises
    ------
    SceneError
        If they are of another version or lesson, or anything in them is not allowed; one line.
    """
    source = printable(os.fspath(path))
    document = checks.checked_object(parse_json(read_text(path, source), source), source, "an object")
    version = document.get("format")
    if version != FORMAT:
        other = isinstance(version, str) and version.startswith(f"{_FAMILY}/")
        allowed = f'"{FORMAT}"{", the version that this program reads" if other else ""}'
        raise checks.refusal(f"{source}: format", version, allowed)
    checks.checked_keys(document, f"{source}: ", "key", ("format", "lesson", "digest", "learner", "answers"))
    if document.get("lesson") != lesson.name:
        raise checks.refusal(f"{source}: lesson", document.get("lesson"), f'"{lesson.name}", the lesson')
    learner = checks.checked_title(document.get("learner", ""), f"{source}: learner", 200)
    given = checks.checked_object(document.get("answers"), f"{source}: answers", "an object of answers")
    questions = {name: part for name, _, part, _ in asked(lesson, find)}
    for name, answer in given.items():
        where = f"{source}: answers: {name}"
        if name not in questions:
            raise SceneError(f"{where}: the lesson has no such question{suggestion(name, questions)}")
        check_answer(where, checks.checked_object(answer, where, "an object"), questions[name])
    digest = document.get("digest")
    return Answers(learner, given, digest is not None and digest != lesson.digest)


def write_answers(
    path: str | os.PathLike[str], lesson: Lesson, learner: str, given: Mapping[str, Any]
) -> None:
    """Write the answers of a learner to a file, whole or not at all.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    document = {
        "format": FORMAT, "lesson": lesson.name, "digest": lesson.digest, "learner": learner,
        "answers": dict(given),
    }  # fmt: skip
    replace_file(path, json_bytes(document))


def check_answer(where: str, answer: Mapping[str, Any], question: Question | Explain) -> None:
    """Refuse an answer that its question does not take.

    Raises
    ------
    SceneError
        With what is allowed.
    """
    key = "text" if isinstance(question, Explain) else _KEYS[question.form]
    checks.checked_keys(answer, f"{where}.", "key", (key, "sure"))
    value, place = answer.get(key), f"{where}.{key}"
    if "sure" in answer and answer["sure"] not in SURENESS:
        raise checks.refusal(f"{where}.sure", answer["sure"], f"one of {', '.join(SURENESS)}")
    if isinstance(question, Explain):
        if len(checks.checked_text(value, place, lines=True)) > _TEXT_LIMIT:
            raise checks.refusal(place, value, f"a text of at most {_TEXT_LIMIT} characters")
    elif question.form == "choice":
        if type(value) is not int or not 1 <= value <= len(question.replies):
            raise checks.refusal(place, value, f"a whole number from 1 to {len(question.replies)}")
    elif question.form == "number":
        _number(value, question.unit, place)
    elif question.form == "goal":
        for name, text in checks.checked_object(value, place, 'an object as {"th": "30 deg"}').items():
            if not isinstance(text, str):
                raise checks.refusal(f"{place}.{name}", text, "a number with its unit, as text")
    else:
        _points(value, place)


def _number(value: object, unit: str, where: str) -> float:
    if checks.is_number(value):
        return float(value)  # type: ignore[arg-type]
    try:
        return evaluate(value if isinstance(value, str) else "", unit)
    except InvalidText as error:
        raise SceneError(f"{where} = {checks.shown(value)}: {error}") from error


def _points(value: object, where: str) -> list[tuple[float, float]]:
    """Return a drawn curve: times [s], in order, and values."""
    points: list[tuple[float, float]] = []
    for place, pair in checks.checked_rows(value, where, "a list of [time, value]"):
        pair_is_right = isinstance(pair, list) and len(pair) == 2 and all(map(checks.is_number, pair))
        if not pair_is_right or (points and pair[0] <= points[-1][0]):
            raise checks.refusal(place, pair, "[time, value], two finite numbers, later than the one before")
        points.append((float(pair[0]), float(pair[1])))
    if len(points) < 2:
        raise checks.refusal(where, value, "two points or more")
    return points


def grade(lesson: Lesson, answers: Answers, find: Callable[[str], Lesson]) -> Iterator[Graded]:
    """Yield every question of a lesson with its answer and grade, in order."""
    runs: dict[str, LessonRuns] = {}
    for name, kind, part, owner in asked(lesson, find):
        of = runs.setdefault(owner.name, LessonRuns(owner))
        yield grade_one(of, name, kind, part, answers.given.get(name))


def grade_one(
    runs: LessonRuns, name: str, kind: str, part: Question | Explain, answer: Mapping[str, Any] | None
) -> Graded:
    """Return one question of :func:`asked` with its answer, if there is one, and the grade."""
    if isinstance(part, Explain):
        given = "" if answer is None else str(answer["text"])
        return Graded(name, kind, part.prompt, given, part.answer, None)
    blank = Graded(name, kind, part.prompt, "", _expected(runs, part), None)
    if answer is None:
        return blank
    blank = replace(blank, sure=str(answer.get("sure", "")))
    try:
        return _GRADERS[part.form](runs, part, answer[_KEYS[part.form]], blank)
    except (InvalidText, SceneError, Diverged) as error:  # values with which the run cannot be
        return replace(blank, given=str(answer), right=False, feedback=str(error))


def _expected(runs: LessonRuns, question: Question) -> str:
    own = runs.lesson.own
    match question.form:
        case "choice":
            return next(reply.text for reply in question.replies if reply.right)
        case "number":
            return measure(own, runs.number(question), question.unit)
        case "goal":
            solution = formula(own, question.solution.text) if question.solution else ""
            return own.say("for example {values}", values=solution)
    times, values = runs.figures(question.run).record.times, runs.curve(question)
    unit = factor_of(question.unit)
    at = [round(i * (len(values) - 1) / _POINTS) for i in range(_POINTS + 1)]
    shown = (
        f"{measure(own, times[i], 's', 3)}: {measure(own, values[i] / unit, question.unit, 3)}" for i in at
    )
    return "; ".join(shown)


def _grade_choice(runs: LessonRuns, question: Question, value: int, blank: Graded) -> Graded:
    reply = question.replies[value - 1]
    return replace(blank, given=reply.text, right=reply.right, feedback=reply.feedback, idea=reply.idea)


def _grade_number(runs: LessonRuns, question: Question, value: object, blank: Graded) -> Graded:
    number, right = _number(value, question.unit, question.name), runs.number(question)
    given = measure(runs.lesson.own, number, question.unit)
    if is_near(number, right, question.tolerance):
        return replace(blank, given=given, right=True, feedback=question.right)
    reply: Reply | None = None
    for one in question.replies:
        if reply is None and is_near(number, runs.number(question, one), question.tolerance):
            reply = one
    feedback, idea = (reply.feedback, reply.idea) if reply else ("", "")
    return replace(blank, given=given, right=False, feedback=feedback, idea=idea)


def _grade_goal(runs: LessonRuns, question: Question, value: Mapping[str, str], blank: Graded) -> Graded:
    text = "; ".join(f"{name} = {one}" for name, one in value.items())
    blank = replace(blank, given=formula(runs.lesson.own, text), right=False)
    try:
        _refuse_closed(runs, value)
        assert question.goal is not None
        reached = question.goal.holds(runs.figures(question.run, Case(text, tuple(value.items()))))
    except (InvalidText, SceneError, Diverged) as error:  # values with which the run cannot be
        return replace(blank, feedback=str(error))
    return replace(blank, right=True, feedback=question.right) if reached else blank


def _refuse_closed(runs: LessonRuns, value: Mapping[str, str]) -> None:
    """Refuse values of what is not open, or beyond its least and greatest value."""
    own, opened = runs.lesson.own, runs.lesson.setup.opened
    for name, text in value.items():
        if name not in opened:
            names = ", ".join(opened)
            raise InvalidText(own.say("{name} may not be changed here, but: {names}", name=name, names=names))
        low, high = (runs.lesson.setup.quantity(name, end) for end in opened[name])
        if not low <= runs.lesson.setup.quantity(name, text) <= high:
            least, most = (formula(own, end) for end in opened[name])
            raise InvalidText(
                own.say("{name} must be from {least} to {most}", name=name, least=least, most=most)
            )


def _grade_curve(runs: LessonRuns, question: Question, value: object, blank: Graded) -> Graded:
    """Grade a drawn curve by its distance from what is measured, and from the mistakes that are foreseen."""
    points, unit = _points(value, question.name), factor_of(question.unit)
    measured = runs.curve(question)
    times = runs.figures(question.run).record.times[: len(measured)]
    drawn = [unit * _drawn(points, time) for time in times]
    gap, own = curve_gap(drawn, measured), runs.lesson.own
    given = own.say("a curve that is {gap} of the span away", gap=own.decimal(f"{100.0 * gap:.1f} %"))
    if gap <= question.tolerance:
        return replace(blank, given=given, right=True, feedback=question.right)
    for reply in question.replies:
        if curve_gap(drawn, runs.curve(question, reply)) <= question.tolerance:
            return replace(blank, given=given, right=False, feedback=reply.feedback, idea=reply.idea)
    return replace(blank, given=given, right=False)


def _drawn(points: list[tuple[float, float]], time: float) -> float:
    """Return the value of a curve of straight parts, level beyond its ends."""
    for (before, first), (after, second) in itertools.pairwise(points):
        if time <= after:
            return first + (second - first) * max(0.0, (time - before) / (after - before))
    return points[-1][1]


_GRADERS: dict[str, Callable[[LessonRuns, Question, Any, Graded], Graded]] = {
    "choice": _grade_choice, "number": _grade_number, "goal": _grade_goal, "curve": _grade_curve,
}  # fmt: skip
