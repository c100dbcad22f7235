"""Fields for numbers, typed with units or changed by dragging their label, and for texts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pygame
from imgui_bundle import ImVec2, imgui

from physicslab.ecs.fields import Field, InvalidValue
from physicslab.ecs.quantity_text import InvalidText, evaluate
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui

__all__ = ["NumberFields", "shown_number", "shown_vector_part"]

_DRAG = 0.005
"""Share of its size by which a number changes a pixel; of numbers below one, share of one."""
_FINER, _COARSER = 0.1, 10.0
"""What Shift and Ctrl make of that."""
_ONLY_MOUSE = imgui.ItemFlags_.no_nav | imgui.ItemFlags_.no_tab_stop
_PART = 6
"""Characters that the field of a part of a vector has room for."""
_LINES_SHOWN = 3
"""Lines that a field of several shows at once."""

type Commit = Callable[[Any], None]
"""Takes what was written: a number, or the text of a field for text."""


def shown_number(value: float, figures: int = 6) -> str:
    """Return a number as a field shows it: so many figures, and no more than it has.

    >>> shown_number(0.1 + 0.2), shown_number(-0.0), shown_number(1234567.0), shown_number(2.0)
    ('0.3', '0', '1.23457e+06', '2')
    """
    return f"{value + 0.0:.{figures}g}"


def shown_vector_part(value: float) -> str:
    """Return a number as half a field shows it: to four figures, or to fewer where it is longer than that.

    >>> shown_vector_part(0.123456), shown_vector_part(-0.123456)
    ('0.1235', '-0.123')
    """
    shorter = (shown_number(value, figures) for figures in range(4, 1, -1))
    return next((text for text in shorter if len(text) <= _PART), shown_number(value, 3))


def _shown(value: float | str, spec: Field) -> str:
    if isinstance(value, str):
        return value
    return shown_vector_part(value) if spec.kind == "vector" else shown_number(value)


@dataclass(slots=True)
class _Draft:
    """What is being written in a field, and why it was refused."""

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
    """The fields of a panel; what is half written in one is kept from frame to frame."""

    def __init__(self) -> None:
        self._drafts: dict[str, _Draft] = {}
        self._edited: _Target | None = None
        self._dragged: tuple[str, float] | None = None

    def clear(self) -> None:
        """Forget what was half written."""
        self._drafts.clear()
        self._edited = self._dragged = None

    def build(
        self, ui: Ui, key: str, value: float | str, spec: Field, width: float, commit: Commit, zero: str = ""
    ) -> str:
        """Build one field, and return why what was written in it is refused; empty while it is not.

        ``zero`` is shown in place of 0 where that has a meaning of its own.

        ``commit`` is called once Enter or Tab is pressed, or the field is left; it raises
        :class:`InvalidValue` for what the field cannot hold.
        """
        draft = self._drafts.get(key)
        shown = zero if zero and value == 0.0 else _shown(value, spec)
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
            text, spec = draft.text, edited.spec
            edited.commit(text if spec.kind == "text" else evaluate(text, spec.unit))
        except InvalidText as error:
            draft.refusal = str(error)
        except InvalidValue as error:
            draft.refusal = f"must be {error.allowed}"
        else:
            return ""
        self._drafts[edited.key] = draft
        return draft.refusal

    def label(
        self, ui: Ui, key: str, words: str, width: float, value: float | None, tip: str, commit: Commit
    ) -> None:
        """Build a label; dragging it to the side changes its number, Shift finer, Ctrl coarser."""
        corner = imgui.get_cursor_screen_pos()
        imgui.push_item_flag(_ONLY_MOUSE, True)
        imgui.invisible_button(f"drag {key}", ImVec2(width, imgui.get_frame_height()))
        imgui.pop_item_flag()
        ui.note(f"label {key}")
        ui.words.append(words)
        drawn = (
            ui.theme.accent
            if value is not None and (imgui.is_item_hovered() or imgui.is_item_active())
            else ui.theme.faint
        )
        place = ImVec2(corner.x, corner.y + 0.5 * (imgui.get_frame_height() - imgui.get_font_size()))
        imgui.get_window_draw_list().add_text(place, packed(drawn), words)
        if value is None:
            ui.tip(tip)
            return
        if imgui.is_item_active() and imgui.is_mouse_dragging(0, 2.0):
            if self._dragged is None or self._dragged[0] != key:
                self._dragged = key, value
            held = pygame.key.get_mods()
            factor = _FINER if held & pygame.KMOD_SHIFT else _COARSER if held & pygame.KMOD_CTRL else 1.0
            moved = imgui.get_mouse_drag_delta(0, 2.0).x
            self._commit(self._dragged[1] + moved * factor * _DRAG * max(abs(self._dragged[1]), 1.0), commit)
        elif self._dragged is not None and self._dragged[0] == key:
            self._dragged = None
        else:
            ui.tip(f"{tip}\nDrag to change; Shift: finer, Ctrl: coarser" if tip else "")

    @staticmethod
    def _commit(value: float, commit: Commit) -> None:
        """Hand over what a drag gives, to six figures; where the field cannot hold it, nothing happens."""
        try:
            commit(float(f"{value:.6g}"))
        except InvalidValue:
            return
