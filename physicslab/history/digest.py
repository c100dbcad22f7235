"""Whether the columns of motion have the bits that they had."""

from __future__ import annotations

import numpy as np

from physicslab.components import Transform, Velocity
from physicslab.kernels.digest import digest_motion
from physicslab.state.masses import quiet
from physicslab.world import World

__all__ = ["COLUMNS", "Digest", "differing", "digest_of"]

type Digest = tuple[int, int, int, int]
"""32 bits for each of the columns of motion after a step."""

COLUMNS = ("Transform.position", "Transform.angle", "Velocity.linear", "Velocity.angular")
"""These columns."""


@quiet
def digest_of(world: World) -> Digest:
    """Return the digest of a world. It does not depend on how rows are numbered."""
    index, transform, velocity = world.entity_index, world.table(Transform), world.table(Velocity)
    rows = slice(1, None) if len(index.row_of) + 1 == len(index) else np.flatnonzero(index.entities)
    columns = (transform["position"], transform["angle"], velocity["linear"], velocity["angular"])
    position, angle, linear, angular = (column[rows].reshape(-1).view(np.int64) for column in columns)
    return digest_motion(position, angle, linear, angular)


def differing(one: Digest, other: Digest) -> tuple[str, ...]:
    """Return the names of the columns in which two digests differ."""
    return tuple(name for name, a, b in zip(COLUMNS, one, other, strict=True) if a != b)
