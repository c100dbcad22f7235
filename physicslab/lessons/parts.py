"""From the blocks of a lesson's file to its parts, each with the run that it is about."""

import itertools
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace

from physicslab.diagnostics.figures import FUNCTIONS
from physicslab.diagnostics.samples import quantity_of, quoted
from physicslab.ecs.conditions import Condition
from physicslab.ecs.quantity_text import Expression, InvalidText, factor_of, in_unit
from physicslab.lessons.blocks import Block, Entry
from physicslab.lessons.lesson import Compare, Explain, Question, Recall, Reply, Run
from physicslab.lessons.live_run import refuse_long
from physicslab.lessons.setup import AS_IT_IS, Case, Setup
from physicslab.world import World

CITED = re.compile(r"\[([a-z]+[0-9]{4}[a-z]?)\]")
_RATIO = "a share of it, as 0.1 %, or an amount in its unit"
_TIME = Expression("time")
_BELOW = ("idea", "show", "where", "when")
"""Keys below a choice or a mistake, beside right and wrong."""


class PartMaker:
    """Makes the parts of one lesson.

    Parameters
    ----------
    setup : Setup
        Its scene; expressions may name its parameters and its bodies.
    sources : mapping of str to str
        The literature that feedback may cite.

    Attributes
    ----------
    quantities : dict
        As its keys, in order, what expressions read from runs.
    """

    def __init__(self, setup: Setup, sources: Mapping[str, str]) -> None:
        self.quantities: dict[str, None] = {}
        self._setup, self._sources = setup, sources
        self._ids = [one["id"] for one in setup.document["entities"] if "id" in one]
        self._runs: list[Run] = []
        self._counts: dict[str, int] = {}
        self._worlds: dict[tuple[tuple[str, str], ...], World] = {}
        self._makers: dict[str, Callable[[Block], Run | Question | Compare | Explain | Recall]] = {
            "predict": self._question, "check": self._question, "compare": self._compare,
            "explain": self._explain, "recall": self._recall, "run": self._made_run,
        }  # fmt: skip

    def make_runs(self, blocks: Iterable[Block]) -> None:
        """Make all runs, which other parts refer to."""
        self._runs = [self._run(block) for block in blocks]

    def make(self, block: Block) -> Run | Question | Compare | Explain | Recall:
        """Return the part of a block."""
        if not block.name:
            self._counts[block.kind] = self._counts.get(block.kind, 0) + 1
            block.name = f"{block.kind}_{self._counts[block.kind]}"
        return self._makers[block.kind](block)

    # ---- kinds of blocks -----------------------------------------------------------------------------------

    def _made_run(self, block: Block) -> Run:
        made = next(run for run in self._runs if run.line == block.line)
        return replace(made, name=block.name)

    def _run(self, block: Block) -> Run:
        seconds, until = block.find("seconds"), block.find("until")
        if bool(seconds) == bool(until):
            raise block.error("must have seconds: TIME or until: CONDITION, one of both")
        limit = block.find("limit")
        if limit and seconds:
            raise block.refusal(limit, "must stand beside until")
        case = block.find("case")
        return Run(
            block.name, block.line,
            self._duration(block, seconds) if seconds else None,
            self._condition(block, until) if until else None,
            self._duration(block, limit) if limit else Expression("60 s"),
            tuple(self._graph(block, entry) for entry in block.all("graph")),
            self._case(block, case) if case else AS_IT_IS,
        )  # fmt: skip

    def _graph(self, block: Block, entry: Entry) -> tuple[Expression, Expression]:
        drawn, _, against = entry.value.partition(" against ")
        first = self._expression(block, replace(entry, value=drawn))
        return first, self._expression(block, replace(entry, value=against)) if against else _TIME

    def _compare(self, block: Block) -> Compare:
        run = self._run_of(block)
        measure, along = block.find("measure"), block.find("along")
        if bool(measure) == bool(along) or run is None:
            why = "measure: EXPRESSION or along: EXPRESSION, one of both" if run else "a run before it"
            raise block.error(f"must have {why}")
        cases = [self._case(block, entry) for entry in block.all("case")]
        unit = block.find("unit")
        if unit:
            block.read(unit, factor_of)
        return Compare(
            block.name, block.line, block.text("quantity", "what is compared, in words"),
            unit.value if unit else "",
            self._expression(block, measure or block.one("along", "")),
            self._expression(block, block.one("theory", "an expression")),
            along is not None,
            self._condition(block, block.one("holds", "when the theory holds: a condition, or always")),
            self._expression(block, block.one("tolerance", _RATIO)),
            tuple(cases or [AS_IT_IS]),
            tuple(self._case(block, entry) for entry in block.all("fails")),
            run,
        )  # fmt: skip

    def _explain(self, block: Block) -> Explain:
        return Explain(
            block.name, block.line, block.text("question", "what is to be explained"),
            self._cited(block, block.one("answer", "a model answer")),
        )  # fmt: skip

    def _recall(self, block: Block) -> Recall:
        asks = []
        for entry in block.all("ask"):
            lesson, sign, name = entry.value.partition("/")
            if not (sign and lesson and name):
                raise block.refusal(entry, "must be LESSON/CHECK, a check of an earlier lesson")
            asks.append((lesson.strip(), name.strip()))
        if not asks:
            raise block.error("ask is missing: must be LESSON/CHECK, a check of an earlier lesson")
        return Recall(block.name, block.line, tuple(asks))

    def _question(self, block: Block) -> Question:
        forms = [key for key in ("choice", "number", "curve", "goal") if block.find_first(key)]
        if len(forms) != 1:
            raise block.error("must have one of choice: TEXT, number: UNIT, curve: UNIT and goal: CONDITION")
        (form,) = forms
        made = Question(
            block.kind, block.name, block.line, block.text("question", "a question"), form,
            replies=tuple(self._replies(block)), right=self._own(block, "right"), run=self._run_of(block),
        )  # fmt: skip
        if form == "choice":
            if len(made.replies) > 1 and sum(reply.right for reply in made.replies) == 1:
                return made
            why = "must have two choices or more, one with right: below it, the others with wrong:"
            raise block.error(why)
        if form == "goal":
            solution = block.one("solution", "values of a case that reach the goal")
            goal = self._condition(block, block.one("goal", "a condition"))
            return replace(made, goal=goal, solution=self._open_case(block, solution))
        unit = block.one(form, 'a unit, as "m/s", or 1')
        block.read(unit, factor_of)
        answer = self._expression(block, block.one("answer", "an expression of the right answer"))
        share = block.one("tolerance", "a share, as 5 %")
        tolerance = block.read(share, lambda text: Expression(text).value())
        if tolerance.dimension != Expression("1").value().dimension or not 0.0 < tolerance.value < 1.0:
            raise block.refusal(share, "must be a share above 0 % and below 100 %")
        return replace(made, unit=unit.value, answer=answer, tolerance=tolerance.value)

    def _replies(self, block: Block) -> Iterator[Reply]:
        """Yield the choices or mistakes, each with the keys that follow it."""
        own: list[Entry] = []
        for entry in [*block.entries, None]:
            if entry is None or entry.key in ("choice", "mistake"):
                if own:
                    yield self._reply(block, own)
                own = [entry] if entry else []
            elif own and entry.key in ("right", "wrong", *_BELOW):
                own.append(entry)
            elif entry.key in ("wrong", *_BELOW):
                raise block.error(f"{entry.key}: must stand below a choice or a mistake", entry.line)

    def _reply(self, block: Block, entries: list[Entry]) -> Reply:
        first, by_key = entries[0], {entry.key: entry for entry in entries}
        if len(by_key) < len(entries):
            raise block.error(f"{first.key} {first.value!r}: a key below it is given twice", first.line)
        said = [entry for entry in entries if entry.key in ("right", "wrong")]
        if len(said) != 1 or (first.key == "mistake" and said[0].key == "right"):
            allowed = "wrong: FEEDBACK" if first.key == "mistake" else "right: FEEDBACK or wrong: FEEDBACK"
            raise block.refusal(first, f"must have below it {allowed}")
        idea, shown_by, where, when = (by_key.get(key) for key in _BELOW)
        if where and shown_by:
            raise block.refusal(where, "must not stand beside show: one run is shown")
        shown_by = shown_by or where
        return Reply(
            first.value,
            self._expression(block, first) if first.key == "mistake" else None,
            said[0].key == "right",
            self._cited(block, said[0]),
            self._cited(block, idea) if idea else "",
            self._case(block, shown_by) if shown_by else None,
            bool(where),
            self._condition(block, when) if when else None,
        )

    def _own(self, block: Block, key: str) -> str:
        """Return the words of a key that stands above all choices and mistakes."""
        above = itertools.takewhile(lambda entry: entry.key not in ("choice", "mistake"), block.entries)
        return next((self._cited(block, entry) for entry in above if entry.key == key), "")

    def _run_of(self, block: Block) -> Run | None:
        """Return the run that a block is about: a prediction is of the next, all else of the last."""
        before = [run for run in self._runs if run.line < block.line]
        after = [run for run in self._runs if run.line > block.line]
        wanted = (after[:1] or before[-1:]) if block.kind == "predict" else before[-1:]
        return wanted[0] if wanted else None

    # ---- values, with the names that they may have ---------------------------------------------------------

    def _expression(self, block: Block, entry: Entry) -> Expression:
        return block.read(entry, lambda text: self._known(Expression(quoted(text, self._ids))))

    def _duration(self, block: Block, entry: Entry) -> Expression:
        """Return a time above zero, of numbers and parameters."""
        found = self._expression(block, entry)
        time = block.read(entry, lambda text: in_unit(found.value(self._setup.values()), "s", text))
        if time <= 0.0:
            raise block.refusal(entry, "must be a time above 0 s")
        block.read(entry, lambda _: refuse_long(time, self._world(AS_IT_IS)))
        return found

    def _condition(self, block: Block, entry: Entry) -> Condition:
        return block.read(entry, lambda text: self._known(Condition(quoted(text, self._ids))))

    def _case(self, block: Block, entry: Entry) -> Case:
        case = block.case(entry)
        block.read(entry, lambda _: self._world(case))
        return case

    def _world(self, case: Case) -> World:
        """Return the world of a case, which many parts name."""
        if case.values not in self._worlds:
            self._worlds[case.values] = self._setup.world(case)
        return self._worlds[case.values]

    def _open_case(self, block: Block, entry: Entry) -> Case:
        """Return a case that learners can set: of what is open, within its limits."""
        case, setup = self._case(block, entry), self._setup
        for name, text in case.values:
            if name not in setup.opened:
                raise block.refusal(entry, f"must be of what is open: {', '.join(setup.opened) or 'nothing'}")
            low, high = setup.opened[name]
            if not setup.quantity(name, low) <= setup.quantity(name, text) <= setup.quantity(name, high):
                raise block.refusal(entry, f"{name} must be from {low} to {high}")
        return case

    def _cited(self, block: Block, entry: Entry) -> str:
        for key in CITED.findall(entry.value):
            if key not in self._sources:
                known = ", ".join(self._sources) or "none"
                raise block.refusal(entry, f"[{key}] is no source of the head; must be one of {known}")
        return entry.value

    def _known[T: (Expression, Condition)](self, found: T) -> T:
        """Refuse what names neither a parameter, nor a function, nor a quantity."""
        for name in found.names():
            if name in self._setup.parameters or name in FUNCTIONS or name == "time":
                continue
            if "." not in name:
                names = ", ".join([*self._setup.parameters, "time"])
                raise InvalidText(f"'{name}' is unknown; must be one of {names}, or a quantity as ball.x")
            quantity_of(name, self._ids)
            self.quantities[name] = None
        return found
