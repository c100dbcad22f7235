"""Which worlds can have their collisions located exactly, and which gain by it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Held, Material, Shape, Transform, Velocity
from physicslab.components.shape import BOX, CIRCLE
from physicslab.systems.schedule import ForceSystem, Stage

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["FEW", "MOST_PAIRS", "pairs_that_may_meet", "turning_boxes", "why_not_exact", "why_not_worthwhile"]

FEW = 32
"""So many moving bodies, at the most, are few."""
MOST_PAIRS = 20_000
"""Every impact looks through all pairs: beyond so many that costs more than any accuracy is worth."""
_CONTACT_STEP = ("IntegrateSystem", "BroadPhaseSystem", "ContactSystem", "ResolveSystem")
_KNOWN = ("Bodies", "SleepSystem", *_CONTACT_STEP)
_AROUND = {Stage.INPUT, Stage.PREPARE, Stage.IMPACT, Stage.FINISH, Stage.RENDER, Stage.HUD}
_NEAR = 0.01
"""Share of the smaller body's size within which bodies count as lying on each other."""


def why_not_exact(world: World) -> str | None:
    """Return what stands in the way of locating the times of impacts, or ``None``.

    Between impacts a body must move under a constant acceleration, and no box may turn.
    """
    if world.simulation.integrator not in ("auto", "exact"):
        return f"{world.simulation.integrator} was asked for, and flights between impacts are in closed form"
    reason = _foreign(world)
    if reason is not None:
        return reason
    if world.physics.linear_damping > 0.0 or world.physics.angular_damping > 0.0:
        return "velocities are damped"
    if len(world.batch(Held)):
        return "a body is held"
    if (world.table(Velocity).present & ~world.table(Transform).present).any():
        return "something moves that is nowhere"
    rows = turning_boxes(world)
    if len(rows):
        return f"{world.label(int(world.entity_index.entities[rows[0]]))} is a box that may turn"
    if _count_pairs(world) > MOST_PAIRS:
        return f"more than {MOST_PAIRS} pairs may meet"
    return None


def _foreign(world: World) -> str | None:
    """Return what acts within a step that is neither uniform gravity nor the contact step, or ``None``."""
    running = world.schedule.running
    for name in _CONTACT_STEP:
        if not any(system.name == name for system in running):
            return f"{name} is not among the systems, which moves what rests"
    for system in running:
        if isinstance(system, ForceSystem):
            if system.name != "GravitySystem" or not type(system).packs():
                return f"the force of {system.name} bends the flights"
            if world.physics.gravity_mode == "planet":
                return "planets attract each other"
        elif system.name not in _KNOWN and not set(type(system).marked()) <= _AROUND:
            return f"{system.name} acts within the step"
    return None


def turning_boxes(world: World) -> NDArray[np.int64]:
    """Return the rows of boxes that turn, or would if they were struck beside the middle."""
    moving = world.batch(Shape, Transform, Velocity).rows
    boxes = moving[world.table(Shape)["kind"][moving] == BOX]
    turns = (world.bodies.inverse_inertia[boxes] > 0.0) | (world.table(Velocity)["angular"][boxes] != 0.0)
    turning: NDArray[np.int64] = boxes[turns]
    return turning


def _count_pairs(world: World) -> int:
    """Return how many pairs may meet, without making a list of what may be thousands of millions."""
    shaped = world.batch(Shape, Transform).rows
    count, movable = len(shaped), int(np.count_nonzero(world.bodies.inverse_mass[shaped] > 0.0))
    walls = 0 if world.physics.bounds is None else 4
    return movable * (movable - 1) // 2 + movable * (count - movable) + movable * walls


def pairs_that_may_meet(world: World) -> NDArray[np.int64]:
    """Return every pair of rows (a, b, wall) of which one can be moved, sorted, bounds as walls of row 0."""
    shaped = world.batch(Shape, Transform).rows
    inverse_mass = world.bodies.inverse_mass[shaped]
    i, j = np.triu_indices(len(shaped), 1)
    meets = (inverse_mass[i] > 0.0) | (inverse_mass[j] > 0.0)
    bodies = np.stack((shaped[i[meets]], shaped[j[meets]], np.full(int(meets.sum()), -1)), axis=1)
    walled = np.zeros((0, 3), np.int64)
    if world.physics.bounds is not None:
        inner = np.repeat(shaped[inverse_mass > 0.0], 4)
        walled = np.stack((np.zeros_like(inner), inner, np.tile(np.arange(4), len(inner) // 4)), axis=1)
    return np.ascontiguousarray(np.concatenate((walled, bodies)), dtype=np.int64)


def why_not_worthwhile(world: World) -> str | None:
    """Return why a world that qualifies is better off with the contact step, or ``None``."""
    moving = world.batch(Transform, Velocity).rows
    if len(moving) > FEW:
        return f"more than {FEW} bodies move"
    pairs = pairs_that_may_meet(world)
    restitution = world.table(Material)["restitution"]
    other = np.where(pairs[:, 2] >= 0, world.physics.bounds_restitution, restitution[pairs[:, 0]])
    if (np.minimum(other, restitution[pairs[:, 1]]) == 0.0).any():
        return "some pairs do not bounce"
    return _why_at_rest(world, moving, pairs)


def _why_at_rest(world: World, moving: NDArray[np.int64], pairs: NDArray[np.int64]) -> str | None:
    """Return what already lies on what, as far as boxes along the axes around all bodies can tell."""
    if not any(system.name == "GravitySystem" for system in world.schedule.running):
        return None  # nothing presses
    low, high, size = _boxes(world)
    a, b, wall = pairs.T
    apart = np.maximum(low[b] - high[a], low[a] - high[b]).max(axis=1)
    if world.physics.bounds is not None:
        bounds = np.array(world.physics.bounds)
        to_wall = np.concatenate((low - bounds[:2], bounds[2:] - high), axis=1)
        apart = np.where(wall >= 0, to_wall[b, wall], apart)
        size = size.copy()
        size[0] = np.inf
    velocity = world.table(Velocity)["linear"]
    fall = float(world.physics.gravity.magnitude) * world.simulation.dt
    slow = np.hypot(*(velocity[b] - velocity[a]).T) <= fall
    lies = slow & (apart <= _NEAR * np.minimum(size[a], size[b]))
    free = world.bodies.inverse_mass > 0.0
    if (lies & free[a] & free[b]).any():
        return "bodies rest on each other"
    proximity_count = np.unique(np.concatenate((a[lies & free[a]], b[lies & free[b]])))
    if len(moving) and len(proximity_count) == int(free[moving].sum()):
        return "everything rests"
    return None


def _boxes(world: World) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return the lowest and highest coordinates of every row (rows, 2), and its size [m]."""
    shape, transform = world.table(Shape), world.table(Transform)
    c, s = np.abs(np.cos(transform["angle"])), np.abs(np.sin(transform["angle"]))
    width, height, radius = shape["width"], shape["height"], shape["radius"]
    box = 0.5 * np.stack((c * width + s * height, s * width + c * height), axis=1)
    half = np.where((shape["kind"] == CIRCLE)[:, None], radius[:, None], box)
    size = np.where(shape["kind"] == CIRCLE, 2.0 * radius, np.minimum(width, height))
    return transform["position"] - half, transform["position"] + half, size
