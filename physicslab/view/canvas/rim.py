"""The outline of a rounded polygon as straight lines, for whatever draws it."""

import math

import numpy as np
from numpy.typing import NDArray

type Numbers = NDArray[np.float64]
"""Points (n, 2)."""


def rim_of(corners: Numbers, radius: float, lines: int = 48) -> Numbers:
    """Return the outline of a rounded polygon (n, 2) [m] with straight lines, so many to a whole turn.

    Parameters
    ----------
    corners : float64 array (m, 2)
        The vertices of its core [m], counter-clockwise.
    radius : float
        Radius that rounds it [m].
    """
    if radius == 0.0:
        return corners
    ways = np.roll(corners, -1, axis=0) - corners
    faces = np.arctan2(-ways[:, 0], ways[:, 1])[np.hypot(ways[:, 0], ways[:, 1]) > 0.0]
    around = np.arange(lines) * (2.0 * math.pi / lines) - math.pi
    turns = np.unique(np.concatenate((around, faces - 1e-9, faces + 1e-9)))
    normals = np.stack((np.cos(turns), np.sin(turns)), axis=1)
    rim: Numbers = corners[np.argmax(normals @ corners.T, axis=1)] + radius * normals
    return rim
