"""Which shapes can touch each other: all but those that a medium fills."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Medium, Shape, Transform
from physicslab.state.state import State


def solid_rows(state: State) -> NDArray[np.int64]:
    """Return the rows (n,) of all shapes that can touch others."""
    rows = state.batch(Shape, Transform).rows
    return rows[~state.table(Medium).present[rows]] if len(state.batch(Medium)) else rows
