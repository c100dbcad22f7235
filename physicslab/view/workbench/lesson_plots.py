"""The graphs of a lesson: prediction, theory and measurement in one; a curve that is drawn with the mouse."""

import math
from collections.abc import Sequence

import numpy as np
from imgui_bundle import ImVec2, imgui, implot

from physicslab.diagnostics.samples import quantity_of
from physicslab.ecs.quantity_text import Expression, InvalidText, dotted, evaluate, factor_of
from physicslab.languages.sentence import Sentence, proper
from physicslab.lessons.check import Row, unit_of
from physicslab.lessons.lesson import Compare, Question
from physicslab.view.canvas.quantities import rounded_up, written_unit
from physicslab.view.toolkit.axes import WEIGHT, finish_axes, line_look, pad_plot, plot_rect
from physicslab.view.toolkit.style import as_vector
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.lesson import Curve, OpenLesson, Trial

_HEIGHT = 11.0
"""Height of a graph, in heights of the text."""
_THIN = 0.6
"""Width of the line of the run as it is beside another case, as a share of that of the case."""
_DASHES = 40
"""Dashes of a line that is theory."""
_BINS = 120
"""Places along a curve that is drawn."""
_AROUND = ImVec2(0.1, 0.2)
"""Share of what markers span that is left beside them, so that they are whole at the edges."""
_SHADE = 0.25
"""Opacity of the gap between two lines."""
_FLAGS = (
    implot.Flags_.no_menus
    | implot.Flags_.no_mouse_text
    | implot.Flags_.no_title
    | implot.Flags_.no_box_select
)
_LOCK = implot.AxisFlags_.lock
PREDICTED, THEORY, MEASURED, AS_RUN = "predicted", "theory", "measured", "as run"


def plot_run(ui: Ui, lesson: OpenLesson, trial: Trial) -> None:
    """Build the graphs of a run, with what was predicted of them and what theory says."""
    usual = lesson.made(trial.run) if trial.case.values else None
    for n, curve in enumerate(trial.curves):
        try:
            first = trial.live.figures.at(0)
            units = [unit_of(one, one.value(first)) for one in (curve.against, curve.along)]
        except InvalidText:
            continue
        shown = zip((curve.against, curve.along), units, strict=True)
        labels = [_with_unit(_plain(one), unit) for one, unit in shown]
        has_more = usual is not None or _has_more(lesson, trial, curve)
        flags = _FLAGS if has_more else _FLAGS | implot.Flags_.no_legend
        if units == ["m", "m"]:  # a path looks as it is in the world: a right angle is one
            flags |= implot.Flags_.equal
        if _begin(ui, f"{trial.run.name} {n}", labels[0], labels[1], flags):
            _plot_lines(ui, lesson, trial, curve, usual.curves[n] if usual is not None else None)
            implot.end_plot()


def _has_more(lesson: OpenLesson, trial: Trial, curve: Curve) -> bool:
    """Whether a graph shows more than what is measured."""
    theory = [one.measured.text for one in lesson.lesson.compares() if one.name in trial.theory]
    text = curve.along.text
    return text in theory or bool(lesson.lesson.predicted(trial.run, "curve", text))


def _plot_lines(ui: Ui, lesson: OpenLesson, trial: Trial, curve: Curve, usual: Curve | None) -> None:
    """Build the lines of a graph: those of another case beside the run as it is, which is thin."""
    ui.words += finish_axes(ui.language)
    if usual is not None:
        look = line_look(ui.theme.faint, WEIGHT * ui.size)
        look.line_weight *= _THIN
        implot.plot_line(ui.written(AS_RUN), np.array(usual.x), np.array(usual.y), look)
    x, y = np.array(curve.x), np.array(curve.y)
    theme = ui.theme
    if curve.against.text == "time":
        for question in lesson.lesson.predicted(trial.run, "curve", curve.along.text):
            drawn = np.array(lesson.given.get(question.name, {}).get("curve", []), dtype=float)
            if len(drawn) > 1:
                values = drawn[:, 1] * factor_of(question.unit)
                predicted = np.interp(x, drawn[:, 0], values)
                shade = line_look(theme.notice, WEIGHT * ui.size, _SHADE)
                shade.fill_color, shade.fill_alpha = as_vector(theme.notice), _SHADE
                implot.plot_shaded("##gap", x, predicted, y, shade)
                own = line_look(theme.notice, WEIGHT * ui.size)
                implot.plot_line(ui.written(PREDICTED), drawn[:, 0].copy(), values, own)
    implot.plot_line(ui.said(MEASURED), x, y, line_look(theme.accent, WEIGHT * ui.size))
    for compare in lesson.lesson.compares():
        if compare.name in trial.theory and compare.measured.text == curve.along.text:
            theory = np.array(trial.theory[compare.name])
            dashes = np.linspace(0, len(theory) - 1, min(2 * _DASHES, len(theory))).round().astype(int)
            dashes = dashes[: len(dashes) // 2 * 2]
            look = line_look(theme.text, WEIGHT * ui.size)
            look.flags = implot.LineFlags_.segments
            implot.plot_line(ui.written(THEORY), x[dashes], theory[dashes], look)


def plot_compared(ui: Ui, part: Compare, rows: Sequence[tuple[int, Row]], predicted: float | None) -> None:
    """Build the graph of a comparison: in each case, by its number, theory, measurement and prediction."""
    if not _begin(ui, part.name, "case", _with_unit(proper(part.quantity), rows[0][1].unit)):
        return
    implot.push_style_var(implot.StyleVar_.fit_padding, _AROUND)
    numbers = np.array([float(n) for n, _ in rows])
    implot.setup_axis_ticks(implot.ImAxis_.x1, [float(n) for n, _ in rows], [f"{n}" for n, _ in rows], False)
    ui.words += finish_axes(ui.language)
    theory = np.array([row.theory for _, row in rows])
    measured = np.array([row.measured for _, row in rows])
    gap = line_look(ui.theme.error, WEIGHT * ui.size)
    gap.flags = implot.LineFlags_.segments
    both = np.stack([theory, measured], axis=1).ravel()
    implot.plot_line("##gaps", np.repeat(numbers, 2), both, gap)
    for name, x, y, marker, size, colour in (
        (THEORY, numbers, theory, implot.Marker_.square, 0.42, ui.theme.text),
        (MEASURED, numbers, measured, implot.Marker_.circle, 0.26, ui.theme.accent),
        (PREDICTED, numbers[:1], np.array([predicted or 0.0]), implot.Marker_.diamond, 0.36, ui.theme.notice),
    ):
        if name == PREDICTED and (predicted is None or rows[0][0] != 1):
            continue
        look = line_look(colour, WEIGHT * ui.size)
        look.marker, look.marker_size = marker, size * ui.size
        look.marker_line_color = as_vector(colour)
        look.marker_fill_color = as_vector(colour, 0.0 if name == THEORY else 1.0)
        implot.plot_scatter(ui.written(name), x, y, look)
    implot.end_plot()
    implot.pop_style_var()


def _plain(expression: Expression) -> str:
    """Return the words for an expression: of a quantity as the window calls it, and whose it is."""
    quantity = dotted(expression.node)
    owner = quantity.rpartition(".")[0]
    if quantity == "time":
        return Sentence("time")
    try:
        entity, name = quantity_of(quantity, () if owner == "world" else (owner,))
    except InvalidText:
        return expression.text
    own = Sentence(name)
    return own if entity is None else Sentence("{quantity} of {body}", quantity=own, body=owner)


def _with_unit(words: str, unit: str) -> str:
    unit = written_unit(unit)
    return Sentence("{what} [{unit}]", what=words, unit=unit) if unit else words


def _begin(ui: Ui, name: str, across: str, along: str, flags: int = _FLAGS) -> bool:
    """Begin a graph with what it shows written above it."""
    pad_plot(ui.size)
    implot.get_style().legend_padding = ImVec2(0.3 * ui.size, 0.1 * ui.size)
    ui.faint(along, wrapped=False)
    if not implot.begin_plot(f"##{name}", ImVec2(-1.0, _HEIGHT * ui.size), flags):
        return False
    fit = implot.AxisFlags_.auto_fit
    implot.setup_axes(ui.written(across), "", fit, fit)
    implot.setup_legend(implot.Location_.north, implot.LegendFlags_.horizontal | implot.LegendFlags_.outside)
    return True


class CurveField:
    """A curve that is drawn with the mouse over a graph, or typed as pairs of numbers."""

    def __init__(self) -> None:
        self._values: dict[int, float] = {}
        self._last: int | None = None
        self._text, self._refusal = "", ""

    def build(self, ui: Ui, lesson: OpenLesson, part: Question) -> list[list[float]]:
        """Build it, and return the points that are drawn: times [s] and values, in the question's unit."""
        end, low, high = _axes(lesson, part)
        name = _plain(part.answer) if part.answer is not None else ""
        ui.faint("Draw it: press the button of the mouse in the graph, and go along.")
        pad_plot(ui.size)
        if implot.begin_plot(f"##draw {part.name}", ImVec2(-1.0, 1.3 * _HEIGHT * ui.size),
                             _FLAGS | implot.Flags_.no_legend):  # fmt: skip
            across, along = _with_unit(Sentence("time"), "s"), _with_unit(name, part.unit)
            implot.setup_axes(ui.said(across), ui.said(along), _LOCK, _LOCK)
            implot.setup_axes_limits(0.0, end, low, high, implot.Cond_.always)
            ui.words += finish_axes(ui.language)
            ui.places.setdefault(f"Draw {part.name}", plot_rect())
            self._follow_mouse(end, low, high)
            if self._values:
                points = np.array(sorted(self._values.items()))
                implot.plot_line(
                    ui.said(PREDICTED),
                    points[:, 0] * end / _BINS,
                    points[:, 1].copy(),
                    line_look(ui.theme.notice, WEIGHT * ui.size),
                )
            implot.end_plot()
        self._build_text(ui, part, end)
        return [[n * end / _BINS, value] for n, value in sorted(self._values.items())]

    def _follow_mouse(self, end: float, low: float, high: float) -> None:
        """Let the curve follow the mouse while its button is pressed."""
        if not (imgui.is_mouse_down(0) and (self._last is not None or implot.is_plot_hovered())):
            self._last = None
            return
        mouse = implot.get_plot_mouse_pos()
        here = min(max(round(mouse.x / end * _BINS), 0), _BINS)
        value = min(max(mouse.y, low), high)
        last = here if self._last is None else self._last
        before = self._values.get(last, value)
        for n in range(min(last, here), max(last, here) + 1):
            share = 1.0 if here == last else (n - last) / (here - last)
            self._values[n] = before + share * (value - before)
        self._last, self._text = here, ""

    def _build_text(self, ui: Ui, part: Question, end: float) -> None:
        """Build the field in which points are typed: who has no mouse draws with it."""
        ui.faint("or type it, time and value: 0 1; 0.5 0.7; 1 0", wrapped=False)
        room = ui.button_width("Clear") + imgui.get_style().item_spacing.x
        text, _ = ui.field(f"Points {part.name}", self._text, -room)
        if text != self._text:
            self._text, self._refusal = text, ""
            try:
                pairs = [one.split() for one in text.split(";") if one.strip()]
                found = {round(evaluate(x, "s") / end * _BINS): evaluate(y, part.unit) for x, y in pairs}
                self._values = {n: value for n, value in found.items() if 0 <= n <= _BINS}
            except (InvalidText, ValueError):
                self._refusal = "Pairs of a time and a value, with ; between them"
        imgui.same_line()
        if ui.button(f"Clear {part.name}", shown="Clear"):
            self._values, self._text, self._refusal = {}, "", ""
        ui.refusal(self._refusal)


def _axes(lesson: OpenLesson, part: Question) -> tuple[float, float, float]:
    """Return the end of the run [s] and the ends of the values: roomy ones, which tell little."""
    assert part.answer is not None
    figures, factor = lesson.runs.figures(part.run), factor_of(part.unit)
    series = [value / factor for value in figures.series(part.answer)]
    most = rounded_up(1.2 * max(max(map(abs, series)), 1e-12))
    low = -most if min(series) < -1e-9 * most else 0.0
    return float(figures.record.end) or math.inf, low, most
