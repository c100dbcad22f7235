"""The panel of a lesson: predict, run, compare, explain, one below the other as far as they are done."""

import re
from functools import partial
from typing import TypeGuard

from imgui_bundle import ImVec2, imgui

from physicslab.ecs.quantity_text import InvalidText, evaluate, factor_of
from physicslab.ecs.text import printable
from physicslab.languages.sentence import Sentence, proper
from physicslab.lessons.answers import Graded
from physicslab.lessons.lesson import SURENESS, Compare, Explain, Lesson, Part, Prose, Question, Recall, Run
from physicslab.lessons.words import cited, formula, sureness_words
from physicslab.view.canvas.quantities import written_unit
from physicslab.view.controls import lesson_actions
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.lesson import Key, OpenLesson, Trial
from physicslab.view.window.window import Window
from physicslab.view.workbench.lesson_compare import RIGHT, RUN, WRONG, Rows, build_compare
from physicslab.view.workbench.lesson_plots import CurveField, plot_run

_SHARE, _LEAST = 0.44, 22.0
"""How much of the world's room it takes, and its least width in heights of the text."""
_SIZE = (26.0, 34.0)
"""Width and height where it is not docked, in heights of the text."""
_PREDICT, _COMPARE, _EXPLAIN, _CHECK, _RECALL = "\uf0eb", "\uf24e", "\uf075", "\uf058", "\uf1da"
_LOCKED = "\uf023"
_DECIMAL_COMMA = re.compile(r"(?<=\d),(?=\d)")
_NUMBER = 8.0
"""Width of a field for a number, in heights of the text."""


class LessonPanel:
    """The panel of a lesson; text half written and choices are kept from frame to frame."""

    def __init__(self) -> None:
        self._lesson: OpenLesson | None = None
        self._begin()

    def _begin(self) -> None:
        self._drafts: dict[str, str] = {}
        self._choices: dict[str, int] = {}
        self._sure: dict[str, str] = {}
        self._refused: dict[str, str] = {}
        self._curves: dict[str, CurveField] = {}
        self._graded: dict[str, tuple[object, Graded]] = {}
        self._rows: Rows = {}
        self._showing: tuple[str, Key | None] = (
            "",
            None,
        )  # a question, and the run that shows its answer wrong
        self._parts, self._step = 0, -1

    def build(self, ui: Ui, window: Window, lesson: OpenLesson) -> None:
        """Build it beside the world."""
        if lesson is not self._lesson:
            self._lesson = lesson
            self._begin()
        ui.stand_beside("Lesson", "right", _SHARE, _LEAST, keeps_side=True)
        close = partial(window.do_next, lesson_actions.leave_lesson)
        with ui.floating("Lesson", window.framing.middle, close, docks=True):
            size = ui.extent(_SIZE[0] * ui.size, _SIZE[1] * ui.size)
            with ui.child("of the lesson", ImVec2(size.x, size.y)) as is_seen:
                if is_seen:
                    self._build_head(ui, lesson)
                    self._build_step(ui, window, lesson)

    def _build_head(self, ui: Ui, lesson: OpenLesson) -> None:
        ui.heading(lesson.lesson.title)
        if lesson.told or lesson.failure:
            ui.text(lesson.failure or lesson.told, ui.theme.notice, wrapped=True)
        ui.lead("Your name")
        learner, editing = ui.field("Your name", lesson.learner, -1.0)
        if learner != lesson.learner:
            lesson.learner = learner[:200]
        elif not editing and imgui.is_item_deactivated_after_edit():
            lesson.write()
        ui.tip(f"For your teacher; with your answers it is kept in {printable(str(lesson.path))}")
        steps = lesson.lesson.steps
        for n, step in enumerate(steps):
            if n:
                imgui.same_line()
            mark = RIGHT if lesson.is_done(n) else f"{n + 1}"
            tip = step.heading or "The beginning"
            ui.button(f"Step {n + 1}", tip, lesson_actions.go_to_step, n, shown=mark, on=n == lesson.step,
                      size=(1.8 * ui.size, 0.0))  # fmt: skip
        imgui.same_line()
        ui.faint(f"step {lesson.step + 1} of {len(steps)}", wrapped=False)
        ui.rule(0.2)

    def _build_step(self, ui: Ui, window: Window, lesson: OpenLesson) -> None:
        """Build the parts of a step as far as they are open, and what leads on."""
        step, parts = lesson.lesson.steps[lesson.step], lesson.shown(lesson.step)
        by_keys = imgui.get_io().nav_visible and imgui.is_window_focused()
        if by_keys and lesson.step != self._step >= 0:
            imgui.set_keyboard_focus_here()  # the button that led here is gone
        if step.heading:
            ui.heading(step.heading)
        for n, part in enumerate(parts):
            ui.gap(0.3)
            if n == self._parts > 0 and not isinstance(parts[n - 1], Run):
                imgui.set_scroll_here_y(0.1)
                if by_keys:
                    imgui.set_keyboard_focus_here()
            self._build_part(ui, window, lesson, part)
            if isinstance(part, Run) and n + 1 == self._parts < len(parts):
                imgui.set_scroll_here_y(0.7)  # what is said to the predictions stays in sight
        self._parts = len(parts) if lesson.step == self._step else 0
        self._step = lesson.step
        if all(map(lesson.is_past, parts)) and len(parts) == len(step.parts):
            ui.rule(0.4)
            if lesson.step + 1 < len(lesson.lesson.steps):
                ui.button("Next step", "", lesson_actions.go_to_step, lesson.step + 1, on=True)
            else:
                self._build_end(ui, lesson)

    def _build_end(self, ui: Ui, lesson: OpenLesson) -> None:
        """Say what came of the lesson."""
        ui.text("That was the lesson.", ui.theme.heading)
        ui.text(
            f"Your answers are in {printable(lesson.path.name)}: a file of your own, to be handed in.",
            wrapped=True,
        )
        ui.button("Leave the lesson", "Shift+L", lesson_actions.leave_lesson, on=True)

    def _build_part(self, ui: Ui, window: Window, lesson: OpenLesson, part: Part) -> None:
        match part:
            case Prose():
                for paragraph in part.text.split("\n\n"):
                    _tell(ui, lesson.lesson, " ".join(paragraph.split()))
                    ui.gap(0.2)
            case Question(kind="predict"):
                self._build_prediction(ui, window, lesson, part)
            case Question():
                _title(ui, _CHECK, "Check")
                self._build_question(ui, window, lesson, part, part.name, part.kind, lesson.lesson)
            case Run():
                self._build_run(ui, window, lesson, part)
            case Compare():
                self._build_compare(ui, window, lesson, part)
            case Explain():
                self._build_explain(ui, lesson, part)
            case Recall():
                _title(ui, _RECALL, "Of earlier lessons")
                for name, check in part.asks:
                    other = lesson.find(name)
                    for question in other.questions("check"):
                        if question.name == check and question.form != "goal":
                            ui.faint(other.title)
                            self._build_question(
                                ui, window, lesson, question, f"{name}/{check}", "recall", other
                            )
                            ui.gap(0.3)
                self._build_pass(ui, lesson, part)

    # ---- predict, check ------------------------------------------------------------------------------------

    def _build_prediction(self, ui: Ui, window: Window, lesson: OpenLesson, part: Question) -> None:
        answer = lesson.given.get(part.name)
        _title(ui, _PREDICT if answer is None else _LOCKED, "Predict" if answer is None else "You predicted")
        ui.text(part.prompt, wrapped=True)
        if answer is not None:
            confidence = sureness_words(lesson.lesson.own).get(str(answer.get("sure")), "")
            ui.text(f"{ui.said(_given_words(part, answer))} ({confidence})", wrapped=True)
            return
        found = self._build_room(ui, lesson, part, part.name)
        ui.faint(lesson.lesson.own.say("How sure?"), wrapped=False)
        words = sureness_words(lesson.lesson.own)
        for n, word in enumerate(SURENESS):
            if n:
                ui.same_line_if_room(words[word])
            if ui.button(
                f"Sure {part.name}: {word}", shown=words[word], on=self._sure.get(part.name) == word
            ):
                self._sure[part.name] = word
        sure = self._sure.get(part.name)
        ready = found is not None and sure is not None
        tip = "It cannot be changed afterwards" if ready else "First your prediction, and how sure you are"
        if ui.button(f"Lock in {part.name}", tip, shown=f"{_LOCKED}  Lock it in", enabled=ready) and found:
            self._refused[part.name] = lesson.answer(part.name, part, {**found, "sure": sure})
        ui.refusal(self._refused.get(part.name, ""))

    def _build_question(
        self, ui: Ui, window: Window, lesson: OpenLesson, part: Question, name: str, kind: str, of: Lesson
    ) -> None:
        ui.text(part.prompt, wrapped=True)
        if part.form == "goal":
            self._build_values(ui, window, lesson, part)
        else:
            found = self._build_room(ui, lesson, part, name)
            if ui.button(f"Check {name}", shown="Check", enabled=found is not None) and found:
                self._refused[name] = lesson.answer(name, part, found)
        ui.refusal(self._refused.get(name, ""))
        if name in lesson.given:
            self._build_verdict(ui, lesson, part, name, kind)
        elif kind != "recall":
            self._build_pass(ui, lesson, part)

    def _build_pass(self, ui: Ui, lesson: OpenLesson, part: Question | Explain | Recall) -> None:
        if not lesson.is_past(part):
            imgui.same_line() if not isinstance(part, Recall) else None
            if ui.button(f"Pass {part.name}", "You can come back to it", shown="Go on without an answer"):
                lesson.passed.add(part.name)
                lesson.number += 1

    def _build_room(self, ui: Ui, lesson: OpenLesson, part: Question, name: str) -> dict[str, object] | None:
        """Build where an answer is given, and return it; ``None`` while there is none."""
        if part.form == "choice":
            for n, reply in enumerate(part.replies, start=1):
                if ui.option(f"{name}: {reply.text}", reply.text, on=self._choices.get(name) == n):
                    self._choices[name] = n
            return {"choice": self._choices[name]} if name in self._choices else None
        if part.form == "curve":
            field = self._curves.setdefault(name, CurveField())
            points = field.build(ui, lesson, part)
            return {"curve": points} if len(points) > 1 else None
        draft, _ = ui.field(f"Answer {name}", self._drafts.get(name, ""), _NUMBER * ui.size)
        self._drafts[name] = draft
        imgui.same_line()
        ui.text(written_unit(part.unit))
        if not draft.strip():
            return None
        if lesson.lesson.own.say(".") == ",":
            draft = _DECIMAL_COMMA.sub(".", draft)  # 2,006 are no thousands there
        try:
            evaluate(draft, part.unit)
        except InvalidText as error:
            ui.refusal(str(error))
            return None
        return {"value": draft.strip()}

    def _build_verdict(self, ui: Ui, lesson: OpenLesson, part: Question, name: str, kind: str) -> None:
        """Build an answer, and what is said to it; to a prediction only after its run."""
        graded = self._grade(lesson, part, name, kind)
        ui.text(f"You predicted: {graded.given}" if kind == "predict" else graded.given, wrapped=True)
        colour = ui.theme.accent if graded.right else ui.theme.error
        ui.text(f"{RIGHT}  Right." if graded.right else f"{WRONG}  Not so.", colour)
        if graded.feedback:
            _tell(ui, lesson.lesson, graded.feedback)
        if graded.idea:
            idea, sources = cited(graded.idea, lesson.lesson.sources)
            ui.faint(f"Behind it: {idea}")
            ui.tip(sources)
        if not graded.right and kind == "predict":
            ui.text(f"It is: {graded.expected}", wrapped=True)
        shown = next((one.shown_by for one in part.replies if one.feedback == graded.feedback), None)
        if shown is not None and part.run is not None and kind != "recall" and not graded.right:
            own = lesson.lesson.own
            told = Sentence("{icon}  Show it: {what}", icon=RUN, what=formula(own, shown.text))
            words = told if shown.values else Sentence("{icon}  Show it again", icon=RUN)
            if ui.button(f"Show {name}", "A run that shows it", lesson_actions.begin_run, part.run, shown,
                         shown=words, enabled=not lesson.running):  # fmt: skip
                self._showing = name, (part.run.line, shown.values)
            if shown.note:
                ui.text(proper(shown.note), wrapped=True)
            if self._showing[0] == name and self._is_beside(lesson.trial):
                imgui.push_id(name)  # the usual run has graphs of the same names
                _build_trial(ui, lesson, lesson.trial)
                imgui.pop_id()

    def _is_beside(self, trial: Trial | None) -> TypeGuard[Trial]:
        """Whether a run in another case is shown below the answer that it refutes, not in its own place."""
        return trial is not None and bool(trial.case.values) and self._showing[1] == trial.key

    def _grade(self, lesson: OpenLesson, part: Question, name: str, kind: str) -> Graded:
        answer, kept = lesson.given[name], self._graded.get(name)
        if kept is None or kept[0] != answer:
            kept = self._graded[name] = dict(answer), lesson.graded(name, kind, part)
        return kept[1]

    # ---- run -----------------------------------------------------------------------------------------------

    def _build_run(self, ui: Ui, window: Window, lesson: OpenLesson, part: Run) -> None:
        own = lesson.lesson.own
        if part.seconds is not None:
            text = part.seconds.text
            time = formula(own, text if any(map(str.isalpha, text)) else f"{text} s")
            _title(ui, RUN, Sentence("Run for {time}", time=time))
        elif part.until is not None:
            _title(ui, RUN, Sentence("Run until {condition}", condition=formula(own, part.until.text)))
        trial, is_open = lesson.trial, lesson.open_to(part)
        mine = trial is not None and trial.run.line == part.line and not self._is_beside(trial)
        made = lesson.made(part)
        case = formula(own, part.case.text)
        if part.case.values:
            told = "{icon}  Run again with {case}" if made else "{icon}  Run with {case}"
            words = Sentence(told, icon=RUN, case=case)
        else:
            words = Sentence("{icon}  Run again" if made else "{icon}  Run", icon=RUN)
        tip = "" if is_open else "Lock in your prediction first"
        ui.button(f"Run {part.name}", tip, lesson_actions.begin_run, part, shown=words,
                  on=is_open and not made, enabled=is_open and not lesson.running)  # fmt: skip
        shown = trial if mine else made
        if shown is None:
            return
        _build_trial(ui, lesson, shown)
        for question in lesson.lesson.predictions(part) if made is not None else ():
            if question.name in lesson.given:
                self._build_verdict(ui, lesson, question, question.name, "predict")
                ui.gap(0.2)

    def _build_values(self, ui: Ui, window: Window, lesson: OpenLesson, part: Question | Compare) -> None:
        """Build the values that a learner may choose, and the button that runs with them."""
        run, setup, ready = part.run, lesson.lesson.setup, True
        if run is None or not setup.opened:
            return
        for name, (low, high) in setup.opened.items():
            label = f"{part.name}: {name}"
            note, symbol = setup.notes.get(name, ""), formula(lesson.lesson.own, name)
            imgui.align_text_to_frame_padding()
            ui.faint(symbol, wrapped=False)
            ui.tip(note)
            imgui.same_line(4.0 * ui.size)
            shown = ui.language.decimal(lesson.values[name])
            text, editing = ui.field(label, shown, _NUMBER * ui.size)
            if text != shown:
                lesson.values[name] = text
            try:
                value, least, most = (setup.quantity(name, one) for one in (text, low, high))
            except InvalidText as error:
                ui.refusal(str(error))
                ready = False
                continue
            imgui.same_line()
            span = Sentence("{least} to {most}", least=low, most=high)
            moved = ui.slider(f"Slide {label}", value, least, most, span)
            ui.tip(f"{note}: {ui.said(span)}" if note else "")
            if moved is not None and not editing:
                lesson.values[name] = _in_unit_of(moved, low)
            if not least <= value <= most:
                ui.refusal(f"{symbol} must be from {low} to {high}")
                ready = False
        case = lesson.own_case()
        if ui.button(f"Run own {part.name}", "", shown=f"{RUN}  Run with these values",
                     enabled=ready and not lesson.running and lesson.open_to(run)):  # fmt: skip
            window.do_next(lesson_actions.begin_run, run, case)
        made = lesson.made(run, case)
        if isinstance(part, Question) and made is not None and made is lesson.trial:
            answer = {"values": dict(case.values)}
            if lesson.given.get(part.name) != answer:
                self._refused[part.name] = lesson.answer(part.name, part, answer)

    # ---- compare, explain ----------------------------------------------------------------------------------

    def _build_compare(self, ui: Ui, window: Window, lesson: OpenLesson, part: Compare) -> None:
        compare = lesson.lesson.own.say("Compare")
        _title(ui, _COMPARE, f"{compare}: {part.quantity}")
        build_compare(ui, lesson, part, self._rows)
        own = ui.said("Your own values")
        if lesson.lesson.setup.opened and imgui.tree_node_ex(f"{own}###own {part.name}"):
            self._build_values(ui, window, lesson, part)
            imgui.tree_pop()
        ui.note(f"Own values {part.name}")

    def _build_explain(self, ui: Ui, lesson: OpenLesson, part: Explain) -> None:
        _title(ui, _EXPLAIN, "Explain")
        ui.text(part.prompt, wrapped=True)
        given = lesson.given.get(part.name)
        if given is not None:
            ui.text(f"You: {given['text']}", wrapped=True)
            ui.gap(0.2)
            model, sources = cited(part.answer, lesson.lesson.sources)
            ui.text(f"Compare with: {model}", ui.theme.heading, wrapped=True)
            ui.tip(sources)
            return
        draft = self._drafts.get(part.name, "")
        self._drafts[part.name], _ = ui.field(f"Explain {part.name}", draft, -1.0, lines=4)
        ready = bool(self._drafts[part.name].strip())
        tip = "" if ready else "First a sentence of your own"
        if ui.button(f"Say {part.name}", tip, shown="Compare with the model answer", enabled=ready):
            text = self._drafts[part.name].strip()
            self._refused[part.name] = lesson.answer(part.name, part, {"text": text})
        ui.refusal(self._refused.get(part.name, ""))
        self._build_pass(ui, lesson, part)


def _build_trial(ui: Ui, lesson: OpenLesson, trial: Trial) -> None:
    """Build what is known of a run so far."""
    if not trial.ended:
        imgui.progress_bar(trial.share, ImVec2(-1.0, 0.5 * ui.size), "")
    ui.refusal(trial.failure)
    if trial.case.values:
        own = lesson.lesson.own
        values = (formula(own, f"{name} = {text}") for name, text in trial.case.values)
        ui.faint(f"Shown: {', '.join(values)}")
    plot_run(ui, lesson, trial)


def _tell(ui: Ui, lesson: Lesson, text: str) -> None:
    """Write a text of a lesson; its sources are in a tip."""
    words, sources = cited(text, lesson.sources)
    ui.text(words, wrapped=True)
    ui.tip(sources)


def _title(ui: Ui, icon: str, words: str) -> None:
    """Write what kind of part begins here."""
    ui.rule(0.2)
    ui.text(f"{icon}  {ui.said(words)}", ui.theme.accent, wrapped=True)


def _given_words(part: Question, answer: dict[str, object]) -> str:
    if part.form == "choice":
        return part.replies[int(str(answer["choice"])) - 1].text
    if part.form == "number":
        text = str(answer["value"])
        if any(map(str.isalpha, text)):
            return text
        return f"{text} {written_unit(part.unit)}".replace(" °", "°").strip()
    return "A curve, as drawn below"


def _in_unit_of(value: float, text: str) -> str:
    """Return a number [SI] in the unit of another one.

    >>> _in_unit_of(0.5235987755982988, "5 deg"), _in_unit_of(0.25, "1")
    ('30 deg', '0.25')
    """
    unit = text.strip().lstrip("-+.0123456789e").strip()
    return f"{value / factor_of(unit or '1'):.4g} {unit}".strip()
