"""Fat boxes: boxes around bodies with a margin, so that the pairs found with them hold for several steps."""

import math

from physicslab.kernels import Numbers, Rows, Vectors, inlined, kernel

__all__ = ["fat_boxes", "still_holds"]


@inlined
def _bounding_radius(kind: int, radius: float, width: float, height: float) -> float:
    if kind == 1:
        return radius
    return 0.5 * math.sqrt(width * width + height * height)


@kernel
def still_holds(
    position: Vectors,
    angle: Numbers,
    linear: Vectors,
    kind: Rows,
    radius: Numbers,
    width: Numbers,
    height: Numbers,
    fat: Vectors,
    h: float,
) -> bool:
    """Whether every body, with its motion in a time h, is still inside the fat box made for it.

    ``fat`` (5, rows) holds where each body was (x, y, angle), its bounding radius then, and the margin around
    it.
    """
    places, velocities = position.reshape(position.size), linear.reshape(linear.size)
    holds = True
    for i in range(len(angle)):  # no early exit, so that LLVM vectorises the loop
        reach = _bounding_radius(kind[i], radius[i], width[i], height[i])
        made_for = reach if kind[i] != 0 else 0.0
        moved_x = abs(places[2 * i] - fat[0, i]) + abs(velocities[2 * i]) * h
        moved_y = abs(places[2 * i + 1] - fat[1, i]) + abs(velocities[2 * i + 1]) * h
        turned = abs(angle[i] - fat[2, i]) * (reach if kind[i] == 2 else 0.0)
        inside = (max(moved_x, moved_y) + turned <= fat[4, i]) | (kind[i] == 0)
        holds &= inside & (made_for == fat[3, i])
    return holds


@kernel
def fat_boxes(
    position: Vectors,
    angle: Numbers,
    linear: Vectors,
    kind: Rows,
    radius: Numbers,
    width: Numbers,
    height: Numbers,
    inverse_mass: Numbers,
    fat: Vectors,
    boxes: Vectors,
    h: float,
) -> None:
    """Make each body's fat box (xmin, ymin, xmax, ymax), good for about three steps."""
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
        margin = 0.1 * min(half_x, half_y) + 14.0 * h * speed
        fat[0, i], fat[1, i], fat[2, i] = position[i, 0], position[i, 1], angle[i]
        fat[3, i], fat[4, i] = reach, margin
        boxes[i, 0], boxes[i, 2] = position[i, 0] - half_x - margin, position[i, 0] + half_x + margin
        boxes[i, 1], boxes[i, 3] = position[i, 1] - half_y - margin, position[i, 1] + half_y + margin
