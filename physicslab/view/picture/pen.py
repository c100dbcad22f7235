"""Lines and discs that are drawn together, in their order: joints and springs are made of them."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from physicslab.theme import Colour, Theme, mixed
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Numbers, Points

_FAR = 1e6
"""Things farther out of the picture than this are not drawn [px]."""
_USUAL, _LEAST, _MOST = 100.0, 0.6, 1.7
"""The scale at which joints have their usual size [px/m], and how small and large they get."""
_HEAD, _SLOT = 5.2, 3.2
"""Radius of the head of a screw, and half length of the slot in it [px]."""
_PLATE, _REACH = 9.0, 11.0
"""Half the width of the plate of a bracket, and how far it is from the screw [px]."""


_mixed = lru_cache(maxsize=256)(mixed)


def divided(count: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return of which thing each part is, and its number within that; ``count`` (n,) says how many each has.

    >>> [part.tolist() for part in divided(np.array([2, 0, 1]))]
    [[0, 0, 2], [0, 1, 0]]
    """
    thing = np.repeat(np.arange(len(count)), count)
    return thing, np.arange(len(thing)) - np.repeat(np.cumsum(count) - count, count)


class Pen:
    """Collects lines with round ends, and discs, which are lines without length.

    Attributes
    ----------
    unit : float
        How large a pixel of the usual picture is [px]: things grow with the root of the scale.
    """

    def __init__(self, camera: Camera, theme: Theme) -> None:
        self.camera, self.theme = camera, theme
        self.unit = min(max((camera.scale / _USUAL) ** 0.5, _LEAST), _MOST)
        self._parts: list[tuple[Points, Points, Colour, float | Numbers]] = []

    def dark(self, colour: Colour, share: float = 0.55) -> Colour:
        """Return a colour with a share of the background in it: edges, and what is behind."""
        return _mixed(colour, self.theme.background, share)

    def light(self, colour: Colour) -> Colour:
        """Return a colour half way to the brightest one."""
        return _mixed(colour, self.theme.shine, 0.5)

    def lines(self, start: Points, end: Points, colour: Colour, width: float | Numbers) -> None:
        """Add straight lines (n, 2) [px] of a width, in usual pixels."""
        if len(start):
            self._parts.append((start, end, colour, self.unit * width))

    def paths(self, corners: Points, colour: Colour, width: float | Numbers) -> None:
        """Add lines through corners (n, k, 2) [px]; each may have a width of its own."""
        if not isinstance(width, float):
            width = np.repeat(width, corners.shape[1] - 1)
        self.lines(corners[:, :-1].reshape(-1, 2), corners[:, 1:].reshape(-1, 2), colour, width)

    def discs(self, centre: Points, radius: float, colour: Colour) -> None:
        """Add discs with centres (n, 2) [px] of a radius, in usual pixels."""
        self.lines(centre, centre, colour, 2.0 * radius)

    def rings(self, centre: Points, radius: float, colour: Colour, inside: Colour, width: float) -> None:
        """Add discs with a rim."""
        self.discs(centre, radius, colour)
        self.discs(centre, radius - width, inside)

    def screws(self, centre: Points, angle: Numbers) -> None:
        """Add the heads of screws, whose slots are turned by angles (n,) [rad]."""
        colour = self.theme.pin
        self.rings(centre, _HEAD, self.dark(colour), colour, 1.2)
        along = _SLOT * self.unit * np.stack((np.cos(angle), -np.sin(angle)), axis=1)
        self.lines(centre - along, centre + along, self.dark(colour, 0.8), 1.7)

    def brackets(self, centre: Points, side: float) -> None:
        """Add what fixes screws to the world: above them (1) or below (-1)."""
        reach = -side * _REACH * self.unit
        colour = self.dark(self.theme.static, 0.25)
        for across in np.linspace(-0.7, 0.7, 5) * _PLATE * self.unit:
            self.lines(centre, centre + np.array((across, reach)), colour, 4.2)
        left, right = (np.array((side * _PLATE * self.unit, reach)) for side in (-1.0, 1.0))
        self.lines(centre + left, centre + right, self.theme.static, 3.4)

    def draw(self, canvas: Canvas) -> None:
        """Draw all that is in sight."""
        if not self._parts:
            return
        start, end = (np.concatenate([part[n] for part in self._parts]) for n in (0, 1))
        width = np.concatenate([np.zeros(len(part[0])) + part[3] for part in self._parts])
        shades = np.array([part[2] for part in self._parts], np.uint8)
        colour = np.repeat(shades, [len(part[0]) for part in self._parts], axis=0)
        with np.errstate(invalid="ignore"):
            low, high = np.minimum(start, end) - width[:, None], np.maximum(start, end) + width[:, None]
            seen = ((high > 0.0) & (low < np.array(self.camera.size))).all(axis=1)
            seen &= ((low > -_FAR) & (high < _FAR)).all(axis=1)
        if seen.any():
            canvas.lines(start[seen], end[seen], colour[seen], width[seen])


def aside(way: Points) -> Points:
    """Return unit vectors across ways (n, 2), to their left as the screen shows them."""
    across: Points = np.stack((way[:, 1], -way[:, 0]), axis=1)
    return across / np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9)[:, None]
