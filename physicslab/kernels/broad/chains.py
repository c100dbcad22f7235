"""Near pairs of bodies and segments of chains: these are few and do not move, so each looks at all bodies."""

import math

from physicslab.kernels import Numbers, Rows, Vectors, kernel
from physicslab.kernels.geometry.shapes import ShapesTuple, named_shapes
from physicslab.kernels.records import Pairs

_ARC = 0.05
"""How far arcs at its ends may lie beside a segment, of the larger one of its extents: half of the sagitta of
15 degrees, times the root of 2."""


@kernel
def add_chains(
    chains: Rows, segments: Rows, position: Vectors, angle: Numbers, plain_shapes: ShapesTuple,
    boxes: Vectors, fat: Vectors, inverse_mass: Numbers, pairs: Pairs, count: int,
) -> int:  # fmt: skip
    """Add to ``count`` pairs those of bodies that can be moved and segments, in order; return how many then.

    Where ``pairs`` has no room, the number is larger than that.

    Parameters
    ----------
    chains, segments : int64 arrays (n,)
        The rows of the chains, and how many segments each has.
    position, angle : float64 arrays (rows, 2), (rows,)
        Where everything is [m], [rad].
    boxes, fat : float64 arrays (rows, 4), (8, rows)
        Fat boxes (:mod:`physicslab.kernels.broad.fat_boxes`).
    inverse_mass : float64 array (rows,)
        Zero for what cannot be moved [1/kg].
    pairs : int64 array (m, 3)
        Rows a < b, and the segment k as -2 - k.
    """
    shapes = named_shapes(plain_shapes)
    for n in range(len(chains)):
        c, first = chains[n], shapes.first[chains[n]]
        half_x, half_y = shapes.half_x[c], shapes.half_y[c]
        cosine, sine = math.cos(angle[c]), math.sin(angle[c])
        for i in range(len(inverse_mass)):
            if not (inverse_mass[i] > 0.0 and shapes.vertices[i] > 0):
                continue
            # A margin is a share of the reach, and that of a chain is long; points go by the smaller body.
            room = min(fat[4, c], fat[4, i])
            left, low = boxes[i, 0] - position[c, 0] - room, boxes[i, 1] - position[c, 1] - room
            right, high = boxes[i, 2] - position[c, 0] + room, boxes[i, 3] - position[c, 1] + room
            px, py = half_x * shapes.pool[first, 0], half_y * shapes.pool[first, 1]
            px, py = cosine * px - sine * py, sine * px + cosine * py
            for k in range(segments[n]):
                qx, qy = half_x * shapes.pool[first + k + 1, 0], half_y * shapes.pool[first + k + 1, 1]
                qx, qy = cosine * qx - sine * qy, sine * qx + cosine * qy
                beside = _ARC * max(abs(qx - px), abs(qy - py))
                across = min(px, qx) <= right + beside and max(px, qx) >= left - beside
                if across and min(py, qy) <= high + beside and max(py, qy) >= low - beside:
                    if count < len(pairs):
                        pairs[count, 0], pairs[count, 1], pairs[count, 2] = min(c, i), max(c, i), -2 - k
                    count += 1
                px, py = qx, qy
    return count
