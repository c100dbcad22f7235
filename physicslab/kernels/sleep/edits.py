"""Which sleeping bodies were edited, overlapped or pushed from outside the steps."""

import math

from physicslab.kernels import Flags, Numbers, Rows, Vectors, kernel

FIGURES = 12
"""How many numbers describe where a body is and what it is made of."""
INVERSE_MASS = 9
"""Index of the inverse mass among them."""
_VERTICES, _REACH, _MOVES = 3, 4, 11
_MARGIN = 1.05
"""Factor by which circles around bodies are enlarged, for rounding and gaps."""
_SAME = 1e-6
"""Relative change of a force below which it counts as the same."""


@kernel
def note_figures(
    position: Vectors, angle: Numbers, vertices: Rows, first: Rows, half_x: Numbers, half_y: Numbers,
    reach: Numbers, restitution: Numbers, friction: Numbers, inverse_mass: Numbers, inverse_inertia: Numbers,
    moves: Flags, figures: Vectors,
) -> None:  # fmt: skip
    """Write down where every body is and what it is made of."""
    for i in range(len(angle)):
        figures[i, 0], figures[i, 1], figures[i, 2] = position[i, 0], position[i, 1], angle[i]
        figures[i, _VERTICES], figures[i, _REACH] = vertices[i] + 16 * first[i], reach[i]
        figures[i, 5], figures[i, 6] = half_x[i], half_y[i]
        figures[i, 7], figures[i, 8] = restitution[i], friction[i]
        figures[i, INVERSE_MASS], figures[i, 10] = inverse_mass[i], inverse_inertia[i]
        figures[i, _MOVES] = 1.0 if moves[i] else 0.0


@kernel
def find_edited(
    figures: Vectors, kept: Vectors, linear: Vectors, angular: Numbers, asleep: Flags, known: Flags,
    within: bool, edited: Flags,
) -> int:  # fmt: skip
    """Mark sleeping bodies and fixed shapes that differ from what was ``kept``; return how many there are.

    A sleeping body must also have no velocity. Awake bodies that can be moved change in every step, and so
    does, ``within`` a step, the place of kinematic ones. Rows that are not ``known`` are new, and no edit.
    """
    found = 0
    for i in range(len(angular)):
        edited[i] = False
        if not known[i]:
            continue
        first = 0
        if asleep[i]:
            edited[i] = linear[i, 0] != 0.0 or linear[i, 1] != 0.0 or angular[i] != 0.0
        else:
            shaped = figures[i, _VERTICES] != 0.0 or kept[i, _VERTICES] != 0.0
            fixed = figures[i, INVERSE_MASS] == 0.0 or kept[i, INVERSE_MASS] == 0.0
            if not (shaped and fixed):
                continue
            if within and figures[i, _MOVES] != 0.0:
                first = _VERTICES
        for k in range(first, FIGURES):
            if figures[i, k] != kept[i, k]:
                edited[i] = True
        found += 1 if edited[i] else 0
    return found


@kernel
def find_overlapped(figures: Vectors, causes: Rows, asleep: Flags, marked: Flags) -> None:
    """Mark the sleeping bodies that the bodies ``causes`` may touch, by the circles around them."""
    for k in range(len(causes)):
        c = causes[k]
        if figures[c, _VERTICES] == 0.0:
            continue
        for i in range(len(asleep)):
            if asleep[i]:
                both = _MARGIN * (figures[c, _REACH] + figures[i, _REACH])
                x, y = figures[i, 0] - figures[c, 0], figures[i, 1] - figures[c, 1]
                if x * x + y * y <= both * both:
                    marked[i] = True


@kernel
def find_pushed(force: Vectors, torque: Numbers, kept: Vectors, asleep: Flags, pushed: Flags) -> int:
    """Mark the sleeping bodies on which other forces act than those ``kept`` (rows, 3); return how many.

    A kept force that is NaN is not known yet, as after a file was read, and is replaced by the present one.
    """
    found = 0
    for i in range(len(torque)):
        if not asleep[i]:
            continue
        if math.isnan(kept[i, 0]):
            kept[i, 0], kept[i, 1], kept[i, 2] = force[i, 0], force[i, 1], torque[i]
        x, y, turn = force[i, 0] - kept[i, 0], force[i, 1] - kept[i, 1], torque[i] - kept[i, 2]
        strength = kept[i, 0] * kept[i, 0] + kept[i, 1] * kept[i, 1]
        if x * x + y * y > _SAME * _SAME * strength or abs(turn) > _SAME * abs(kept[i, 2]):
            pushed[i] = True
            found += 1
    return found
