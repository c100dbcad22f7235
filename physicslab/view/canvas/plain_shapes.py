"""Discs, boxes and lines drawn by pygame, until the loops that paint smooth ones are compiled.

Edges are rough, places rounded to pixels, and nothing is lit. Anything far outside the picture is cut off
first, or pygame would go through all of its rows.
"""

import math
from collections.abc import Iterator

import numpy as np
import pygame
from numpy.typing import NDArray

from physicslab.view.canvas.canvas import Finish, Look, Numbers, Points, Rounded
from physicslab.view.canvas.rim import rim_of

_LARGE = 200.0
"""Radius [px] from which a disc is drawn as a polygon, which can be cut off."""
_CORNERS = 256
_SPOKE_FROM = 3.0
"""Radius [px] from which a disc shows how far it has turned."""
_MARGIN = 8.0
"""The margin around the picture within which outlines are drawn [px]."""

type _Place = tuple[float, float]
type _Colour = tuple[int, int, int]


def draw_rounded(surface: pygame.Surface, shapes: Rounded, angle: Numbers, look: Look, rim: float) -> None:
    """Draw rounded polygons, each with a rim; a line shows the angle [rad] of a disc that is not flat."""
    for i, (fill, edge) in enumerate(_colours(look)):
        core, r = shapes.corners[i, : shapes.vertices[i]], float(shapes.radius[i])
        width = max(1, round(min(rim, 0.35 * r) if len(core) == 1 else rim))
        if len(core) > 1 or r >= _LARGE:
            outline = rim_of(core[::-1], r, 48 if len(core) > 1 else _CORNERS)
            _polygon(surface, outline[:, 0], outline[:, 1], fill, edge, width)
            continue
        x, y = core[0].tolist()
        if _is_seen(surface, x, y, r):
            pygame.draw.circle(surface, fill, (x, y), max(r, 1.0))
            pygame.draw.circle(surface, edge, (x, y), max(r, 1.0), width)
        if r >= _SPOKE_FROM and look.finish[i] >= Finish.LIT and look.finish[i] != Finish.GROUND:
            tip = x + 0.8 * r * math.cos(angle[i]), y - 0.8 * r * math.sin(angle[i])
            _stroke(surface, (x, y), tip, edge, width)


def draw_lines(
    surface: pygame.Surface, start: Points, end: Points, colour: NDArray[np.uint8], width: Numbers,
    opacity: Numbers,
) -> None:  # fmt: skip
    """Draw straight lines, each of its own colour (n, 3), width [px] and opacity (0 to 1)."""
    for i in range(len(start)):
        share = float(opacity[i])
        if share > 0.0:
            first, second = (float(start[i, 0]), float(start[i, 1])), (float(end[i, 0]), float(end[i, 1]))
            red, green, blue = colour[i].tolist()
            if first == second:  # a disc
                pygame.draw.circle(surface, (red, green, blue), first, 0.5 * float(width[i]))
            else:
                _stroke(surface, first, second, (red, green, blue), max(1, round(float(width[i]))), share)


def _colours(look: Look) -> Iterator[tuple[_Colour, _Colour]]:
    """Yield what fills each body, and what is at its edge."""
    for fill, edge in zip(look.fill.astype(int), look.rim.astype(int), strict=True):
        yield _colour(fill), _colour(edge)


def _colour(parts: NDArray[np.int64]) -> _Colour:
    red, green, blue = parts.tolist()
    return red, green, blue


def _is_seen(surface: pygame.Surface, x: float, y: float, r: float) -> bool:
    width, height = surface.get_size()
    return -r <= x <= width + r and -r <= y <= height + r


def _polygon(
    surface: pygame.Surface, x: Numbers, y: Numbers, fill: _Colour, edge: _Colour, width: int
) -> None:
    corners = _within(surface, list(zip(x.tolist(), y.tolist(), strict=True)))
    if len(corners) > 2:
        pygame.draw.polygon(surface, fill, corners)
        pygame.draw.polygon(surface, edge, corners, width)


def _within(surface: pygame.Surface, corners: list[_Place]) -> list[_Place]:
    """Return the part of a convex polygon that may be seen (Sutherland and Hodgman, CACM 17 (1974) 32)."""
    for axis, size in enumerate(surface.get_size()):
        for sign, limit in ((1.0, -_MARGIN), (-1.0, -(size + _MARGIN))):
            kept: list[_Place] = []
            for one, other in zip(corners, corners[1:] + corners[:1], strict=True):
                depth, next_depth = sign * one[axis] - limit, sign * other[axis] - limit
                if depth >= 0.0:
                    kept.append(one)
                if (depth >= 0.0) != (next_depth >= 0.0):
                    share = depth / (depth - next_depth)
                    kept.append((one[0] + share * (other[0] - one[0]), one[1] + share * (other[1] - one[1])))
            corners = kept
    return corners


def _stroke(
    surface: pygame.Surface, start: _Place, end: _Place, colour: _Colour, width: int, opacity: float = 1.0
) -> None:
    cut = _within(surface, [start, end])
    if len(cut) < 2:
        return
    first, last = cut[0], cut[1]
    if opacity < 1.0:
        middle = round(0.5 * (first[0] + last[0])), round(0.5 * (first[1] + last[1]))
        colour = _mixed(surface, middle, colour, opacity)
    pygame.draw.line(surface, colour, first, last, width)


def _mixed(surface: pygame.Surface, place: tuple[int, int], colour: _Colour, share: float) -> _Colour:
    """Return a colour with a share of it laid on what is at a place."""
    if not surface.get_rect().collidepoint(place):
        return colour
    under = surface.get_at(place)
    red, green, blue = (round(b + share * (c - b)) for c, b in zip(colour, under[:3], strict=True))
    return red, green, blue
