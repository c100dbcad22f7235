"""The window in which a teacher makes a lesson of the scene."""

from functools import partial

from imgui_bundle import imgui

from physicslab.lessons.writer import FORMS
from physicslab.view.controls import making as actions
from physicslab.view.controls.share_actions import varying, words_of
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.making import Making
from physicslab.view.window.sharing import beginnings
from physicslab.view.window.window import Window
from physicslab.view.workbench.file_panels import build_answers, build_name
from physicslab.world import World

_LABEL, _FIELD, _HALF, _NUMBER = 7.5, 30.0, 14.6, 6.5
"""Widths of the words at the left and of fields, in heights of the text."""
_FORMS = dict(zip(FORMS, ("a number", "a curve over time", "one of three answers"), strict=True))
_BLOCKS = {
    "title": ("", "title"), "seconds": ("run", "seconds"), "measured": ("predict", "answer"),
    "unit": ("predict", "number"), "question": ("predict", "question"), "theory": ("compare", "theory"),
    "holds": ("compare", "holds"), "tolerance": ("compare", "tolerance"), "why": ("explain", "question"),
    "answer": ("explain", "answer"),
}  # fmt: skip
"""The blocks and keys of a lesson's file in which the parts of a draft stand."""
_SAME = {
    ("predict", "curve"): ("predict", "number"), ("compare", "measure"): ("predict", "answer"),
    ("run", "graph"): ("predict", "answer"),
}  # fmt: skip
"""Others in which the same stands."""


def build_maker(ui: Ui, world: World, window: Window) -> None:
    """Build the fields and the buttons, in a window of its own."""
    making, draft, close = window.making, window.making.draft, window.closing_of("making.choosing")
    with ui.floating("Make a lesson of this scene", window.framing.middle, close):
        ui.faint("Learners predict, run, compare and explain; the lesson is a text file", wrapped=False)
        entered = build_name(ui, "Lesson name", making.naming, _LABEL + _FIELD, close)
        refused = {_SAME.get(entry, entry): why for entry, why in making.refused.items()}
        _build_field(ui, making, refused, "Title", "title")
        _begin(ui, "The run")
        holds = beginnings(window.edits.history.last_edit)
        begins = making.begins if making.begins in holds else holds[0]  # an edit was taken back
        making.begins = ui.choice("Lesson begins", begins, holds, width=_HALF * ui.size)
        imgui.same_line()
        draft.seconds, _ = ui.field("Seconds of the lesson", draft.seconds, _NUMBER * ui.size,
                                    wrong=("run", "seconds") in refused)  # fmt: skip
        imgui.same_line()
        ui.faint("seconds", wrapped=False)
        ui.refusal(refused.get(("run", "seconds"), ""))
        _build_opened(ui, world, window, refused)
        _build_prediction(ui, world, making, refused)
        ui.rule(0.2)
        _build_field(ui, making, refused, "Theory", "theory", "A formula, or nothing: sqrt(2*height/gravity)")
        if draft.theory.strip():
            _build_field(ui, making, refused, "holds for", "holds", "A condition, as v < 5 m/s, or always")
            _build_field(
                ui, making, refused, "within", "tolerance", "A share, or in the unit of the quantity"
            )
        names = ["gravity" if world.physics.gravity.y < 0.0 else "", "time"]
        names += [one.name for one in draft.opened if one.path]
        quoted = ", ".join(f"'{name}'" for name in names if name)  # so that they stay as they are
        ui.faint(f"Formulas may have {quoted}, and all that is measured")
        _build_field(ui, making, refused, "To explain", "why")
        _build_field(ui, making, refused, "Answer", "answer", "A model answer, shown after the learner's own")
        for entry, why in refused.items():
            if entry not in _BLOCKS.values() and entry[1] not in ("let", "open"):
                ui.refusal(why)
        build_answers(ui, making.naming, ("Make the lesson", "Cancel"), entered, actions.make_lesson, close)


def _build_opened(ui: Ui, world: World, window: Window, refused: dict[tuple[str, str], str]) -> None:
    """Build what learners may change."""
    draft = window.making.draft
    for n, opened in enumerate(draft.opened, start=1):
        _begin(ui, "They may change" if n == 1 else "and")
        path = ui.choice(
            f"Opened {n}", opened.path, partial(varying, world), width=_HALF * ui.size,
            shown=words_of(opened.path),
        )  # fmt: skip
        if path != opened.path:
            window.do_next(actions.choose_opened, opened, path)
        if opened.path:
            imgui.same_line()
            ui.faint("called", wrapped=False)
            imgui.same_line()
            opened.name, _ = ui.field(f"Name of {n}", opened.name, -1.0)
            _begin(ui, "from, to")
            opened.low, _ = ui.field(f"Least of {n}", opened.low, _NUMBER * ui.size)
            imgui.same_line()
            opened.high, _ = ui.field(f"Greatest of {n}", opened.high, _NUMBER * ui.size)
    for entry in (("scene", "let"), ("scene", "open")):
        ui.refusal(refused.get(entry, ""))


def _build_prediction(ui: Ui, world: World, making: Making, refused: dict[tuple[str, str], str]) -> None:
    """Build what is asked before the run, and what the run answers."""
    draft = making.draft
    ui.rule(0.2)
    _begin(ui, "Measured")
    offered = partial(actions.measurable, world)
    name = ui.choice("Measured quantity", making.quantity, offered, width=_HALF * ui.size,
                     shown=making.quantity)  # fmt: skip
    imgui.same_line()
    reading = ui.choice("Reading", making.reading, tuple(actions.READINGS), width=-1.0)
    if (name, reading) != (making.quantity, making.reading):
        actions.choose_measured(making, name, reading)
    _build_field(
        ui, making, refused, "as a formula", "measured", "Functions of the run: when, at, slope, ..."
    )
    _build_field(ui, making, refused, "in", "unit", "Its unit, as m/s; 1 for a pure number")
    _build_field(ui, making, refused, "Question", "question")
    _begin(ui, "predicted by")
    draft.form = ui.choice("Form of the prediction", draft.form, _FORMS.copy, width=_HALF * ui.size,
                           shown=_FORMS[draft.form])  # fmt: skip
    if draft.form == "choice":
        for n, one in enumerate(draft.choices, start=1):
            _begin(ui, "right answer" if n == 1 else "wrong answer")
            one[0], _ = ui.field(f"Answer {n} of the lesson", one[0], 0.3 * _FIELD * ui.size)
            imgui.same_line()
            ui.faint("then say", wrapped=False)
            imgui.same_line()
            one[1], _ = ui.field(f"Reply {n} of the lesson", one[1], -1.0)


def _begin(ui: Ui, words: str) -> None:
    """Begin a line with what it is about."""
    ui.lead(words, _LABEL * ui.size)


def _build_field(
    ui: Ui, making: Making, refused: dict[tuple[str, str], str], words: str, part: str, tip: str = ""
) -> None:
    """Build a line with one part of the draft, and below it why it cannot be so."""
    entry = _BLOCKS[part]
    _begin(ui, words)
    text, _ = ui.field(f"{part} of the lesson", getattr(making.draft, part), -1.0, wrong=entry in refused)
    ui.tip(tip)
    setattr(making.draft, part, text)
    ui.refusal(refused.get(entry, ""))
