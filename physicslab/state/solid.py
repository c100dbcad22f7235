"""Which shapes can touch each other: all but those that a medium, a joint or a layer keeps apart."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Layer, Medium, Shape, Transform
from physicslab.kernels import direct_entry
from physicslab.kernels.broad import filters
from physicslab.state.state import State

_NONE = np.zeros(0, np.int64)


def solid_rows(state: State) -> NDArray[np.int64]:
    """Return the rows (n,) of all shapes that can touch others."""
    rows = state.batch(Shape, Transform).rows
    return rows[~state.table(Medium).present[rows]] if len(state.batch(Medium)) else rows


def is_any_apart(state: State) -> bool:
    """Whether joints or layers keep any two shapes from touching each other."""
    return len(state.joints.apart) > 0 or state.entity_index.has_any(Layer)


def filters_of(state: State) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Return what joints and layers keep apart, in four arrays (:func:`.filters.may_touch`)."""
    apart, layer, touches = state.joints.apart, _NONE, _NONE
    if state.entity_index.has_any(Layer):
        layer, touches = state.table(Layer)["number"], state.table(Layer)["touches"]
    if not len(apart):
        return _NONE, _NONE, layer, touches
    first = np.searchsorted(apart[:, 0], np.arange(len(state.entity_index) + 1))
    return first, np.ascontiguousarray(apart[:, 1]), layer, touches


def may_touch(state: State, a: NDArray[Any], b: NDArray[Any]) -> NDArray[np.bool_]:
    """Return of pairs of rows (n,) which of them no joint and no layer keeps from touching each other."""
    state.compile((filters.mark_touching,))
    touching, one, other = np.zeros(len(a), np.bool_), a.astype(np.int64), b.astype(np.int64)
    direct_entry(filters.mark_touching)(*filters_of(state), one, other, touching)
    return touching
