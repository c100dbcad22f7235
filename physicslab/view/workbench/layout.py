"""The layout of the window: the world first, panels around it."""

from __future__ import annotations

from dataclasses import dataclass

from physicslab.view.canvas.canvas import Rect
from physicslab.view.toolkit.style import bar_height

_PALETTE, _SIDE, _TRANSPORT = 6.9, 16.8, 3.0
"""Widths of the palette and the side panel, height of the transport, in heights of the text."""
_MIN_WORLD = 0.34
"""Share of the window's width that is always left to the world: the side panel lies over it if it must."""


@dataclass(frozen=True, slots=True)
class Layout:
    """The rectangles of a window [px].

    Attributes
    ----------
    menu, palette, transport, side, room : Rect
        The menu bar, the tools, the transport, the panel at the right, and what is left for the world.
    """

    menu: Rect
    palette: Rect
    transport: Rect
    side: Rect
    room: Rect

    @property
    def panels(self) -> tuple[Rect, ...]:
        """All that is not left for the world [px]."""
        return self.menu, self.palette, self.transport, self.side

    @property
    def visible(self) -> Rect:
        """The part of the world's room that the panel at the right does not lie over [px]."""
        left, top, width, height = self.room
        return left, top, max(min(width, self.side[0] - left), 1), height

    @classmethod
    def of(cls, size: tuple[int, int], text: int, *, side: bool) -> Layout:
        """Lay a window out for text of a height [px], with or without the panel at the right."""
        width, height = size
        top, foot, left = bar_height(text), round(_TRANSPORT * text), round(_PALETTE * text)
        right = round(_SIDE * text) if side else 0
        middle = max(height - top - foot, 1)
        room_width = width - left - right
        if room_width < _MIN_WORLD * width:
            room_width = width - left
        return cls(
            (0, 0, width, top),
            (0, top, left, middle),
            (0, height - foot, width, foot),
            (width - right, top, right, middle),
            (left, top, max(room_width, 1), middle),
        )
