"""A gas of discs."""

import math

import numpy as np

from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import circle
from physicslab.state.contents import Contents


def gas(
    world: Contents, count: int, region: tuple[float, float, float, float], *, radius: float = 0.1,
    mass: float = 1.0, slowest: float = 1.0, fastest: float = 3.0, seed: int = 1,
) -> list[int]:  # fmt: skip
    """Spawn elastic, frictionless discs that move in all directions; return their entities.

    No two overlap: each is at a random place in a cell of its own.

    Parameters
    ----------
    count : int
        How many.
    region : tuple of four floats
        Where they are at the start: xmin, ymin, xmax, ymax [m].
    radius, mass : float
        Radius [m] and mass [kg] of each.
    slowest, fastest : float
        Limits of the speeds [m/s].
    seed : int
        Seed of places, directions and speeds.

    Raises
    ------
    ValueError
        If ``count`` is less than 1, or the region has no room for so many.
    """
    if count < 1:
        raise ValueError(f"count = {count!r}: must be a whole number >= 1")
    left, bottom, right, top = region
    columns = max(1, math.ceil(math.sqrt(count * (right - left) / (top - bottom))))
    rows = math.ceil(count / columns)
    cell = Vector2((right - left) / columns, (top - bottom) / rows)
    room = Vector2(cell.x / 2.0 - radius, cell.y / 2.0 - radius)
    if min(room) < 0.0:
        raise ValueError(f"{count} discs of radius {radius:g} m have no room in {region}")
    random = np.random.default_rng(seed)
    places = (random.uniform(-1.0, 1.0, (count, 2)) * tuple(room)).tolist()
    angles = random.uniform(0.0, 2.0 * math.pi, count).tolist()
    speeds = random.uniform(slowest, fastest, count).tolist()
    discs: list[int] = []
    for i, ((x, y), angle, speed) in enumerate(zip(places, angles, speeds, strict=True)):
        place = Vector2(left + (i % columns + 0.5) * cell.x + x, bottom + (i // columns + 0.5) * cell.y + y)
        velocity = Vector2.from_angle(angle, speed)
        discs.append(
            circle(world, place, radius=radius, mass=mass, velocity=velocity, restitution=1.0, friction=0.0)
        )
    return discs
