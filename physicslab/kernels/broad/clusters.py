"""Clusters of circles: those that overlap, and those that overlap these, are one."""

from physicslab.kernels import Numbers, Rows, Vectors, kernel
from physicslab.kernels.disjoint_sets import join_sets, root_of

_NEXT = 8
"""With so many circles along the axis each is compared first: of a heap this leaves hardly two clusters, and
the search ends as soon as there is one."""


@kernel
def label_clusters(order: Rows, axis: int, position: Vectors, radius: Numbers, labels: Rows) -> None:
    """Set the labels of circles in one cluster to the smallest of them, which are their own numbers at first.

    Parameters
    ----------
    order, axis : int64 array (m,), int
        The circles that count, sorted along an axis (0 or 1): best along which they are spread most.
    position, radius : float64 arrays (n, 2), (n,)
        Centres and radii [m].
    labels : int64 array (n,)
        Numbers from 0 on; those of circles that do not count stay.
    """
    farthest = 0.0
    for k in range(len(order)):
        farthest = max(farthest, radius[order[k]])
    left = len(order)
    for ahead in (_NEXT, len(order)):
        for k in range(len(order)):
            if left <= 1:
                break
            i = order[k]
            most = (radius[i] + farthest) * (radius[i] + farthest)
            for m in range(k + 1, min(len(order), k + 1 + ahead)):
                j = order[m]
                dx, dy = position[j, 0] - position[i, 0], position[j, 1] - position[i, 1]
                along = position[j, axis] - position[i, axis]
                if along * along > most:
                    break
                near = dx * dx + dy * dy <= (radius[i] + radius[j]) * (radius[i] + radius[j])
                if near and root_of(labels, i) != root_of(labels, j):
                    join_sets(labels, i, j)
                    left -= 1
    for k in range(len(order)):
        labels[order[k]] = root_of(labels, order[k])
