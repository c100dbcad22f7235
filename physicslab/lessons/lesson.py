"""A lesson as records, which a panel, a page or a grader renders without knowing the format of its file."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from physicslab.ecs.conditions import Condition
from physicslab.ecs.quantity_text import Expression
from physicslab.languages.language import Language, language
from physicslab.lessons.setup import AS_IT_IS, Case, Setup

SURENESS = ("guess", "unsure", "sure", "certain")
"""How sure a learner may be of a prediction."""
DEPTHS = (1, 2, 3)
"""How deep a step goes: see it, reckon it, find its limits."""
HEADING = re.compile(r"##\s+(?:[^:#]*?(\d+):\s*)?(.*)")
"""The heading of a step: a word and its depth, if it has one, and its driving question."""


@dataclass(frozen=True, slots=True)
class Prose:
    """Markdown between two blocks, with the line on which it begins."""

    text: str
    line: int


@dataclass(frozen=True, slots=True)
class Run:
    """A run of the scene.

    Attributes
    ----------
    seconds : Expression, optional
        How long it goes on [s].
    until : Condition, optional
        Condition that ends it otherwise, as soon as it becomes true.
    limit : Expression
        The longest that it may take then [s].
    graphs : tuple of pairs of Expression
        Expressions drawn, and those on the horizontal axis; ``time`` by default.
    case : Case
        Changes to the scene.
    """

    name: str
    line: int
    seconds: Expression | None
    until: Condition | None
    limit: Expression
    graphs: tuple[tuple[Expression, Expression], ...]
    case: Case


@dataclass(frozen=True, slots=True)
class Reply:
    """An answer that a question foresees.

    Attributes
    ----------
    text : str
        The words of a choice, or the expression of a wrong number.
    value : Expression, optional
        That number.
    right : bool
        Whether it is right.
    feedback, idea : str
        Reply to a learner who gives it; the misconception that it stands for, with its source.
    shown_by : Case, optional
        A run that shows it wrong; or, ``holds_there``, the one in which it would be right.
    when : Condition, optional
        Condition on a run's figures that holds if, and only if, this choice is right there.
    """

    text: str
    value: Expression | None
    right: bool
    feedback: str
    idea: str = ""
    shown_by: Case | None = None
    holds_there: bool = False
    when: Condition | None = None


@dataclass(frozen=True, slots=True)
class Question:
    """A question: a prediction before a run, or a check after it.

    Attributes
    ----------
    kind : str
        ``"predict"`` or ``"check"``.
    form : str
        ``"choice"``, ``"number"``, ``"curve"`` (drawn over time) or ``"goal"`` (values with which the run
        reaches something).
    unit : str
        Unit of a number or a curve.
    answer : Expression, optional
        The right number, or what is measured along the curve.
    tolerance : float
        Share of the right number within which an answer is right; of its span for a curve.
    goal : Condition, optional
        Condition to be reached.
    solution : Case, optional
        Values that reach it.
    replies : tuple of Reply
        The choices, or the wrong numbers that have a feedback of their own.
    right : str
        Reply to a right answer.
    run : Run, optional
        Whose figures it is about.
    """

    kind: str
    name: str
    line: int
    prompt: str
    form: str
    unit: str = "1"
    answer: Expression | None = None
    tolerance: float = 0.0
    goal: Condition | None = None
    solution: Case | None = None
    replies: tuple[Reply, ...] = ()
    right: str = ""
    run: Run | None = None


@dataclass(frozen=True, slots=True)
class Compare:
    """Theory beside measurement.

    Attributes
    ----------
    quantity, unit : str
        Its name; the unit in which it is shown, empty for SI units.
    measured, theory : Expression
        Over the figures of the run, and over parameters.
    along : bool
        Whether both are compared at each sample of the run, where ``time`` is its time.
    holds : Condition
        When the theory holds.
    tolerance : Expression
        The largest gap: a share, or in the unit of the quantity.
    cases, fails : tuple of Case
        Where it holds, and where it must not.
    """

    name: str
    line: int
    quantity: str
    unit: str
    measured: Expression
    theory: Expression
    along: bool
    holds: Condition
    tolerance: Expression
    cases: tuple[Case, ...]
    fails: tuple[Case, ...]
    run: Run

    def rows(self, tried: Iterable[Case] = ()) -> list[Case]:
        """Return its cases, each once: first the run as it is, at the end those that a learner tried."""
        cases = list(dict.fromkeys((*self.cases, *self.fails, *tried)))
        as_run = next((case for case in cases if not case.values), AS_IT_IS)
        return [as_run, *(case for case in cases if case.values)]


@dataclass(frozen=True, slots=True)
class Explain:
    """A prompt to explain, and a model answer."""

    name: str
    line: int
    prompt: str
    answer: str


@dataclass(frozen=True, slots=True)
class Recall:
    """Questions of earlier lessons, each as ``(lesson, name of its check)``."""

    name: str
    line: int
    asks: tuple[tuple[str, str], ...]


type Part = Prose | Run | Question | Compare | Explain | Recall


def place_of(part: Run | Question | Compare | Explain | Recall) -> str:
    """Return where a part stands, as messages have it: ``line 42: compare period``."""
    kind = part.kind if isinstance(part, Question) else type(part).__name__.lower()
    return f"line {part.line}: {kind} {part.name}"


@dataclass(frozen=True, slots=True)
class Step:
    """A part of a lesson below one heading: its driving question, how deep it goes, and what is in it."""

    heading: str
    depth: int
    parts: tuple[Part, ...]


@dataclass(frozen=True, slots=True)
class Lesson:
    """A lesson.

    Attributes
    ----------
    name, title, language : str
        Its name, by which answers and other lessons know it; its title; its language, as ``"en"``.
    level : int
        One of ``DEPTHS``: the deepest that it needs.
    minutes : int
        How long it takes.
    needs : tuple of str
        Lessons that should be known before.
    setup : Setup
        Its scene, with parameters, and what of the window is open.
    sources : dict of str to str
        Literature, by the keys that stand in brackets.
    quantities : tuple of str
        Quantities that the expressions read from a run, as ``ball.x``.
    digest : str
        Digest of the file's bytes: answers say to which text they were given.
    path : Path
        Where it was read.
    """

    name: str
    title: str
    language: str
    level: int
    minutes: int
    needs: tuple[str, ...]
    setup: Setup
    steps: tuple[Step, ...]
    sources: dict[str, str] = field(default_factory=dict)
    quantities: tuple[str, ...] = ()
    digest: str = ""
    path: Path = Path()

    @property
    def own(self) -> Language:
        """The language in which its formulas are written."""
        return language(self.language)

    def parts(self) -> Iterator[Part]:
        """Yield everything in it, in order."""
        for step in self.steps:
            yield from step.parts

    def questions(self, kind: str = "") -> Iterator[Question]:
        """Yield its questions, or those of a kind."""
        yield from (part for part in self.parts() if isinstance(part, Question) and kind in ("", part.kind))

    def predictions(self, run: Run) -> list[Question]:
        """Return what is to be predicted of a run."""
        return [one for one in self.questions("predict") if one.run and one.run.line == run.line]

    def predicted(self, run: Run, form: str, text: str) -> list[Question]:
        """Return which predictions of a run ask, in a form, for an expression of that text."""
        asked = (one for one in self.predictions(run) if one.form == form)
        return [one for one in asked if one.answer is not None and one.answer.text == text]

    def compares(self) -> Iterator[Compare]:
        """Yield what it compares."""
        yield from (part for part in self.parts() if isinstance(part, Compare))
