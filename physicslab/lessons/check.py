"""Lessons against the engine: every theory, where it holds and where it must not, and every answer."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from physicslab.components.quantities import QUANTITIES
from physicslab.diagnostics.figures import Figures
from physicslab.ecs.quantity_text import (
    Expression,
    InvalidText,
    Quantity,
    dotted,
    factor_of,
    in_unit,
    in_words,
    same_dimension,
)  # fmt: skip
from physicslab.files.checks import SceneError, shown
from physicslab.lessons.blocks import LessonError
from physicslab.lessons.lesson import Compare, Lesson, Question, Reply, Run, place_of
from physicslab.lessons.live_run import record_run
from physicslab.lessons.setup import AS_IT_IS, Case
from physicslab.lessons.words import case_words, with_run
from physicslab.state.masses import Diverged


@dataclass(frozen=True, slots=True)
class Row:
    """One theory or answer in one case.

    Attributes
    ----------
    lesson, block : str
        Where it stands; ``line`` is its line.
    quantity, case : str
        Measure that is compared, and the case.
    measured, theory : float
        In the ``unit``; NaN where it has no number.
    gap, tolerance : float
        A share of the theory's value, or in the unit where ``absolute``.
    holds : bool
        Whether the theory is to hold.
    passed : bool
        Whether it does as it is to; a theory that is to fail does so beyond the tolerance.
    """

    lesson: str
    block: str
    line: int
    quantity: str
    case: str
    unit: str
    measured: float
    theory: float
    gap: float
    tolerance: float
    absolute: bool
    holds: bool
    passed: bool


class LessonRuns:
    """The runs of one lesson; each is made once."""

    def __init__(self, lesson: Lesson) -> None:
        self.lesson = lesson
        self._made: dict[tuple[int, tuple[tuple[str, str], ...]], Figures] = {}

    def figures(self, run: Run | None, case: Case = AS_IT_IS) -> Figures:
        """Return the figures of a run in a case; without a run those of the scene at its beginning."""
        key = (run.line if run else 0, case.values)
        if key not in self._made:
            run = run or self._no_run
            self._made[key] = record_run(self.lesson.setup, run, self.lesson.quantities, case)
        return self._made[key]

    def keep(self, run: Run, figures: Figures, case: Case = AS_IT_IS) -> None:
        """Take the figures of a run that was made elsewhere, as in the window."""
        self._made[run.line, case.values] = figures

    @cached_property
    def _no_run(self) -> Run:
        return Run("", 0, Expression("0 s"), None, Expression("0 s"), (), AS_IT_IS)

    def number(self, question: Question, reply: Reply | None = None) -> float:
        """Return the number that is right, or a foreseen mistake, in the unit of the question."""
        expression = _expected(question, reply)
        value = expression.value(self.figures(question.run))
        if value.dimension == Quantity(0.0).dimension:  # the angle of an arctangent is in radians
            value = replace(value, has_unit=True)
        return in_unit(value, question.unit, expression.text)

    def curve(self, question: Question, reply: Reply | None = None) -> list[float]:
        """Return the curve that is right, or a foreseen mistake, at each sample [SI]."""
        return self.figures(question.run).series(_expected(question, reply))


def _expected(question: Question, reply: Reply | None) -> Expression:
    """Return the answer of a question, or that of a foreseen mistake."""
    expression = question.answer if reply is None else reply.value
    assert expression is not None
    return expression


def check_lesson(lesson: Lesson) -> Iterator[Row]:
    """Yield a row for each theory and answer of a lesson, in each of its cases.

    Raises
    ------
    LessonError
        If one cannot be evaluated: which line, and why.
    """
    runs = LessonRuns(lesson)
    # Runs first: what is wrong with one is said of it, not of the prediction that stands before it.
    for part in sorted(lesson.parts(), key=lambda one: not isinstance(one, Run)):
        if isinstance(part, Run | Compare | Question):
            try:
                match part:
                    case Run():
                        runs.figures(part)
                    case Compare():
                        yield from _compared(runs, part)
                    case Question():
                        yield from _answered(runs, part)
            except LessonError:
                raise
            except (InvalidText, SceneError, Diverged) as error:
                raise LessonError(f"{lesson.path}: {place_of(part)}: {error}") from error


def _compared(runs: LessonRuns, compare: Compare) -> Iterator[Row]:
    for key, cases in (("case", compare.cases), ("fails", compare.fails)):
        for case in cases:
            try:
                row = row_of(runs.lesson, compare, case, runs.figures(compare.run, case))
            except (InvalidText, SceneError, Diverged) as error:
                if key == "case":  # the measure itself may be wrong
                    raise
                allowed = f"must be a case in which {compare.measured.text} can be measured"
                raise _refusal(runs.lesson, compare, key, case, f"{error}; {allowed}") from error
            if row.holds != (key == "case"):
                told = f"'{compare.holds.text}' {'holds' if row.holds else 'does not hold'}"
                allowed = f"must be a case in which it {'does not' if row.holds else 'does'}"
                raise _refusal(runs.lesson, compare, key, case, f"{told}; {allowed}")
            yield row


def _refusal(lesson: Lesson, part: Compare | Question, key: str, case: Case, why: str) -> LessonError:
    """Return the error that a case of a part cannot be so."""
    place = place_of(replace(part, line=case.line or part.line))
    return LessonError(f"{lesson.path}: {place}: {key} = {shown(case.text)}: {why}")


def row_of(lesson: Lesson, compare: Compare, case: Case, figures: Figures) -> Row:
    """Return theory beside measurement in a case of which these are the figures.

    Raises
    ------
    InvalidText
        If one of both has no value.
    """
    measured, theory, gap = gap_of(compare, figures)
    tolerance = compare.tolerance.value(figures)
    absolute, holds = _is_absolute(tolerance, theory), compare.holds.holds(figures)
    unit, factor = compare.unit or si_unit(theory), 1.0
    if compare.unit:
        same_dimension(Expression(compare.unit).value(), theory, compare.unit)
        factor = factor_of(compare.unit)
    gap = gap / factor if absolute else _share(gap, theory.value)
    most = tolerance.value / factor if absolute else tolerance.value
    return Row(
        lesson.name, compare.name, compare.line, compare.quantity,
        case_words(lesson.own, with_run(compare.run, case)), unit,
        measured.value / factor, theory.value / factor, gap, most, absolute, holds,
        (gap <= most) == holds,
    )  # fmt: skip


def gap_of(compare: Compare, figures: Figures) -> tuple[Quantity, Quantity, float]:
    """Return what is measured, the theory's value, and their gap [SI]; along a run where it is widest.

    The theory's value along a run, of which a tolerance is a share, is the greatest of all.
    """
    if not compare.along:
        measured, theory = compare.measured.value(figures), compare.theory.value(figures)
        same_dimension(measured, theory, compare.theory.text)
        return measured, theory, abs(measured.value - theory.value)
    measured, theory, _ = gap_of(replace(compare, along=False), figures.at(0))
    first, second = (figures.series(expression) for expression in (compare.measured, compare.theory))
    gap = max(abs(a - b) for a, b in zip(first, second, strict=True))
    worst = max(range(len(first)), key=lambda i: abs(second[i]))
    return (
        Quantity(first[worst], measured.dimension, True),
        Quantity(second[worst], theory.dimension, True),
        gap,
    )


def _is_absolute(tolerance: Quantity, theory: Quantity) -> bool:
    if tolerance.dimension == Quantity(0.0).dimension:
        return False
    same_dimension(tolerance, theory, "tolerance")
    return True


def _share(gap: float, of: float) -> float:
    return gap / abs(of) if of else (math.inf if gap else 0.0)


_UNITS = {"no unit": "", "kg m^2/s^2": "J", "kg m/s": "N s", "kg m^2/s": "N m s"}
"""Units as a table has them."""


def si_unit(quantity: Quantity) -> str:
    """Return the SI unit of a quantity; empty for a pure number."""
    words = in_words(quantity.dimension)
    return _UNITS.get(words, words)


def unit_of(expression: Expression, quantity: Quantity) -> str:
    """Return the unit of an expression in a graph: a quantity of the window has its own there, as rad."""
    column = dotted(expression.node).rpartition(".")[2]
    own = next((one.unit for one in QUANTITIES.values() if one.column == column), "")
    return own or si_unit(quantity)


def _answered(runs: LessonRuns, question: Question) -> Iterator[Row]:
    """Yield the answers that the engine can tell: a choice's condition, a number, a goal."""
    figures = runs.figures(question.run)
    for reply in question.replies:
        if reply.when is not None:
            yield _told(runs, question, reply.text, reply.when.holds(figures), reply.right)
        if reply.shown_by is not None:
            yield from _shown(runs, question, reply, reply.shown_by)
    if question.form == "number":
        right = runs.number(question)
        yield _told(runs, question, f"{right:.6g} {question.unit}", math.isfinite(right), True)
        for reply in question.replies:
            wrong = runs.number(question, reply)
            is_wrong = abs(wrong - right) > question.tolerance * abs(right)
            yield _told(runs, question, f"{reply.text} = {wrong:.6g} is a mistake", is_wrong, True)
    if question.form == "curve":
        assert question.answer is not None
        in_unit(question.answer.value(figures.at(0)), question.unit, question.answer.text)
        measured = runs.curve(question)
        for reply in question.replies:
            gap = curve_gap(runs.curve(question, reply), measured)
            what = f"{reply.text} is a mistake, {gap:.0%} away"
            yield _told(runs, question, what, gap > 2.0 * question.tolerance, True)
    if question.goal is not None and question.solution is not None:
        solved = question.goal.holds(runs.figures(question.run, question.solution))
        yield _told(runs, question, f"{question.goal.text}: {question.solution.text}", solved, True)
        yield _told(runs, question, f"{question.goal.text}: as it is", question.goal.holds(figures), False)


def _shown(runs: LessonRuns, question: Question, reply: Reply, case: Case) -> Iterator[Row]:
    """Yield whether an answer is as true in the run that is shown to it as the lesson says."""
    key = "where" if reply.holds_there else "show"
    try:
        figures = runs.figures(question.run, case)
    except (InvalidText, SceneError, Diverged) as error:
        allowed = "must be a case in which the run comes to its end"
        raise _refusal(runs.lesson, question, key, case, f"{error}; {allowed}") from error
    try:
        claimed = _claimed(question, reply, figures)
    except InvalidText:  # it is about something that does not happen in this run
        return
    if claimed is not None:
        what = f"{reply.text}, {key}: {case.text}"
        yield _told(runs, question, what, claimed, reply.right or reply.holds_there)


def _claimed(question: Question, reply: Reply, figures: Figures) -> bool | None:
    """Whether an answer is true in a run; ``None`` for a choice without a condition."""
    if reply.value is None:
        return None if reply.when is None else reply.when.holds(figures)
    assert question.answer is not None
    if question.form == "curve":
        gap = curve_gap(figures.series(reply.value), figures.series(question.answer))
        return gap <= 2.0 * question.tolerance
    mistaken, right = (one.value(figures).value for one in (reply.value, question.answer))
    return is_near(mistaken, right, question.tolerance)


def is_near(number: float, right: float, tolerance: float) -> bool:
    """Whether a number is right, within a tolerance that is a share of it."""
    return abs(number - right) <= tolerance * abs(right)


def curve_gap(drawn: Sequence[float], measured: Sequence[float]) -> float:
    """Return the root mean square of the distance of two curves, as a share of what the second spans."""
    squares = [(a - b) ** 2 for a, b in zip(drawn, measured, strict=True)]
    span = max(measured) - min(measured) or abs(measured[0]) or 1.0
    return math.sqrt(sum(squares) / len(squares)) / span


def _told(runs: LessonRuns, question: Question, what: str, found: bool, expected: bool) -> Row:
    nan = math.nan
    return Row(
        runs.lesson.name, question.name, question.line, question.prompt, what, "", nan, nan, nan, nan, False,
        expected, found == expected,
    )  # fmt: skip
