"""Compute where the hundred bodies of the problem crowd100 are: how its reference figures were made.

``uv run python benchmarks/crowd_reference.py`` prints how far two runs of different steps are apart, and the
places, by Gragg-Bulirsch-Stoer extrapolation of leapfrog to order 24 (Hairer, Norsett & Wanner, Solving
Ordinary Differential Equations I, 1993, II.14) with numpy's long double: 64 bits of mantissa on x86.
"""

from __future__ import annotations

import json

import numpy as np
from numpy.typing import NDArray

from physicslab.lab.accuracy.forces import CROWD, CROWD_SOFTENING, CROWD_TIME, crowd

Long = np.longdouble
type Places = NDArray[np.longdouble]
ROWS = 12
"""Leapfrogs of 2, 4, ... 24 parts that a step is extrapolated from."""


def accelerations(q: Places) -> Places:
    """Return the pull on every body."""
    gap = q[None, :, :] - q[:, None, :]
    r2 = (gap * gap).sum(-1) + Long(CROWD_SOFTENING) ** 2
    pull: Places = ((Long(1.0 / CROWD) / (r2 * np.sqrt(r2)))[:, :, None] * gap).sum(1)
    return pull


def leapfrog(q: Places, v: Places, step: np.longdouble, parts: int) -> Places:
    """Return places and velocities a step on, made in so many parts."""
    h = step / parts
    v = v + accelerations(q) * (h / 2)
    for _ in range(parts - 1):
        q = q + v * h
        v = v + accelerations(q) * h
    q = q + v * h
    return np.stack((q, v + accelerations(q) * (h / 2)))


def extrapolated(q: Places, v: Places, step: np.longdouble) -> Places:
    """Return places and velocities a step on, extrapolated to parts of no length (Aitken and Neville)."""
    parts = [2 * (row + 1) for row in range(ROWS)]
    before: list[Places] = []
    for k, count in enumerate(parts):
        row = [leapfrog(q, v, step, count)]
        for j in range(1, k + 1):
            ratio = Long(count) ** 2 / Long(parts[k - j]) ** 2
            row.append(row[j - 1] + (row[j - 1] - before[j - 1]) / (ratio - 1))
        before = row
    return before[-1]


def places_after(steps: int) -> Places:
    """Return where the bodies are at the end."""
    bodies = np.array(crowd(), Long)
    q, v = bodies[:, 0], bodies[:, 1]
    for _ in range(steps):
        q, v = extrapolated(q, v, Long(CROWD_TIME) / steps)
    return q


def main() -> None:
    """Print the places, and how sure they are."""
    coarse, fine = places_after(60), places_after(90)
    print(f"60 and 90 steps differ by {float(np.abs(coarse - fine).max()):.1e} m")
    digits = [[np.format_float_positional(x, precision=13, unique=False) for x in row] for row in fine]
    print(json.dumps({str(i): pair for i, pair in enumerate(digits)}))


if __name__ == "__main__":
    main()
