"""Words of panels: lines, headings, rows of figures, and tips."""

import re

from imgui_bundle import ImVec2, imgui

from physicslab.theme import Colour
from physicslab.view.canvas.drawable_text import drawable
from physicslab.view.canvas.surface_cache import RAISED_SIZE, raised_parts
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.windows import Windows

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


class Words(Windows):
    """Writes words and figures into the panel that is open. Powers in them are small figures."""

    def width(self, words: str) -> float:
        """Return how wide words are in the language of the window [px]."""
        return float(imgui.calc_text_size(self.said(words)).x)

    def height(self, words: str, room: float) -> float:
        """Return how high they are, broken to a width [px]."""
        return float(imgui.calc_text_size(_with_units(self.said(words)), wrap_width=room).y)

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
