"""A menu that opens over the world: lines to choose from, in as many columns and pages as they need."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from physicslab.view.canvas.canvas import Canvas, Rect, TextStyle
from physicslab.view.canvas.theme import Theme
from physicslab.view.controls.menus import StepPlan
from physicslab.view.controls.widgets import Button, Widgets

__all__ = ["Popup"]

_LONGEST = 46
"""A title is cut at so many letters."""


class Popup:
    """The one menu there is at a time; its lines are made once and used for every menu.

    Parameters
    ----------
    widgets : Widgets
        What its lines are made of.
    choose : callable
        What is called with the choice that is clicked.
    """

    def __init__(self, widgets: Widgets, choose: Callable[[StepPlan], None]) -> None:
        self._widgets = widgets
        self._choose = choose
        self._plate = widgets.plate(menu=True)
        self._rows: list[Button] = []
        self._shown: list[StepPlan] = []
        self._page = 0
        self._pages = 1

    @property
    def titles(self) -> dict[str, Rect]:
        """What each line that is shown says, and where it is [px]."""
        return {
            row.text: (row.rect.left, row.rect.top, row.rect.width, row.rect.height)
            for row in self._rows
            if row.visible
        }

    def close(self) -> None:
        """Hide it; next time it shows its first page."""
        self._page = 0
        self._plate.vanish()
        for row in self._rows:
            row.reveal(False)

    def turn(self, pages: int) -> None:
        """Go on by so many pages, and from the last to the first."""
        self._page = (self._page + pages) % self._pages

    def open(
        self, choices: Sequence[StepPlan], anchor: Rect, room: Rect, size: int, canvas: Canvas, theme: Theme
    ) -> None:
        """Show choices at a button, within a part of the window.

        Parameters
        ----------
        anchor, room : Rect
            The button, and what the menu may cover [px].
        size : int
            Height of the text [px].
        """
        height, pad = round(1.9 * size), max(size // 3, 2)
        style = TextStyle(size, theme.text)
        titles = [_cut(choice.title) for choice in choices]
        widest = max(canvas.text_size(title, style)[0] for title in titles)
        width = min(widest + 3 * size, max(room[2] - 2 * pad, 2))
        rows = max((room[3] - 2 * pad) // height, 2)
        columns = max(min((room[2] - 2 * pad) // width, math.ceil(len(choices) / rows)), 1)
        shown = self._paged(list(choices), rows * columns)
        each = math.ceil(len(shown) / columns)
        wide, high = columns * width + 2 * pad, each * height + 2 * pad
        left = min(max(anchor[0], room[0]), max(room[0] + room[2] - wide, 0))
        self._plate.put((left, room[1], wide, high))
        while len(self._rows) < len(shown):
            self._rows.append(self._row(len(self._rows)))
        self._shown = shown
        for n, row in enumerate(self._rows):
            if n >= len(shown):
                row.reveal(False)
                continue
            column, line = divmod(n, each)
            row.put((left + pad + column * width, room[1] + pad + line * height, width, height))
            row.say(("• " if shown[n].on else "") + _cut(shown[n].title))
            row.allow(shown[n].choose is not None or shown[n] is self._turning)
            row.mark(shown[n].on)

    def _paged(self, choices: list[StepPlan], room: int) -> list[StepPlan]:
        """Return what is shown of the choices where there is room for so many lines."""
        self._turning: StepPlan | None = None
        self._pages = 1
        if len(choices) <= room:
            return choices
        each = max(room - 1, 1)
        self._pages = math.ceil(len(choices) / each)
        self._page %= self._pages
        self._turning = StepPlan(f"More ({self._page + 1} of {self._pages})")
        return [*choices[self._page * each : (self._page + 1) * each], self._turning]

    def _row(self, number: int) -> Button:
        def click() -> None:
            choice = self._shown[number]
            if choice is self._turning:
                self.turn(1)
            elif choice.choose is not None:
                self._choose(choice)

        return self._widgets.button(click, row=True)


def _cut(title: str) -> str:
    return title if len(title) <= _LONGEST else title[: _LONGEST - 1] + "…"
