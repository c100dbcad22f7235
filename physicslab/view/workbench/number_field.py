"""Rows of numbers and texts: a label, a field that is typed into, the unit, and why a value is refused."""

import contextlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import pygame
from imgui_bundle import ImVec2, imgui

from physicslab.ecs.fields import Field, InvalidValue
from physicslab.ecs.quantity_text import InvalidText, evaluate
from physicslab.ecs.value_text import evaluate_points
from physicslab.languages.sentence import Sentence
from physicslab.view.canvas.keyboard import held_keys
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui

_SHARE = 0.42
"""Share of the width of a panel that labels take as a rule."""
_DRAG = 0.005
"""Share of its size by which a number changes a pixel; of numbers below one, share of one."""
_FINER, _COARSER = 0.1, 10.0
"""Factors of that with Shift and Ctrl held."""
_ONLY_MOUSE = imgui.ItemFlags_.no_nav | imgui.ItemFlags_.no_tab_stop
_FIGURES = 6
"""Figures to which a number is shown where there is room."""
_PART_FIGURES = 4
"""Figures to which a part of a vector is shown."""
_LEAST = "-0.00"
"""Two fields in one line have room for at least this."""
_TINY, _ABOUT_ZERO = 1e-3, "\N{ALMOST EQUAL TO}0"
"""Smaller numbers for which there is no room are shown as about zero."""
_VARIOUS = "…"
"""The text of a field for several bodies whose numbers differ, where there is no room for their span."""
_LARGEST_ANGLE = 1e5
"""Larger angles are not shown in degrees as well [°]."""
_HALF_TURN = 180.0
"""[°]."""

_LINES_SHOWN = 4
"""Lines of a longer text that a field shows at one time."""

BETWEEN = ";"
"""Separates numbers for several bodies."""
ABSENT = "none"
"""How a number is ``derived`` that may be absent, as a limit; writing this takes it away."""
type Commit = Callable[[Any], None]
type CommitPart = Callable[[int, Any], None]


def shown_number(value: float, figures: int = _FIGURES) -> str:
    """Return a number as a field shows it: so many figures, and no more than it has.

    >>> shown_number(0.1 + 0.2), shown_number(-0.0), shown_number(1234567.0), shown_number(1.5e-5)
    ('0.3', '0', '1.23457e6', '1.5e-5')
    """
    figures_shown, _, power = f"{value + 0.0:.{figures}g}".partition("e")
    return f"{figures_shown}e{int(power)}" if power else figures_shown


@dataclass(slots=True)
class _Draft:
    """The text being written in a field, and why it was refused."""

    text: str
    refusal: str = ""


@dataclass(frozen=True, slots=True)
class _Target:
    """The field that is being written in: what it showed, and where its number goes."""

    key: str
    shown: str
    spec: Field
    commit: Commit


class NumberFields:
    """The rows of numbers of a panel; what is half written in one is kept from frame to frame.

    Attributes
    ----------
    share : float
        Share of the panel's width that labels take.
    selected : int
        To how many bodies the numbers go; so many may be written in a field, as ``1; 2``.
    """

    def __init__(self) -> None:
        self.share = _SHARE
        self.selected = 1
        self._for: object = None
        self._drafts: dict[str, _Draft] = {}
        self._edited: _Target | None = None
        self._dragged: tuple[str, float] | None = None

    def begin(self, subject: object) -> None:
        """Begin the rows of a subject; what was half written for another one is forgotten."""
        self.share = _SHARE
        if self._for != subject:
            self._for, self._edited, self._dragged = subject, None, None
            self._drafts.clear()

    def row(
        self, ui: Ui, key: str, words: str, spec: Field, value: float | str | None, commit: Commit, *,
        drags: bool = True, zero: str = "",
    ) -> None:  # fmt: skip
        """Build the row of one number or text.

        Parameters
        ----------
        key : str
            Key of the field; that of its label is ``"label " + key``.
        words : str
            Text of the label.
        spec : Field
            The unit, and what is shown as the tip.
        value : float or str, optional
            The number in SI, or the text; ``None`` where entities differ in it.
        commit : callable
            Called with the new one once Enter or Tab is pressed or the field is left; it raises
            :class:`InvalidValue` for one that cannot be.
        drags : bool
            Whether dragging the label changes the number.
        zero : str
            Text in place of 0, without a unit, where 0 has a meaning of its own.
        """
        number = 0.0 if value == ABSENT else None if isinstance(value, str) else value
        self.label(ui, key, words, spec, number if drags else None, commit)
        is_bare = (zero and number == 0.0) or value == ABSENT
        unit = "" if is_bare else _unit_shown(spec, number)
        room = imgui.get_content_region_avail().x - _width(ui, unit)
        refusal = self.build(ui, key, value, spec, room, commit, zero)
        _finish(ui, unit, refusal)

    def vector_row(
        self, ui: Ui, key: str, words: str, spec: Field, value: tuple[float | None, float | None],
        commit: CommitPart,
    ) -> None:  # fmt: skip
        """Build the row of a vector: a field for each part; ``commit`` is called with its number as well."""
        parts = [
            (f"{key}.{name}", spec, value[axis], partial(commit, axis))
            for axis, name in enumerate(("x", "y"))
        ]
        self.pair_row(ui, key, words, parts)

    def pair_row(
        self, ui: Ui, key: str, words: str, parts: Sequence[tuple[str, Field, float | None, Commit]]
    ) -> None:
        """Build the row of two numbers: of each its field's key, its description, it, and where it goes.

        In a narrow panel they stand one below the other.
        """
        units = [_unit_shown(spec, None) for _, spec, _, _ in parts]
        units = units[-1:] if units[0] == units[-1] else units
        self.label(ui, key, words, parts[0][1], is_short=len(units) > 1)
        left, available = imgui.get_cursor_pos_x(), imgui.get_content_region_avail().x
        taken = sum(_width(ui, unit) for unit in units) + imgui.get_style().item_spacing.x
        room = 0.5 * (available - taken)
        is_stacked = _room_in(room) < imgui.calc_text_size(_LEAST).x
        refusals = []
        for n, (name, spec, value, commit) in enumerate(parts):
            unit = units[min(n, len(units) - 1)]
            if is_stacked:
                imgui.set_cursor_pos_x(left)
                room = available - _width(ui, unit)
            elif n:
                imgui.same_line()
            refusals.append(self.build(ui, name, value, spec, room, commit))
            if n or len(units) > 1 or is_stacked:
                _finish(ui, unit, next(filter(None, refusals), "") if n else "")

    def build(
        self, ui: Ui, key: str, value: float | str | None, spec: Field, width: float, commit: Commit,
        zero: str = "",
    ) -> str:  # fmt: skip
        """Build one field, and return why what was written in it is refused; empty while it is not."""
        draft = self._drafts.get(key)
        shown = zero if zero and value == 0.0 else _shown(value, spec, width)
        if not isinstance(value, str) or isinstance(value, Sentence):
            shown = ui.said(shown)  # of a text what is written is its own
        wrong, lines = bool(draft and draft.refusal), min(spec.lines, _LINES_SHOWN)
        text, active = ui.field(key, draft.text if draft else shown, width, wrong=wrong, lines=lines)
        if active:
            if self._edited is not None and self._edited.key != key:
                self.finish()  # Tab went on from there
            self._drafts[key] = _Draft(text, draft.refusal if draft else "")
            self._edited = _Target(key, shown, spec, commit)
        elif self._edited is not None and self._edited.key == key:
            if imgui.is_key_pressed(imgui.Key.escape):
                self._edited = None
                self._drafts.pop(key, None)
            self.finish()
        draft = self._drafts.get(key)
        return draft.refusal if draft else ""

    def finish(self) -> str:
        """Take over what is half written, and return why it is refused; empty where it is not."""
        edited, self._edited = self._edited, None
        draft = self._drafts.pop(edited.key, None) if edited is not None else None
        if edited is None or draft is None or draft.text == edited.shown:
            return ""  # the number may have more figures than the field shows
        try:
            edited.commit(_as_field(draft.text, edited.spec, self.selected))
        except InvalidText as error:
            draft.refusal = str(error)
        except InvalidValue as error:
            draft.refusal = f"must be {error.allowed}"
        else:
            return ""
        self._drafts[edited.key] = draft
        return draft.refusal

    def drop_refused(self) -> bool:
        """Let fields show their numbers where others were refused; return whether there were any."""
        refused = [key for key, draft in self._drafts.items() if draft.refusal]
        for key in refused:
            del self._drafts[key]
        return bool(refused)

    def label(
        self, ui: Ui, key: str, words: str, spec: Field, value: float | None = None,
        commit: Commit | None = None, *, is_short: bool = False,
    ) -> None:  # fmt: skip
        """Build the label of a row, and stay in its line; a short one takes no more room than it has words.

        Dragging the label of a number to the side changes it, Shift finer, Ctrl coarser.
        """
        width, corner = self.share * imgui.get_content_region_avail().x, imgui.get_cursor_screen_pos()
        written = imgui.calc_text_size(ui.said(words)).x
        width = min(width, written) if is_short else max(width, written)
        imgui.push_item_flag(_ONLY_MOUSE, True)
        imgui.invisible_button(ui.held(f"drag {key}"), ImVec2(width, imgui.get_frame_height()))
        imgui.pop_item_flag()
        ui.note(f"label {key}")
        words = ui.written(words)
        drags = value is not None and commit is not None
        lit = drags and (imgui.is_item_hovered() or imgui.is_item_active())
        place = ImVec2(corner.x, corner.y + 0.5 * (imgui.get_frame_height() - imgui.get_font_size()))
        drawn = packed(ui.theme.accent if lit else ui.theme.faint)
        imgui.get_window_draw_list().add_text(place, drawn, words)
        if value is None or commit is None:
            ui.tip(spec.meaning)
        else:
            self._drag(ui, key, value, spec, commit)
        imgui.same_line()

    def _drag(self, ui: Ui, key: str, value: float, spec: Field, commit: Commit) -> None:
        """Change a number while its label is dragged: one edit, until it is let go."""
        if imgui.is_item_activated():
            self._dragged = key, value
            ui.do_next(lambda _, window: window.edits.hold())
        if self._dragged is not None and imgui.is_item_active() and imgui.is_mouse_dragging(0, 2.0):
            held = held_keys()
            factor = _FINER if held & pygame.KMOD_SHIFT else _COARSER if held & pygame.KMOD_CTRL else 1.0
            moved = imgui.get_mouse_drag_delta(0, 2.0).x
            least = math.degrees(1.0) if spec.unit == "deg" else 1.0
            new = self._dragged[1] + moved * factor * _DRAG * max(abs(self._dragged[1]), least)
            with contextlib.suppress(InvalidValue):  # at the end of its range a drag does nothing more
                commit(round(new) if spec.kind == "whole" else float(f"{new:.6g}"))
        else:
            tip = "Drag to change; Shift: finer, Ctrl: coarser"
            ui.tip(f"{spec.meaning}\n{tip}" if spec.meaning else tip)


def _shown(value: float | str | None, spec: Field, width: float) -> str:
    """Return a value as it stands in a field: a number to as many figures as the field has room for [px]."""
    if value is None:
        return _VARIOUS
    room = _room_in(width)
    if isinstance(value, str):
        is_span = spec.kind in ("number", "whole", "vector") and imgui.calc_text_size(value).x > room
        return _VARIOUS if is_span else value
    most = _PART_FIGURES if spec.kind == "vector" else _FIGURES
    texts = [shown_number(value, figures) for figures in range(most, 0, -1)]
    fitting = (text for text in texts if imgui.calc_text_size(text).x <= room)
    return next(fitting, _ABOUT_ZERO if abs(value) < _TINY else texts[-1])


def _room_in(width: float) -> float:
    """Return how wide the text of a field can be that is so wide [px]."""
    return float(width - 2.0 * imgui.get_style().frame_padding.x)


def _as_field(
    text: str, spec: Field, selected: int
) -> float | str | list[tuple[float, float]] | tuple[float, ...] | None:
    """Return what was written as a field takes it; raise ``InvalidText`` where it cannot be read."""
    if spec.derived == ABSENT and text.strip().lower() == ABSENT:
        return None
    if spec.kind == "text":
        return text
    if spec.kind == "points":
        return evaluate_points(text, spec.unit)
    if selected > 1 and BETWEEN in text:
        values = tuple(_number(part, spec) for part in text.split(BETWEEN))
        if len(values) != selected:
            raise InvalidText(f"must be one number, or {selected}: one for each from left to right")
        return values
    return _number(text, spec)


def _number(text: str, spec: Field) -> float:
    value = evaluate(text, spec.unit)
    return round(value) if spec.kind == "whole" and value == round(value) else value


def _unit_shown(spec: Field, value: float | None) -> str:
    """Return what stands beside a field: its unit; after an angle, what it is in degrees, to a hundredth.

    For more than half a turn it is the direction that is written so.

    >>> spec = Field("angle", "number", unit="rad")
    >>> [_unit_shown(spec, math.radians(degrees)) for degrees in (-30.0, 1e-6, 900.5)]
    ['rad = -30°', 'rad = 0°', 'rad, -179.5°']
    >>> [_unit_shown(Field("angle", "number", unit="deg"), degrees) for degrees in (90.0, 900.5)]
    ['°', '°, -179.5°']
    """
    is_angle = spec.unit in ("rad", "deg")
    unit = spec.unit.replace("^2", "²").replace("^3", "³").replace("deg", "°") if spec.unit != "1" else ""
    if value is None or not is_angle:
        return unit
    degrees = value if spec.unit == "deg" else math.degrees(value)
    if abs(degrees) >= _LARGEST_ANGLE or (spec.unit == "deg" and abs(degrees) <= _HALF_TURN):
        return unit
    sign = " =" if abs(degrees) <= _HALF_TURN else ","
    return f"{unit}{sign} {round(math.remainder(degrees, 2.0 * _HALF_TURN), 2) + 0.0:.5g}°"


def _width(ui: Ui, unit: str) -> float:
    return float(imgui.calc_text_size(unit).x) + 0.6 * ui.size if unit else 0.0


def _finish(ui: Ui, unit: str, refusal: str) -> None:
    """Write the unit beside a field, and below it why what is written there is refused."""
    if unit:
        imgui.same_line(0.0, 0.4 * ui.size)
        ui.faint(ui.said(unit), wrapped=False)
    ui.refusal(refusal)
