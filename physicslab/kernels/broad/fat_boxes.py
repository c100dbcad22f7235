"""Fat boxes: boxes around bodies with a margin, so that the pairs found with them hold for several steps.

They hold as long as they have every pair that may have points: so which pairs have points depends on places
and velocities, and not on when pairs were last listed.
"""

import math

from physicslab.kernels import Numbers, Plain, Vectors, inlined, kernel
from physicslab.kernels.arguments import Motion
from physicslab.kernels.geometry.margins import touching_ahead, touching_distance
from physicslab.kernels.geometry.shapes import Shapes, ShapesTuple, half_extents, named_shapes

HIT_SHARE = 1.0
"""Share of its bounding radius by which the margin of a slow body is increased at most where many pairs have
records."""
_TURNS = 4.0
"""Number of times h in which a body may turn on as it does; nowhere does it pass its bounding radius."""


@inlined
def _reaches(
    moved: float, turned: float, ux: float, uy: float, reach: float, radius: float, thin: float,
    speculative_margin: float,
) -> float:  # fmt: skip
    """Return how far [m] from the way of its fat box a body may have points, ``moved`` from there by now.

    It goes on by (ux, uy) [m], and has turned by ``turned`` [rad] then.
    """
    needed = touching_ahead(ux, uy, reach, radius, thin, speculative_margin)
    return moved + min(turned, 1.0) * (reach - radius) + needed


@inlined
def left(
    i: int, motion: Motion, shapes: Shapes, fat: Vectors, h: float, later: float, speculative_margin: float
) -> bool:
    """Whether body i may, in a time h, have points with what does not meet the fat box made for it.

    Now, or, if it moves on as it does, in a time h that is up to ``later`` [s] from now.
    """
    position, linear, reach = motion.position, motion.linear, shapes.reach[i]
    if shapes.vertices[i] == 0:
        return bool(fat[3, i] != 0.0)
    x, y = position[i, 0] - fat[0, i], position[i, 1] - fat[1, i]
    moved_x = max(abs(x), abs(x + later * linear[i, 0])) - abs(fat[6, i])
    moved_y = max(abs(y), abs(y + later * linear[i, 1])) - abs(fat[7, i])
    turn, spin = motion.angle[i] - fat[2, i], motion.angular[i]
    turned = max(abs(turn), abs(turn + later * spin)) + abs(spin) * h
    reaches = _reaches(
        max(moved_x, moved_y), turned, linear[i, 0] * h, linear[i, 1] * h, reach, shapes.radius[i],
        shapes.thin[i], speculative_margin,
    )  # fmt: skip
    return not (reaches <= fat[4, i] and reach == fat[3, i])


@inlined
def all_inside(motion: Motion, shapes: Shapes, fat: Vectors, h: float, speculative_margin: float) -> bool:
    """Whether whatever each body may have points with in a time h meets the fat box made for it.

    ``fat`` (8, rows) holds the middle of the way for which it was made (x, y) and the angle, the bounding
    radius then, the margin around the way, what :mod:`physicslab.kernels.broad.leaving` keeps there, and half
    the way (x, y). ``speculative_margin`` is how far the forces may bring two bodies together within ``h``.
    """
    position, angle, linear, angular = motion
    radius, reach, thin = shapes.radius, shapes.reach, shapes.thin
    places, velocities = position.reshape(position.size), linear.reshape(linear.size)
    holds = True
    for i in range(len(angle)):  # no early exit, so that LLVM vectorises the loop
        moved_x = abs(places[2 * i] - fat[0, i]) - abs(fat[6, i])
        moved_y = abs(places[2 * i + 1] - fat[1, i]) - abs(fat[7, i])
        turned = abs(angle[i] - fat[2, i]) + abs(angular[i]) * h
        reaches = _reaches(
            max(moved_x, moved_y), turned, velocities[2 * i] * h, velocities[2 * i + 1] * h, reach[i],
            radius[i], thin[i], speculative_margin,
        )  # fmt: skip
        holds &= ((reaches <= fat[4, i]) | (reach[i] == 0.0)) & (reach[i] == fat[3, i])
    return holds


@inlined
def usual_speed(motion: Motion, shapes: Shapes) -> float:
    """Return the mean speed [m/s] of what moves against its mean velocity: what falls together meets less."""
    moving, mean_x, mean_y, speeds = 0, 0.0, 0.0, 0.0
    for i in range(len(motion.angle)):
        vx, vy = motion.linear[i, 0], motion.linear[i, 1]
        if (vx != 0.0 or vy != 0.0) and shapes.vertices[i] != 0:
            moving += 1
            mean_x, mean_y = mean_x + min(max(vx, -1e9), 1e9), mean_y + min(max(vy, -1e9), 1e9)
    if moving == 0:
        return 0.0
    mean_x, mean_y = mean_x / moving, mean_y / moving
    for i in range(len(motion.angle)):
        vx, vy = motion.linear[i, 0], motion.linear[i, 1]
        if (vx != 0.0 or vy != 0.0) and shapes.vertices[i] != 0:
            speeds += min(abs(vx - mean_x) + abs(vy - mean_y), 1e9)
    return speeds / moving


@inlined
def fatten(
    i: int, motion: Motion, shapes: Shapes, fat: Vectors, h: float, usual: float, hit_share: float,
    speculative_margin: float,
) -> tuple[float, float, float, float]:  # fmt: skip
    """Return the fat box (xmin, ymin, xmax, ymax) of body i, good for some three steps of four substeps h.

    It reaches as far as the body would come at its velocity. A body among fast ones is likely to be hit:
    the margin around that way goes by the ``usual`` speed [m/s], but for no more than ``hit_share`` of its
    bounding radius.
    """
    angle, reach, radius = motion.angle[i], shapes.reach[i], shapes.radius[i]
    x, y = motion.position[i, 0], motion.position[i, 1]
    half_x, half_y = half_extents(shapes, i, angle)
    vx, vy = motion.linear[i, 0], motion.linear[i, 1]
    around = max(2.0 * h * math.sqrt(vx * vx + vy * vy), min(13.0 * h * usual, hit_share * reach))
    ahead_x, ahead_y = max(6.5 * h * abs(vx) - 0.5 * around, 0.0), max(6.5 * h * abs(vy) - 0.5 * around, 0.0)
    margin = 0.08 * min(half_x, half_y) + around
    margin += min(_TURNS * h * abs(motion.angular[i]), 1.0) * (reach - radius)
    margin += touching_distance(reach, radius, shapes.thin[i], speculative_margin)
    fat[6, i], fat[7, i] = math.copysign(ahead_x, vx), math.copysign(ahead_y, vy)
    x, y = x + fat[6, i], y + fat[7, i]
    fat[0, i], fat[1, i], fat[2, i], fat[3, i], fat[4, i] = x, y, angle, reach, margin
    half_x, half_y = half_x + ahead_x + margin, half_y + ahead_y + margin
    return x - half_x, y - half_y, x + half_x, y + half_y


@kernel
def fat_boxes(
    plain_motion: Plain[Motion], plain_shapes: ShapesTuple, inverse_mass: Numbers, fat: Vectors,
    boxes: Vectors, h: float, hit_share: float, speculative_margin: float,
) -> None:  # fmt: skip
    """Make each body's fat box, as :func:`fatten` describes."""
    motion, shapes = Motion(*plain_motion), named_shapes(plain_shapes)
    usual = usual_speed(motion, shapes)
    for i in range(len(motion.angle)):
        fat[3, i] = 0.0
        if shapes.vertices[i] != 0:
            hit = usual if inverse_mass[i] > 0.0 else 0.0
            boxes[i, 0], boxes[i, 1], boxes[i, 2], boxes[i, 3] = fatten(
                i, motion, shapes, fat, h, hit, hit_share, speculative_margin
            )
