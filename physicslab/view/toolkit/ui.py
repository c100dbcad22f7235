"""Elements of panels: buttons, fields, bars and menus, each identified by its label."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from imgui_bundle import ImVec2, imgui

from physicslab.theme import Colour
from physicslab.view.canvas.drawable_text import encodable
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.windows import Spoken, widget_label
from physicslab.view.toolkit.words import Words


class Ui(Words):
    """The widgets of one frame. Each is noted: where it is, by its words, and all that is written."""

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
        room = 0.5 * high - 0.5 * low
        share = min(max((0.5 * value - 0.5 * low) / room, 0.0), 1.0) if room > 0.0 else 0.0
        moved, new = imgui.slider_float(self.held(label), share, 0.0, 1.0, "", flags)
        _write_beside_handle(shown, new)
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


def _write_beside_handle(words: str, share: float) -> None:
    """Write words into the middle of the slider drawn last, or beside its handle where that is in the way."""
    (left, top), (right, bottom) = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    style, size = imgui.get_style(), imgui.calc_text_size(words)
    reach = 0.5 * style.grab_min_size + style.item_inner_spacing.x
    handle = left + reach + share * (right - left - 2.0 * reach)
    x = 0.5 * (left + right - size.x)
    if x - reach < handle < x + size.x + reach:
        beside = handle + reach if handle < 0.5 * (left + right) else handle - reach - size.x
        x = min(max(beside, left), max(right - size.x, left))
    place = ImVec2(x, 0.5 * (top + bottom - size.y))
    imgui.push_clip_rect(ImVec2(left, top), ImVec2(right, bottom), True)
    imgui.get_window_draw_list().add_text(place, imgui.get_color_u32(imgui.Col_.text), words)
    imgui.pop_clip_rect()
