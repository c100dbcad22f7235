"""Elements of panels: buttons, rows, bars and menus, each identified by its label."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from imgui_bundle import ImVec2, imgui

from physicslab.theme import Colour
from physicslab.view.canvas.drawable_text import drawable, encodable
from physicslab.view.canvas.surface_cache import RAISED_SIZE, raised_parts
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.windows import Spoken, Windows, widget_label

_TIP_FLAGS = imgui.HoveredFlags_.delay_short | imgui.HoveredFlags_.allow_when_disabled
_TIP_WIDTH = 23.5
"""Width of a tip at most, in heights of the text."""
_BEFORE_A_UNIT = re.compile(r"(?<=[\d⁰¹²³⁴-⁹]) (?=[%°]|[A-Za-z]{1,3}\b)")


def _with_units(words: str) -> str:
    """Return words in which no line ends between a number and its unit.

    >>> _with_units("9.81 m/s² down, 2 J, 4·10⁻¹⁰ %").split("\N{NO-BREAK SPACE}")
    ['9.81', 'm/s² down, 2', 'J, 4·10⁻¹⁰', '%']
    """
    return _BEFORE_A_UNIT.sub("\N{NO-BREAK SPACE}", words)


class Ui(Windows):
    """The widgets of one frame. Each is noted: where it is, by its words, and all that is written."""

    def width(self, words: str) -> float:
        """Return how wide words are in the language of the window [px]."""
        return float(imgui.calc_text_size(self.said(words)).x)

    def height(self, words: str, room: float) -> float:
        """Return how high they are, broken to a width [px]."""
        return float(imgui.calc_text_size(_with_units(self.said(words)), wrap_width=room).y)

    # ---- words ---------------------------------------------------------------------------------------------

    def text(self, words: str, colour: Colour | None = None, *, wrapped: bool = False) -> None:
        """Write words in a colour of the theme, broken to the panel's width if ``wrapped``.

        Powers in a line are small figures, all at one height: fonts lack some of the raised.
        """
        words = self.written(words)
        imgui.push_style_color(imgui.Col_.text, packed(colour or self.theme.text))
        end = imgui.internal.get_current_window_read().dc.text_wrap_pos  # below 0 where none is set
        wrapped = wrapped or end > 0.0
        if wrapped and not any(raised for _, raised in raised_parts(words)):
            imgui.push_text_wrap_pos(max(end, 0.0))
            imgui.text_unformatted(_with_units(words))
            imgui.pop_text_wrap_pos()
        else:
            imgui.begin_group()
            imgui.push_style_var(imgui.StyleVar_.item_spacing, ImVec2(0.0, 0.0))
            for line in self._broken(_with_units(words), end) if wrapped else [words]:
                self._line(line)
            imgui.pop_style_var()
            imgui.end_group()
        imgui.pop_style_color()

    def _line(self, words: str) -> None:
        for n, (part, raised) in enumerate(raised_parts(words)):
            if n:
                imgui.same_line(0.0, 0.0)
            imgui.push_font(None, imgui.get_font_size() * (RAISED_SIZE if raised else 1.0))
            imgui.text_unformatted(part)
            imgui.pop_font()

    def _broken(self, words: str, end: float) -> list[str]:
        """Return words in lines that end there [px], or with the panel, in which powers are small figures."""
        room, lines = imgui.get_content_region_avail().x, [""]
        if end > 0.0:
            room = min(room, end - imgui.get_cursor_pos_x())
        for part in re.split("([ \n])", words):
            if part == "\n" or (part.strip() and self._figure_width(lines[-1] + part) > room):
                lines.append("")
            lines[-1] = (lines[-1] + part).lstrip()
        return lines

    def faint(self, words: str, *, wrapped: bool = True) -> None:
        """Write words that matter less."""
        self.text(words, self.theme.faint, wrapped=wrapped)

    def refusal(self, words: str) -> None:
        """Write why something cannot be so, if there is a reason."""
        if words:
            self.text(words, self.theme.error, wrapped=True)

    def lead(self, words: str, at: float = 0.0) -> None:
        """Write what the widget is for that comes next in the line, there or ``at`` a place [px]."""
        imgui.align_text_to_frame_padding()
        self.faint(words, wrapped=False)
        imgui.same_line(at)

    def heading(self, words: str) -> None:
        """Write a title."""
        imgui.push_font(self.fonts.bold, self.size * 1.06)
        self.text(words, self.theme.heading, wrapped=True)
        imgui.pop_font()

    def gap(self, share: float = 0.4) -> None:
        """Leave some room, in heights of the text."""
        imgui.dummy(ImVec2(1.0, share * self.size))

    def rule(self, above: float = 0.0) -> None:
        """Draw a thin line across, below some room in heights of the text."""
        if above:
            self.gap(above)
        imgui.separator()

    def row(self, label: str, value: str, tip: str = "", *, lesser: bool = False) -> None:
        """Write a label and its value, the value at the right."""
        value = self.said(value)
        self.rows.setdefault(drawable(label), value)
        colour = self.theme.faint
        if lesser:
            imgui.indent(0.8 * self.size)
        self.text(label, colour)
        if lesser:
            imgui.unindent(0.8 * self.size)
        self.tip(tip)
        imgui.same_line()
        wide = self._figure_width(value)
        room = imgui.get_content_region_avail().x - wide
        if room < 0:
            imgui.new_line()
            room = imgui.get_content_region_avail().x - wide
        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + max(room, 0.0))
        self.text(value, colour if lesser else None)

    def _figure_width(self, words: str) -> float:
        """Return how wide a figure is [px]."""
        wide = 0.0
        for part, raised in raised_parts(words):
            imgui.push_font(None, imgui.get_font_size() * (RAISED_SIZE if raised else 1.0))
            wide += imgui.calc_text_size(part).x
            imgui.pop_font()
        return wide

    def tip(self, words: str) -> None:
        """Show words beside the cursor while it rests on what was drawn last."""
        if words and imgui.is_item_hovered(_TIP_FLAGS):
            words = self.written(words)
            self._place_tip()
            if imgui.begin_tooltip():
                imgui.push_text_wrap_pos((_TIP_WIDTH - 1.5) * self.size)
                imgui.text_unformatted(words)
                imgui.pop_text_wrap_pos()
                imgui.end_tooltip()

    def _place_tip(self) -> None:
        """Have the tip beside the panel that it is for: it covers nothing of what was gone to."""
        panel = imgui.internal.get_current_window_read().root_window
        if panel is None or not (panel.flags & imgui.WindowFlags_.no_move or panel.dock_node):
            return
        low, room, (left, top) = imgui.get_item_rect_min(), imgui.get_io().display_size, panel.pos
        right, foot = left + panel.size.x, top + panel.size.y
        across = max(min(low.x, room.x - _TIP_WIDTH * self.size), 0.0)
        _, place, pivot = max(
            (left, (left, low.y), (1.0, 0.0)), (room.x - right, (right, low.y), (0.0, 0.0)),
            (top, (across, top), (0.0, 1.0)), (room.y - foot, (across, foot), (0.0, 0.0)),
        )  # fmt: skip
        imgui.set_next_window_pos(ImVec2(*place), imgui.Cond_.always, ImVec2(*pivot))

    # ---- what is clicked -----------------------------------------------------------------------------------

    def note(self, label: str, role: str = "button", value: str = "") -> None:
        """Note where the widget is that was drawn last, what it is for who hears it, and if keys go to it."""
        self.spoken.setdefault(label, Spoken(role, value))
        if imgui.is_item_focused():
            self.focused = label
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        self.places.setdefault(
            label, (round(low.x), round(low.y), round(high.x - low.x), round(high.y - low.y))
        )

    def button(
        self, label: str, tip: str = "", *action: Any, shown: str | None = None, on: bool = False,
        size: tuple[float, float] = (0.0, 0.0), enabled: bool = True,
    ) -> bool:  # fmt: skip
        """Draw a button, and return whether it was clicked.

        Parameters
        ----------
        label : str
            Its key.
        action : callable, and its further arguments
            Called after a click.
        shown : str, optional
            Its text, where that is not the label.
        on : bool
            Whether it is marked as what there is now.
        """
        words = self.written(label if shown is None else shown)
        if on:
            imgui.push_style_color(imgui.Col_.button, packed(self.theme.accent))
            imgui.push_style_color(imgui.Col_.button_hovered, packed(self.theme.accent, 0.9))
            imgui.push_style_color(imgui.Col_.text, packed(self.theme.background))
        if not enabled:
            imgui.begin_disabled()
        clicked = imgui.button(widget_label(words, label), ImVec2(*size))
        self.note(label, value="on" if on else "")
        if not enabled:
            imgui.end_disabled()
        if on:
            imgui.pop_style_color(3)
        self.tip(tip)
        return self._did(clicked, action)

    def _did(self, clicked: bool, action: tuple[Any, ...]) -> bool:
        """Have an action done next where a widget was clicked, and return whether it was."""
        if clicked and action:
            self.do_next(*action)
        return bool(clicked)

    def item(
        self, label: str, *action: Any, keys: str = "", on: bool = False, enabled: bool = True, tip: str = "",
        shown: str | None = None, identity: str | None = None,
    ) -> bool:  # fmt: skip
        """Draw a line of the menu that is open, and return whether it was chosen; that does an ``action``.

        ``shown`` is written on it, where not the label; ``identity`` tells it from lines with the same one.
        """
        words = self.written(label if shown is None else shown)
        chosen, _ = imgui.menu_item(widget_label(words, identity or label), self.said(keys), on, enabled)
        self.note(label, "menu item", "on" if on else "")
        self.tip(tip)
        return self._did(chosen, action)

    @contextmanager
    def menu(self, label: str, identity: str | None = None) -> Iterator[bool]:
        """Begin a menu; what is yielded says whether it is open. ``identity`` as in :meth:`item`."""
        words = self.written(label)
        shown = bool(imgui.begin_menu(widget_label(words, identity or label)))
        self.note(label, "menu")
        try:
            yield shown
        finally:
            if shown:
                imgui.end_menu()

    @contextmanager
    def list(
        self, label: str, tip: str = "", *, shown: str | None = None, on: bool = False,
        size: tuple[float, float] = (0.0, 0.0),
    ) -> Iterator[bool]:  # fmt: skip
        """Draw a button that opens a list of lines; the yielded value says whether it is open."""
        if self.button(label, tip, shown=shown, on=on, size=size):
            imgui.open_popup(label)
        is_open = bool(imgui.begin_popup(label))
        try:
            yield is_open
        finally:
            if is_open:
                imgui.end_popup()

    def button_width(self, words: str) -> float:
        """Return how wide a button with such words is [px]."""
        return self.width(words) + 2.0 * float(imgui.get_style().frame_padding.x)

    def same_line_if_room(self, label: str, end: float | None = None) -> None:
        """Go on in the same line where there is room for a button with such words, up to an ``end`` [px]."""
        imgui.same_line()
        needed = self.button_width(label)
        room = imgui.get_content_region_avail().x if end is None else end - imgui.get_cursor_pos_x()
        if room < needed:
            imgui.new_line()

    def table(self, name: str, columns: Sequence[tuple[str, float]], rows: Iterable[Sequence[str]]) -> None:
        """Draw a table of words; ``columns`` are their heads, and their widths in heights of the text."""
        flags = imgui.TableFlags_.row_bg | imgui.TableFlags_.sizing_fixed_fit
        if not imgui.begin_table(name, len(columns), flags):
            return
        for head, width in columns:
            imgui.table_setup_column(head, imgui.TableColumnFlags_.width_fixed, width * self.size)
        imgui.table_next_row()
        for head, _ in columns:
            imgui.table_next_column()
            self.faint(head, wrapped=False)
        for row in rows:
            imgui.table_next_row()
            for words in row:
                imgui.table_next_column()
                self.text(words)
        imgui.end_table()

    def checkbox(self, label: str, on: bool, tip: str = "") -> bool:
        """Draw a box to tick, and return whether it was clicked."""
        words = self.written(label)
        changed, _ = imgui.checkbox(widget_label(words, label), on)
        self.note(label, "check box", "on" if on else "off")
        self.tip(tip)
        return bool(changed)

    def checkbox_width(self, label: str) -> float:
        """Return how wide a box to tick is with its words [px]."""
        gap = imgui.get_style().item_inner_spacing.x
        return float(imgui.get_frame_height()) + gap + self.width(label)

    def choice[T](
        self, label: str, chosen: T, choices: Sequence[T] | Callable[[], Mapping[T, str]], tip: str = "",
        width: float = -1.0, shown: str | None = None,
    ) -> T:  # fmt: skip
        """Draw a list that unfolds, and return what is chosen in it.

        Parameters
        ----------
        choices : sequence, or callable
            The texts there are; or what returns the words of each thing, called while the list is unfolded.
        shown : str, optional
            The words of what is chosen, where it is no text.
        """
        words = self.written(str(chosen) if shown is None else shown)
        imgui.set_next_item_width(width)
        unfolded = imgui.begin_combo(widget_label("", label), words)
        self.note(label, "combo box", words)
        self.tip(tip if not unfolded else "")
        if unfolded:
            offered = choices() if callable(choices) else {one: str(one) for one in choices}
            for one, name in offered.items():
                clicked, _ = imgui.selectable(widget_label(self.written(name), repr(one)), one == chosen)
                self.note(f"{label}: {name}", "list item")
                if clicked:
                    chosen = one
            imgui.end_combo()
        return chosen

    def selectable(
        self, label: str, *action: Any, on: bool = False, faint: bool = False, identity: str | None = None
    ) -> bool:
        """Draw a line that can be clicked, which does an ``action``, and return whether it was.

        ``identity`` as in :meth:`item`.
        """
        words = self.written(label)
        imgui.push_style_color(imgui.Col_.text, packed(self.theme.faint if faint else self.theme.text))
        clicked, _ = imgui.selectable(widget_label(words, identity or label), on)
        imgui.pop_style_color()
        self.note(label, "list item", "on" if on else "")
        return self._did(clicked, action)

    def option(self, label: str, words: str, *, on: bool) -> bool:
        """Draw a line of a choice, broken to the panel's width, and return whether it was clicked."""
        inset, room = 1.6 * self.size, imgui.get_content_region_avail().x
        high = self.height(words, room - inset)
        corner = imgui.get_cursor_screen_pos()
        clicked, _ = imgui.selectable(widget_label("", label), on, 0, ImVec2(room, high + 0.4 * self.size))
        self.note(label, "radio", "on" if on else "off")
        after, paper, radius = imgui.get_cursor_screen_pos(), imgui.get_window_draw_list(), 0.38 * self.size
        middle = ImVec2(
            corner.x + 0.8 * self.size, corner.y + 0.2 * self.size + 0.5 * imgui.get_text_line_height()
        )
        paper.add_circle(middle, radius, packed(self.theme.text), 0, 1.5)
        if on:
            paper.add_circle_filled(middle, 0.55 * radius, packed(self.theme.accent))
        imgui.set_cursor_screen_pos(ImVec2(corner.x + inset, corner.y + 0.2 * self.size))
        self.text(words, wrapped=True)
        imgui.set_cursor_screen_pos(after)
        return bool(clicked)

    def slider(
        self, label: str, value: float, low: float, high: float, shown: str, width: float = -1.0
    ) -> float | None:
        """Draw a slider with words on it, and return the new value if it was moved.

        It slides a share: Dear ImGui takes float32, and ends the program where a range is beyond that.
        """
        shown = self.written(shown)
        imgui.set_next_item_width(width)
        flags = imgui.SliderFlags_.no_input  # Ctrl-click would make a field of it, without units
        words = shown.replace("%", "%%")
        room = 0.5 * high - 0.5 * low
        share = min(max((0.5 * value - 0.5 * low) / room, 0.0), 1.0) if room > 0.0 else 0.0
        moved, new = imgui.slider_float(self.held(label), share, 0.0, 1.0, words, flags)
        self.note(label, "slider", shown)
        return low * (1.0 - new) + high * new if moved else None

    def field(
        self, label: str, text: str, width: float = -1.0, *, wrong: bool = False, lines: int = 1
    ) -> tuple[str, bool]:
        """Draw a field for text, and return its text and whether it is edited.

        In one of several lines Enter ends the writing, and Ctrl+Enter the line.
        """
        text = encodable(text)
        self.words.append(text)
        if wrong:
            imgui.push_style_color(imgui.Col_.border, packed(self.theme.error))
            imgui.push_style_var(imgui.StyleVar_.frame_border_size, 1.5)
        imgui.set_next_item_width(width)
        if self.keys_go_to == "fields":
            imgui.set_keyboard_focus_here()
            self.keys_go_to = ""
        flags, known = imgui.InputTextFlags_, self.held(label)
        if lines == 1:
            _, text = imgui.input_text(known, text, flags.auto_select_all)
        else:
            room = ImVec2(
                width, lines * imgui.get_text_line_height() + 2.0 * imgui.get_style().frame_padding.y
            )
            several = flags.auto_select_all | flags.ctrl_enter_for_new_line | flags.word_wrap
            _, text = imgui.input_text_multiline(known, text, room, several)
        self.note(label, "text", text)
        if self.writes_at_once and imgui.is_item_focused():
            imgui.set_keyboard_focus_here(-1)
            self.writes_at_once = False
        if wrong:
            imgui.pop_style_var()
            imgui.pop_style_color()
        return text, bool(imgui.is_item_active())

    # ---- bars ----------------------------------------------------------------------------------------------

    def bar(
        self, label: str, value: str, share: float, colour: Colour, *, zero: float = 0.0, tip: str = ""
    ) -> None:
        """Write a label and its value over a bar as long as a share (-1 to 1), which begins at ``zero``."""
        self.row(label, value, tip)
        width, height = imgui.get_content_region_avail().x, round(0.4 * self.size)
        corner = imgui.get_cursor_screen_pos()
        paper = imgui.get_window_draw_list()
        paper.add_rect_filled(
            corner, ImVec2(corner.x + width, corner.y + height), packed(self.theme.key), 0.5 * height
        )
        low, high = (min(max(end, 0.0), 1.0) * width for end in sorted((zero, zero + share)))
        if high - low >= 1.0:
            if zero == 0.0:
                high = max(high, height)  # as wide as its ends are round
            paper.add_rect_filled(
                ImVec2(corner.x + low, corner.y), ImVec2(corner.x + high, corner.y + height), packed(colour),
                0.5 * height,
            )  # fmt: skip
        if 0.0 < zero < 1.0:
            self.zero_line(corner.x + zero * width, corner.y, height)
        imgui.dummy(ImVec2(width, height))

    def zero_line(self, x: float, top: float, height: float) -> None:
        """Draw where zero is on a bar [px]."""
        beyond = 0.15 * self.size
        ends = ImVec2(x - 0.5, top - beyond), ImVec2(x + 0.5, top + height + beyond)
        imgui.get_window_draw_list().add_rect_filled(*ends, packed(self.theme.text))
