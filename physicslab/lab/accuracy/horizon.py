"""Until when a scene can be predicted: how fast a start that is displaced parts from it."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform
from physicslab.files.reader import read_scene
from physicslab.lab.accuracy.paths import rows_of
from physicslab.lab.accuracy.twins import ROUNDING, Document
from physicslab.lab.jobs import Job
from physicslab.state.masses import Diverged
from physicslab.world import World

_DISPLACED = 1e-10
"""By what share of its size each body is displaced in the twin that shows how errors grow."""
_PARTED = 0.1
"""Two runs in which a body is so many of its sizes apart have parted: they are different futures."""
_LOOKS = 400
"""How often two runs are compared."""


def sizes_of(world: World, bodies: Sequence[str]) -> NDArray[np.float64]:
    """Return half the extent of each body (n,) [m]; of one without a shape that of the whole scene."""
    rows = rows_of(world, bodies)
    shape, places = world.table(Shape), world.table(Transform)["position"][rows]
    sizes = np.maximum(shape["radius"][rows], 0.5 * np.hypot(shape["width"][rows], shape["height"][rows]))
    whole = float(np.abs(places - places.mean(axis=0)).max(initial=0.0)) or 1.0
    return np.where(sizes > 0.0, sizes, whole)


def find_horizon(document: Document, bodies: Sequence[str], seconds: float) -> Job[float | None]:
    """Find the time at which a rounding has become another future; yield the share of the work that is done.

    That is the time from the start [s] at which an error of one rounding has grown to a tenth of a body's
    size, at the rate at which a larger one does; ``None`` where none does within the run.

    Parameters
    ----------
    document : Document
        The scene, with ids.
    bodies : sequence of str
        Those that can move.
    seconds : float
        How long it is run [s].
    """
    world, twin = read_scene(document), read_scene(document)
    rows, other = rows_of(world, bodies), rows_of(twin, bodies)
    if not rows:
        return None
    sizes = sizes_of(world, bodies)
    ways = np.random.default_rng(0).choice((-1.0, 1.0), (len(bodies), 2))
    twin.table(Transform)["position"][other] += _DISPLACED * sizes[:, None] * ways
    stride = max(1, round(seconds / world.simulation.dt) // _LOOKS)
    start = world.time
    beside = twin.stepping(seconds=seconds, stride=stride)
    try:
        for _ in world.stepping(seconds=seconds, stride=stride):
            next(beside, None)
            apart = world.table(Transform)["position"][rows] - twin.table(Transform)["position"][other]
            if (np.hypot(*apart.T) > _PARTED * sizes).any():
                rate = math.log(_PARTED / _DISPLACED) / (world.time - start)
                return math.log(_PARTED / ROUNDING) / rate
            yield (world.time - start) / seconds
    except Diverged:
        return None
    return None
