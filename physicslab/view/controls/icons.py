"""The pictures on buttons, drawn with a few strokes each."""

from __future__ import annotations

import itertools
import math

import pygame

from physicslab.view.canvas.theme import Colour, Theme

__all__ = ["ICONS", "IconCache", "draw_icon"]

_GRID = 24.0
"""Icons are written down on a square of this side, y pointing down."""
_STROKE = 1.9
"""Width of a stroke, on that square."""
_SMOOTHING = 4
"""How many times too large icons are drawn, to be shrunk."""
_SHARE = 0.74
"""The side of an icon, as a share of its button's."""

ICONS = {
    "hand": "line 9,10 9,20 11.6,17.4 13.6,21.5 15.6,20.5 13.7,16.6 17.2,16.4 9,10; ring 8,7,4",
    "circle": "ring 12,12,8; line 12,12 20,12",
    "box": "line 4,6 20,6 20,18 4,18 4,6; line 16,12 20,12",
    "block": "line 4,6 20,6 20,18 4,18 4,6; line 5,17 15,7; line 12,17 19,10",
    "pendulum": "disc 8,4,2; line 8,4 14,15; ring 16,18,4",
    "spring": "disc 4,20,2.4; line 4,20 7,17 6,12 12,14 11,9 17,11 16,6 20,4; disc 20,4,2.4",
    "remove": "ring 12,12,9; line 8.5,8.5 15.5,15.5; line 15.5,8.5 8.5,15.5",
    "clear": "line 4,6.5 20,6.5; line 9,6.5 9,3.5 15,3.5 15,6.5; line 6,6.5 7,21 17,21 18,6.5;"
    " line 10.3,10 10.6,17.5; line 13.7,10 13.4,17.5",
    "pan": "line 12,3 12,21; line 3,12 21,12; line 9.5,5.5 12,3 14.5,5.5; line 9.5,18.5 12,21 14.5,18.5;"
    " line 5.5,9.5 3,12 5.5,14.5; line 18.5,9.5 21,12 18.5,14.5",
    "plot": "line 4,3 4,20 21,20; disc 8,7,1.8; disc 12,12,1.8; disc 18,16,1.8; line 8,7 12,12 18,16",
    "spawn": "ring 8,8,4.6; line 13,13 21,13 21,21 13,21 13,13; line 18,3 18,10; line 14.5,6.5 21.5,6.5",
    "pause": "bar 8.5,5 8.5,19; bar 15.5,5 15.5,19",
    "play": "fill 7,4 20,12 7,20",
    "step": "fill 5,5 14,12 5,19; bar 17.5,5.5 17.5,18.5",
    "slow": "ring 12,13,8; line 12,13 12,8; line 12,13 15,15; line 9.5,2.5 14.5,2.5; line 12,2.5 12,5",
    "slower": "line 11,5 5,12 11,19; line 19,5 13,12 19,19",
    "faster": "line 5,5 11,12 5,19; line 13,5 19,12 13,19",
    "gravity": "line 12,3 12,15; line 7.5,11 12,15.5 16.5,11; line 4,20 20,20",
    "planets": "disc 12,12,3; ring 12,12,8.6; disc 18.4,6.2,2.7",
    "arrows": "line 4,20 19,5; line 11.5,5 19,5 19,12.5",
    "trails": "disc 18.5,6,3.4; disc 12.5,10.5,2.3; disc 8,15,1.6; disc 5,19.5,1.1",
    "impulses": "line 12,2.5 12,8; line 12,16 12,21.5; line 2.5,12 8,12; line 16,12 21.5,12;"
    " line 5.5,5.5 8.7,8.7; line 15.3,15.3 18.5,18.5; line 18.5,5.5 15.3,8.7; line 8.7,15.3 5.5,18.5",
    "zoom in": "ring 10,10,6.6; line 15,15 21,21; line 7,10 13,10; line 10,7 10,13",
    "zoom out": "ring 10,10,6.6; line 15,15 21,21; line 7,10 13,10",
    "fit": "line 3.5,9 3.5,3.5 9,3.5; line 15,3.5 20.5,3.5 20.5,9; line 20.5,15 20.5,20.5 15,20.5;"
    " line 9,20.5 3.5,20.5 3.5,15; ring 12,12,3.4",
    "home": "line 3,12 12,4 21,12; line 6,10 6,20 18,20 18,10; line 12,20 12,14.5",
    "grid": "line 8.5,3 8.5,21; line 15.5,3 15.5,21; line 3,8.5 21,8.5; line 3,15.5 21,15.5",
    "figures": "line 4,6 14,6; line 4,12 14,12; line 4,18 14,18; bar 19.5,6 19.5,6; bar 19.5,12 19.5,12;"
    " bar 19.5,18 19.5,18",
    "theme": "ring 12,12,8.6; half 12,12,8.6",
    "scenes": "line 3.5,4 10.5,4 10.5,10.5 3.5,10.5 3.5,4; line 13.5,4 20.5,4 20.5,10.5 13.5,10.5 13.5,4;"
    " line 3.5,13.5 10.5,13.5 10.5,20 3.5,20 3.5,13.5; line 13.5,13.5 20.5,13.5 20.5,20 13.5,20 13.5,13.5",
    "save": "line 12,3.5 12,14; line 7.5,10 12,14.5 16.5,10; line 4,15 4,20 20,20 20,15",
    "open": "line 3,19.5 3,5 9,5 11,7.5 19,7.5 19,11; line 3,19.5 6.5,11 22,11 18.5,19.5 3,19.5",
    "screenshot": "line 3,7.5 8,7.5 9.5,5 14.5,5 16,7.5 21,7.5 21,19 3,19 3,7.5; ring 12,13,3.8",
    "keys": "line 8.3,8.4 8.8,6.2 10.4,4.6 12.4,4.2 14.6,4.8 15.8,6.6 15.7,8.9 14.3,10.6 12.6,12 12.1,13.6"
    " 12.1,15; disc 12.1,19.3,1.5",
    "quit": "line 8,6 6,8 4.8,10.4 4.5,13 5.2,16 7,18.6 9.4,20 12,20.5 14.6,20 17,18.6 18.8,16 19.5,13"
    " 19.2,10.4 18,8 16,6; line 12,3 12,12",
    "more": "disc 5,12,2; disc 12,12,2; disc 19,12,2",
    "stack": "line 7,3.5 17,3.5 17,9 7,9 7,3.5; line 7,9 7,15 17,15 17,9; line 7,15 7,20.5 17,20.5 17,15",
    "pyramid": "line 8.5,4 15.5,4 15.5,11.5 8.5,11.5 8.5,4; line 4.5,11.5 19.5,11.5 19.5,19.5 4.5,19.5"
    " 4.5,11.5; line 12,11.5 12,19.5",
    "chain": "disc 4,5,2; line 4,5 9,9; ring 10.5,10.5,2.2; line 12,12 14,14; ring 15.5,15.5,2.2;"
    " line 17,17 20,20",
    "heap": "ring 7,17,3.6; ring 17,17,3.6; ring 12,8.6,3.6",
    "pit": "line 3.5,6 3.5,19 20.5,19 20.5,6; ring 9,14.5,2.6; ring 15,14.5,2.6",
    "binary": "ring 6,15,3.4; ring 18,9,3.4; line 3.5,8.5 5.5,5.5 9,4 12.5,4.2; line 20.5,15.5 18.5,18.5"
    " 15,20 11.5,19.8",
}  # fmt: skip
"""Strokes by name: ``line`` through points, ``bar`` (thick), ``fill`` (a polygon), ``ring``, ``disc`` and
``half`` (of a disc, the right one) by centre and radius."""


class IconCache:
    """The icons of a theme, each drawn once for every size of its button.

    Parameters
    ----------
    theme : Theme
        The colours.
    """

    def __init__(self, theme: Theme) -> None:
        self._theme = theme
        self._drawn: dict[tuple[str, int], tuple[pygame.Surface, pygame.Surface]] = {}

    def pictures(self, name: str, size: tuple[int, int]) -> tuple[pygame.Surface, pygame.Surface]:
        """Return an icon for a button of a size [px], as it is usually and where the button is on."""
        side = min(size)
        if (name, side) not in self._drawn:
            usual = draw_icon(name, side, self._theme.text)
            self._drawn[name, side] = usual, draw_icon(name, side, self._theme.accent, marked=True)
        return self._drawn[name, side]


def draw_icon(name: str, side: int, colour: Colour, *, marked: bool = False) -> pygame.Surface:
    """Return an icon for a button of a given side [px]; ``marked`` adds a bar below."""
    large = pygame.Surface((_SMOOTHING * side,) * 2, pygame.SRCALPHA, 32)
    scale = _SMOOTHING * side * _SHARE / _GRID
    shift = 0.5 * _SMOOTHING * side * (1.0 - _SHARE)
    for stroke in ICONS[name].split(";"):
        kind, *points = stroke.split()
        numbers = [tuple(float(part) for part in point.split(",")) for point in points]
        _draw_stroke(large, kind, numbers, scale, shift, colour)
    if marked:
        wide, high = round(0.5 * large.get_width()), max(round(0.07 * large.get_width()), 2 * _SMOOTHING)
        bar = pygame.Rect((large.get_width() - wide) // 2, large.get_height() - round(1.5 * high), wide, high)
        pygame.draw.rect(large, colour, bar, border_radius=high // 2)
    return pygame.transform.smoothscale(large.premul_alpha(), (side, side))


def _draw_stroke(
    large: pygame.Surface,
    kind: str,
    numbers: list[tuple[float, ...]],
    scale: float,
    shift: float,
    colour: Colour,
) -> None:
    places = [(x * scale + shift, y * scale + shift) for x, y, *_ in numbers]
    width = _STROKE * scale * (2.0 if kind == "bar" else 1.0)
    match kind:
        case "line" | "bar":
            for start, end in itertools.pairwise(places):
                _draw_line(large, start, end, width, colour)
        case "fill":
            pygame.draw.polygon(large, colour, places)
        case "ring":
            pygame.draw.circle(large, colour, places[0], numbers[0][2] * scale + 0.5 * width, round(width))
        case "disc":
            pygame.draw.circle(large, colour, places[0], numbers[0][2] * scale)
        case _:
            pygame.draw.circle(
                large, colour, places[0], numbers[0][2] * scale, draw_top_right=True, draw_bottom_right=True
            )


def _draw_line(
    large: pygame.Surface,
    start: tuple[float, float],
    end: tuple[float, float],
    width: float,
    colour: Colour,
) -> None:
    """Draw a thick line with round ends."""
    for place in (start, end):
        pygame.draw.circle(large, colour, place, 0.5 * width)
    length = math.hypot(end[0] - start[0], end[1] - start[1])
    if length:
        across = (end[1] - start[1]) / length * 0.5 * width, (start[0] - end[0]) / length * 0.5 * width
        corners = [
            (x + sign * across[0], y + sign * across[1])
            for (x, y), sign in ((start, 1), (end, 1), (end, -1), (start, -1))
        ]
        pygame.draw.polygon(large, colour, corners)
