"""Which bodies joints and layers keep from touching each other."""

from physicslab.kernels import Flags, Rows, inlined, kernel
from physicslab.kernels.records import Couples

ALL, OWN, OTHERS = 0, 1, 2
"""Which layers a body touches, as columns of :class:`~physicslab.components.layer.Layer` have it: every one,
as a body without a Layer does; its own, and bodies without one; all but its own. Of a larger number: none."""


@inlined
def _touches(layer: Rows, touches: Rows, i: int, j: int) -> bool:
    """Whether body i touches the layer of body j; the layer of none is 0."""
    if touches[i] == OWN:
        return bool((layer[j] == layer[i]) | (layer[j] == 0))
    return bool(touches[i] == ALL) or bool((touches[i] == OTHERS) & (layer[j] != layer[i]))


@inlined
def may_touch(first_apart: Rows, apart: Rows, layer: Rows, touches: Rows, i: int, j: int) -> bool:
    """Whether no joint and no layer keeps bodies i and j from touching each other.

    Parameters
    ----------
    first_apart, apart : int64 arrays (rows + 1,), (n,)
        The rows that joints keep apart from a row and that are higher: ``apart[first_apart[i]:first_apart[i +
        1]]``, sorted. Both empty where there are none.
    layer, touches : int64 arrays (rows,)
        The layer of each body, and which others it touches; empty where no body has one.
    i, j : int
        The rows.
    """
    if len(layer) and not (_touches(layer, touches, i, j) and _touches(layer, touches, j, i)):
        return False
    if not len(apart):
        return True
    low, high = min(i, j), max(i, j)
    left, end = first_apart[low], first_apart[low + 1]
    while left < end:
        middle = (left + end) >> 1
        if apart[middle] == high:
            return False
        if apart[middle] < high:
            left = middle + 1
        else:
            end = middle
    return True


@kernel
def mark_touching(
    first_apart: Rows, apart: Rows, layer: Rows, touches: Rows, a: Rows, b: Rows, found: Flags
) -> None:
    """Mark in ``found`` (n,) which pairs of rows ``a`` and ``b`` (n,) :func:`may_touch`."""
    for k in range(len(a)):
        found[k] = may_touch(first_apart, apart, layer, touches, a[k], b[k])


@kernel
def keep_touching(
    first_apart: Rows, apart: Rows, layer: Rows, touches: Rows, couples: Couples, count: int
) -> int:
    """Keep those of the first ``count`` of ``couples`` that :func:`may_touch`, in order; return how many."""
    kept = 0
    for k in range(count):
        i, j = couples[2 * k], couples[2 * k + 1]
        if may_touch(first_apart, apart, layer, touches, i, j):
            couples[2 * kept], couples[2 * kept + 1] = i, j
            kept += 1
    return kept
