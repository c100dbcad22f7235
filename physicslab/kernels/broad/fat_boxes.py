"""Fat boxes: boxes around bodies with a margin, so that the pairs found with them hold for several steps.

They hold as long as they have every pair that may have points: so which pairs have points depends on places
and velocities, and not on when pairs were last listed.
"""

import math

from physicslab.kernels import Numbers, Rows, Vectors, inlined, kernel
from physicslab.kernels.narrow.contact import CACHE_TOLERANCE, CACHE_TURN_TOLERANCE
from physicslab.kernels.narrow.pair import CONTACT_MARGIN

__all__ = ["CORNERWISE", "fat_boxes", "still_holds"]

CORNERWISE = math.sqrt(2.0)
"""Largest ratio of the distance of two boxes to their distance along the normal of a side."""
_BOX_SHARE = 0.5 * CORNERWISE * (1.5 * CONTACT_MARGIN + CACHE_TOLERANCE)
"""Share of its smaller side up to which a slow box is one half of a pair that has points, or keeps them."""
_TURN_SHARE = CORNERWISE * CACHE_TURN_TOLERANCE
"""The same for points that are kept while it turns, as a share of its bounding radius."""


@inlined
def _bounding_radius(kind: int, radius: float, width: float, height: float) -> float:
    if kind == 1:
        return radius
    return 0.5 * math.sqrt(width * width + height * height)


@inlined
def _touching_distance(
    kind: int, reach: float, width: float, height: float, speculative_margin: float
) -> float:
    """Return the largest distance [m] at which a body at rest may have points with the bounds.

    Two bodies may have points with each other up to the sum of theirs.
    """
    share = CONTACT_MARGIN * reach
    if kind == 2:
        share = _BOX_SHARE * min(width, height) + _TURN_SHARE * reach
    return share + speculative_margin


@kernel
def still_holds(
    position: Vectors,
    angle: Numbers,
    linear: Vectors,
    angular: Numbers,
    kind: Rows,
    radius: Numbers,
    width: Numbers,
    height: Numbers,
    fat: Vectors,
    h: float,
    speculative_margin: float,
) -> bool:
    """Whether whatever each body may have points with in a time h meets the fat box made for it.

    ``fat`` (5, rows) holds where each body was (x, y, angle), its bounding radius then, and the margin around
    it. ``speculative_margin`` is how far the forces may bring two bodies together within ``h``.
    """
    places, velocities = position.reshape(position.size), linear.reshape(linear.size)
    holds = True
    for i in range(len(angle)):  # no early exit, so that LLVM vectorises the loop
        reach = _bounding_radius(kind[i], radius[i], width[i], height[i])
        made_for = reach if kind[i] != 0 else 0.0
        moved_x, moved_y = abs(places[2 * i] - fat[0, i]), abs(places[2 * i + 1] - fat[1, i])
        ux, uy = velocities[2 * i] * h, velocities[2 * i + 1] * h
        ahead = math.sqrt(ux * ux + uy * uy) * (CORNERWISE if kind[i] == 2 else 1.0)
        turned = (abs(angle[i] - fat[2, i]) + abs(angular[i]) * h) * (reach if kind[i] == 2 else 0.0)
        needed = _touching_distance(kind[i], reach, width[i], height[i], speculative_margin)
        inside = (max(moved_x, moved_y) + ahead + turned + needed <= fat[4, i]) | (kind[i] == 0)
        holds &= inside & (made_for == fat[3, i])
    return holds


@kernel
def fat_boxes(
    position: Vectors,
    angle: Numbers,
    linear: Vectors,
    angular: Numbers,
    kind: Rows,
    radius: Numbers,
    width: Numbers,
    height: Numbers,
    inverse_mass: Numbers,
    fat: Vectors,
    boxes: Vectors,
    h: float,
    speculative_margin: float,
) -> None:
    """Make each body's fat box (xmin, ymin, xmax, ymax), good for some three steps of four substeps h."""
    moving, speeds = 0, 0.0
    for i in range(len(angle)):
        speed = abs(linear[i, 0]) + abs(linear[i, 1])
        if speed > 0.0 and kind[i] != 0:
            moving += 1
            speeds += min(speed, 1e9)
    usual = speeds / moving if moving else 0.0
    for i in range(len(angle)):
        fat[3, i] = 0.0
        if kind[i] == 0:
            continue
        reach = _bounding_radius(kind[i], radius[i], width[i], height[i])
        half_x = half_y = reach
        if kind[i] == 2:
            c, s = abs(math.cos(angle[i])), abs(math.sin(angle[i]))
            half_x = 0.5 * (c * width[i] + s * height[i])
            half_y = 0.5 * (s * width[i] + c * height[i])
        # A slow body among fast ones is likely to be hit.
        speed = max(abs(linear[i, 0]), abs(linear[i, 1]), usual if inverse_mass[i] > 0.0 else 0.0)
        margin = 0.08 * min(half_x, half_y) + 13.0 * h * speed
        margin += 2.0 * h * abs(angular[i]) * (reach if kind[i] == 2 else 0.0)
        margin += _touching_distance(kind[i], reach, width[i], height[i], speculative_margin)
        fat[0, i], fat[1, i], fat[2, i] = position[i, 0], position[i, 1], angle[i]
        fat[3, i], fat[4, i] = reach, margin
        boxes[i, 0], boxes[i, 2] = position[i, 0] - half_x - margin, position[i, 0] + half_x + margin
        boxes[i, 1], boxes[i, 3] = position[i, 1] - half_y - margin, position[i, 1] + half_y + margin
