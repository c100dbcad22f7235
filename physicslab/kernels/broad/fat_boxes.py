"""Fat boxes: boxes around bodies with a margin, so that the pairs found with them hold for several steps.

They hold as long as they have every pair that may have points: so which pairs have points depends on places
and velocities, and not on when pairs were last listed.
"""

import math

from physicslab.kernels import Numbers, Rows, Vectors, inlined, kernel
from physicslab.kernels.arguments import Motion, MotionTuple, Sizes, SizesTuple
from physicslab.kernels.narrow.contact import CACHE_TOLERANCE, CACHE_TURN_TOLERANCE, WIDE_TOLERANCE
from physicslab.kernels.narrow.pair import CONTACT_MARGIN

__all__ = ["CORNERWISE", "HIT_SHARE", "fat_boxes", "fatten", "left", "still_holds", "usual_speed"]

CORNERWISE = math.sqrt(2.0)
"""Largest ratio of the distance of two boxes to their distance along the normal of a side."""
_BOX_SHARE = 0.5 * CORNERWISE * (1.5 * CONTACT_MARGIN + WIDE_TOLERANCE * CACHE_TOLERANCE)
"""Share of its smaller side up to which a slow box is one half of a pair that has points, or keeps them."""
HIT_SHARE = 1.0
"""Share of its bounding radius by which the margin of a slow body is increased at most where many pairs have
records."""
_TURN_SHARE = CORNERWISE * WIDE_TOLERANCE * CACHE_TURN_TOLERANCE
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


@inlined
def left(
    i: int, motion: Motion, sizes: Sizes, fat: Vectors, h: float, later: float, speculative_margin: float
) -> bool:
    """Whether body i may, in a time h, have points with what does not meet the fat box made for it.

    Now, or, if it moves on as it does, in a time h that is up to ``later`` [s] from now.
    """
    kind, position, linear = sizes.kind[i], motion.position, motion.linear
    if kind == 0:
        return bool(fat[3, i] != 0.0)
    reach = _bounding_radius(kind, sizes.radius[i], sizes.width[i], sizes.height[i])
    x, y = position[i, 0] - fat[0, i], position[i, 1] - fat[1, i]
    moved_x = max(abs(x), abs(x + later * linear[i, 0])) - abs(fat[6, i])
    moved_y = max(abs(y), abs(y + later * linear[i, 1])) - abs(fat[7, i])
    ux, uy = linear[i, 0] * h, linear[i, 1] * h
    ahead = math.sqrt(ux * ux + uy * uy) * (CORNERWISE if kind == 2 else 1.0)
    turned = (abs(motion.angle[i] - fat[2, i]) + abs(motion.angular[i]) * h) * (reach if kind == 2 else 0.0)
    needed = _touching_distance(kind, reach, sizes.width[i], sizes.height[i], speculative_margin)
    return not (max(moved_x, moved_y) + ahead + turned + needed <= fat[4, i] and reach == fat[3, i])


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

    ``fat`` (8, rows) holds the middle of the way for which it was made (x, y) and the angle, the bounding
    radius then, the margin around the way, what :mod:`physicslab.kernels.broad.leaving` keeps there, and half
    the way (x, y). ``speculative_margin`` is how far the forces may bring two bodies together within ``h``.
    """
    places, velocities = position.reshape(position.size), linear.reshape(linear.size)
    holds = True
    for i in range(len(angle)):  # no early exit, so that LLVM vectorises the loop
        reach = _bounding_radius(kind[i], radius[i], width[i], height[i])
        made_for = reach if kind[i] != 0 else 0.0
        moved_x = abs(places[2 * i] - fat[0, i]) - abs(fat[6, i])
        moved_y = abs(places[2 * i + 1] - fat[1, i]) - abs(fat[7, i])
        ux, uy = velocities[2 * i] * h, velocities[2 * i + 1] * h
        ahead = math.sqrt(ux * ux + uy * uy) * (CORNERWISE if kind[i] == 2 else 1.0)
        turned = (abs(angle[i] - fat[2, i]) + abs(angular[i]) * h) * (reach if kind[i] == 2 else 0.0)
        needed = _touching_distance(kind[i], reach, width[i], height[i], speculative_margin)
        inside = (max(moved_x, moved_y) + ahead + turned + needed <= fat[4, i]) | (kind[i] == 0)
        holds &= inside & (made_for == fat[3, i])
    return holds


@inlined
def usual_speed(motion: Motion, sizes: Sizes) -> float:
    """Return the mean speed [m/s] of what moves against its mean velocity: what falls together meets less."""
    moving, mean_x, mean_y, speeds = 0, 0.0, 0.0, 0.0
    for i in range(len(motion.angle)):
        vx, vy = motion.linear[i, 0], motion.linear[i, 1]
        if (vx != 0.0 or vy != 0.0) and sizes.kind[i] != 0:
            moving += 1
            mean_x, mean_y = mean_x + min(max(vx, -1e9), 1e9), mean_y + min(max(vy, -1e9), 1e9)
    if moving == 0:
        return 0.0
    mean_x, mean_y = mean_x / moving, mean_y / moving
    for i in range(len(motion.angle)):
        vx, vy = motion.linear[i, 0], motion.linear[i, 1]
        if (vx != 0.0 or vy != 0.0) and sizes.kind[i] != 0:
            speeds += min(abs(vx - mean_x) + abs(vy - mean_y), 1e9)
    return speeds / moving


@inlined
def fatten(
    i: int, motion: Motion, sizes: Sizes, fat: Vectors, h: float, usual: float, hit_share: float,
    speculative_margin: float,
) -> tuple[float, float, float, float]:  # fmt: skip
    """Return the fat box (xmin, ymin, xmax, ymax) of body i, good for some three steps of four substeps h.

    It reaches as far as the body would come at its velocity. What is among fast bodies is likely to be hit:
    the margin around that way goes by the ``usual`` speed [m/s], but for no more than ``hit_share`` of its
    bounding radius.
    """
    kind, angle = sizes.kind[i], motion.angle[i]
    x, y, width, height = motion.position[i, 0], motion.position[i, 1], sizes.width[i], sizes.height[i]
    reach = _bounding_radius(kind, sizes.radius[i], width, height)
    half_x = half_y = reach
    if kind == 2:
        c, s = abs(math.cos(angle)), abs(math.sin(angle))
        half_x, half_y = 0.5 * (c * width + s * height), 0.5 * (s * width + c * height)
    vx, vy = motion.linear[i, 0], motion.linear[i, 1]
    around = max(2.0 * h * math.sqrt(vx * vx + vy * vy), min(13.0 * h * usual, hit_share * reach))
    ahead_x, ahead_y = max(6.5 * h * abs(vx) - 0.5 * around, 0.0), max(6.5 * h * abs(vy) - 0.5 * around, 0.0)
    margin = 0.08 * min(half_x, half_y) + around
    margin += 2.0 * h * abs(motion.angular[i]) * (reach if kind == 2 else 0.0)
    margin += _touching_distance(kind, reach, width, height, speculative_margin)
    fat[6, i], fat[7, i] = math.copysign(ahead_x, vx), math.copysign(ahead_y, vy)
    x, y = x + fat[6, i], y + fat[7, i]
    fat[0, i], fat[1, i], fat[2, i], fat[3, i], fat[4, i] = x, y, angle, reach, margin
    half_x, half_y = half_x + ahead_x + margin, half_y + ahead_y + margin
    return x - half_x, y - half_y, x + half_x, y + half_y


@kernel
def fat_boxes(
    plain_motion: MotionTuple, plain_sizes: SizesTuple, inverse_mass: Numbers, fat: Vectors, boxes: Vectors,
    h: float, hit_share: float, speculative_margin: float,
) -> None:  # fmt: skip
    """Make each body's fat box, as :func:`fatten` describes."""
    motion, sizes = Motion(*plain_motion), Sizes(*plain_sizes)
    usual = usual_speed(motion, sizes)
    for i in range(len(motion.angle)):
        fat[3, i] = 0.0
        if sizes.kind[i] != 0:
            hit = usual if inverse_mass[i] > 0.0 else 0.0
            boxes[i, 0], boxes[i, 1], boxes[i, 2], boxes[i, 3] = fatten(
                i, motion, sizes, fat, h, hit, hit_share, speculative_margin
            )
