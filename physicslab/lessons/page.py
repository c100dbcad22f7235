"""A lesson as one page for a browser without a network.

Every run is made here, for each value of its sliders and each case that the lesson names; their pictures and
figures go into books, which the player of shared pages plays. Questions become forms, and what the engine
knows of them (right numbers, foreseen mistakes, theory beside measurement) stands beside the books in the
page's JSON. The page keeps each run shut until all is predicted of it, says what the lesson says to an
answer, and saves ``physicslab-answers/1``, which :mod:`physicslab.lessons.answers` grades.
"""

import itertools
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from html import escape
from typing import Any

import numpy as np

from physicslab.diagnostics.figures import Figures
from physicslab.diagnostics.samples import quantity_of
from physicslab.ecs.quantity_text import Expression, InvalidText, dotted, factor_of
from physicslab.export.packing import pack
from physicslab.export.page import fill_page, run_document
from physicslab.export.recording import NotShown, RunRecorder
from physicslab.files.checks import SceneError
from physicslab.lessons import words
from physicslab.lessons.answers import FORMAT, asked, grade_one
from physicslab.lessons.check import LessonRuns, Row, row_of, unit_of
from physicslab.lessons.film import Film
from physicslab.lessons.lesson import Compare, Explain, Lesson, Part, Prose, Question, Recall, Reply, Run
from physicslab.lessons.live_run import record_run
from physicslab.lessons.setup import AS_IT_IS, Case
from physicslab.state.masses import Diverged
from physicslab.world import World

_VALUES = (11, 5)
"""Values of a slider, where there is one and where there are two, beside that of the run as it is."""
_WIDE = 50.0
"""A span of such a ratio is divided by ratios."""
_CURVE = 100
"""Points of a curve beside which a drawn one is held."""
_FAILURES = (InvalidText, SceneError, Diverged, NotShown)
_UNIT = re.compile(r"\s*[-+\d.e]+\s*(.*)")


def lesson_page(
    lesson: Lesson, find: Callable[[str], Lesson], tell: Callable[[float], object] = lambda share: None
) -> bytes:
    """Return the page in UTF-8, which needs nothing beside itself.

    ``find`` returns earlier lessons; ``tell`` is told what share of the lesson is done.
    """
    made = _Page(lesson, find, tell)
    article = "\n".join(made.article())
    document = {"lesson": made.told, "runs": made.pictures, "books": made.books, "words": made.words}
    return fill_page(lesson.title, words.about_words(made.own, lesson), document, article, lesson.language)


class _Page:
    """The parts gathered while the article is written: runs, books of runs, and answers to questions."""

    def __init__(
        self, lesson: Lesson, find: Callable[[str], Lesson], tell: Callable[[float], object]
    ) -> None:
        self._report, self._parts, self._done = tell, sum(len(step.parts) for step in lesson.steps), 0
        self.lesson, self.own = lesson, lesson.own
        self.pictures: list[dict[str, Any]] = []
        self.books: list[dict[str, Any]] = []
        self.words: dict[str, str] = {}
        self.told: dict[str, Any] = {
            "head": {"format": FORMAT, "lesson": lesson.name, "digest": lesson.digest},
            "questions": {}, "compares": {}, "runs": {},
        }  # fmt: skip
        self._asked = {
            name: (kind, part, LessonRuns(owner)) for name, kind, part, owner in asked(lesson, find)
            if kind == "recall"
        }  # fmt: skip
        self._runs = LessonRuns(lesson)
        self._made: dict[object, tuple[int, Figures | None]] = {}

    # ---- runs ----------------------------------------------------------------------------------------------

    def book(self, runs: LessonRuns, run: Run, cases: Sequence[Case], sliders: Sequence[Any] = ()) -> int:
        """Add a book of a run in some cases, and return its number."""
        found = []
        for n, case in enumerate(cases):
            found.append(self._picture(runs, run, case))
            self._report((self._done + (n + 1) / len(cases)) / self._parts)
        compares = [one for one in runs.lesson.compares() if one.run.line == run.line]
        rows = [
            {one.name: self._row(one, case, figures) for one in compares} if figures else {}
            for case, (_, figures) in zip(cases, found, strict=True)
        ]
        views = [self.pictures[n]["view"] for n, figures in found if figures]
        if not views:
            raise SceneError(f"{self.lesson.path}: line {run.line}: {self.pictures[found[0][0]]['failure']}")
        low, high = np.min(views, axis=0)[:2], np.max(views, axis=0)[2:]
        self.books.append({
            "view": [*low.tolist(), *high.tolist()], "runs": [n for n, _ in found], "rows": rows,
            "sliders": sliders, "run": run.line,
        })  # fmt: skip
        return len(self.books) - 1

    def _picture(self, runs: LessonRuns, run: Run, case: Case) -> tuple[int, Figures | None]:
        """Return the number of a run's picture, and its figures, if it can be made; each is made once."""
        texts = [one and one.text for one in (run.seconds, run.until, run.limit)]
        graphs = [(one.text, across.text) for one, across in run.graphs]
        key = (runs.lesson.name, str(texts), str(graphs), words.with_run(run, case).values)
        if key not in self._made:
            try:
                document, figures = self._record(runs.lesson, run, case)
            except _FAILURES as error:
                document, figures = {"failure": str(error)}, None
            self.pictures.append(document)
            self._made[key] = len(self.pictures) - 1, figures
        number, figures = self._made[key]
        if figures is not None:
            runs.keep(run, figures, case)
        return number, figures

    def _record(self, lesson: Lesson, run: Run, case: Case) -> tuple[dict[str, Any], Figures]:
        film = Film()
        figures = record_run(lesson.setup, run, lesson.quantities, case, film.watch)
        world, recorder, kept = film.ended(figures.record.samples)
        document = run_document(world, recorder, [])
        self.words |= {name: self.own.reword(name) for name in (*recorder.energies, "total")}
        self.words |= {name: self.own.reword(name) for _, name in recorder.quantities}
        self._add_graphs(document, recorder, lesson, run, figures, kept, world)
        return document, figures

    def _add_graphs(
        self, document: dict[str, Any], recorder: RunRecorder, lesson: Lesson, run: Run, figures: Figures,
        kept: Sequence[int], world: World,
    ) -> None:  # fmt: skip
        """Add the graphs of a run: what is measured, and theory where one is compared along the run."""
        columns: list[Any] = []
        graphs = document["graphs"] = []

        def add(expression: Expression, name: str = "") -> int:
            series = [expression.value(figures.at(sample)) for sample in kept]
            columns.append(np.array([one.value for one in series], np.float32))
            unit = unit_of(expression, series[0])
            called, body = self._quantity(expression, world)
            document["quantities"].append(
                {"name": name or called, "unit": unit, "body": None if name else body}
            )
            return len(document["quantities"]) - 1

        for along, across in run.graphs:
            theories = [
                one.theory for one in lesson.compares()
                if one.along and one.run.line == run.line and one.measured.text == along.text
            ]  # fmt: skip
            lines = [add(along), *(add(one, self.own.say("by theory")) for one in theories)]
            graphs.append({"across": None if across.text == "time" else add(across), "lines": lines})
        head = 1 + len(recorder.energies) + len(recorder.quantities)
        packed = recorder.columns
        if columns:
            packed = np.column_stack((packed[:, :head], *columns, packed[:, head:]))
        document["data"] = pack(packed)

    def _quantity(self, expression: Expression, world: World) -> tuple[str, int | None]:
        """Return what a line of a graph is called, and the number of its body."""
        ids = {world.label(entity): entity for entity in world.entities()}
        try:
            entity, name = quantity_of(dotted(expression.node), ids)
        except InvalidText:
            return words.formula(self.own, expression.text), None
        said = self.own.reword(name)
        return (said, None) if entity is None else (f"{entity}: {said}", ids[entity])

    def _slid(self, runs: LessonRuns, run: Run, wanted: Sequence[str] = (), least: Case = AS_IT_IS) -> int:
        """Add the book of a run with sliders, of what its cases vary first; return its number.

        A value of ``least`` is among those of its slider.
        """
        lesson, named = runs.lesson, list(wanted)
        for compare in lesson.compares():
            for case in (*compare.cases, *compare.fails) if compare.run.line == run.line else ():
                named += [name for name, _ in case.values]
        order = [*dict.fromkeys(named), *lesson.setup.opened]
        names = list(dict.fromkeys(name for name in order if name in lesson.setup.opened))[: len(wanted) or 2]
        sliders, texts = [], []
        for name in names:
            unit, values, start = self._values(lesson, run, name, _VALUES[len(names) - 1], dict(least.values))
            note = lesson.setup.notes.get(name, "")
            symbol = words.formula(self.own, name)
            label = f"{symbol}, {note}" if note else symbol
            shown = "" if unit == "1" else words.formula(self.own, f"1 {unit}")[1:].strip()
            sliders.append({"label": label, "unit": shown, "values": values, "start": start, "name": name})
            texts.append([f"{value!r} {'' if unit == '1' else unit}".strip() for value in values])
            sliders[-1]["texts"] = texts[-1]
        cases = []
        for places in itertools.product(*(range(len(one)) for one in texts)):
            changed = [(names[k], texts[k][n]) for k, n in enumerate(places) if n != sliders[k]["start"]]
            cases.append(Case("; ".join(map(" = ".join, changed)), tuple(changed)) if changed else AS_IT_IS)
        return self.book(runs, run, cases, sliders)

    def _values(
        self, lesson: Lesson, run: Run, name: str, count: int, also: Mapping[str, str]
    ) -> tuple[str, list[float], int]:
        """Return the unit of a slider, its values in it, and which of them the run has as it is."""
        setup, ends = lesson.setup, lesson.setup.opened[name]
        found = _UNIT.fullmatch(ends[1])
        unit = (found[1] if found else "") or "1"
        factor = factor_of(unit)
        low, high = (setup.quantity(name, end) / factor for end in ends)
        space = np.geomspace if low > 0.0 and high / low > _WIDE else np.linspace
        parameter = setup.values(run.case).named(name)
        assert parameter is not None
        usual = float(f"{parameter.value / factor:.9g}")
        values = {usual, *(float(f"{value:.3g}") for value in space(low, high, count))}
        values |= {float(f"{setup.quantity(name, also[name]) / factor:.9g}")} if name in also else set()
        ordered = sorted(values)
        return unit, ordered, ordered.index(usual)

    # ---- the article ---------------------------------------------------------------------------------------

    def article(self) -> Iterator[str]:
        """Yield its HTML."""
        own = self.own
        yield '<article id="lesson">'
        name = escape(own.say("Name"))
        yield f'<p class="name"><label>{name} <input id="learner" autocomplete="off"></label></p>'
        for step in self.lesson.steps:
            yield '<section class="step">'
            if step.heading:
                yield f"<h2>{step.depth} · {escape(step.heading)}</h2>"
            for part in step.parts:
                yield from self._part(part)
                self._done += 1
            yield "</section>"
        if self.lesson.sources:
            yield f"<details><summary>{escape(own.say('Sources'))}</summary><ul>"
            yield from (
                f"<li>[{escape(key)}] {escape(said)}</li>" for key, said in self.lesson.sources.items()
            )
            yield "</ul></details>"
        said = own.say("Your answers stay in this page until you save them; the file is for your teacher.")
        yield f'<section class="part keep"><p>{escape(said)}</p>'
        save, again = escape(own.say("Save the answers")), escape(own.say("Open saved answers"))
        yield f'<button id="save" type="button" class="main">{save}</button>'
        yield f'<label class="file">{again} <input id="open" type="file" accept=".json"></label>'
        yield '<p id="kept" role="status"></p></section></article>'

    def _part(self, part: Part) -> Iterator[str]:
        match part:
            case Prose(text=text):
                yield '<div class="prose">'
                yield from (f"<p>{escape(one)}</p>" for one in text.split("\n\n"))
                yield "</div>"
            case Question():
                yield from self._question(part.name, part.kind, part, self._runs)
            case Explain():
                yield from self._explain(part)
            case Run():
                yield from self._run(part)
            case Compare():
                yield from self._compare(part)
            case Recall():
                for name, check in part.asks:
                    kind, question, runs = self._asked[f"{name}/{check}"]
                    if isinstance(question, Question):
                        yield from self._question(f"{name}/{check}", kind, question, runs)

    def _begun(self, tag: str, kind: str, name: str) -> str:
        title = escape(words.kind_words(self.own)[kind])
        return f'<{tag} class="part {kind}" data-kind="{kind}" data-name="{escape(name)}"><h3>{title}</h3>'

    def _question(self, name: str, kind: str, part: Question, runs: LessonRuns) -> Iterator[str]:
        own, predicts = self.own, kind == "predict"
        self._tell(name, kind, part, runs)
        yield self._begun("form", kind, name)
        yield f"<fieldset><legend>{escape(part.prompt)}</legend>"
        unit = words.unit_words(own, part.unit)
        if part.form == "choice":
            for n, reply in enumerate(part.replies, 1):
                button = f'<input type="radio" name="choice" value="{n}">'
                yield f'<label class="choice">{button} <span>{escape(reply.text)}</span></label>'
        elif part.form == "number":
            label = escape(own.say("a number"))
            field = '<input class="number" name="number" inputmode="decimal" autocomplete="off">'
            yield f"<label>{label} {field} {escape(unit)}</label>"
        elif part.form == "curve":
            yield '<div class="curve"></div>'
        else:
            yield f"<p>{escape(own.say('Set the sliders, look at the run, and then check.'))}</p>"
            yield '<div class="here"></div>'
        if predicts:
            how = escape(own.say("How sure?"))
            yield f'<div class="sure" role="radiogroup" aria-label="{how}"><span>{how}</span>'
            for key, said in words.sureness_words(own).items():
                yield f'<label><input type="radio" name="sure" value="{key}"> {escape(said)}</label>'
            yield "</div>"
        yield "</fieldset>"
        button = own.say("Lock in the prediction") if predicts else own.say("Check")
        yield f'<button class="main">{escape(button)}</button>'
        if predicts:
            yield f'<span class="faint locks">{escape(own.say("The run opens then."))}</span>'
        yield '<div class="said" role="status"></div></form>'

    def _explain(self, part: Explain) -> Iterator[str]:
        own = self.own
        self.told["questions"][part.name] = {"kind": "explain", "form": "text", "right": part.answer}
        yield self._begun("form", "explain", part.name)
        field = '<textarea name="text" rows="3" maxlength="10000"></textarea>'
        yield f"<label>{escape(part.prompt)}{field}</label>"
        yield f'<button class="main">{escape(own.say("Show the model answer"))}</button>'
        yield '<div class="said" role="status"></div></form>'

    def _run(self, run: Run) -> Iterator[str]:
        own, said = self.own, words.run_words(self.own, run)
        self.told["runs"][run.name] = {"line": run.line, "book": self._slid(self._runs, run)}
        yield self._begun("section", "run", run.name)
        yield f'<p>{escape(said)}</p><button type="button" class="main">{escape(own.say("Run"))}</button>'
        yield '<div class="here"></div></section>'

    def _compare(self, part: Compare) -> Iterator[str]:
        theory, holds, heads = words.compare_words(self.own, part)
        cases = part.rows()
        books = [self.book(self._runs, part.run, [case]) for case in cases]
        rows = [self.books[book]["rows"][0].get(part.name) for book in books]
        self.told["compares"][part.name] = {
            "run": part.run.line, "along": part.along, "quantity": part.quantity, "rows": rows,
            "cases": [words.case_words(self.own, case) for case in cases], "books": books,
            "prediction": self._prediction(part),
        }  # fmt: skip
        yield self._begun("section", "compare", part.name)
        yield f'<p>{escape(theory)} <span class="faint">{escape(holds)}</span></p>'
        cells = "".join(f'<th scope="col">{escape(one)}</th>' for one in heads)
        yield f'<div class="wide"><table><thead><tr>{cells}</tr></thead><tbody></tbody></table></div>'
        yield '<div class="plot"></div></section>'

    # ---- what is known of questions ------------------------------------------------------------------------

    def _row(self, compare: Compare, case: Case, figures: Figures) -> dict[str, Any] | None:
        """Return a row of a comparison: numbers for its graph, and their words."""
        try:
            row: Row = row_of(self.lesson, compare, case, figures)
        except _FAILURES:
            return None
        unit = row.unit or "1"
        gap = words.measure(self.own, row.gap, unit, 2) if row.absolute else self._percent(row.gap)
        near = row.gap <= row.tolerance
        return {
            "theory": row.theory, "measured": row.measured, "gap": gap, "near": bool(near),
            "words": [words.measure(self.own, one, unit) for one in (row.theory, row.measured)],
            "unit": words.unit_words(self.own, unit),
        }  # fmt: skip

    def _percent(self, share: float) -> str:
        shown = "< 0.001 %" if 0.0 < share < 1e-5 else f"{100.0 * share:.{2 if share < 1.0 else 3}g} %"
        return self.own.decimal(shown) if share < np.inf else "∞"

    def _prediction(self, compare: Compare) -> dict[str, Any] | None:
        """Return the question of the number that is compared, and how many SI units its unit is."""
        for one in self.lesson.predicted(compare.run, "number", compare.measured.text):
            return {"name": one.name, "factor": factor_of(one.unit) / factor_of(compare.unit or "1")}
        return None

    def _tell(self, name: str, kind: str, part: Question, runs: LessonRuns) -> None:
        """Note what the page has to know of a question."""
        told: dict[str, Any] = {
            "kind": kind, "form": part.form, "run": part.run.line if part.run else 0,
            "yes": part.right, "expected": grade_one(runs, name, kind, part, None).expected,
            "unit": words.unit_words(self.own, part.unit),
            "replies": [self._reply(part, reply, runs) for reply in part.replies],
        }  # fmt: skip
        if part.form == "number":
            told |= {"answer": runs.number(part), "tolerance": part.tolerance}
        elif part.form == "curve":
            figures, curve = runs.figures(part.run), self._curve(part, runs)
            top = max(1e-12, *(abs(value) for value in curve)) * 1.2
            step = 0.5 * 10.0 ** np.floor(np.log10(top))
            high = float(np.ceil(top / step) * step)
            times = [figures.record.times[n] for n in self._places(len(figures.record.samples))]
            told |= {
                "answer": curve, "tolerance": part.tolerance, "times": times, "end": figures.record.end,
                "low": -high if min(curve) < -1e-9 * high else 0.0, "high": high,
                "graph": [one.text for one, _ in part.run.graphs].index(part.answer.text)
                if part.run and part.answer and part.answer.text in [one.text for one, _ in part.run.graphs]
                else None,
                "factor": factor_of(part.unit),
            }  # fmt: skip
        elif part.form == "goal" and part.run and part.goal and part.solution:
            names = [one for one, _ in part.solution.values if one in runs.lesson.setup.opened][:2]
            told["book"] = book = self._slid(runs, part.run, names, part.solution)
            sliders = self.books[book]["sliders"]
            told["reached"] = []
            for values in itertools.product(*(one["texts"] for one in sliders)):
                pairs = tuple(zip((one["name"] for one in sliders), values, strict=True))
                given = {"values": dict(pairs)}
                told["reached"].append(grade_one(runs, name, kind, part, given).right)
        self.told["questions"][name] = told

    def _reply(self, part: Question, reply: Reply, runs: LessonRuns) -> dict[str, Any]:
        told: dict[str, Any] = {"right": reply.right, "said": reply.feedback, "idea": reply.idea}
        if part.form == "number":
            told["value"] = runs.number(part, reply)
        elif part.form == "curve":
            told["value"] = self._curve(part, runs, reply)
        if reply.shown_by is not None and part.run is not None:
            try:
                told["show"] = self.book(runs, part.run, [reply.shown_by])
                told["case"] = words.case_words(self.own, reply.shown_by, noted=False)
                told["note"] = reply.shown_by.note
            except SceneError:
                pass  # the run does not come to its end so: the words have to do
        return told

    def _curve(self, part: Question, runs: LessonRuns, reply: Reply | None = None) -> list[float]:
        series, unit = runs.curve(part, reply), factor_of(part.unit)
        return [series[n] / unit for n in self._places(len(series))]

    @staticmethod
    def _places(count: int) -> list[int]:
        """Return the numbers of some of so many samples, from the first to the last."""
        return sorted({round(n * (count - 1) / _CURVE) for n in range(_CURVE + 1)})
