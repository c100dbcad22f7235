"""Which shapes can touch each other: all but those that a medium, a joint or a layer keeps apart."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Layer, Medium, Shape, Transform
from physicslab.components.layer import OTHERS, OWN
from physicslab.state.state import State

_OWN, _OTHERS = (Layer.FIELDS[1].check(word) for word in (OWN, OTHERS))
"""How columns store these."""


def solid_rows(state: State) -> NDArray[np.int64]:
    """Return the rows (n,) of all shapes that can touch others."""
    rows = state.batch(Shape, Transform).rows
    return rows[~state.table(Medium).present[rows]] if len(state.batch(Medium)) else rows


def is_any_apart(state: State) -> bool:
    """Whether joints or layers keep any two shapes from touching each other."""
    return len(state.joints.apart) > 0 or state.entity_index.has_any(Layer)


def may_touch(state: State, a: NDArray[Any], b: NDArray[Any]) -> NDArray[np.bool_]:
    """Return of pairs of rows (n,) which of them no joint and no layer keeps from touching each other."""
    low, high = np.minimum(a, b).astype(np.int64), np.maximum(a, b).astype(np.int64)
    apart, pairs = state.joints.apart, (low << 32) | high
    keys = np.append((apart[:, 0] << 32) | apart[:, 1], -1)  # sorted, but for one that no pair has
    touching: NDArray[np.bool_] = keys[np.searchsorted(keys[:-1], pairs)] != pairs
    if len(state.batch(Layer)):
        touching &= _touches(state, low, high) & _touches(state, high, low)
    return touching


def _touches(state: State, one: NDArray[np.int64], other: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return whether bodies in rows (n,) touch the layers of others; the layer of none is 0."""
    table = state.table(Layer)
    touches, own, layer = table["touches"][one], table["number"][one], table["number"][other]
    found: NDArray[np.bool_] = touches == 0
    found |= (touches == _OWN) & ((layer == own) | (layer == 0))
    found |= (touches == _OTHERS) & (layer != own)
    return found
