"""The lesson that is open in a window: where its reader is, what was answered, and the run under way."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from physicslab.ecs.quantity_text import Expression, InvalidText
from physicslab.files.checks import SceneError
from physicslab.files.replace import reason_of
from physicslab.history import Command, Group, Remove, Spawn
from physicslab.lessons.answers import Graded, check_answer, grade_one, read_answers, write_answers
from physicslab.lessons.check import LessonRuns
from physicslab.lessons.lesson import Compare, Explain, Lesson, Part, Prose, Question, Recall, Run
from physicslab.lessons.live_run import LiveRun
from physicslab.lessons.setup import AS_IT_IS, Case
from physicslab.state.attached import INSTRUMENTS
from physicslab.state.contents import Desk
from physicslab.view.window.naming import free_name, new_paths
from physicslab.view.window.scenes import Left
from physicslab.world import World

type Key = tuple[int, tuple[tuple[str, str], ...]]
"""A run and what differs in it: its line and the values of its case."""


@dataclass(slots=True)
class Curve:
    """A line of a graph as it grows: values of two expressions at each sample [SI]."""

    along: Expression
    against: Expression
    x: list[float]
    y: list[float]


class Trial:
    """A run that is under way in the window, or was made there.

    Attributes
    ----------
    run, case : Run, Case
        Which, and what of it was changed.
    live : LiveRun
        Its world and its samples.
    curves : list of Curve
        Its graphs.
    theory : dict of str to list of float
        The theory's values along it, by the names of comparisons [SI].
    ended : bool
        Whether it is complete.
    failure : str
        Why it could not be made to its end.
    """

    def __init__(self, lesson: Lesson, run: Run, case: Case) -> None:
        self.run, self.case = run, case
        self.live = LiveRun(lesson.setup, run, lesson.quantities, case)
        self.curves = [Curve(along, against, [], []) for along, against in run.graphs]
        self._along = [one for one in lesson.compares() if one.along and one.run.line == run.line]
        self.theory: dict[str, list[float]] = {one.name: [] for one in self._along}
        self.ended, self.failure = False, ""
        self._draw()

    @property
    def key(self) -> Key:
        """Its key."""
        return self.run.line, self.case.values

    @property
    def share(self) -> float:
        """How far it is, at least: a share of the time that it takes at most."""
        return min(self.live.world.time / self.live.limit, 1.0) if self.live.limit else 1.0

    def sample(self) -> None:
        """Take a sample after a step."""
        try:
            self.ended = self.live.sample()
        except (SceneError, InvalidText) as error:
            self.failure = str(error)
        self._draw()

    def _draw(self) -> None:
        now = self.live.figures.at(len(self.live.record.times) - 1)
        try:
            for curve in self.curves:
                curve.x.append(curve.against.value(now).value)
                curve.y.append(curve.along.value(now).value)
            for compare in self._along:
                self.theory[compare.name].append(compare.theory.value(now).value)
        except InvalidText as error:
            self.failure = str(error)


class OpenLesson:
    """A lesson with what its reader has done in it; answers are written to a file as they are given.

    Parameters
    ----------
    lesson : Lesson
        The open lesson.
    source : str
        Its name, or its file, by which it was opened.
    folder : Path
        Where its file of answers is, or is begun.
    before : Left
        The scene that it took the place of; it is shown again when the lesson is left.
    desk, tool : Desk, str
        The view beside that scene, and the tool in hand.
    find : callable
        Returns an earlier lesson by its name.

    Attributes
    ----------
    path : Path
        The file of answers.
    learner : str
        Who learns.
    given : dict of str to object
        The answers, by the names of their questions.
    step : int
        The step that is shown, from 0.
    values : dict of str to str
        The learner's values of open parameters, by their names.
    world : World, optional
        The last that was made for it.
    trial : Trial, optional
        The run that is shown.
    passed : set of str
        Questions that the learner went past without an answer.
    failure, told : str
        Why answers are not kept; what is to be known of those that were found.
    number : int
        Changes with all that a panel shows of it.
    """

    def __init__(
        self, lesson: Lesson, source: str, folder: Path, before: Left, desk: Desk, tool: str,
        find: Callable[[str], Lesson],
    ) -> None:  # fmt: skip
        self.lesson, self.source, self.before, self.desk, self.tool = lesson, source, before, desk, tool
        self.find = find
        self.path = folder / f"{lesson.name}-answers.json"
        self.learner, self.given = "", dict[str, dict[str, Any]]()
        self.step, self.number = 0, 0
        self.values: dict[str, str] = {}
        self.world: World | None = None
        self.trial: Trial | None = None
        self.passed: set[str] = set()
        self.failure = self.told = ""
        self.runs = LessonRuns(lesson)
        self._others: dict[str, LessonRuns] = {}
        self._made: dict[Key, Trial] = {}
        self._read()
        asking = [n for n in range(len(lesson.steps)) if self._asked(n) and not self.is_done(n)]
        self.go_to(asking[0] if self.given and asking else 0)

    # ---- answers -------------------------------------------------------------------------------------------

    def _read(self) -> None:
        """Go on with the answers of a file; one that does not fit is left as it is, and another is begun."""
        if not self.path.exists():
            return
        try:
            found = read_answers(self.path, self.lesson, self.find)
        except SceneError as error:
            stem = self.path.stem
            self.path = self.path.with_name(free_name(new_paths(self.path.parent, stem, ".json")))
            self.told = f"{error}. Answers go to {self.path.name}"
            return
        self.learner, self.given = found.learner, {name: dict(one) for name, one in found.given.items()}
        if found.other_text:
            self.told = "The lesson has been changed since these answers were given"

    def answer(self, name: str, question: Question | Explain, answer: Mapping[str, Any]) -> str:
        """Take an answer and write it; return why it is refused, empty where it is not."""
        try:
            check_answer(name, answer, question)
        except SceneError as error:
            return str(error).partition(": ")[2] or str(error)
        self.given[name] = dict(answer)
        self.write()
        return ""

    def write(self) -> None:
        """Write all answers to their file."""
        self.number += 1
        try:
            write_answers(self.path, self.lesson, self.learner, self.given)
            self.failure = ""
        except (OSError, ValueError) as error:
            self.failure = f"Answers cannot be kept: {reason_of(error)}"

    def graded(self, name: str, kind: str, question: Question | Explain) -> Graded:
        """Return a question with its answer and grade; of an earlier lesson it is named ``LESSON/CHECK``."""
        runs = self.runs
        if kind == "recall":
            other = name.partition("/")[0]
            runs = self._others.setdefault(other, LessonRuns(self.find(other)))
        return grade_one(runs, name, kind, question, self.given.get(name))

    # ---- runs ----------------------------------------------------------------------------------------------

    def open_to(self, run: Run) -> bool:
        """Whether a run may be made: all that is to be predicted of it is locked in."""
        return all(one.name in self.given for one in self.lesson.predictions(run))

    def made(self, run: Run | None, case: Case = AS_IT_IS) -> Trial | None:
        """Return a run that was made to its end."""
        return None if run is None else self._made.get((run.line, case.values))

    def _own_cases(self, run: Run) -> list[Case]:
        """Return the cases of a run that the learner has made with values of their own."""
        return [
            one.case for one in self._made.values() if one.run.line == run.line and one.case.text == "own"
        ]

    def rows(self, part: Compare) -> list[Case]:
        """Return the cases of a comparison, then those of the learner; one of equal values is listed once."""
        own = self._own_cases(part.run)
        shown = {self._values_of(part.run, case) for case in part.rows()} if own else set()
        other = []
        for case in own:
            if (values := self._values_of(part.run, case)) not in shown:
                shown.add(values)
                other.append(case)
        return part.rows(other)

    def _values_of(self, run: Run, case: Case) -> tuple[object, ...]:
        """Return all that parameters are in a run with a case's values, and what else the case sets."""
        setup, given = self.lesson.setup, dict(run.case.values) | dict(case.values)
        scope = setup.values(Case("", tuple(given.items())))
        found = (scope.named(name) for name in setup.parameters)
        rounded = tuple(f"{one.value:.12g}" for one in found if one is not None)  # 50 cm are 0.5 m
        return rounded, frozenset(item for item in given.items() if item[0] not in setup.parameters)

    def own_case(self) -> Case:
        """Return the case of the values that are set."""
        return Case("own", tuple(self.values.items()))

    def begin(self, run: Run, case: Case) -> World:
        """Begin a run and return its world.

        Raises
        ------
        SceneError, InvalidText
            If there is no such run with the values that are set.
        """
        self.trial = Trial(self.lesson, run, case)
        self.number += 1
        if not case.values:
            self._reset(run)
        self.world = self.trial.live.world
        return self.world

    def go_to(self, step: int) -> World:
        """Go to a step, and return the world of its first run, at its beginning."""
        self.step, self.trial = step, None
        self.number += 1
        run = next((part for part in self.lesson.steps[step].parts if isinstance(part, Run)), None)
        self._reset(run)
        self.world = self.lesson.setup.world(AS_IT_IS if run is None else run.case)
        return self.world

    def _reset(self, run: Run | None) -> None:
        """Set what is open to the values of the run that comes next."""
        self._next = run
        setup = self.lesson.setup
        usual = {name: setup.parameters[name].text for name in setup.opened}
        self.values = usual | {name: text for name, text in (run.case.values if run else ()) if name in usual}

    @property
    def waits(self) -> bool:
        """Whether time is shut: of the run whose scene is shown something is still to be predicted.

        A step without a run shows the scene of the next one.
        """
        later = (part for step in self.lesson.steps[self.step :] for part in step.parts)
        run = self._next or next((part for part in later if isinstance(part, Run)), None)
        return run is not None and not self.open_to(run)

    @property
    def coming(self) -> Run | None:
        """The run whose scene is shown, if it may be made and was not begun."""
        return None if self.waits or self.trial is not None else self._next

    @property
    def running(self) -> bool:
        """Whether a run is under way: the world is left alone until it ends."""
        return self.trial is not None and not (self.trial.ended or self.trial.failure)

    def follow(self, world: World) -> bool:
        """Take a sample after a step of a world; return whether the run has ended with it."""
        trial = self.trial
        if trial is None or not self.running or trial.live.world is not world:
            return False
        if world.time <= trial.live.record.times[-1]:
            return False  # made again, in the past
        trial.sample()
        if trial.ended:
            self._made[trial.key] = trial
            self.runs.keep(trial.run, trial.live.figures, trial.case)
            self.number += 1
        return not self.running

    @property
    def state(self) -> tuple[object, ...]:
        """The state that a panel shows; it changes with each sample of a run."""
        samples = len(self.trial.live.record.times) if self.trial is not None else 0
        return self, self.number, samples

    # ---- how far -------------------------------------------------------------------------------------------

    def is_past(self, part: Part) -> bool:
        """Whether what stands below a part is shown: it was answered, made, or passed."""
        match part:
            case Run():
                return self.made(part) is not None
            case Question() | Explain():
                return part.name in self.given or part.name in self.passed
            case Recall():
                return part.name in self.passed or all("/".join(one) in self.given for one in part.asks)
        return True

    def shown(self, step: int) -> Sequence[Part]:
        """Return the parts of a step down to the first that is still to be done."""
        parts = self.lesson.steps[step].parts
        last = next((n for n, part in enumerate(parts) if not self.is_past(part)), len(parts))
        return parts[: last + 1]

    def is_done(self, step: int) -> bool:
        """Whether all of a step was answered; runs are made again when a lesson is taken up."""
        asked = self._asked(step)
        return bool(asked) and all(map(self.is_past, asked))

    def _asked(self, step: int) -> list[Part]:
        """Return the parts of a step that are to be answered."""
        return [part for part in self.lesson.steps[step].parts if not isinstance(part, Prose | Run | Compare)]

    # ---- what is open --------------------------------------------------------------------------------------

    def opens_tool(self, tool: str) -> bool:
        """Whether a tool is open: those that look, and those that the lesson names."""
        return tool in ("select", "pan") or tool in self.lesson.setup.tools

    def allows(self, command: Command, world: World) -> bool:
        """Whether an edit is open: of instruments whose tools are."""
        if isinstance(command, Group):
            return all(self.allows(one, world) for one in command.commands)
        open_kinds = tuple(kind for kind in INSTRUMENTS if kind.__name__.lower() in self.lesson.setup.tools)
        if isinstance(command, Spawn):
            return all(isinstance(one, open_kinds) for one in command.components)
        if isinstance(command, Remove):
            return any(world.has(command.entity, kind) for kind in open_kinds)
        return getattr(command, "component", "") in {kind.__name__ for kind in open_kinds}

    @property
    def opens_hand(self) -> bool:
        """Whether bodies may be taken in the hand: if the lesson says so, while nothing is measured."""
        return "hand" in self.lesson.setup.tools and not self.running

    def shows(self, word: str) -> bool:
        """Whether something may be shown beside the world, by its word in scene files."""
        return word in ("grid", "panel") or word in (*self.lesson.setup.shown, *self.lesson.setup.tools)
