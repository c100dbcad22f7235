"""Places of bodies on their ways, kept in rings."""

import math

from physicslab.kernels import Numbers, Rows, Vectors, kernel

_ROUNDING = 1e-9
"""Share of the time between two places by which a step may come early."""


@kernel
def note_places(
    times: Numbers, motion: Vectors, length: Numbers, head: Rows, time: Vectors, place: Vectors
) -> None:
    """Note where bodies are at some times: beside the newest place, or in its stead where that is too young.

    Parameters
    ----------
    times : float64 array (m,)
        The times [s], ascending.
    motion : float64 array (m n, k)
        The place of each of ``n`` bodies [m] at each, in the first two columns.
    length : float64 array (n,)
        How far back each ring is to go [s].
    head : int64 array (n,)
        Where the newest place is.
    time, place : float64 arrays (n, s) and (n s, 2)
        When each was [s], NaN where there is none yet, and where [m].
    """
    n, slots = time.shape
    for k in range(len(times)):
        for i in range(n):
            newest, before = time[i, head[i]], time[i, (head[i] + slots - 1) % slots]
            gap = (1.0 - _ROUNDING) * length[i] / (slots - 2)
            if newest - before >= gap or (math.isfinite(newest) and math.isnan(before)):
                head[i] = (head[i] + 1) % slots
            at = i * slots + head[i]
            place[at, 0], place[at, 1] = motion[k * n + i, 0], motion[k * n + i, 1]
            time[i, head[i]] = times[k]
