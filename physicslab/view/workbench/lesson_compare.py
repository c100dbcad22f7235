"""Theory beside measurement in the panel of a lesson: a table of cases, and the gap in words."""

import math

from imgui_bundle import imgui

from physicslab.ecs.quantity_text import InvalidText, evaluate, factor_of
from physicslab.files.checks import SceneError
from physicslab.languages.sentence import Sentence
from physicslab.lessons.check import Row, row_of
from physicslab.lessons.lesson import Compare
from physicslab.lessons.setup import Case
from physicslab.lessons.words import condition, formula
from physicslab.state.masses import Diverged
from physicslab.view.canvas.quantities import percentage, quantity, round_quantity, written_unit
from physicslab.view.controls import lesson_actions
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.lesson import OpenLesson
from physicslab.view.workbench.lesson_plots import plot_compared

RIGHT, WRONG, UNLIKE, RUN = "\uf00c", "\uf00d", "\uf53e", "\uf04b"
"""Icons of a right answer, a wrong one, a gap where the theory need not hold, and of a run."""

_NUMBER = 4.2
"""Least width of a column, in heights of the text."""
_GAP = 5.5
"""That of the last one: a mark, and one figure with a power of ten."""
_SMALLEST = 0.75
"""Least size of the table's text, as a share of the usual."""
_COUNTS = 1e6
"""Whole numbers below this are written with all their figures."""

type Rows = dict[tuple[str, object, int], Row | str]
"""Rows that were measured, or why they could not be, by comparison, values and run."""


def build_compare(ui: Ui, lesson: OpenLesson, part: Compare, rows_of: Rows) -> None:
    """Build theory beside the runs in a table, a row a case, and as a graph where there are several."""
    own = lesson.lesson.own
    ui.text(f"Theory: {formula(own, part.theory.text)}", wrapped=True)
    domain = condition(own, part.holds.text)
    holds = Sentence("It holds for {domain}", domain=domain)
    ui.faint(Sentence("It holds always") if part.holds.text == "always" else holds)
    cases = lesson.rows(part)
    rows = [_row(rows_of, lesson, part, case) for case in cases]
    predicted = _predicted(lesson, part)
    flags = imgui.TableFlags_.row_bg | imgui.TableFlags_.sizing_stretch_prop
    heads = ("", *(["predicted"] if predicted else []), "theory", "measured", "gap")
    wide = [max(1.15 * imgui.calc_text_size(ui.said(head)).x, _NUMBER * ui.size) for head in heads[1:]]
    wide[-1] = max(wide[-1], _GAP * ui.size)
    room = imgui.get_content_region_avail().x - 2.0 * len(heads) * imgui.get_style().cell_padding.x
    least = _NUMBER * ui.size
    smaller = max(_SMALLEST, min(1.0, room / (least + sum(wide))))  # else words break within
    imgui.push_font(None, smaller * imgui.get_font_size())
    if imgui.begin_table(f"rows of {part.name}", len(heads), flags):
        wide = [smaller * width for width in wide]
        first = max(room - sum(wide), smaller * least)
        for head, width in zip(heads, (first, *wide), strict=True):
            imgui.table_setup_column(head, imgui.TableColumnFlags_.width_stretch, width)
        imgui.table_next_row()
        for head in heads:
            imgui.table_next_column()
            ui.faint(head)
        for n, (case, row) in enumerate(zip(cases, rows, strict=True), start=1):
            _build_row(ui, lesson, part, n, case, row, predicted, wide[0])
        imgui.end_table()
    imgui.pop_font()
    found = [(n, row) for n, row in enumerate(rows, start=1) if isinstance(row, Row)]
    if not part.along and len(found) > 1:
        plot_compared(ui, part, found, predicted)


def _row(rows_of: Rows, lesson: OpenLesson, part: Compare, case: Case) -> Row | str | None:
    """Return theory beside measurement of a case, why there is none, or ``None`` before its run."""
    made = lesson.made(part.run, case)
    if made is None:
        return None
    key = part.name, case.values, id(made)
    if key not in rows_of:
        try:
            rows_of[key] = row_of(lesson.lesson, part, case, made.live.figures)
        except (InvalidText, SceneError, Diverged) as error:
            rows_of[key] = str(error)
    return rows_of[key]


def _build_row(
    ui: Ui, lesson: OpenLesson, part: Compare, number: int, case: Case,
    row: Row | str | None, predicted: float | None, width: float,
) -> None:  # fmt: skip
    own = lesson.lesson.own
    values = ", ".join(formula(own, f"{name} = {text}") for name, text in case.values)
    imgui.table_next_row()
    imgui.table_next_column()
    what = values if case.values else Sentence("as run")
    words = Sentence("{n}. {case}", n=number, case=what)
    if row is None:
        imgui.align_text_to_frame_padding()  # a button stands beside it
    ui.text(Sentence("{case}: {note}", case=words, note=case.note) if case.note else words, wrapped=True)
    if row is None:
        button, tip = f"Run {part.name} {number}", f"Run it with {values}"
        words = Sentence("{icon}  Run", icon=RUN)
        if ui.button_width(words) < width:
            imgui.table_next_column()
        ui.button(button, tip, lesson_actions.begin_run, part.run,
                  case, shown=words, enabled=not lesson.running)  # fmt: skip
        return
    imgui.table_next_column()
    if predicted is not None:
        if not case.values and isinstance(row, Row):
            ui.text(_figure(predicted, row.unit), wrapped=True)
        imgui.table_next_column()
    if isinstance(row, str):
        ui.refusal(row)
        return
    ui.text(_figure(row.theory, row.unit), wrapped=True)
    imgui.table_next_column()
    ui.text(_figure(row.measured, row.unit), wrapped=True)
    imgui.table_next_column()
    apart = row.gap if row.absolute else abs(row.measured - row.theory)
    is_share = not (row.absolute or math.isinf(row.gap))  # nothing is a share of zero
    gap = percentage(row.gap) if is_share else _figure(apart, row.unit)
    if "·" in gap:  # one figure says how small it is, and fits a narrow column
        small = (100.0 * row.gap, "%") if is_share else (apart, written_unit(row.unit))
        gap = round_quantity(*small)
    near = row.gap <= row.tolerance
    apart_mark = (WRONG, ui.theme.error) if row.holds else (UNLIKE, ui.theme.faint)
    mark, colour = (RIGHT, ui.theme.accent) if near else apart_mark
    ui.text(f"{mark}\u00a0{gap}", colour, wrapped=True)
    ui.tip(_gap_words(row, near=near))


def _figure(value: float, unit: str) -> str:
    """Return a number in a unit as a table has it; a count has no decimals.

    >>> _figure(31.0, ""), _figure(90.0, "deg"), _figure(0.25, "m/s")
    ('31', '90.00°', '0.2500 m/s')
    """
    if not unit and value.is_integer() and abs(value) < _COUNTS:
        return f"{value:.0f}"
    return quantity(value, written_unit(unit)).replace(" °", "°").strip()


def _predicted(lesson: OpenLesson, part: Compare) -> float | None:
    """Return the number that was predicted of what is compared, in the unit of that, if there is one."""
    for one in lesson.lesson.predicted(part.run, "number", part.measured.text):
        if one.name in lesson.given:
            given = evaluate(str(lesson.given[one.name]["value"]), one.unit)
            return factor_of(one.unit) / factor_of(part.unit or "1") * given
    return None


def _gap_words(row: Row, *, near: bool) -> str:
    """Return in words what the gap between theory and measurement says."""
    if row.holds:
        return (
            "Within the tolerance: the theory holds"
            if near
            else "Beyond the tolerance, though it should hold"
        )
    return (
        "The theory need not hold here, and is near" if near else "The theory does not hold here, as it says"
    )
